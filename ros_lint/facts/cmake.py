"""Targets of CMake, and its commands as they are written."""

from __future__ import annotations

from bisect import bisect_right
from typing import Literal, NamedTuple

from ros_lint.base.text import Span


class BuildTarget(NamedTuple):
    """An executable or a library that CMake builds."""

    name: str
    kind: Literal["executable", "library", "interface", "other"]
    sources: tuple[str, ...]
    """Relative to the package."""
    test: bool
    span: Span
    links: tuple[tuple[str, Span], ...] = ()
    """What it is linked with for sure, by name, each with the place that says so."""
    optional_sources: tuple[str, ...] = ()
    """Those of its sources that are not compiled in every build: all of them where it is not built in every one."""
    sources_known: bool = True
    """Whether all of its sources are known."""
    headers: tuple[str, ...] | None = None
    """What may give it headers that are not of the package, mostly as find_package() calls it; None if anything may, and for
    tests and what has no sources."""


class Call(NamedTuple):
    """A command of a CMake file as it is written, not evaluated."""

    name: str
    """In lower case."""
    path: str
    args: tuple[tuple[str, int, int, int], ...]
    """As :data:`ros_lint.collectors.cmake.syntax.Argument`: text, kind, and offsets of the whole argument."""
    start: int
    end: int
    """Offset after the closing parenthesis."""
    line: int
    column: int
    breaks: tuple[int, ...]
    """Offsets at which further lines of the command begin."""
    blocks: tuple[str, ...]
    """What it stands in, from outside: "if", "foreach", "while", "function", "macro"."""
    test: bool
    """Whether one of the conditions asks if tests are wanted."""

    @property
    def texts(self) -> tuple[str, ...]:
        """The arguments, without quotes."""
        return tuple([argument[0] for argument in self.args])

    @property
    def name_span(self) -> Span:
        """The name."""
        return Span(self.path, self.line, self.column, self.line, self.column + len(self.name))

    @property
    def extent(self) -> Span:
        return Span(self.path, self.line, self.column, *self._position(self.end))

    def span(self, index: int) -> Span:
        """Return the place of an argument, quotes included."""
        _, _, start, end = self.args[index]
        return Span(self.path, *self._position(start), *self._position(end))

    def _position(self, offset: int) -> tuple[int, int]:
        return position(offset, self.start, self.line, self.column, self.breaks)


def position(offset: int, start: int, line: int, column: int, breaks: tuple[int, ...]) -> tuple[int, int]:
    """Return line and column of an offset in what begins at some offset, line and column.

    ``breaks`` are the offsets at which further lines of it begin.
    """
    passed = bisect_right(breaks, offset)
    return (line + passed, offset - breaks[passed - 1] + 1) if passed else (line, column + offset - start)
