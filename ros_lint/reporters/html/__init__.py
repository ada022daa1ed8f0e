"""The html format: a report as one page that needs no other file and no network. Only its filters need JavaScript."""

from __future__ import annotations

from collections import Counter
from functools import cache
from typing import TYPE_CHECKING

from ros_lint.analysis.finding import Severity
from ros_lint.base.html_page import fill, resource
from ros_lint.reporters.ansi import Style, safe
from ros_lint.reporters.summary import by_package, count, summary

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from ros_lint.base.text import Span
    from ros_lint.engine.report import Issue, Report
    from ros_lint.reporters import SourceTexts

_PLAIN = Style(summary=True)
_CONTEXT = 2
"""Number of lines shown before and after the place of a finding."""
_MOST_LINES = 12
"""Maximum number of lines shown of a place."""
_MOST_CHARACTERS = 400
"""Maximum number of characters shown of a line."""
_RELATED = 8
"""Maximum number of related places shown of a finding; the json format has all of them."""


def render(report: Report, texts: SourceTexts, style: Style) -> str:  # noqa: ARG001  (the signature of reporters)
    """Return the page: the findings by package, with the source lines of their places, and the summary of the run."""
    texts = cache(texts)
    title = report.workspace or "the workspace"
    parts = {
        "STYLE": resource(__name__, "page.css"),
        "SCRIPT": resource(__name__, "page.js"),
        "TITLE": _escaped(title),
        "SUMMARY": "\n".join(f"<p>{_escaped(line)}</p>" for line in summary(report, _PLAIN).splitlines() if line),
        "FILTERS": "\n".join(_filters(report.issues)),
        "FINDINGS": "\n".join(line for package, issues in by_package(report.issues) for line in _package(package, issues, texts)),
    }
    return fill(resource(__name__, "page.html"), parts)


def _escaped(text: str) -> str:
    """Return a text escaped for HTML. Characters that a terminal would not show unchanged become visible escapes."""
    import html  # noqa: PLC0415

    return html.escape(safe(text, _PLAIN))


def _filters(issues: Iterable[Issue]) -> Iterator[str]:
    issues = list(issues)
    yield from _choice("severity", [str(issue.severity) for issue in issues], [str(level) for level in reversed(Severity)])
    rules = [issue.rule.name for issue in issues]
    yield from _choice("rule", rules, sorted(set(rules)))
    packages = [issue.package for issue in issues]
    yield from _choice("package", packages, sorted(set(packages)))
    yield from _choice("confidence", [str(issue.finding.confidence) for issue in issues], ["high", "medium", "low"])


def _choice(name: str, values: Iterable[str], order: Iterable[str]) -> Iterator[str]:
    """Yield the lines of a select element. Its options are the distinct ``values``, sorted as in ``order``.

    Each option shows how often the value occurs: ``error (3)``.
    """
    numbers = Counter(values)
    yield f'<label>{name.capitalize()} <select name="{name}"><option value="">all</option>'
    for value in order:
        if numbers[value]:
            shown = value or "outside any package"
            yield f'<option value="{_escaped(value or "-")}">{_escaped(shown)} ({numbers[value]})</option>'
    yield "</select></label>"


def _package(package: str, issues: list[Issue], texts: SourceTexts) -> Iterator[str]:
    name = package or "outside any package"
    yield f'<section><h2>{_escaped(name)} <span class="count">{count(len(issues), "finding")}</span></h2>'
    for issue in issues:
        yield from _issue(issue, texts)
    yield "</section>"


def _issue(issue: Issue, texts: SourceTexts) -> Iterator[str]:
    finding, rule = issue.finding, issue.rule
    severity, confidence = str(issue.severity), str(finding.confidence)
    yield (
        f'<article class="{severity}" data-severity="{severity}" data-rule="{_escaped(rule.name)}" '
        f'data-package="{_escaped(issue.package or "-")}" data-confidence="{confidence}">'
    )
    yield f"<h3>{_escaped(finding.message)}</h3>"
    doubt = "" if confidence == "high" else f" · {confidence} confidence"
    yield (
        f'<p class="about"><span class="severity">{severity}</span> · {_escaped(rule.code)} {_escaped(rule.name)}{doubt} · '
        f"<code>{_escaped(str(finding.span))}</code></p>"
    )
    yield from _frame(finding.span, texts)
    if finding.related:
        yield "<ul>"
        for related in finding.related[:_RELATED]:
            yield f"<li>{_escaped(related.message)}: <code>{_escaped(str(related.span))}</code></li>"
        if len(finding.related) > _RELATED:
            yield f"<li>and {len(finding.related) - _RELATED} more</li>"
        yield "</ul>"
    if finding.fix:
        option = "--fix" if finding.fix.safe else "--fix --unsafe-fixes, may change behaviour"
        yield f'<p class="fix">Fix: {_escaped(finding.fix.title)} ({option})</p>'
    if issue.explained:
        yield f"<p>{count(len(issue.explained), 'other finding')} explained by this one:</p><ul>"
        for explained in issue.explained[:_RELATED]:
            yield f"<li>{_escaped(explained.message)}: <code>{_escaped(str(explained.span))}</code></li>"
        yield "</ul>"
    yield "</article>"


def _frame(span: Span, texts: SourceTexts) -> Iterator[str]:
    """Yield the source lines around a place, with the place highlighted; nothing if the file cannot be read."""
    text = texts(span.path)
    if text is None or not 0 < span.line <= text.line_count or span == span.start():
        return
    last = min(span.end_line, text.line_count, span.line + _MOST_LINES)
    rows = []
    for number in range(max(1, span.line - _CONTEXT), min(text.line_count, last + _CONTEXT) + 1):
        line = text.line(number)[:_MOST_CHARACTERS]
        start = span.column - 1 if number == span.line else 0
        end = span.end_column - 1 if number == span.end_line else len(line)
        marked = span.line <= number <= last
        shown = (
            f"{_escaped(line[:start])}<mark>{_escaped(line[start:end])}</mark>{_escaped(line[end:])}"
            if marked
            else _escaped(line)
        )
        rows.append(f'<span class="line"><span class="number">{number}</span> {shown}</span>')
    yield f'<pre role="group" tabindex="0" aria-label="Lines of {_escaped(span.path)}">{"".join(rows)}</pre>'
