"""The markdown format: text for the summary of a GitHub workflow run or for a comment."""

from __future__ import annotations

import re
from html import escape
from typing import TYPE_CHECKING

from ros_lint.reporters.ansi import Style, safe
from ros_lint.reporters.summary import by_package, count, limits, problems, summary

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from ros_lint.engine.report import Issue, Report
    from ros_lint.reporters import SourceTexts

_PLAIN = Style()
_MOST_BYTES = 1_000_000
"""Maximum size of the tables in bytes, because GitHub rejects a summary of more than 1 MiB."""
_HEAD = "| severity | place | finding | rule |\n|---|---|---|---|\n"


def render(report: Report, texts: SourceTexts, style: Style) -> str:  # noqa: ARG001  (the signature of reporters)
    """Return Markdown: the result, a table of findings for each package, and the lists of hidden findings and unchecked files."""
    parts = [f"## ros-lint\n\n{_text(summary(report, _PLAIN).partition(chr(10))[0])}\n", *_tables(report)]
    notes = [*(problem.message for problem in problems(report)), *limits(report)]
    if notes:
        parts.append("\n" + "".join(f"- {_text(note)}\n" for note in notes))
    return "".join(parts)


def _tables(report: Report) -> Iterator[str]:
    """Yield a table for each package, up to the size limit. Packages with the most severe findings come first."""
    size = left_out = 0
    for package, issues in by_package(report.issues):
        table = _table(package, issues, report)
        size += len(table.encode())
        if size > _MOST_BYTES:
            left_out += len(issues)
        else:
            yield table
    if left_out:
        yield f"\n{count(left_out, 'more finding')}: see the log.\n"


def _table(package: str, issues: Sequence[Issue], report: Report) -> str:
    title = f"<b>{escape(safe(package, _PLAIN)) or 'outside any package'}</b>: {count(len(issues), 'finding')}"
    rows = "".join(_row(issue, report) for issue in issues)
    return f"\n<details open><summary>{title}</summary>\n\n{_HEAD}{rows}\n</details>\n"


def _row(issue: Issue, report: Report) -> str:
    url = report.url_of(issue.rule)
    rule = f"[{_text(issue.rule.name)}]({url})" if url else _text(issue.rule.name)
    place = f"{issue.finding.span.path}:{issue.finding.span.line}"
    return f"| {issue.severity} | {_text(place)} | {_text(issue.finding.message)} | {rule} |\n"


def _text(value: str) -> str:
    """Return a text in which each character with a meaning in Markdown or HTML is escaped."""
    return re.sub(r"[\\`*{}\[\]<>#|~&@!$^]|(?<![A-Za-z0-9])_|_(?![A-Za-z0-9])", r"\\\g<0>", safe(value, _PLAIN))
