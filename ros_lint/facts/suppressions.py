"""Facts about comments that suppress findings: ``ros-lint: ignore[rule]``."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from ros_lint.base.edit import Edit
from ros_lint.base.text import Span

if TYPE_CHECKING:
    from collections.abc import Iterable


MARKER = "ros-lint:"
"""The text that every suppression comment contains."""


class Name(NamedTuple):
    """A rule in a suppression comment, given by name or code."""

    text: str
    """Name or code of a rule as written."""
    span: Span
    """Place of the name or code."""


class Suppression(NamedTuple):
    """A comment that suppresses findings of some rules. If ``problem`` is not empty, it suppresses nothing."""

    names: tuple[Name, ...]
    """The rules whose findings the comment suppresses."""
    reason: str
    """Text after the closing bracket, "" if there is none. It explains the suppression."""
    lines: tuple[int, int] | None
    """First and last line in which findings are suppressed, including the line of the comment; None for the whole file."""
    span: Span
    """Place from ``ros-lint:`` to the closing bracket."""
    inside: Span
    """Place between the brackets."""
    removal: Edit
    """Edit that removes the suppression, and the whole comment if it contains nothing else."""
    problem: str = ""
    """Message that explains why the comment suppresses nothing, "" if it is valid."""

    def covers(self, span: Span) -> bool:
        """Return whether the suppression applies to a span: one common line in the same file is enough."""
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
    """Names of rules in a suppression comment that have no effect, because the rules have no finding in the suppressed lines."""

    suppression: Suppression
    """The suppression comment."""
    names: tuple[Name, ...]
    """The names without effect, which can be removed."""


class UnknownSelector(NamedTuple):
    """A name in a suppression comment that is neither the name nor the code of a rule."""

    suppression: Suppression
    """The suppression comment."""
    name: Name
    """The unknown name."""
    suggestion: str
    """The most similar name or code of a rule, "" if there is none."""
    fate: str = ""
    """End of the message for the name of a rule that was removed or divided, such as "was removed"; "" for any other name."""


def lines_of(span: Span) -> tuple[int, int]:
    """Return the first and the last line of a span. If the span ends at the start of a line, this line is not included."""
    return span.line, span.end_line - 1 if span.end_column == 1 and span.end_line > span.line else span.end_line


class SuppressionUse(NamedTuple):
    """The suppression comments that have no effect, or that contain names without effect."""

    unused: tuple[Unused, ...]
    """Suppressions with names of rules that reported no finding in the suppressed lines."""
    unknown: tuple[UnknownSelector, ...]
    """Suppressions with names that no rule has."""
    malformed: tuple[Suppression, ...]
    """Suppressions that are invalid, with the reason in ``problem``."""
