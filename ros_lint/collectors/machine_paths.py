"""Paths in files that exist on one machine only.

These are:
- paths below a home directory,
- paths into the sources relative to the workspace, which only work in that folder,
- paths that climb from an installed folder to the sources, which only work in the workspace that was built,
- paths into ``/opt/ros``, which only work with one distribution.
"""

from __future__ import annotations

import re

from ros_lint.base.text import Text
from ros_lint.collectors.comments import comments
from ros_lint.facts.sources import MachinePath

_PATH = re.compile(r"(?<![\w.$}~)*/-])(?:file://)?(?P<path>/(?:home|Users)/[\w.+-]+/[^\s\"'`<>|;:,()\[\]{}&$\\*?#]+)")
_ANY = re.compile(r"/(?:home|Users|opt/ros)/")
_DISTRIBUTION_PATH = re.compile(
    r"(?<![\w.$}~)*/-])(?:file://)?(?P<path>/opt/ros/[a-z]+/(?:share|lib)/[^\s\"'`<>|;:,()\[\]{}&$\\*?#]+)"
)
_WORKSPACE_PATH = re.compile(r"""(?P<path>~(?<=["']~)/(?:[\w.+-]+/)+(?:src|install)/[^\s"'`<>|;:,()\[\]{}&$\\*?#%]+)(?=["'])""")
_SOURCES = ("'src/", '"src/', "'./src/", '"./src/')
_SOURCE_PATH = re.compile(
    r"""(?:[=(:\[{]|\breturn|["']\s*,)\s*[rbu]?(?P<quote>["'])"""
    r"""(?P<path>(?:\./)?src/[\w.+-]+/[^\s"'`<>|;:,()\[\]{}&$\\*?#%]+)(?P=quote)"""
)
_CLIMBING_PATH = re.compile(r"""(?<=["')}])/?(?P<path>(?:\.\./){3,}src/[\w.+-]+/[^\s"'`<>|;:,()\[\]{}&$\\*?#%]+)(?=["'])""")
"""A share folder is three or four folders below the workspace."""
_INCLUDE = re.compile(r"#[ \t]*include[ \t]*[\"<]\Z")
_JOINED = re.compile(r"join(?:path)?\([^()]*\Z")
_MAX_CONTEXT = 200
_WRITE_MODE = re.compile(r"""["']\s*,\s*(?:(?:mode\s*=\s*)?["'][wax]|std::ios(?:_base)?::(?:out|app|trunc)\b)""")
_WRITING_CALL = re.compile(
    r"\bofstream\b[^;]*\Z|\b(?:imwrite|imsave|save|savefig|savetxt|to_csv|makedirs|mkdir)\(\s*f?[\"']\Z"
    r"|\b\w*(?:output|save)_(?:path|dir|directory|folder|file)[\"']?\s*[,:=]\s*(?:std::string\()?f?[\"']?\Z"
)
_RELATIVE_ATTRIBUTE = re.compile(r"\b(?:mesh|texture|asset)dir\s*=\s*[\"']\Z")
"""Attributes of MuJoCo models whose values are relative to the folder of the model."""
_PARAMETER_DEFAULT = re.compile(r"\bdeclare_parameter(?:<[\w:]+>)?\(\s*[\"'][\w./-]+[\"']\s*,\s*(?:std::string\(|\{)?\s*[\"']\Z")
_UNREAD = re.compile(r"^([ ]*)Description File:[^\n]*\n\1Description Source: Topic\b", re.MULTILINE)
"""Matches a file that RViz stores in a display but does not read, because the description is from a topic."""


def collect(text: Text) -> tuple[MachinePath, ...]:
    """Return the machine-specific paths of a file: in a home directory, in ``src``, or in ``/opt/ros``.

    Paths below ``~`` count only if they lead into a workspace. A path ends where a value is substituted. Left out are:
    - comments and docstrings,
    - paths that RViz stores but does not read,
    - computed paths (``"/home/" + user``, ``join(root, "src/robot")``),
    - folders that all users have.
    """
    content = text.text
    matches = [*_PATH.finditer(content), *_DISTRIBUTION_PATH.finditer(content)] if _ANY.search(content) else []
    if "~" in content:  # one letter is searched ten times as fast as two
        matches += _WORKSPACE_PATH.finditer(content)
    if "src/" in content and any(start in content for start in _SOURCES):
        matches += [
            match
            for match in _SOURCE_PATH.finditer(content)
            if not _JOINED.search(content, match.start() - _MAX_CONTEXT, match.start() + 1)
        ]
    if "../src/" in content:
        matches += [
            match
            for match in _CLIMBING_PATH.finditer(content)
            if not _INCLUDE.search(content, max(0, match.start() - _MAX_CONTEXT), match.start())
        ]
    if not matches:
        return ()
    matches.sort(key=lambda match: match.start("path"))
    ignored_ranges = [*comments(text), *(_docstrings(text) if text.path.endswith(".py") else ())]
    if text.path.endswith(".rviz"):
        ignored_ranges += [unread.span() for unread in _UNREAD.finditer(content)]
    reported = [match for match in matches if not any(start <= match.start("path") < end for start, end in ignored_ranges)]
    return tuple([_machine_path(text, match) for match in reported])


def _machine_path(text: Text, match: re.Match[str]) -> MachinePath:
    path = match["path"].rstrip("./")
    start = match.start("path")
    window_start = max(0, start - _MAX_CONTEXT)
    is_written = _WRITE_MODE.match(text.text, match.end("path")) or _WRITING_CALL.search(text.text, window_start, start)
    is_relative = _RELATIVE_ATTRIBUTE.search(text.text, window_start, match.start())
    is_default = _PARAMETER_DEFAULT.search(text.text, window_start, start)
    return MachinePath(path, text.span(start, start + len(path)), bool(is_written), bool(is_relative), bool(is_default))


def _docstrings(text: Text) -> list[tuple[int, int]]:
    """Return the ranges of strings that are statements: documentation and disabled code."""
    import ast  # noqa: PLC0415

    from ros_lint.collectors.python.source_errors import NotPythonError  # noqa: PLC0415
    from ros_lint.collectors.python.syntax import parse, range_of  # noqa: PLC0415

    try:
        tree = parse(text)
    except NotPythonError:
        return []
    values = (node.value for node in ast.walk(tree) if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant))
    return [range_of(text, node) for node in values if isinstance(node.value, str)]
