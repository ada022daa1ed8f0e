"""Facts from the files with package metadata and dependencies: package.xml, colcon.pkg and colcon.meta."""

from __future__ import annotations

from collections.abc import Mapping
from enum import Flag, auto
from typing import Final, NamedTuple

from ros_lint.base.text import Span
from ros_lint.facts.visibility import Problem


class Role(Flag):
    """A purpose for which a package needs another package. Purposes can be combined."""

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
    """The meaning of a dependency tag such as ``exec_depend``: purpose, letters in the package index, effect in colcon."""

    role: Role
    letters: str
    """Letters for the tag in the index of released packages; "" if the index ignores the tag.

    b build, t buildtool, e build_export, u buildtool_export, x exec, s test, d doc, G group, M membership.
    """
    phases: tuple[str, ...]
    """Dependency categories of colcon-ros by which colcon sorts packages; () if the tag does not affect the order."""


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
"""The purpose of each tag that declares a dependency on a package."""


class Element(NamedTuple):
    """An element of a manifest that declares no dependency: a child of ``<package>`` or of ``<export>``."""

    tag: str
    """Name of the tag."""
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
        """Return the place of the value of an attribute, or of the whole element if the attribute is absent."""
        names = [name for name, _ in self.attributes]
        return self.attribute_spans[names.index(attribute)] if attribute in names else self.span


class Depend(NamedTuple):
    """A dependency element of a manifest, including ``group_depend``, ``member_of_group``, ``conflict`` and ``replace``."""

    name: str
    """Name of the package, rosdep key or group."""
    tag: str
    """Name of the tag, such as "exec_depend"."""
    condition: str
    """Text of the attribute ``condition`` (REP 149), "" if the attribute is absent.

    An empty attribute, which is an error, has the text " ". Findings about the condition are placed at ``span``.
    """
    versions: tuple[tuple[str, str], ...]
    """Names and values of the version attributes, such as ("version_gte", "1.2.0")."""
    span: Span
    """Place of the whole element."""
    name_span: Span
    """Place of the name."""
    close: int = 0
    """Length of the end tag in code points; 0 if there is no end tag or if it contains a line end."""


class Manifest(NamedTuple):
    """The contents of a ``package.xml`` that can be read.

    If ``problems`` is not empty, colcon does not recognize the package.
    """

    path: str
    """Path of the file, relative to the base folder of the run."""
    format: int
    """Value of the attribute ``format``; 1 if it is absent."""
    name: str
    """Text of ``<name>``, "" if there is none."""
    version: str
    """Text of ``<version>``, "" if there is none."""
    elements: tuple[Element, ...]
    """Children of ``<package>`` that declare no dependency, including ``<export>``."""
    depends: tuple[Depend, ...]
    """All dependency elements in the order of the file, including those whose condition is false."""
    exports: tuple[Element, ...]
    """Children of ``<export>``."""
    problems: tuple[Problem, ...]
    """Errors for which colcon or catkin_pkg rejects the file."""
    name_span: Span
    """Place of the name, or of the root element if there is no name."""
    end: Span
    """The empty span just before ``</package>``, where an element can be inserted."""
    begin: Span | None = None
    """The empty span just after ``<package ...>``; None if the file has no such element."""
    format_span: Span | None = None
    """Place of the value of the attribute ``format``; None if the attribute is absent, which means format 1."""
    other_contents: tuple[Span, ...] = ()
    """Direct contents of ``<package>`` that are not elements: comments, processing instructions, text."""
    stray_text: tuple[Span, ...] = ()
    """The members of ``other_contents`` that are text."""
    indent: str = "  "
    """White space before each child of ``<package>``."""
    newline: str = "\n"
    """Line end that the file uses."""
    text: str = ""
    """The text of the file, for its validation by the XML schema; "" if it has no ``<package>``."""
    codec: str = "utf-8"
    """Codec that encodes the text to the original bytes of the file."""


class ColconDepend(NamedTuple):
    """A dependency that colcon reads from colcon.pkg, colcon.meta or a script without manifest, not from package.xml."""

    name: str
    """Name of the package."""
    role: Role
    """Purposes of the dependency that the file declares."""
    span: Span
    """Place of the dependency in the file."""


class ColconSettings(NamedTuple):
    """Settings of a package in a ``colcon.pkg`` file, or in an entry of a ``colcon.meta`` file."""

    name: str
    """Name of the package, "" if not set."""
    type: str
    """Build type of the package, "" if not set."""
    depends: tuple[ColconDepend, ...]


class ColconMeta(NamedTuple):
    """The settings in a ``colcon.meta`` file, for packages given by name and for packages given by path."""

    path: str
    by_name: tuple[tuple[str, ColconSettings], ...]
    by_path: tuple[tuple[str, ColconSettings], ...]
    """Settings by the path of the package, as written, relative to the file."""
