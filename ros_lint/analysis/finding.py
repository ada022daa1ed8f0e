"""Types of a rule's results: findings with their severity, confidence, related places and fixes."""

from __future__ import annotations

from enum import IntEnum
from typing import NamedTuple

from ros_lint.base.edit import Edit
from ros_lint.base.sealed import Sealed
from ros_lint.base.text import Span


class Severity(Sealed, IntEnum):
    """The impact of a problem, given that the finding is right."""

    INFO = 1
    WARNING = 2
    ERROR = 3

    def __str__(self) -> str:
        return self.name.lower()


class Confidence(Sealed, IntEnum):
    """The probability that a finding is right. Only HIGH, at least 99 %, is shown without ``--pedantic``."""

    LOW = 1
    MEDIUM = 2
    HIGH = 3

    def __str__(self) -> str:
        return self.name.lower()


class Fix(NamedTuple):
    """A way to fix a finding. ``title`` is a verb phrase: "declare 'std_msgs' as <depend>".

    A safe fix does not change the behaviour of working code; other fixes need ``--unsafe-fixes``.
    """

    title: str
    edits: tuple[Edit, ...]
    safe: bool = True

    @classmethod
    def of(cls, title: str, *edits: Edit | None, safe: bool = True) -> Fix | None:
        """Return the fix that makes some edits, or None if there are none or if one of them is None."""
        made = tuple([edit for edit in edits if edit is not None])
        return cls(title, made, safe) if made and len(made) == len(edits) else None


class Related(NamedTuple):
    """Another place that matters to a finding."""

    message: str
    span: Span


class Finding(NamedTuple):
    """A problem at a place. The engine adds the rule and the package.

    ``message`` is lower case without a final full stop; it says what is wrong and what to write. ``subject`` is the
    dependency, file or executable concerned: the stable part of the finding's identity. ``package`` is set by workspace
    rules only: the name of the package that has to change.
    """

    message: str
    span: Span
    subject: str
    related: tuple[Related, ...] = ()
    fix: Fix | None = None
    confidence: Confidence = Confidence.HIGH
    severity: Severity | None = None
    """Overrides the severity of the rule for a milder or graver case."""
    package: str = ""
    steps: bool = False
    """True if the related places are the steps of a path, such as a cycle or a dependency chain."""
