"""Facts about CMake files: targets, and commands as written."""

from __future__ import annotations

from bisect import bisect_right
from typing import Literal, NamedTuple

from ros_lint.base.text import Span


class BuildTarget(NamedTuple):
    """An executable or a library that CMake builds."""

    name: str
    """Name of the target."""
    kind: Literal["executable", "library", "interface", "other"]
    """Kind of the target: "interface" for an interface library, "other" for a custom target."""
    sources: tuple[str, ...]
    """Source files, relative to the package."""
    test: bool
    """True if the target is built only when tests are built."""
    span: Span
    """Place of the name in the command that creates the target."""
    links: tuple[tuple[str, Span], ...] = ()
    """Names of libraries and targets that the target links in every build, each with its place."""
    optional_sources: tuple[str, ...] = ()
    """Source files that are not compiled in every build.

    For a target that is not created in every build, these are all its source files.
    """
    sources_known: bool = True
    """True if all source files of the target are known."""
    headers: tuple[str, ...] | None = None
    """Packages whose headers the target can include, mostly as named in find_package().

    Headers of the package itself are left out. None means that any header can be included: for tests, for targets without
    source files, and if the list is unknown.
    """


class CommandPlace(NamedTuple):
    """A call of a CMake command that is executed."""

    name: str
    """Name of the command, in lower case."""
    span: Span
    """Place of the command's name in the file."""


class UnsetVariable(NamedTuple):
    """A reference to an unset CMake variable, in an argument of a command that is certainly executed."""

    name: str
    """Name of the variable."""
    command: str
    """Name of the command with the reference, in lower case."""
    span: Span
    """Place of the name within ``${name}``."""


MOST_BLOCKS = 100
"""Maximum number of blocks that a :class:`Call` names. The blocks inside of these are left out."""


class Call(NamedTuple):
    """A command in a CMake file as it is written, without evaluation of its arguments."""

    name: str
    """Name of the command in lower case."""
    path: str
    """Path of the file, relative to the base folder of the run."""
    args: tuple[tuple[str, int, int, int], ...]
    """For each argument its text, kind, start and end offset. Rules use :attr:`texts` and :meth:`span` instead."""
    start: int
    """Offset of the command's name in the file."""
    end: int
    """Offset after the closing parenthesis."""
    line: int
    """Line of the command's name, from 1."""
    column: int
    """Column of the command's name, from 1."""
    breaks: tuple[int, ...]
    """Offsets at which the second and later lines of the command begin."""
    blocks: tuple[str, ...]
    """Enclosing blocks, outermost first: "if", "foreach", "while", "function", "macro". There are at most :data:`MOST_BLOCKS`."""
    test: bool
    """True if an enclosing if() depends on whether tests are built."""

    @property
    def texts(self) -> tuple[str, ...]:
        """Texts of the arguments, without quotes."""
        return tuple([argument[0] for argument in self.args])

    @property
    def name_span(self) -> Span:
        """Place of the command's name."""
        return Span(self.path, self.line, self.column, self.line, self.column + len(self.name))

    @property
    def extent(self) -> Span:
        """Place of the whole command."""
        return Span(self.path, self.line, self.column, *self._position(self.end))

    def span(self, index: int) -> Span:
        """Return the place of the argument with this index (from 0), including its quotes."""
        _, _, start, end = self.args[index]
        return Span(self.path, *self._position(start), *self._position(end))

    def _position(self, offset: int) -> tuple[int, int]:
        return position(offset, self.start, self.line, self.column, self.breaks)


def position(offset: int, start: int, line: int, column: int, breaks: tuple[int, ...]) -> tuple[int, int]:
    """Return the line and the column of ``offset``, a place in a command.

    The command begins at the offset ``start``, which is at ``line`` and ``column``. ``breaks`` are the offsets at which
    the second and later lines of the command begin.
    """
    lines = bisect_right(breaks, offset)
    return (line + lines, offset - breaks[lines - 1] + 1) if lines else (line, column + offset - start)
