"""The text format, for people: findings by package with code frames, and what was not analysed."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

from ros_lint.analysis.finding import Confidence
from ros_lint.reporters.ansi import Style, paint, safe
from ros_lint.reporters.frames import Mark, frame
from ros_lint.reporters.summary import count, summary

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from ros_lint.analysis.finding import Fix
    from ros_lint.engine.report import Issue, Report
    from ros_lint.reporters import SourceTexts

_PLAIN = Style()
_RELATED = 8
"""Number of related places to show; the json format has all."""
_FILES = 2
"""Number of files to show lines of, except for cycles, of which all steps are shown."""


def render(report: Report, texts: SourceTexts, style: Style) -> str:
    """Return the report as text."""
    texts = cache(texts)
    packages: dict[str, list[Issue]] = {}
    for issue in report.issues:
        packages.setdefault(issue.package, []).append(issue)
    parts: list[str] = []
    for package, issues in packages.items():
        title = f"{safe(package, style) or 'outside any package'}: {count(len(issues), 'finding')}"
        parts.append(f"{paint(style, 'bold', title)}\n\n{render_issues(issues, texts, style)}\n")
    return "".join(parts) + summary(report, style)


def render_issues(issues: Iterable[Issue], texts: SourceTexts, style: Style = _PLAIN) -> str:
    """Return issues as text, separated by empty lines."""
    return "\n".join("".join(f"{row}\n" for row in _issue(issue, texts, style)) for issue in issues)


def _issue(issue: Issue, texts: SourceTexts, style: Style) -> list[str]:
    finding, level = issue.finding, str(issue.severity)
    head = paint(style, level, f"{level}[{issue.rule.code} {issue.rule.name}]")
    marks = [Mark(finding.span, "", level, "^")]
    for number, related in enumerate(finding.related[:_RELATED], 1):
        label = f"{number}: {related.message}" if finding.steps else related.message
        marks.append(Mark(related.span, label, "related", "-"))
    rows, gutter = frame(marks, texts, style, None if finding.steps else _FILES)
    notes: list[str] = []
    if len(finding.related) > _RELATED:
        notes.append(f"note: and {count(len(finding.related) - _RELATED, 'more place')}")
    if finding.confidence is not Confidence.HIGH:
        notes.append(f"note: {finding.confidence} confidence")
    if finding.fix:
        how = "--fix" if finding.fix.safe else "--fix --unsafe-fixes, may change behaviour"
        notes.append(f"{paint(style, 'good', 'fix')}: {safe(finding.fix.title, style)} ({how})")
    equals = paint(style, "gutter", f"{gutter} =")
    bar = [paint(style, "gutter", f"{gutter} |")] if notes else []
    preview = _preview(finding.fix, texts, style, gutter) if finding.fix and style.fixes else ()
    return [
        f"{head}: {paint(style, 'bold', safe(finding.message, style))}",
        *rows,
        *bar,
        *(f"{equals} {note}" for note in notes),
        *preview,
    ]


def _preview(fix: Fix, texts: SourceTexts, style: Style, gutter: str) -> Iterator[str]:
    """Yield the changes of a fix as a diff below a frame, which has this gutter."""
    from ros_lint.base.diff import unified  # noqa: PLC0415
    from ros_lint.engine.edits import EditError, apply  # noqa: PLC0415  (only for diffs)

    sources = {edit.span.path: texts(edit.span.path) for edit in fix.edits}
    readable = {path: source for path, source in sources.items() if source is not None}
    if len(readable) < len(sources):
        return
    bar = paint(style, "gutter", f"{gutter} |")
    try:
        changed_texts = apply([fix], readable.__getitem__)
    except EditError:  # the file has changed in the meantime
        return
    for path, changed in changed_texts.items():
        yield f"{gutter}{paint(style, 'gutter', ':::')} {safe(path, style)}"
        for line in unified(path, readable[path].text, changed).splitlines()[2:]:
            color = {"+": "added", "-": "removed"}.get(line[:1], "")
            shown = safe(line, style)
            yield f"{bar} {paint(style, color, shown) if color else shown}".rstrip()
