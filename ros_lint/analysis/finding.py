"""What a rule reports: findings with their severity, confidence, related places and fixes."""

from __future__ import annotations

from enum import IntEnum
from typing import NamedTuple

from ros_lint.base.edit import Edit
from ros_lint.base.sealed import Sealed
from ros_lint.base.text import Span


class Severity(Sealed, IntEnum):
    """How bad it is if the finding is right."""

    INFO = 1
    WARNING = 2
    ERROR = 3

    def __str__(self) -> str:
        return self.name.lower()


class Confidence(Sealed, IntEnum):
    """How sure the tool is. Without ``--pedantic`` only HIGH is shown: right at least 99 times in 100."""

    LOW = 1
    MEDIUM = 2
    HIGH = 3

    def __str__(self) -> str:
        return self.name.lower()


class Fix(NamedTuple):
    """One way out. ``title`` is a verb phrase: "declare std_msgs as <depend>".

    A safe fix keeps the meaning of everything that works; the others need ``--unsafe-fixes``.
    """

    title: str
    edits: tuple[Edit, ...]
    safe: bool = True

    @classmethod
    def of(cls, title: str, *edits: Edit | None, safe: bool = True) -> Fix | None:
        """Return the fix that some edits are, None where there are none, or where one of them cannot be made."""
        made = tuple([edit for edit in edits if edit is not None])
        return cls(title, made, safe) if made and len(made) == len(edits) else None


class Related(NamedTuple):
    """Another place that matters to a finding."""

    message: str
    span: Span


class Finding(NamedTuple):
    """Something wrong at a place. It knows neither its rule nor its package: the engine does.

    ``message`` is lower case without a final full stop, names the culprit and the way out. ``subject`` is the
    dependency, file or executable concerned: the stable part of the finding's identity. ``package`` is set only by
    workspace rules, to the name of the package that has to change.
    """

    message: str
    span: Span
    subject: str
    related: tuple[Related, ...] = ()
    fix: Fix | None = None
    confidence: Confidence = Confidence.HIGH
    severity: Severity | None = None
    """Instead of the rule's, where one case is milder than the others."""
    package: str = ""
    steps: bool = False
    """Whether the related places are the steps of one way, in order: round a cycle, or along a chain of needs."""
