"""Limits of the analysis of a file (``Opaque``) and errors in it (``Problem``)."""

from __future__ import annotations

from enum import Flag, auto
from typing import NamedTuple

from ros_lint.base.text import Span


class Facet(Flag):
    """A part of a package that a place without a known value can hide.

    Example: ``install(FILES ${UNKNOWN} DESTINATION lib/robot)`` hides EXECUTABLES.
    """

    USES = auto()
    """Packages that this package uses."""
    EXECUTABLES = auto()
    """Files installed to lib/<package> and to bin."""
    SHARE = auto()
    """Files installed to share/<package>: launch files, parameters, models."""
    PYTHON = auto()
    """Python modules that the package provides."""
    LIBRARIES = auto()
    """Libraries, headers, CMake packages and targets that the package provides."""
    INTERFACES = auto()
    """Messages, services and actions of the package."""
    COMPONENTS = auto()
    """Component and plugin classes of the package."""
    EXPORTS = auto()
    """Packages that CMake finds for the dependents of the package."""


ALL_FACETS = ~Facet(0)
"""All parts of a package."""


class Opaque(NamedTuple):
    """A place that could not be evaluated. A rule that claims absence reports nothing about what it hides."""

    hides: Facet
    """The parts of the package that may contain more than is known."""
    reason: str
    """Reason as a clause without subject, such as "include() of ${name} cannot be followed"."""
    span: Span
    """The place."""
    undefined: str = ""
    """Name of an installed target without a visible definition, if that is the reason."""
    below: str = ""
    """Folder of the install prefix that contains the hidden files, "" for any folder."""
    inside: str = ""
    """Folder with a separate build that was not analysed, "" for any part of the build.

    It is in the package or next to it.
    """
    unchecked: bool = False
    """True if a limit or a bug of ros-lint is the reason, so that the file counts as not checked."""

    def reaches(self, path: str) -> bool:
        """Return whether this place may hide ``path``, a file or folder in the install prefix, or a file below ``path``."""
        return not self.below or f"{path}/".startswith(f"{self.below}/") or self.below.startswith(f"{path}/")


class NewerSyntax(NamedTuple):
    """A construct of Python that versions before ``version`` reject."""

    construct: str
    """Name of the construct, in the plural."""
    version: tuple[int, int]
    """First version of Python that accepts it, such as (3, 12)."""
    span: Span
    """The place."""


class Problem(NamedTuple):
    """An error of a file for the tools that read it."""

    kind: str
    """Short stable name, such as "unknown-tag"."""
    message: str
    """Text in lower case without a final full stop."""
    span: Span
    """The place."""
    instead: str = ""
    """Replacement of something that was valid in ROS 1."""
    subject: str = ""
    """Subject of the problem, if a rule needs it.

    A path relative to the package (that of a missing folder to install ends with a slash), the pattern of a glob, a key,
    the manifest format that has a tag or attribute, or the new name of a keyword.
    """
