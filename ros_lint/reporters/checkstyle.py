"""The checkstyle format: XML of the tool Checkstyle, which many tools read, such as the plugin Warnings of Jenkins."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ros_lint.reporters.summary import DEFAULT_PATH, problems
from ros_lint.reporters.xml_text import element, start

if TYPE_CHECKING:
    from ros_lint.engine.report import Report
    from ros_lint.reporters import SourceTexts
    from ros_lint.reporters.ansi import Style


def render(report: Report, texts: SourceTexts, style: Style) -> str:  # noqa: ARG001  (the signature of reporters)
    """Return XML with an element for each file, which contains an element for each finding in the file.

    Problems of the run without a place, such as a crash of a rule, are listed under ``package.xml``.
    """
    files: dict[str, list[str]] = {}
    for problem in problems(report):
        path, line, column = problem.span[:3] if problem.span else (DEFAULT_PATH, 1, 1)
        files.setdefault(path, []).append(_error(line, column, str(problem.severity), problem.message, "ros-lint"))
    for issue in report.issues:
        span = issue.finding.span
        source = f"ros-lint.{issue.rule.name}"
        error = _error(span.line, span.column, str(issue.severity), f"{issue.finding.message} ({issue.rule.code})", source)
        files.setdefault(span.path, []).append(error)
    parts = [f"{start('file', name=path)}\n{''.join(errors)}</file>\n" for path, errors in files.items()]
    return f'<?xml version="1.0" encoding="UTF-8"?>\n<checkstyle version="4.3">\n{"".join(parts)}</checkstyle>\n'


def _error(line: int, column: int, severity: str, message: str, source: str) -> str:
    return element("error", line=line, column=column, severity=severity, message=message, source=source)
