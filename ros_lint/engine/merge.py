"""Merge the findings for several distributions of ROS into one list."""

from __future__ import annotations

from collections import Counter
from functools import cached_property
from typing import TYPE_CHECKING

from ros_lint.base.suggestions import and_list

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from ros_lint.analysis.finding import Consequence, Fix
    from ros_lint.engine.report import Issue

DistroIssue = tuple["_DistroFindings", "Issue"]
"""The findings for a distribution, and one of these findings."""


def merge(issues_by_distro: Sequence[tuple[str, Sequence[Issue]]]) -> tuple[Issue, ...]:
    """Return the merged findings for several distributions, given pairs of a distribution and its findings.

    - Findings are merged into one if rule, package, subject, place, severity and confidence are equal.
    - The message is that for the first distribution with the finding. It ends with "(reported only for jazzy)" if not all
      distributions have the finding.
    - Its fix is safe only if every distribution has a safe fix with the same edits. That may be the fix of another finding.
    - It explains another finding only if it does so in every distribution that has the other finding.

    The result is not sorted.
    """
    if len(issues_by_distro) == 1:
        return tuple(issues_by_distro[0][1])
    distros = [_DistroFindings(name, issues) for name, issues in issues_by_distro]
    groups: dict[tuple[object, int], list[DistroIssue]] = {}
    for distro in distros:
        counts: Counter[object] = Counter()
        for issue in distro.issues:
            finding = issue.finding
            key = (issue.rule.code, issue.package, finding.subject, finding.span, issue.severity, finding.confidence)
            counts[key] += 1
            groups.setdefault((key, counts[key]), []).append((distro, issue))
    return tuple([_merged(group, distros) for group in groups.values()])


class _DistroFindings:
    """The findings for one distribution of ROS."""

    def __init__(self, name: str, issues: Sequence[Issue]) -> None:
        self.name = name
        self.issues = issues

    @cached_property
    def safe_edits(self) -> frozenset[object]:
        """The edits of all safe fixes: one tuple of edits for each fix."""
        return frozenset([issue.finding.fix.edits for issue in self.issues if issue.finding.fix and issue.finding.fix.safe])

    @cached_property
    def _subjects(self) -> frozenset[tuple[str, str, str]]:
        """Package, rule and subject of each finding; also package, rule and "", because "" in a Consequence means any subject."""
        subjects = [(issue.package, issue.rule.name, issue.finding.subject) for issue in self.issues]
        return frozenset([*subjects, *((package, rule, "") for package, rule, _ in subjects)])

    def accepts(self, entry: Consequence, issue: Issue) -> bool:
        """Return whether a finding that is merged from several distributions may explain the consequences ``entry``.

        ``issue`` is the finding in this distribution. The result is True if ``issue`` itself explains them, or if this
        distribution has no finding that ``entry`` describes.
        """
        return entry in issue.finding.explains or (issue.package, entry.rule, entry.subject) not in self._subjects


def _merged(group: Sequence[DistroIssue], distros: Sequence[_DistroFindings]) -> Issue:
    (_, first), *others = group
    finding = first.finding
    names = () if len(group) == len(distros) else tuple([distro.name for distro, _ in group])
    differing = [(distro.name, issue.finding.message) for distro, issue in others if issue.finding.message != finding.message]
    if names:
        ending = f" (reported only for {and_list(names)})"
    else:
        ending = f" (reported also for {and_list([name for name, _ in differing])})" if differing else ""
    entries = dict.fromkeys([entry for _, issue in group for entry in issue.finding.explains])
    merged = finding._replace(
        message=finding.message + ending,
        fix=_merged_fix([issue.finding.fix for _, issue in group], distros),
        explains=tuple([entry for entry in entries if all(distro.accepts(entry, issue) for distro, issue in group)]),
    )
    return first._replace(finding=merged, distros=names, other_messages=tuple(differing))


def _merged_fix(fixes: Sequence[Fix | None], distros: Iterable[_DistroFindings]) -> Fix | None:
    """Return the fix of a merged finding; None if any of the merged findings has no fix."""
    first = fixes[0]
    if first is None or None in fixes:
        return None
    return first._replace(safe=all(first.edits in distro.safe_edits for distro in distros))
