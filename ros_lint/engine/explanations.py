"""Hide findings that are consequences of another finding, so that only the cause is shown."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ros_lint.engine.report import ExplainedFinding

if TYPE_CHECKING:
    from collections.abc import Container, Iterable, Sequence

    from ros_lint.engine.report import Issue


def without_explained(issues: Sequence[Issue], fixed_severities: Container[str] = ()) -> tuple[Issue, ...]:
    """Return the issues that are no consequence of another issue. ``explained`` of each issue has its consequences.

    - A cause explains only findings in its own package whose confidence is not higher than that of the cause, and only if
      the cause occurs in every distribution in which the finding occurs.
    - A cause gets the severity of its most severe consequence, unless its rule is one of ``fixed_severities``.
    - If issues explain only each other, all of them are returned.
    """
    packages = {issue.package for issue in issues if issue.finding.explains}
    by_package = {package: [issue for issue in issues if issue.package == package] for package in packages}
    causes = {issue: _explained_by(issue, by_package[issue.package]) for issue in issues if issue.finding.explains}
    if not any(causes.values()):
        return tuple(issues)
    consequences = {explained for group in causes.values() for explained in group}
    explained_issues: set[Issue] = set()
    pending = [issue for issue in causes if issue not in consequences]
    while pending:
        new = [issue for issue in causes[pending.pop()] if issue not in explained_issues]
        explained_issues.update(new)
        pending += [issue for issue in new if issue in causes]
    return tuple(
        [
            _with_explained(issue, [other for other in causes.get(issue, ()) if other in explained_issues], fixed_severities)
            for issue in issues
            if issue not in explained_issues
        ]
    )


def _explained_by(cause: Issue, issues: Iterable[Issue]) -> list[Issue]:
    """Return the elements of ``issues`` that ``cause`` explains. All of ``issues`` are about the package of ``cause``."""
    keys = {(consequence.rule, consequence.subject) for consequence in cause.finding.explains}
    return [
        issue
        for issue in issues
        if issue is not cause
        and not keys.isdisjoint([(issue.rule.name, issue.finding.subject), (issue.rule.name, "")])
        and issue.finding.confidence <= cause.finding.confidence
        and _in_all_distros_of(issue, cause)
    ]


def _in_all_distros_of(issue: Issue, cause: Issue) -> bool:
    """Return whether the issue ``cause`` occurs in all distributions in which ``issue`` occurs."""
    return not cause.distros or (bool(issue.distros) and set(issue.distros) <= set(cause.distros))


def _with_explained(cause: Issue, explained: Sequence[Issue], fixed_severities: Container[str]) -> Issue:
    if not explained:
        return cause
    finding = cause.finding
    if cause.rule.name not in fixed_severities:
        finding = finding._replace(severity=max(issue.severity for issue in (cause, *explained)))
    entries = [
        ExplainedFinding(issue.rule.name, issue.finding.subject, issue.finding.message, issue.finding.span) for issue in explained
    ]
    return cause._replace(finding=finding, explained=tuple(entries))
