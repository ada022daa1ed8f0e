"""The github format: a workflow command of GitHub Actions for each finding, which GitHub shows as an annotation."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

from ros_lint.analysis.finding import Severity
from ros_lint.base.suggestions import and_list
from ros_lint.reporters.ansi import Style, safe
from ros_lint.reporters.summary import count, crashed, summary, unread_file

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ros_lint.base.text import Span
    from ros_lint.engine.report import Issue, Report
    from ros_lint.reporters import SourceTexts

_MOST_ANNOTATIONS = 10
"""Number of annotations of each level that GitHub shows for one step of a workflow. The log contains all of them."""
_RELATED = 10
_COMMANDS = {Severity.ERROR: "error", Severity.WARNING: "warning", Severity.INFO: "notice"}


def render(report: Report, texts: SourceTexts, style: Style) -> str:
    """Return a workflow command for each finding, the most severe first, and the summary."""
    texts = cache(texts)
    ranked = sorted(report.issues, key=lambda issue: -issue.severity)
    problems = list(_problems(report))
    prominent = [_annotation(issue, texts, style) for issue in ranked if issue.severity is not Severity.INFO]
    notices = [_annotation(issue, texts, style) for issue in ranked if issue.severity is Severity.INFO]
    lines = [*problems, *prominent, *_overflow([*problems, *prominent, *notices]), *notices]
    return "".join(f"{line}\n" for line in lines) + summary(report, style._replace(color=False))


def command(name: str, properties: dict[str, str | int], message: str) -> str:
    """Return a workflow command, escaped as the GitHub runner expects (actions/toolkit, command.ts)."""
    pairs = ",".join(f"{key}={_property(str(value))}" for key, value in properties.items() if value != "")
    return f"::{name}{' ' if pairs else ''}{pairs}::{_data(message)}"


def _data(text: str) -> str:
    return text.replace("%", "%25").replace("\r", "%0D").replace("\n", "%0A")


def _property(text: str) -> str:
    return _data(text).replace(":", "%3A").replace(",", "%2C")


def _annotation(issue: Issue, texts: SourceTexts, style: Style) -> str:
    finding = issue.finding
    title = f"{issue.rule.name} ({issue.rule.code})"
    lines = [safe(finding.message, style)]
    lines += [safe(f"{related.span}: {related.message}", style) for related in finding.related[:_RELATED]]
    if len(finding.related) > _RELATED:
        lines.append(f"and {count(len(finding.related) - _RELATED, 'more place')}")
    if finding.fix:
        lines.append(f"fix: {safe(finding.fix.title, style)}")
    return command(_COMMANDS[issue.severity], {"title": title, **_place(finding.span, texts)}, "\n".join(lines))


def _place(span: Span, texts: SourceTexts) -> dict[str, str | int]:
    source = texts(span.path)
    path = safe(span.path, Style())
    if source is None or span.line > source.line_count:
        return {"file": path, "line": span.line}
    # Columns are only valid within one line, so a place of several lines is annotated on its first line.
    end = span.end_column if span.end_line == span.line else max(len(source.line(span.line)) + 1, span.column)
    return {"file": path, "line": span.line, "endLine": span.line, "col": span.column, "endColumn": end}


def _problems(report: Report) -> Iterator[str]:
    """Yield a workflow command for each problem that makes the run incomplete, such as a crash of a rule."""
    if not report.packages:
        yield command("error", {"title": "ros-lint"}, "no package found, so nothing was checked")
    for crash in report.crashes:
        yield command("error", {"title": "ros-lint"}, f"a rule failed: {safe(crashed(crash), Style())}")
    for entry in report.not_checked:
        place = _place(entry.span, lambda _: None) if entry.span else {}
        yield command("warning", {"title": "not checked", **place}, safe(unread_file(entry), Style()))


def _overflow(lines: list[str]) -> Iterator[str]:
    """Yield a notice with the numbers of findings if there are more annotations than GitHub shows."""
    numbers = {name: sum(line.startswith(f"::{name} ") for line in lines) for name in _COMMANDS.values()}
    if max(numbers.values()) > _MOST_ANNOTATIONS:
        counts = and_list([count(number, name) for name, number in numbers.items() if number])
        message = f"{counts}: GitHub shows only {_MOST_ANNOTATIONS} of each; the log has all of them"
        yield command("notice", {"title": "ros-lint"}, message)
