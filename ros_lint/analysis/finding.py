"""Types of a rule's results: findings with their severity, confidence, related places and fixes."""

from __future__ import annotations

from enum import IntEnum
from typing import NamedTuple

from ros_lint.base.edit import Edit
from ros_lint.base.text import Span


class Severity(IntEnum):
    """The impact of a problem, provided that the finding about it is right."""

    INFO = 1
    """A matter of style, or an improvement."""
    WARNING = 2
    """A problem that does not occur now or on this machine, but later or for other users."""
    ERROR = 3
    """The build, the installation or the launch fails."""

    def __str__(self) -> str:
        return self.name.lower()


class Confidence(IntEnum):
    """The probability that a finding is right."""

    LOW = 1
    """A hint: the finding is often wrong."""
    MEDIUM = 2
    """The finding is probably right, but a doubt remains."""
    HIGH = 3
    """The finding is right in at least 99 of 100 cases."""

    def __str__(self) -> str:
        return self.name.lower()


class Fix(NamedTuple):
    """A way to fix a finding. ``ros-lint --fix`` applies it, unless the fix causes another finding."""

    title: str
    """Verb phrase: "declare 'std_msgs' as <depend>"."""
    edits: tuple[Edit, ...]
    """The changes, at least one. They are made all together or not at all."""
    safe: bool = True
    """True if the fix does not change the behaviour of working code; other fixes need ``--unsafe-fixes``."""

    @classmethod
    def of(cls, title: str, *edits: Edit | None, safe: bool = True) -> Fix | None:
        """Return the fix that makes ``edits``; None if there are no edits, or if an edit is None.

        The functions of :mod:`ros_lint.api.edits` return None if a file has no place for an edit.
        """
        present = tuple([edit for edit in edits if edit is not None])
        return cls(title, present, safe) if present and len(present) == len(edits) else None


class Related(NamedTuple):
    """A place, besides that of the finding, that matters to the finding."""

    message: str
    """Text in lower case without a final full stop."""
    span: Span
    """Position of the place."""


class Consequence(NamedTuple):
    """Findings that are not reported, because a reported finding in the package explains them.

    They are the findings of ``rule`` about ``subject``, e.g. the rule "unused-dependency" and the subject "rclpy".
    """

    rule: str
    """Name of the rule of the explained findings."""
    subject: str = ""
    """Subject of the explained findings; "" means all findings of the rule in the package."""


class Finding(NamedTuple):
    """A problem at a place. The engine adds the rule and the package."""

    message: str
    """Text in lower case without a final full stop: the problem, why it matters, what to write instead."""
    span: Span
    """Place of the problem."""
    subject: str
    """The dependency, file or executable that the finding is about.

    Rule, package and subject identify a finding when lines move, for example in a baseline.
    """
    related: tuple[Related, ...] = ()
    """Other places that matter to the finding."""
    fix: Fix | None = None
    """The fix of the problem, None if there is none. A rule whose findings have fixes is ``fixable``."""
    confidence: Confidence = Confidence.HIGH
    """Probability that the finding is right. Only HIGH is shown without ``--pedantic``."""
    severity: Severity | None = None
    """Severity of this finding if it differs from that of the rule, else None."""
    package: str = ""
    """Name of the package that has to change. Only rules that check the whole workspace set it."""
    steps: bool = False
    """True if the related places are the steps of a path, such as a cycle or a dependency chain."""
    explains: tuple[Consequence, ...] = ()
    """Findings that probably disappear, or become milder, once this finding is fixed.

    They are not shown beside this finding if their confidence is not greater.
    """
