"""The rdjson format: the Reviewdog Diagnostic Format. reviewdog posts its findings as comments in code review.

The format is described in ``proto/rdf`` of reviewdog. Its columns count bytes of UTF-8.
"""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING, Any

from ros_lint.base.json_text import encode
from ros_lint.reporters.summary import DEFAULT_PATH, problems

if TYPE_CHECKING:
    from ros_lint.base.text import Span
    from ros_lint.engine.report import Issue, Report
    from ros_lint.reporters import SourceTexts
    from ros_lint.reporters.ansi import Style


def render(report: Report, texts: SourceTexts, style: Style) -> str:  # noqa: ARG001  (the signature of reporters)
    """Return JSON with a diagnostic for each finding, and for each problem that makes the run incomplete."""
    texts = cache(texts)
    diagnostics = [_diagnostic(issue, report, texts) for issue in report.issues]
    for problem in problems(report):
        location = _location(problem.span, texts) if problem.span else {"path": DEFAULT_PATH}
        diagnostics.append({"message": problem.message, "location": location, "severity": problem.severity.name})
    return encode({"source": {"name": "ros-lint"}, "diagnostics": diagnostics}, 2)


def _diagnostic(issue: Issue, report: Report, texts: SourceTexts) -> dict[str, Any]:
    finding = issue.finding
    url = report.url_of(issue.rule)
    result: dict[str, Any] = {
        "message": finding.message,
        "location": _location(finding.span, texts),
        "severity": issue.severity.name,
        "code": {"value": issue.rule.code, **({"url": url} if url else {})},
    }
    edits = finding.fix.edits if finding.fix else ()
    # Reviewdog offers each suggestion by itself, and at the place of the finding only.
    if len(edits) == 1 and edits[0].span.path == finding.span.path:
        result["suggestions"] = [{"range": _range(edits[0].span, texts), "text": edits[0].text}]
    if finding.related:
        result["related_locations"] = [
            {"message": related.message, "location": _location(related.span, texts)} for related in finding.related
        ]
    return result


def _location(span: Span, texts: SourceTexts) -> dict[str, Any]:
    return {"path": span.path, "range": _range(span, texts)}


def _range(span: Span, texts: SourceTexts) -> dict[str, Any]:
    return {
        "start": _position(span.path, span.line, span.column, texts),
        "end": _position(span.path, span.end_line, span.end_column, texts),
    }


def _position(path: str, line: int, column: int, texts: SourceTexts) -> dict[str, int]:
    source = texts(path)
    if source is None or line > source.line_count:
        return {"line": line}
    before = source.line(line)[: column - 1]
    return {"line": line, "column": len(before.encode("utf-8", "replace")) + 1}
