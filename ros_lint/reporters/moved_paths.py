"""Replace the paths in a report, e.g. by paths relative to the current folder."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable

    from ros_lint.analysis.finding import Finding
    from ros_lint.engine.report import Issue, Report
    from ros_lint.workspace.target import UnreadFile


def with_paths(report: Report, rename: Callable[[str], str]) -> Report:
    """Return the report with ``rename(path)`` in place of each path. Paths in messages are not changed."""
    return report._replace(
        issues=tuple([_issue(issue, rename) for issue in report.issues]),
        not_checked=tuple([_unread(entry, rename) for entry in report.not_checked]),
        named_distros=tuple([named._replace(path=rename(named.path)) for named in report.named_distros]),
        not_cloned=tuple([uncloned._replace(path=rename(uncloned.path)) for uncloned in report.not_cloned]),
    )


def _issue(issue: Issue, rename: Callable[[str], str]) -> Issue:
    explained = [entry._replace(span=entry.span._replace(path=rename(entry.span.path))) for entry in issue.explained]
    return issue._replace(finding=_finding(issue.finding, rename), explained=tuple(explained))


def _finding(finding: Finding, rename: Callable[[str], str]) -> Finding:
    related = [place._replace(span=place.span._replace(path=rename(place.span.path))) for place in finding.related]
    fix = finding.fix
    if fix is not None:
        edits = [edit._replace(span=edit.span._replace(path=rename(edit.span.path))) for edit in fix.edits]
        fix = fix._replace(edits=tuple(edits))
    return finding._replace(span=finding.span._replace(path=rename(finding.span.path)), related=tuple(related), fix=fix)


def _unread(entry: UnreadFile, rename: Callable[[str], str]) -> UnreadFile:
    if entry.span is None:
        return entry
    path = rename(entry.span.path)
    return entry._replace(what=path if entry.what == entry.span.path else entry.what, span=entry.span._replace(path=path))
