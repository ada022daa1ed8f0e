"""Choose the fixes to apply. Each fix is tried in memory and checked before it is kept.

A fix is kept if the workspace, loaded and checked again with the fix, no longer has the fixed finding and has no new
finding. A new finding is accepted if a fix of the next round resolves it: a launch file that one fix installs can need a
dependency that another fix declares. So no fix is written that, for example, closes a dependency cycle or inserts an
unknown rosdep key.
"""

from __future__ import annotations

from types import MappingProxyType
from typing import TYPE_CHECKING, NamedTuple, Protocol

from ros_lint.engine import edits

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from ros_lint.engine.report import Issue

_MOST_ROUNDS = 100
"""Maximum number of rounds. If fixes conflict or depend on each other, each round applies one of them."""


class FixResult(NamedTuple):
    """The fixes that were checked successfully in memory, and the fixes that were skipped."""

    changed: Mapping[str, bytes]
    """The new contents of the changed files, by path."""
    applied: tuple[Issue, ...]
    skipped: tuple[tuple[Issue, str], ...]
    """Issues whose fix was not applied, each with the reason. Their spans refer to the files on disk."""


class Regression(NamedTuple):
    """A reason not to apply a group of fixes.

    If they would cause a finding, ``package`` and ``subject`` are those of the finding.
    """

    reason: str
    package: str | None = None
    subject: str | None = None

    def suspects(self, group: Sequence[Issue]) -> list[Issue]:
        """Return the issues of ``group`` whose fixes most likely cause this regression, judging by package and subject."""
        same_package = [issue for issue in group if issue.package == self.package]
        same_subject = [issue for issue in group if issue.finding.subject == self.subject]
        both = [issue for issue in same_package if issue in same_subject]
        return both or [issue for issue in same_package if _only_removes(issue)] or same_subject or same_package


class Trials(Protocol):
    """Tries fixes on a workspace without writing them. ``changed`` has the new contents of changed files, by path."""

    def fixable(self, changed: Mapping[str, bytes]) -> list[Issue]:
        """Return the issues that have a safe fix, or an unsafe fix if unsafe fixes are selected."""

    def applied(self, changed: Mapping[str, bytes], group: Iterable[Issue]) -> dict[str, bytes]:
        """Return ``changed`` with the fixes of ``group`` applied to it. Raises EditError if the fixes cannot be combined."""

    def regressions(self, changed: Mapping[str, bytes], group: Sequence[Issue]) -> tuple[Regression, ...]:
        """Return the reasons not to apply the fixes of ``group``, () if there are none."""

    def original(self, changed: Mapping[str, bytes], issue: Issue) -> Issue:
        """Return ``issue``, whose span is in the changed files, with its span in the files on disk."""

    def refused(self, changed: Mapping[str, bytes]) -> list[tuple[Issue, str]]:
        """Return the issues whose fixes edit a file that must not be changed, each with the reason."""


def fix(trials: Trials, unsaved: Mapping[str, bytes] = MappingProxyType({})) -> FixResult:
    """Return all fixes that resolve their finding and cause no new one, as checked in memory. No file is written.

    ``unsaved`` has contents, by path, that replace those on disk, such as unsaved files of an editor. They are part of
    ``FixResult.changed``.
    """
    changed = unsaved
    applied: list[Issue] = []
    for _ in range(_MOST_ROUNDS):
        last_round = _Round(trials, changed)
        last_round.run()
        changed = last_round.changed
        applied += last_round.applied
        if not last_round.applied:
            break  # otherwise the applied fixes may make others possible
    return FixResult(changed, tuple(applied), (*last_round.skipped.values(), *trials.refused(changed)))


class _Round:
    """One round of applying fixes in memory and checking the result.

    It applies fixes in groups that are as large as possible, each group in addition to the earlier groups.
    """

    def __init__(self, trials: Trials, changed: Mapping[str, bytes]) -> None:
        self._trials = trials
        self._groups: list[frozenset[str]] = []
        """Groups of issues whose fixes are still to be tried, each group as the identities of its issues."""
        self.changed = changed
        self.applied: list[Issue] = []
        self.skipped: dict[str, tuple[Issue, str]] = {}

    def run(self) -> None:
        self._postpone(self._trials.fixable(self.changed))
        while self._groups:
            self._try(self._groups.pop())

    def _try(self, identities: frozenset[str]) -> None:
        """Apply or skip the fixes of the issues with ``identities``. Postpone the fixes that need a trial in a smaller group.

        Most groups are large, and few of their fixes cause a regression. So the suspected fixes are postponed first. If
        the other fixes cause no regression, a suspect with a regression of its own is skipped without another trial.
        Otherwise the group is halved.
        """
        issues = [issue for issue in self._trials.fixable(self.changed) if issue.identity in identities]  # with current spans
        fixes = frozenset(edits.choose(issue.finding.fix for issue in issues if issue.finding.fix))
        group = [issue for issue in issues if issue.finding.fix in fixes]
        self._postpone(issue for issue in issues if issue.finding.fix not in fixes)
        regressions = self._trials.regressions(self.changed, group)
        suspects = _suspects(group, regressions)
        unsuspected = [issue for issue in group if issue not in suspects]
        names = list(dict.fromkeys(issue.identity for issue in group))
        if not regressions:
            self._apply(group)
        elif suspects and unsuspected and self._trials.regressions(self.changed, unsuspected):
            self._postpone(suspects)
            self._postpone(unsuspected)
        elif suspects and (unsuspected or all(suspects.values())):
            self._skip({issue: reason for issue, reason in suspects.items() if reason})
            self._apply(unsuspected)
            self._postpone(issue for issue, reason in suspects.items() if not reason)
        elif len(names) == 1:
            self._skip(dict.fromkeys(group, regressions[0].reason))
        else:
            first = frozenset(names[: len(names) // 2])
            self._groups += [frozenset(names) - first, first]

    def _postpone(self, issues: Iterable[Issue]) -> None:
        if identities := frozenset(issue.identity for issue in issues):
            self._groups.append(identities)

    def _apply(self, group: Sequence[Issue]) -> None:
        self.changed = self._trials.applied(self.changed, group)
        self.applied += group

    def _skip(self, reasons: Mapping[Issue, str]) -> None:
        for issue, reason in reasons.items():
            self.skipped[issue.identity] = (self._trials.original(self.changed, issue), reason)


def _only_removes(issue: Issue) -> bool:
    fix = issue.finding.fix
    return fix is not None and not any(edit.text.strip() for edit in fix.edits)


def _suspects(group: Sequence[Issue], regressions: Iterable[Regression]) -> Mapping[Issue, str]:
    """Return the issues whose fixes may cause the regressions, each with a reason.

    The reason is that of a regression for which the issue is the only suspect, "" if there is no such regression.
    """
    reasons: dict[Issue, str] = {}
    for regression in regressions:
        suspects = regression.suspects(group)
        for issue in suspects:
            reason = regression.reason if len(suspects) == 1 else ""
            reasons[issue] = reasons.get(issue, "") or reason
    return reasons
