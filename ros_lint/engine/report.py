"""What a run found, what it did not show, and what it could not see: all that a reporter needs."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from ros_lint.workspace.target import TargetDistro, UnreadFile

if TYPE_CHECKING:
    from ros_lint.analysis.finding import Finding, Severity
    from ros_lint.analysis.rule import Rule


class Issue(NamedTuple):
    """A finding with the rule that made it and the package that has to change, "" when it is none of the workspace."""

    rule: Rule
    package: str
    finding: Finding

    @property
    def severity(self) -> Severity:
        return self.finding.severity or self.rule.severity

    @property
    def identity(self) -> str:
        """What stays the same when lines move: rule, package and subject. Two places can share it."""
        return f"{self.rule.code}/{self.package}/{self.finding.subject}"


UNSURE = "of lower confidence (shown with --pedantic)"


class HiddenCount(NamedTuple):
    """Findings that are not shown. ``reason`` goes on from the count, as :data:`UNSURE` does."""

    reason: str
    count: int  # type: ignore[assignment]  # a tuple counts things as well


class BlindSpot(NamedTuple):
    """A side of packages that something opaque hides."""

    what: str
    """In words: "executables"."""
    packages: tuple[str, ...]
    """The names of those that it concerns, in the order of the workspace."""


class Crash(NamedTuple):
    """A rule that failed, for one package or (``package`` is "") for the workspace."""

    rule: str
    package: str
    traceback: str

    @property
    def error(self) -> str:
        """The last line of the traceback: type and message."""
        return self.traceback.strip().rpartition("\n")[2]


class Report(NamedTuple):
    """The result of a run. The same input gives the same report, on any machine."""

    issues: tuple[Issue, ...]
    """Those to show, sorted by span, code, message."""
    rules: tuple[Rule, ...]
    """Those that ran, sorted by code."""
    packages: int
    """How many were checked. 0 means that nothing was."""
    target: TargetDistro
    data_date: str
    """Of what is known about the released world, as YYYY-MM-DD."""
    version: str
    """Of ros-lint."""
    hidden: tuple[HiddenCount, ...] = ()
    not_checked: tuple[UnreadFile, ...] = ()
    unseen: tuple[BlindSpot, ...] = ()
    crashes: tuple[Crash, ...] = ()
    workspace: str = ""
    """The folder that was checked, relative to the base that paths are relative to; "" is the base."""
    warnings: tuple[str, ...] = ()
    """What is odd about what was asked for: no part of the output, but told all the same."""

    def count(self, severity: Severity) -> int:
        """Return how many issues have a severity."""
        return sum(issue.severity is severity for issue in self.issues)

    def fixable(self, *, safe: bool) -> int:
        """Return how many issues carry a safe fix, or one that is not."""
        return sum(issue.finding.fix is not None and issue.finding.fix.safe is safe for issue in self.issues)
