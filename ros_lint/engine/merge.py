"""Merge the findings of a workspace for several distributions into one list."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING

from ros_lint.base.suggestions import and_list

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ros_lint.analysis.finding import Fix
    from ros_lint.engine.report import Issue

DistroIssue = tuple[str, "Issue"]
"""A distribution with a finding for it."""


def merge(issues_by_distro: Sequence[tuple[str, Sequence[Issue]]]) -> tuple[Issue, ...]:
    """Return the findings for several distributions, each pair of which has the name of a distribution and its findings.

    Findings are merged into one if rule, package, subject, place, severity and confidence are equal. The merged finding has the
    message for the first distribution that has it, and ends with "(only in jazzy)" if not all distributions have it. Its fix
    is safe only if all distributions have the finding with the same safe fix. The result is not sorted.
    """
    if len(issues_by_distro) == 1:
        return tuple(issues_by_distro[0][1])
    groups: dict[tuple[object, int], list[DistroIssue]] = {}
    for distro, issues in issues_by_distro:
        counts: Counter[object] = Counter()
        for issue in issues:
            finding = issue.finding
            key = (issue.rule.code, issue.package, finding.subject, finding.span, issue.severity, finding.confidence)
            counts[key] += 1
            groups.setdefault((key, counts[key]), []).append((distro, issue))
    return tuple([_merged(group, everywhere=len(group) == len(issues_by_distro)) for group in groups.values()])


def _merged(group: Sequence[DistroIssue], *, everywhere: bool) -> Issue:
    (_, first), *others = group
    finding = first.finding
    differing = [(distro, issue.finding.message) for distro, issue in others if issue.finding.message != finding.message]
    distros = () if everywhere else tuple([distro for distro, _ in group])
    if distros:
        ending = f" (only in {and_list(distros)})"
    else:
        ending = f" (also in {and_list([distro for distro, _ in differing])})" if differing else ""
    merged = finding._replace(
        message=finding.message + ending,
        fix=_merged_fix([issue.finding.fix for _, issue in group], everywhere=everywhere),
        explains=tuple([entry for entry in finding.explains if all(entry in issue.finding.explains for _, issue in others)]),
    )
    return first._replace(finding=merged, distros=distros, other_messages=tuple(differing))


def _merged_fix(fixes: Sequence[Fix | None], *, everywhere: bool) -> Fix | None:
    """Return the fix of a merged finding; None if a distribution has the finding without a fix."""
    present = [fix for fix in fixes if fix is not None]
    if len(present) < len(fixes):
        return None
    first = present[0]
    return first._replace(safe=everywhere and all(fix.safe and fix.edits == first.edits for fix in present))
