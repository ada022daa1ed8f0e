"""The concise format, for people and editors: one line for each finding."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ros_lint.reporters.ansi import Style, paint, safe
from ros_lint.reporters.summary import summary

if TYPE_CHECKING:
    from ros_lint.engine.report import Issue, Report
    from ros_lint.reporters import SourceTexts


def render(report: Report, texts: SourceTexts, style: Style) -> str:  # noqa: ARG001  (the signature of reporters)
    """Return ``path:line:column: severity: message [rule]`` for each finding, and a summary."""
    return "".join(f"{_line(issue, style)}\n" for issue in report.issues) + summary(report, style)


def _line(issue: Issue, style: Style) -> str:
    level = str(issue.severity)
    place = safe(str(issue.finding.span), style)
    place = paint(style, "bold", f"./{place}" if place.startswith("::") else place)  # GitHub Actions would run ::error::
    return f"{place}: {paint(style, level, level)}: {safe(issue.finding.message, style)} [{issue.rule.name}]"
