"""Collectors of sources in other languages with ROS 2 bindings: Java, Rust and MATLAB.

As in C++, generators put the interfaces of each package into a namespace of that package: ``std_msgs.msg.String`` in Java
(rosidl_generator_java), ``std_msgs::msg::String`` in Rust (rosidl_generator_rs). The mentions (names that may belong to
another package) have ``via="symbol"``.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from typing import TYPE_CHECKING

from ros_lint.collectors.cpp.includes import blank_comments
from ros_lint.facts.sources import FileFacts, Mention

if TYPE_CHECKING:
    from ros_lint.base.text import Text

_STRING = re.compile(r'"(?:[^"\\\n]|\\.)*"')
_JAVA_TYPE = re.compile(r"(?<![\w.])([a-z]\w*)\.(?:msg|srv|action)\.[A-Z*]\w*")
_RCLJAVA = re.compile(r"^[ \t]*import[ \t]+(?:static[ \t]+)?(org\.ros2\.rcljava(?:\.(\w+))?)\b", re.MULTILINE)
_JAVA_MARKS = (".msg.", ".srv.", ".action.", "org.ros2.rcljava")
"""Texts of which every relevant Java source contains at least one, for a fast test before comments are removed."""
_RCLJAVA_COMMON = frozenset({"common", "exceptions", "interfaces"})
"""Parts of org.ros2.rcljava that belong to the package rcljava_common."""

_CRATE = re.compile(r"(?<![\w:])(?:use\s+|extern\s+crate\s+)(rclrs|rosidl_runtime_rs)\b")
_RUST_TYPE = re.compile(r"(?<![\w:])(?:::)?(?P<type>(?P<package>[a-z]\w*)::(?:msg|srv|action)::\w*)")
_RUST_MARKS = ("::msg::", "::srv::", "::action::", "rclrs", "rosidl_runtime_rs")
"""Texts of which every relevant Rust source contains at least one."""
_CRATE_PREFIX = re.compile(r"\buse\s[^;]*::\s*\{[^;]*\Z")
"""Matches the text before a name inside of another crate: ``use ros_env::{std_msgs::msg::String}``."""
_SECTION = re.compile(r"^[ \t]*\[+([^\]\n]+)\]+", re.MULTILINE)
_ENTRY = re.compile(r"^[ \t]*([\w-]+)(?:\.\w+)?[ \t]*=[ \t]*([^\n#]*)", re.MULTILINE)
_FROM_WORKSPACE = re.compile(r'"\*"|\bpath[ \t]*=')

_ROS_CALL = re.compile(r"\bros2(?:publisher|subscriber|message|svcclient|svcserver|actionclient|actionserver)[ \t]*\(([^%;\n]*)")
_ROS_TYPE = re.compile(r"""["']([a-z]\w*)/(?:(?:msg|srv|action)/)?[A-Z]\w*["']""")
_CONTINUED = re.compile(r"\.\.\.[^\n]*\n")


def java(source: Text) -> FileFacts:
    """Return mentions of the packages whose interfaces a Java source names, and of the packages of rcljava that it imports."""
    if not any(word in source.text for word in _JAVA_MARKS):
        return FileFacts()
    text = _STRING.sub(_spaces, blank_comments(source.text))
    names = [(match.span(), match[1]) for match in _JAVA_TYPE.finditer(text)]
    names += [
        (match.span(1), "rcljava_common" if match[2] in _RCLJAVA_COMMON else "rcljava") for match in _RCLJAVA.finditer(text)
    ]
    return _facts(source, names)


def rust(source: Text) -> FileFacts:
    """Return mentions of the packages whose interfaces a Rust source names, and of rclrs and rosidl_runtime_rs.

    Mentions in the unit tests of the source are marked with ``test``, so that a test dependency on the package suffices.
    """
    if not any(word in source.text for word in _RUST_MARKS):
        return FileFacts()
    text = _STRING.sub(_spaces, blank_comments(source.text))
    names = [(match.span(1), match[1]) for match in _CRATE.finditer(text)]
    names += [
        (match.span("type"), match["package"])
        for match in _RUST_TYPE.finditer(text)
        if not _CRATE_PREFIX.search(text, text.rfind(";", 0, match.start()) + 1, match.start())
    ]
    facts = _facts(source, names)
    tests = source.text.find("#[cfg(test)]")
    if tests < 0:
        return facts
    begin = source.span(tests, tests)  # unit tests are at the end of a source
    return facts._replace(mentions=tuple(mention._replace(test=mention.span > begin) for mention in facts.mentions))


def cargo(source: Text) -> FileFacts:
    """Return mentions of the dependencies in a Cargo.toml.

    Crates of the workspace have the version ``*`` or a path, which colcon-ros-cargo replaces by the installed package.
    Crates with another version may not be in the workspace, and their mentions are optional.
    """
    return FileFacts(tuple(_crates(source)))


def _crates(source: Text) -> Iterator[Mention]:
    text = source.text
    sections = list(_SECTION.finditer(text))
    ends = [*(section.start() for section in sections[1:]), len(text)]
    for section, end in zip(sections, ends, strict=False):
        path = section[1].strip().split(".")
        if path[-1].endswith("dependencies"):
            entries = [(match.span(1), match[2]) for match in _ENTRY.finditer(text, section.end(), end)]
        elif len(path) > 1 and path[-2].endswith("dependencies"):
            start = section.end(1) - len(path[-1])
            entries = [((start, section.end(1)), text[section.end() : end])]
        else:
            continue
        test = "dev-dependencies" in path
        for (start, stop), value in entries:
            name = text[start:stop]
            optional = not _FROM_WORKSPACE.search(value)
            yield Mention(name, "symbol", source.span(start, stop), f"crate {name}", optional, test)


def matlab(source: Text) -> FileFacts:
    """Return mentions of the interface packages that a MATLAB script uses in calls such as ``ros2publisher``.

    All mentions are optional, because MATLAB builds its own copies of the packages and runs outside of the workspace.
    """
    text = _CONTINUED.sub(_spaces, source.text)
    names = [
        ((call.start(1) + kind.start(1), call.start(1) + kind.end() - 1), kind[1])
        for call in _ROS_CALL.finditer(text)
        if "%" not in text[text.rfind("\n", 0, call.start()) + 1 : call.start()]
        for kind in _ROS_TYPE.finditer(call[1])
    ]
    return _facts(source, names, optional=True)


COLLECTORS: Mapping[str, Callable[[Text], FileFacts]] = {"java": java, "rust": rust, "cargo": cargo, "matlab": matlab}
"""The collectors of the sources in this module, by kind of file, see :mod:`ros_lint.workspace.collect`."""


def _spaces(match: re.Match[str]) -> str:
    return " " * len(match[0])


def _facts(source: Text, places: list[tuple[tuple[int, int], str]], *, optional: bool = False) -> FileFacts:
    """Return facts with one mention of each package, at its first place. ``places`` are offset ranges, each with its package."""
    first: dict[str, tuple[int, int]] = {}
    for place, package in sorted(places):
        first.setdefault(package, place)
    return FileFacts(
        tuple(
            Mention(package, "symbol", source.span(*place), source.text[place[0] : place[1]], optional)
            for package, place in first.items()
        ),
    )
