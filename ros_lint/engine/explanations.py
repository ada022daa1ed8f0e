"""Hide findings that are consequences of another finding, so that only the cause is shown."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ros_lint.engine.report import ExplainedFinding

if TYPE_CHECKING:
    from collections.abc import Container, Sequence

    from ros_lint.engine.report import Issue


def without_explained(issues: Sequence[Issue], fixed_severities: Container[str] = ()) -> tuple[Issue, ...]:
    """Return the issues that are no consequence of another issue. ``explained`` of each issue has its consequences.

    - A cause explains only findings in its own package whose confidence is not higher than that of the cause, and only if
      the cause occurs in every distribution in which the finding occurs.
    - A cause gets the severity of its most severe consequence, unless its rule is one of ``fixed_severities``.
    - If issues explain only each other, all of them are returned.
    """
    if not any(issue.finding.explains for issue in issues):
        return tuple(issues)
    places: _Places = {}
    for number, issue in enumerate(issues):
        for subject in {issue.finding.subject, ""}:  # "" stands for every subject
            places.setdefault((issue.package, issue.rule.name, subject), []).append(number)
    causes = {number: _explained_by(issue, issues, places) for number, issue in enumerate(issues) if issue.finding.explains}
    consequences = {explained for group in causes.values() for explained in group}
    hidden: set[int] = set()
    pending = [number for number in causes if number not in consequences]
    while pending:
        new = [number for number in causes[pending.pop()] if number not in hidden]
        hidden.update(new)
        pending += [number for number in new if number in causes]
    return tuple(
        [
            _with_explained(issue, [issues[other] for other in causes.get(number, ()) if other in hidden], fixed_severities)
            for number, issue in enumerate(issues)
            if number not in hidden
        ]
    )


_Places = dict[tuple[str, str, str], list[int]]
"""The numbers of issues by their package, rule and subject."""


def _explained_by(cause: Issue, issues: Sequence[Issue], places: _Places) -> list[int]:
    """Return the numbers of the elements of ``issues`` that ``cause`` explains, in their order."""
    keys = {(cause.package, consequence.rule, consequence.subject) for consequence in cause.finding.explains}
    numbers = sorted({number for key in keys for number in places.get(key, ())})
    return [number for number in numbers if _explains(cause, issues[number])]


def _explains(cause: Issue, issue: Issue) -> bool:
    """Return whether ``cause``, whose consequences include one with the rule and subject of ``issue``, explains ``issue``."""
    is_as_sure = issue.finding.confidence <= cause.finding.confidence
    return issue is not cause and is_as_sure and _in_all_distros_of(issue, cause)


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
