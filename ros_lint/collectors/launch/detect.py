"""Detection of launch files and of their language.

The content decides, because file names are ambiguous: ``.launch`` is XML of ROS 1 or ROS 2 or YAML, and one Python launch
file in forty has an unusual name. ``launch.frontend`` and ``python_launch_file_utilities`` decide by content, too.
"""

from __future__ import annotations

import re
from typing import Literal

Language = Literal["python", "xml", "yaml"]

LAUNCH_FILE_NAMES = ("launch.py", "launch.xml", "launch.yaml", "launch.yml", ".launch")
"""Suffixes by which ``ros2 launch`` recognizes launch files if the user gives a name without a path."""

_PYTHON = re.compile(r"generate_(launch|test)_description\b")
_DEF = re.compile(r"(?:async[ \t]+)?def[ \t]+\Z")
_HELPER = re.compile(r"^[ \t]*(?:from|import)[ \t]+launch(?:_ros)?\b", re.MULTILINE)
_ACTION = re.compile(r"\b(?:\w*Node|\w*LaunchDescription|ComposableNodeContainer)\(")
_SPACE = re.compile(r"\s*")
_ROOT = re.compile(r"<launch(?=[\s/>])")
# Syntax that only ROS 1 has, and syntax that only ROS 2 has. A file with both is a ROS 2 file with leftovers.
_ROS1 = re.compile(
    r"<(?:rosparam|machine)\b|<(?:node|test)\b[^>]*?\stype\s*=|\$\((?:arg|find|optenv)\s"
    r"|\spass_all_args\s*=|\sclear_params\s*=|<arg\b[^>]*?\sdoc\s*="
    r"|<(?:launch|group\b[^>]*)>\s*(?:<!--(?:[^-]|-(?!->))*-->\s*)*<param\b"
    r"|<param\b[^>]*?\s(?:command|textfile|binfile)\s*="
)
_ROS2 = re.compile(
    r"\sexec\s*=|\$\((?:var|find-pkg-share|find-pkg-prefix|exec-in-pkg|command)\s"
    r"|<(?:let|executable|node_container|load_composable_node|push[-_]ros[-_]namespace|set_parameter|set_env)\b"
)
_NODE_ATTRIBUTE = re.compile(r"pkg|exec|\stype\s*=")
_ROS2_WORDS = ("$(var ", "$(find-pkg-share ", " exec=")
_YAML_ROOT = re.compile(r"^(?:launch|'launch'|\"launch\")[ \t]*:", re.MULTILINE)
_YAML_OTHER = re.compile(r"^(?=[^\n])(?![ \t\r#%-]|launch[ \t]*:|['\"]launch['\"][ \t]*:|\.\.\.)", re.MULTILINE)


def is_launch_file(path: str, text: str) -> Language | None:
    """Return the language of a ROS 2 launch file, None for any other file.

    A Python module that only builds launch actions for other files counts as a launch file (see :attr:`LaunchFile.helper`). A
    launch file of ROS 1 does not count, because ros-lint does not check it.
    """
    if path.endswith(".py"):
        if "launch" not in text and "generate_test" not in text:
            return None
        return "python" if entries(text) or (_HELPER.search(text) and _ACTION.search(text)) else None
    if path.endswith((".yaml", ".yml")):
        return "yaml" if _is_yaml(text) else None
    if "<launch" in text and _is_xml(text):
        return None if _is_of_other_format(path, text) else "xml"
    if path.endswith(".launch") and _is_yaml(text):
        return "yaml"
    return None


def entries(text: str) -> frozenset[str]:
    """Return the kinds of functions for launch descriptions that a Python source defines.

    "launch" is for ``generate_launch_description()``, "test" for ``generate_test_description()``.
    """
    kinds = set()
    for match in _PYTHON.finditer(text):
        line = text.rfind("\n", 0, match.start()) + 1
        if _DEF.match(text, line, match.start()):
            kinds.add(match[1])
    return frozenset(kinds)


def is_of_ros_1(text: str) -> bool:
    """Return whether a text is a launch file of ROS 1, which ROS 2 cannot read."""
    return "<launch" in text and _is_launch(text) and not _is_xml(text)


def _is_launch(text: str) -> bool:
    return _ROOT.match(text, _after_prolog(text)) is not None


def _is_xml(text: str) -> bool:
    if not _is_launch(text):
        return False
    # The words are searched first, because a search with the regular expressions takes as long as reading the file.
    return any(word in text for word in _ROS2_WORDS) or not _ROS1.search(text) or bool(_ROS2.search(text))


def _is_of_other_format(path: str, text: str) -> bool:
    """Return whether an XML file with ``<launch>`` is no launch file: its nodes have neither package nor executable."""
    return "<node" in text and not path.endswith((".launch", ".launch.xml")) and not _NODE_ATTRIBUTE.search(text)


def _after_prolog(text: str) -> int:
    """Return the offset of the root element of an XML text, after the XML declaration, comments and document type."""
    at = 0
    while True:
        at = _SPACE.match(text, at).end()  # type: ignore[union-attr]
        for opening, closing in (("<?", "?>"), ("<!--", "-->"), ("<!", ">")):
            if text.startswith(opening, at):
                end = text.find(closing, at + len(opening))
                subset = text.find("[", at, end) if opening == "<!" else -1
                if subset >= 0:
                    end = text.find(closing, text.find("]", subset))
                if end < 0:
                    return len(text)
                at = end + len(closing)
                break
        else:
            return at


def _is_yaml(text: str) -> bool:
    return bool(_YAML_ROOT.search(text)) and not _YAML_OTHER.search(text)
