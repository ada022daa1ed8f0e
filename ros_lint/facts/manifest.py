"""Facts about package metadata and dependencies: package.xml, colcon.pkg and colcon.meta."""

from __future__ import annotations

from collections.abc import Mapping
from enum import Flag, auto
from typing import Final, NamedTuple

from ros_lint.base.text import Span
from ros_lint.facts.visibility import Problem


class Role(Flag):
    """A purpose for which a package needs another package."""

    BUILD = auto()
    """Needed to build this package."""
    EXPORT = auto()
    """Needed to build against this package: by its public headers and exported targets."""
    EXEC = auto()
    """Needed to run this package."""
    TEST = auto()
    """Needed by the tests only."""
    TOOL = auto()
    """Needed as a program on the build machine."""


class DependencyKind(NamedTuple):
    """The meaning of a dependency tag such as ``exec_depend``: its role, its letters in our data, its order in colcon."""

    role: Role
    letters: str
    """Letters of the tag in the index of released packages.

    b build, t buildtool, e build_export, u buildtool_export, x exec, s test, d doc, G group, M membership.
    """
    phases: tuple[str, ...]
    """Dependency categories of colcon-ros that order packages; () if the tag orders none."""


DEPENDENCY_KINDS: Final[Mapping[str, DependencyKind]] = {
    "depend": DependencyKind(Role.BUILD | Role.EXPORT | Role.EXEC, "bex", ("build", "run")),
    "build_depend": DependencyKind(Role.BUILD, "b", ("build",)),
    "buildtool_depend": DependencyKind(Role.TOOL, "t", ("build",)),
    "build_export_depend": DependencyKind(Role.EXPORT, "e", ("run",)),
    "buildtool_export_depend": DependencyKind(Role.TOOL | Role.EXPORT, "u", ("run",)),
    "exec_depend": DependencyKind(Role.EXEC, "x", ("run",)),
    "run_depend": DependencyKind(Role.EXPORT | Role.EXEC, "ex", ("run",)),
    "test_depend": DependencyKind(Role.TEST, "s", ("test",)),
    "doc_depend": DependencyKind(Role(0), "d", ()),
    "group_depend": DependencyKind(Role(0), "G", ()),
    "member_of_group": DependencyKind(Role(0), "M", ()),
    "conflict": DependencyKind(Role(0), "", ()),
    "replace": DependencyKind(Role(0), "", ()),
}
"""The meaning of each dependency tag (REP 127, 140 and 149; colcon_ros/package_identification/ros.py)."""

ROLES: Final[Mapping[str, Role]] = {tag: kind.role for tag, kind in DEPENDENCY_KINDS.items() if kind.role}
"""The role of each tag that declares a dependency."""


class Element(NamedTuple):
    """An element of a manifest that is not a dependency: a child of ``<package>`` or of ``<export>``."""

    tag: str
    """Name of the element."""
    text: str
    """Text of the element, without surrounding white space."""
    attributes: tuple[tuple[str, str], ...]
    """Names and values of the attributes."""
    span: Span
    """Place of the whole element."""
    text_span: Span
    """Place of the text."""
    attribute_spans: tuple[Span, ...] = ()
    """Places of the values of the attributes, without the quotes: one for each of ``attributes``."""

    def get(self, attribute: str, default: str = "") -> str:
        """Return the value of an attribute, or ``default`` if the element does not have it."""
        return dict(self.attributes).get(attribute, default)

    def span_of(self, attribute: str) -> Span:
        """Return the place of the value of an attribute, or of the whole element if it does not have the attribute."""
        names = [name for name, _ in self.attributes]
        return self.attribute_spans[names.index(attribute)] if attribute in names else self.span


class Depend(NamedTuple):
    """A dependency element of a manifest, ``group_depend``, ``member_of_group``, ``conflict`` and ``replace`` included."""

    name: str
    """Name of the package, rosdep key or group."""
    tag: str
    """Name of the element, such as "exec_depend"."""
    condition: str
    """Text of the attribute ``condition`` (REP 149), "" if absent. A finding about an attribute is placed at ``span``.

    " " is an empty attribute, which fails to parse.
    """
    versions: tuple[tuple[str, str], ...]
    """Version attributes, such as ("version_gte", "1.2.0")."""
    span: Span
    """Place of the whole element."""
    name_span: Span
    """Place of the name."""
    close: int = 0
    """Length of the end tag in code points.

    0 if there is no end tag or if it contains a line end.
    """


class Manifest(NamedTuple):
    """A ``package.xml``, as far as it can be read.

    If it has problems, colcon does not recognize the package.
    """

    path: str
    """Path of the file, relative to the base of the run."""
    format: int
    """Value of the attribute ``format``; 1 if it is absent."""
    name: str
    """Text of ``<name>``, "" if there is none."""
    version: str
    """Text of ``<version>``, "" if there is none."""
    elements: tuple[Element, ...]
    """Children of ``<package>`` that declare no dependency, ``<export>`` included."""
    depends: tuple[Depend, ...]
    """Dependency tags in the order of the file, whatever their condition is."""
    exports: tuple[Element, ...]
    """Children of ``<export>``."""
    problems: tuple[Problem, ...]
    """Errors for which colcon or catkin_pkg rejects the file."""
    name_span: Span
    """Place of the name, or of the root element if there is no name."""
    end: Span
    """The empty span just before ``</package>``, where an element can be added."""
    begin: Span | None = None
    """The empty span just after ``<package ...>``; None if there is no such element."""
    format_span: Span | None = None
    """Span of the value of the attribute ``format``; None if it is absent, which means format 1."""
    other_contents: tuple[Span, ...] = ()
    """Other direct contents of ``<package>``: comments, processing instructions, stray text."""
    stray_text: tuple[Span, ...] = ()
    """The members of ``other_contents`` that are text."""
    indent: str = "  "
    """White space before a child of ``<package>``."""
    newline: str = "\n"
    """Line end of the file."""
    text: str = ""
    """The file, for its validation by the XML schema; "" if it has no ``<package>``."""
    codec: str = "utf-8"
    """Codec that encodes the text to the bytes of the file."""


class ColconDepend(NamedTuple):
    """A dependency that colcon takes from a place other than package.xml.

    The place is colcon.pkg, colcon.meta or a plain script.
    """

    name: str
    """Name of the package."""
    role: Role
    """Purposes that the place declares."""
    span: Span
    """The place."""


class ColconSettings(NamedTuple):
    """Settings of a package in a ``colcon.pkg``, or in an entry of a ``colcon.meta``."""

    name: str
    """Name of the package, "" if not set."""
    type: str
    """Build type of the package, "" if not set."""
    depends: tuple[ColconDepend, ...]


class ColconMeta(NamedTuple):
    """The settings in a ``colcon.meta``: for packages given by name, and for packages given by path."""

    path: str
    by_name: tuple[tuple[str, ColconSettings], ...]
    by_path: tuple[tuple[str, ColconSettings], ...]
    """Settings by path: as written, relative to the file."""
