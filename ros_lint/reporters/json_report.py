"""The json format, for programs: the whole report. Its keys are described in docs/output.md and report.schema.json."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ros_lint.analysis.finding import Severity
from ros_lint.base.json_text import encode

if TYPE_CHECKING:
    from ros_lint.analysis.finding import Fix
    from ros_lint.base.text import Span
    from ros_lint.engine.report import Issue, Report
    from ros_lint.reporters import SourceTexts
    from ros_lint.reporters.ansi import Style

SCHEMA_VERSION = 1
"""Version of the format. It increases when the meaning of a key changes or a key is removed, but not when a key is added."""


def render(report: Report, texts: SourceTexts, style: Style) -> str:  # noqa: ARG001  (the signature of reporters)
    """Return the report as JSON."""
    return encode(document(report), 2)


def document(report: Report) -> dict[str, Any]:
    """Return the report as Python values for JSON."""
    return {
        "schema_version": SCHEMA_VERSION,
        "tool": "ros-lint",
        "version": report.version,
        "distro": report.target.distro,
        "distros": list(report.target.distros),
        "distro_source": report.target.source,
        "named_distros": [{"distro": named.distro, "path": named.path, "line": named.line} for named in report.named_distros],
        "data_date": report.data_date,
        "workspace": report.workspace,
        "packages": report.packages,
        "context_packages": report.context_packages,
        "findings": [_finding(issue, report) for issue in report.issues],
        "hidden": [{"reason": hidden.reason, "count": hidden.count, "rules": dict(hidden.rules)} for hidden in report.hidden],
        "not_checked": [
            {"what": entry.what, "reason": entry.reason, **(_place(entry.span) if entry.span else _NO_PLACE)}
            for entry in report.not_checked
        ],
        "not_cloned": [{"list": path, "repositories": list(names)} for path, names in report.not_cloned],
        "not_seen_through": [
            {"what": spot.what, "packages": len(spot.packages), "names": list(spot.packages)} for spot in report.blind_spots
        ],
        "ros1_packages": list(report.ros1),
        "crashes": [crash._asdict() for crash in report.crashes],
        "summary": {
            **{str(severity): report.count(severity) for severity in sorted(Severity, reverse=True)},
            "fixable": report.fixable(safe=True),
            "unsafely_fixable": report.fixable(safe=False),
        },
    }


def _finding(issue: Issue, report: Report) -> dict[str, Any]:
    finding = issue.finding
    return {
        "rule": issue.rule.name,
        "code": issue.rule.code,
        "url": report.url_of(issue.rule),
        "package": issue.package,
        "subject": finding.subject,
        **_place(finding.span),
        "message": finding.message,
        "distros": list(issue.distros or report.target.distros),
        "other_messages": [{"distro": distro, "message": message} for distro, message in issue.other_messages],
        "severity": str(issue.severity),
        "confidence": str(finding.confidence),
        "related": [{"message": related.message, **_place(related.span)} for related in finding.related],
        "steps": finding.steps,
        "explains": [
            {"rule": explained.rule, "subject": explained.subject, "message": explained.message, **_place(explained.span)}
            for explained in issue.explained
        ],
        "fix": _fix(finding.fix) if finding.fix else None,
    }


def _fix(fix: Fix) -> dict[str, Any]:
    edits = [{**_place(edit.span), "text": edit.text} for edit in fix.edits]
    return {"title": fix.title, "safe": fix.safe, "edits": edits}


_NO_PLACE = dict.fromkeys(("path", "line", "column", "end_line", "end_column"))


def _place(span: Span) -> dict[str, Any]:
    return span._asdict()
