"""The output of ``--statistics``: the number of findings of each rule, and the summary."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING

from ros_lint.reporters.ansi import Style, paint
from ros_lint.reporters.summary import summary

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ros_lint.engine.report import Report
    from ros_lint.reporters import SourceTexts


def render(report: Report, texts: SourceTexts, style: Style) -> str:  # noqa: ARG001  (the signature of reporters)
    """Return a line for each pair of rule and severity, the most frequent pair first, and a summary.

    A line has the number of findings, the severity, the code and name of the rule, and the number of findings with a fix.
    """
    names = {issue.rule.code: issue.rule.name for issue in report.issues}
    counts = Counter((issue.rule.code, issue.severity) for issue in report.issues)
    fixable = Counter((issue.rule.code, issue.severity) for issue in report.issues if issue.finding.fix)
    rows = [
        (str(number), str(severity), code, names[code], f"{fixable[code, severity]} fixable")
        for (code, severity), number in sorted(counts.items(), key=lambda item: (-item[1], item[0]))
    ]
    return "".join(f"{line}\n" for line in _table(rows, style)) + summary(report, style)


def _table(rows: list[tuple[str, str, str, str, str]], style: Style) -> Iterator[str]:
    """Yield the rows as lines with aligned columns. The numbers are right-aligned."""
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    for number, severity, code, name, fixes in rows:
        level = paint(style, severity, severity) + " " * (widths[1] - len(severity))
        yield f"{number:>{widths[0]}}  {level}  {code:{widths[2]}}  {name:{widths[3]}}  {fixes}"
