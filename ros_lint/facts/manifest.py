"""What a package says of itself and of what it depends on: package.xml, colcon.pkg and colcon.meta."""

from __future__ import annotations

from collections.abc import Mapping
from enum import Flag, auto
from typing import Final, NamedTuple

from ros_lint.base.sealed import Sealed
from ros_lint.base.text import Span
from ros_lint.facts.visibility import Problem


class Role(Sealed, Flag):
    """What a package is needed for."""

    BUILD = auto()
    EXPORT = auto()
    """To build against this package: its public headers and exported targets."""
    EXEC = auto()
    TEST = auto()
    TOOL = auto()
    """To run on the build machine."""


class DependencyKind(NamedTuple):
    """What a dependency tag means to ROS, to colcon and in the data of the released world."""

    role: Role
    letters: str
    """In the index of the released world: b build, t buildtool, e build_export, u buildtool_export, x exec, s test, d doc,
    G group, M membership."""
    phases: tuple[str, ...]
    """The categories of colcon-ros that order packages; () if the tag orders none."""


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
"""What each dependency tag means (REP 127, 140 and 149; colcon_ros/package_identification/ros.py)."""

ROLES: Final[Mapping[str, Role]] = {tag: kind.role for tag, kind in DEPENDENCY_KINDS.items() if kind.role}
"""The role of each tag that declares a need."""


class Element(NamedTuple):
    """An element of a manifest that is no dependency: a child of ``<package>`` or of ``<export>``."""

    tag: str
    text: str
    attributes: tuple[tuple[str, str], ...]
    span: Span
    text_span: Span

    def get(self, attribute: str, default: str = "") -> str:
        return dict(self.attributes).get(attribute, default)


class Depend(NamedTuple):
    """A dependency element of a manifest, ``group_depend``, ``member_of_group``, ``conflict`` and ``replace`` included."""

    name: str
    tag: str
    condition: str
    """The text of the attribute, "" when there is none and " " when it is empty, which fails to parse. REP 149."""
    versions: tuple[tuple[str, str], ...]
    """Such as ("version_gte", "1.2.0")."""
    span: Span
    name_span: Span
    close: int = 0
    """Length of the end tag in code points, 0 when there is none or when it runs over a line end."""


class Manifest(NamedTuple):
    """A ``package.xml``, as far as it can be read. With problems, colcon takes it for no package."""

    path: str
    format: int
    name: str
    version: str
    elements: tuple[Element, ...]
    depends: tuple[Depend, ...]
    exports: tuple[Element, ...]
    problems: tuple[Problem, ...]
    name_span: Span
    end: Span
    """The empty span just before ``</package>``, where an element can be added."""
    begin: Span | None = None
    """The empty span just after ``<package ...>``; None when there is no such element."""
    format_span: Span | None = None
    """The value of the attribute ``format``; None when it has none, which means 1."""
    asides: tuple[Span, ...] = ()
    """Whatever else stands directly in ``<package>``: comments, instructions, stray text."""
    strays: tuple[Span, ...] = ()
    """Those of ``asides`` that are text."""
    indent: str = "  "
    """The white space before a child of ``<package>``."""
    newline: str = "\n"


class ColconDepend(NamedTuple):
    """An ordering edge that colcon takes from elsewhere than the manifest: colcon.pkg, colcon.meta or a plain script."""

    name: str
    role: Role
    span: Span


class ColconSettings(NamedTuple):
    """What a ``colcon.pkg``, or an entry of a ``colcon.meta``, sets for a package."""

    name: str
    """"" when it sets none."""
    type: str
    """"" when it sets none."""
    depends: tuple[ColconDepend, ...]


class ColconMeta(NamedTuple):
    """A ``colcon.meta``."""

    path: str
    by_name: tuple[tuple[str, ColconSettings], ...]
    by_path: tuple[tuple[str, ColconSettings], ...]
    """Paths as written, relative to the file."""
