"""Collector of models, displays, parameters and plugin descriptions: URDF, xacro, SDF, rviz, YAML, XML.

Such files name packages in a few fixed forms such as ``package://robot/``, so the text is searched and not parsed.
"""

from __future__ import annotations

import re
from bisect import bisect_left
from collections.abc import Iterator
from functools import lru_cache
from posixpath import normpath
from typing import TYPE_CHECKING

from ros_lint.collectors.launch.detect import is_of_ros_1
from ros_lint.collectors.resources import generated_parameters, parameter_files
from ros_lint.collectors.resources.xacro_conditions import inactive_ranges
from ros_lint.facts.sources import FileFacts, LookUp, Mention

if TYPE_CHECKING:
    from ros_lint.base.text import Text

_NAME = r"([A-Za-z][\w-]*)"
# Names that are looked up: package://p/meshes/a.stl in descriptions, $(find p) in xacro, $(find-pkg-share p) in parameters,
# <include ros_pkg="p"> in behavior trees. Each pattern starts with fixed letters, which are searched fast.
_LOOK_UPS = tuple(
    map(
        re.compile,
        (
            rf"package://{_NAME}(?=/)",
            rf"\$\(find(?:-pkg-share|-pkg-prefix)?\s+{_NAME}\s*\)",
            rf"""ros_pkg\s*=\s*["']{_NAME}["']""",
        ),
    )
)
# Names that are packages by convention only. model://p/a.stl may be a package or a model. Classes have the names of packages:
# Class: p/Name in rviz and rqt (rviz_common is built into rviz), type: p/Name in controllers, plugin: "p::Name" in navigation,
# <plugin>p/Name</plugin>, type="p::Name", moveit_controller_manager: p/Name. ros1_bridge translates ros2_package_name: p;
# ros_gz_bridge translates only messages that it depends on itself (ros_type_name).
_CLASS = r"([a-z]\w*)(?:/|::)[A-Za-z]"
_MANAGER = re.compile(rf"""moveit_controller_manager["']?[ \t]*:[ \t]*["']?{_CLASS}""")
_CONVENTIONS = (
    _MANAGER,
    *map(
        re.compile,
        (
            rf"model://{_NAME}(?=/)",
            rf"""Class["']?[ \t]*:[ \t]*["']?(?!rviz_common/){_CLASS}""",
            rf"""ype["']?[ \t]*[:=][ \t]*["']?{_CLASS}""",
            rf"""ros2_package_name["']?[ \t]*:[ \t]*["']?{_NAME}""",
            rf"""plugin(?:_name)?["']?[ \t]*[:>]\s*["']?{_CLASS}""",
        ),
    ),
)


def collect(source: Text) -> FileFacts:
    """Return the packages that a resource file names, the files that it looks up, and the parameters of a YAML file."""
    facts = _packages(source)
    if source.path.endswith((".yaml", ".yml")):
        return facts._replace(parameters=parameter_files.collect(source), nodes=generated_parameters.collect(source))
    return facts


def controller_managers(source: Text) -> tuple[Mention, ...]:
    """Return the packages of controller managers that MoveIt loads by parameters in a Python launch file."""
    result: dict[str, tuple[int, int]] = {}
    _search(_MANAGER, source.text, result)
    spans = source.spans(result.values())
    return tuple(
        Mention(name, "package", span, optional=True, purpose="plugins") for name, span in zip(result, spans, strict=True)
    )


def _packages(source: Text) -> FileFacts:
    """Return the packages that a resource file names, each at its first place, and the files that it looks up in them.

    A mention (a name that may belong to another package) is optional in two cases: the form of its text suggests a package, but
    nothing looks it up; or the file is a ROS 1 launch file. A mention has the purpose "conditional" if all its places are in
    blocks that xacro leaves out by default.
    """
    text = source.text
    places: dict[str, tuple[int, int]] = {}
    inactive = inactive_ranges(text)
    for pattern in _LOOK_UPS:
        _search(pattern, text, places, inactive)
    active = frozenset(places)
    if inactive:
        for pattern in _LOOK_UPS:
            _search(pattern, text, places)
    conditional = frozenset(places) - active
    certain = frozenset(places) if places and not is_of_ros_1(text) else frozenset()
    for pattern in _CONVENTIONS:
        _search(pattern, text, places)
    if not places:
        return FileFacts()
    looked_up = tuple(_files(source)) if certain else ()
    names = sorted(places, key=lambda name: places[name])
    spans = source.spans(places[name] for name in names)
    return FileFacts(
        tuple(
            Mention(name, "package", span, optional=name not in certain, purpose="conditional" if name in conditional else "")
            for name, span in zip(names, spans, strict=True)
        ),
        lookups=looked_up,
    )


# A path that continues with a reference or a variable is not a file name.
_FILE = re.compile(rf"(?:package://{_NAME}|\$\(find(?:-pkg-share)?\s+{_NAME}\s*\))/([\w./+-]*[\w+-]\.\w+)(?![\w./${{(@%-])")

# Files that a behavior tree includes from the share folder of a package (BehaviorTree.CPP, loadDocImpl).
_TREE = re.compile(rf"""<include\s(?=[^<>]*\bros_pkg\s*=\s*["']{_NAME}["'])[^<>]*>""")
_TREE_PATH = re.compile(r"""\spath\s*=\s*["'](\w[\w./+-]*\.\w+)["']""")


def _files(source: Text) -> Iterator[LookUp]:
    """Yield the files of packages to which a resource file refers, such as ``package://robot/meshes/arm.stl``, each once.

    The span of a look-up is the span of the first reference to the file.
    """
    places: dict[tuple[str, str], tuple[int, int]] = {}
    for match in _FILE.finditer(source.text):
        key = (match[1] or match[2], normpath(match[3].lstrip("/")))
        if key[1].startswith("../"):  # it is outside of the package
            continue
        if key not in places and not _in_comment(source.text, match.start()) and not _is_optional(source.text, match.start()):
            places[key] = match.span()
    for match in _TREE.finditer(source.text):
        path = _TREE_PATH.search(match[0])
        if path and not _in_comment(source.text, match.start()):
            start = match.start()
            places.setdefault((match[1], path[1]), (start + path.start(1), start + path.end(1)))
    names = sorted(places, key=lambda name: places[name])
    spans = source.spans([places[name] for name in names])
    yield from (LookUp(package, path, span) for (package, path), span in zip(names, spans, strict=True))


def _is_optional(text: str, at: int) -> bool:
    """Return whether an offset is in a tag that includes an optional file: ``<xacro:include optional="true"/>``."""
    opening = text.rfind("<", 0, at)
    return opening >= 0 and _OPTIONAL.match(text, opening) is not None


_OPTIONAL = re.compile(r"""<xacro:include\s[^<>]*\boptional\s*=""")


def _search(pattern: re.Pattern[str], text: str, places: dict[str, tuple[int, int]], inactive: tuple[range, ...] = ()) -> None:
    """Add the first place of each name in ``text`` to ``places``. Places in the offset ranges ``inactive`` are ignored."""
    for match in pattern.finditer(text):
        if any(match.start() in block for block in inactive):
            continue
        if match[1] not in places and not _in_comment(text, match.start()) and not _in_class(text, match.start()):
            places[match[1]] = match.span(1)


def _in_class(text: str, at: int) -> bool:
    """Return whether an offset is in a ``<class>`` tag of a plugin description.

    A package name in such a tag is not recorded, because the C++ code of the plugin includes headers of the package anyway.
    """
    return _PLUGIN.match(text, max(text.rfind("<", 0, at), 0)) is not None


_PLUGIN = re.compile(r"<class\s")


def _in_comment(text: str, at: int) -> bool:
    line = text[text.rfind("\n", 0, at) + 1 : at]
    if line.lstrip()[:1] == "#" or " # " in line:
        return True
    comments = _comments(text)
    number = bisect_left(comments, (at,)) - 1
    return number >= 0 and at < comments[number][1]


@lru_cache(maxsize=2)
def _comments(text: str) -> list[tuple[int, int]]:
    """Return the start and end offsets of the XML comments of a text. The offsets of one text are asked for many places."""
    comments: list[tuple[int, int]] = []
    start = text.find("<!--")
    while start >= 0 and (end := text.find("-->", start)) >= 0:
        comments.append((start, end))
        start = text.find("<!--", end + 3)
    return comments
