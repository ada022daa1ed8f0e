"""Comments that suppress findings."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from ros_lint.base.edit import Edit
from ros_lint.base.text import Span

if TYPE_CHECKING:
    from collections.abc import Iterable


MARKER = "ros-lint:"
"""The text that each suppression contains; files without it suppress nothing."""


class Name(NamedTuple):
    """A reference to a rule in a suppression, by name or code."""

    text: str
    """Name or code of a rule as written."""
    span: Span
    """The place."""


class Suppression(NamedTuple):
    """A comment that suppresses findings of some rules, or has a ``problem`` and suppresses nothing."""

    names: tuple[Name, ...]
    """The rules."""
    reason: str
    """Text after the closing bracket, "" if there is none."""
    lines: tuple[int, int] | None
    """First and last line that the suppression covers, its own included; None for the whole file."""
    span: Span
    """Span from ``ros-lint:`` to the closing bracket."""
    inside: Span
    """Span between the brackets."""
    removal: Edit
    """Edit that removes the suppression, and the comment if it contains nothing else."""
    problem: str = ""
    """Message that explains why the comment suppresses nothing, "" if it is valid."""

    def covers(self, span: Span) -> bool:
        """Return whether the suppression applies to a span of its file: one common line is enough."""
        if self.problem or span.path != self.span.path:
            return False
        if self.lines is None:
            return True
        first, last = lines_of(span)
        return first <= self.lines[1] and self.lines[0] <= last

    def without(self, names: Iterable[Name]) -> Edit:
        """Return the edit that removes ``names`` from the suppression, or the whole suppression if no name remains."""
        removed = set(names)
        remaining = [name.text for name in self.names if name not in removed]
        return Edit(self.inside, ", ".join(remaining)) if remaining else self.removal


class Unused(NamedTuple):
    """Names of rules in a suppression that hides no finding of these rules, so that the names can be removed."""

    suppression: Suppression
    """The comment."""
    names: tuple[Name, ...]
    """The names without effect."""


class UnknownSelector(NamedTuple):
    """A name in a suppression that is not the name of a rule."""

    suppression: Suppression
    """The comment."""
    name: Name
    """The name that no rule has."""
    suggestion: str
    """The nearest name or code, or ""."""
    fate: str = ""
    """End of the message about a former rule of this name, such as "was removed"; "" if no former rule has the name."""


def lines_of(span: Span) -> tuple[int, int]:
    """Return the first and the last line of a span.

    A span that ends before the first column of a line does not include that line.
    """
    return span.line, span.end_line - 1 if span.end_column == 1 and span.end_line > span.line else span.end_line


class SuppressionUse(NamedTuple):
    """The suppressions without effect, or with names without effect, in a list for each reason."""

    unused: tuple[Unused, ...]
    """Names of rules that reported nothing at the place."""
    unknown: tuple[UnknownSelector, ...]
    """Names that no rule has."""
    malformed: tuple[Suppression, ...]
    """Suppressions with a ``problem``."""
