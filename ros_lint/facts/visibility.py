"""What of a file cannot be seen through, and what is wrong with it."""

from __future__ import annotations

from enum import Flag, auto
from typing import NamedTuple

from ros_lint.base.sealed import Sealed
from ros_lint.base.text import Span


class Facet(Sealed, Flag):
    """A side of a package that something opaque can hide."""

    USES = auto()
    """Which packages it needs."""
    EXECUTABLES = auto()
    """What lands in lib/<package> and in bin."""
    SHARE = auto()
    """What lands in share/<package>: launch files, parameters, models."""
    PYTHON = auto()
    """Which Python modules it offers."""
    LIBRARIES = auto()
    """Libraries, headers, CMake packages and targets."""
    INTERFACES = auto()
    """Messages, services, actions."""
    COMPONENTS = auto()
    """Component and plugin classes."""


ALL_FACETS = Facet.USES | Facet.EXECUTABLES | Facet.SHARE | Facet.PYTHON | Facet.LIBRARIES | Facet.INTERFACES | Facet.COMPONENTS


class Opaque(NamedTuple):
    """A place that could not be seen through. A rule that claims absence keeps silent about what it hides."""

    hides: Facet
    reason: str
    """A clause without subject, such as "include() of ${name} cannot be followed"."""
    span: Span
    undefined: str = ""
    """The name of a target that is installed and that nothing in sight defines, where that is what hides something."""
    below: str = ""
    """The folder of the prefix that what is hidden lies below, "" if that may be any."""
    inside: str = ""
    """The folder with a build of its own that is what is not seen, in the package or beside it, "" if it may be any part of
    the build."""
    unchecked: bool = False
    """Whether the place exceeds a bound of ros-lint, so that the file counts as not checked."""

    def reaches(self, path: str) -> bool:
        """Return whether what is hidden may be at a path in the prefix, or in a folder there."""
        return not self.below or f"{path}/".startswith(f"{self.below}/") or self.below.startswith(f"{path}/")


class NewerSyntax(NamedTuple):
    """A construct of Python that versions before the one named refuse."""

    construct: str
    """A noun in the plural."""
    version: tuple[int, int]
    span: Span


class Problem(NamedTuple):
    """Something that makes a file wrong for the tools that read it."""

    kind: str
    """A short stable name, such as "unknown-tag"."""
    message: str
    span: Span
    instead: str = ""
    """What has taken the place of something that was right in ROS 1."""
    subject: str = ""
    """What it is about, where a rule asks for it: a path relative to the package, the pattern of a glob, a key, the format of
    manifests that has the tag or attribute which the one that is used lacks, what a keyword is called now."""
