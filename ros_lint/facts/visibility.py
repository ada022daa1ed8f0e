"""Parts of a file that could not be analysed (``Opaque``), and errors in a file (``Problem``)."""

from __future__ import annotations

from enum import Flag, auto
from typing import NamedTuple

from ros_lint.base.text import Span


class Facet(Flag):
    """A kind of contents of a package.

    If a place in a build script cannot be evaluated, it may add unknown contents of some kinds. Example: ``install(FILES
    ${UNKNOWN} DESTINATION lib/robot)`` may add to EXECUTABLES.
    """

    USES = auto()
    """Other packages that the package uses."""
    EXECUTABLES = auto()
    """Files installed to lib/<package> and to bin."""
    SHARE = auto()
    """Files installed to share/<package>: launch files, parameters, models."""
    PYTHON = auto()
    """Python modules that the package installs."""
    LIBRARIES = auto()
    """Libraries, headers, CMake packages and CMake targets that the package provides."""
    INTERFACES = auto()
    """Messages, services and actions of the package."""
    COMPONENTS = auto()
    """Component classes and plugin classes of the package."""
    EXPORTS = auto()
    """Packages that the CMake configuration file of the package searches for on behalf of dependents."""


ALL_FACETS = ~Facet(0)
"""All kinds of contents."""


class Opaque(NamedTuple):
    """A place in a file that ros-lint could not evaluate, for example a command with an unknown variable.

    Rules that report missing contents report nothing about the contents in ``hides``.
    """

    hides: Facet
    """The kinds of contents to which the place may add more than is known."""
    reason: str
    """Reason why the place could not be evaluated, as a clause such as "include() of ${name} cannot be followed"."""
    span: Span
    """The place in the file."""
    undefined: str = ""
    """Name of the installed target whose definition was not found, if this is the reason; otherwise ""."""
    below: str = ""
    """Folder of the install prefix that contains the unknown files, "" for any folder."""
    inside: str = ""
    """Folder with a build of its own that was not analysed, in the package or next to it; "" for any part of the build."""
    unchecked: bool = False
    """True if a limit or a bug of ros-lint is the reason. The file then counts as not checked."""

    def reaches(self, path: str) -> bool:
        """Return whether this place may add ``path``, a file or folder in the install prefix, or a file below ``path``."""
        return not self.below or f"{path}/".startswith(f"{self.below}/") or self.below.startswith(f"{path}/")


class NewerSyntax(NamedTuple):
    """A construct in a Python source that versions of Python before ``version`` reject."""

    construct: str
    """Name of the construct, in the plural."""
    version: tuple[int, int]
    """First version of Python that accepts the construct, such as (3, 12)."""
    span: Span
    """Place of the construct."""


class Problem(NamedTuple):
    """An error in a file that makes a tool fail, or report an error, when it reads the file."""

    kind: str
    """Short stable name of the kind of error, such as "unknown-tag"."""
    message: str
    """Message in lower case without a final full stop."""
    span: Span
    """Place of the error."""
    instead: str = ""
    """The ROS 2 name that replaces a name that was valid in ROS 1; "" for other errors."""
    subject: str = ""
    """Name or path that the error is about, "" if no rule needs it.

    It is a path relative to the package (that of a missing folder to install ends with a slash), the pattern of a glob, a
    key, the manifest format that has a tag or attribute, or the new name of a keyword.
    """
