"""What a rule is, and what it says."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from enum import IntEnum
from typing import TYPE_CHECKING, NamedTuple

from ros_lint.base.sealed import Sealed
from ros_lint.base.text import Span

if TYPE_CHECKING:
    from ros_lint.engine.suppressions import Outcome
    from ros_lint.workspace.model import Package, Workspace


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


class Edit(NamedTuple):
    """Put ``text`` where ``span`` is. An empty span inserts."""

    span: Span
    text: str
    kind: int = 0
    """Of several insertions at one place the one of the least kind comes first. Those of one kind belong together: they are set
    off by a blank line once. 0 belongs to nothing."""
    order: str = ""
    """Of those of one kind the one with the least comes first; those with the same one keep their order."""


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


class Rule(NamedTuple):
    """A check with its papers. Declared once, as ``RULE``, in the file that holds the check.

    Exactly one of ``package``, ``workspace`` and ``suppressions`` is given: a pure generator of findings for one
    package, for all, or about the comments that suppress findings, once all other rules have run.
    """

    name: str
    code: str
    """``ROS`` and three digits: 1xx workspace and manifest, 2xx dependencies, 3xx build scripts, 4xx install, 5xx launch,
    9xx the tool itself."""
    summary: str
    """Completes "checks that", lower case, no full stop: "used packages are declared"."""
    severity: Severity
    since: str
    doc: str
    """The module's docstring with the headings What it finds / Why it matters / How to fix it / Limitations."""
    default: bool = True
    """Whether it runs without being asked for."""
    fixable: bool = False
    """Whether some of its findings carry a fix."""
    package: Callable[[Package, Workspace], Iterable[Finding]] | None = None
    workspace: Callable[[Workspace], Iterable[Finding]] | None = None
    suppressions: Callable[[Outcome], Iterable[Finding]] | None = None
