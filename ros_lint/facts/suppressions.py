"""Comments that suppress findings."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from ros_lint.base.edit import Edit

if TYPE_CHECKING:
    from collections.abc import Iterable

    from ros_lint.base.text import Span


MARKER = "ros-lint:"
"""Only files that hold this can suppress anything."""


class Name(NamedTuple):
    """A rule as a suppression names it, by name or code."""

    text: str
    span: Span


class Suppression(NamedTuple):
    """A comment that suppresses findings of some rules, or a ``problem`` that keeps it from doing so."""

    names: tuple[Name, ...]
    reason: str
    lines: tuple[int, int] | None
    """First and last line that it speaks for, its own included; None stands for the whole file."""
    span: Span
    """From ``ros-lint:`` to the closing bracket."""
    inside: Span
    """Between the brackets."""
    removal: Edit
    """Takes it out of the file, with the comment when there is nothing else in it."""
    problem: str = ""
    """Why it suppresses nothing, as a message."""

    def covers(self, span: Span) -> bool:
        """Return whether it applies to a span of its file: one common line is enough."""
        if self.problem or span.path != self.span.path:
            return False
        if self.lines is None:
            return True
        first, last = lines_of(span)
        return first <= self.lines[1] and self.lines[0] <= last

    def without(self, names: Iterable[Name]) -> Edit:
        """Return the edit that takes some of the names out, and the whole suppression when none would be left."""
        gone = set(names)
        left = [name.text for name in self.names if name not in gone]
        return Edit(self.inside, ", ".join(left)) if left else self.removal


class Unused(NamedTuple):
    """Names in a suppression for which their rules found nothing to suppress."""

    suppression: Suppression
    names: tuple[Name, ...]


class Unknown(NamedTuple):
    """A name in a suppression that no rule has."""

    suppression: Suppression
    name: Name
    suggestion: str
    """The nearest name or code, or ""."""


def lines_of(span: Span) -> tuple[int, int]:
    """Return the first and the last line of a place: one that ends before the first column has nothing of its last line."""
    return span.line, span.end_line - 1 if span.end_column == 1 and span.end_line > span.line else span.end_line


class SuppressionUse(NamedTuple):
    """Which suppressions had no effect, and why."""

    unused: tuple[Unused, ...]
    unknown: tuple[Unknown, ...]
    malformed: tuple[Suppression, ...]
    """Those with a ``problem``."""
