"""The text format, for people: findings by package with their source lines, and a summary."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

from ros_lint.analysis.finding import Confidence, Severity
from ros_lint.base.suggestions import and_list, shorten_list
from ros_lint.engine.report import page_url
from ros_lint.reporters.ansi import Style, link, paint, safe
from ros_lint.reporters.frames import Mark, frame
from ros_lint.reporters.summary import by_package, count, summary

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from ros_lint.analysis.finding import Fix
    from ros_lint.engine.report import ExplainedFinding, Issue, Report
    from ros_lint.reporters import SourceTexts

_PLAIN = Style()
_RELATED = 8
"""Maximum number of related places shown of a finding; the json format has all of them."""
_FILES = 2
"""Maximum number of files whose source lines are shown for a finding. For a cycle, the lines of all steps are shown."""


def render(report: Report, texts: SourceTexts, style: Style) -> str:
    """Return the report as text. Packages with errors come first; in a package errors, then warnings, then infos."""
    texts = cache(texts)
    parts: list[str] = []
    for package, issues in by_package(report.issues):
        title = f"{safe(package, style) or 'outside any package'}: {count(len(issues), 'finding')}"
        parts.append(f"{paint(style, 'bold', title)}\n\n{render_issues(issues, texts, style)}\n")
    return "".join(parts) + summary(report, style)


def render_issues(issues: Iterable[Issue], texts: SourceTexts, style: Style = _PLAIN) -> str:
    """Return issues as text, separated by empty lines. All infos of one rule in one package form one block."""
    blocks = (_infos(block, texts, style) if len(block) > 1 else _issue(block[0], texts, style) for block in _blocks(issues))
    return "\n".join("".join(f"{row}\n" for row in block) for block in blocks)


def _blocks(issues: Iterable[Issue]) -> Iterable[list[Issue]]:
    """Return the issues in blocks, in order. Infos of one rule in one package form a block at the place of the first of them.

    Each other issue is a block of its own.
    """
    blocks: dict[object, list[Issue]] = {}
    for issue in issues:
        is_info = issue.severity is Severity.INFO
        blocks.setdefault((issue.rule.code, issue.package) if is_info else (issue, len(blocks)), []).append(issue)
    return blocks.values()


def _infos(issues: Sequence[Issue], texts: SourceTexts, style: Style) -> Iterator[str]:
    """Yield the rows of a block of infos: the rule, a line for each info, and the options that apply the fixes."""
    rule = issues[0].rule
    title = f"{len(issues)} findings; expected: {rule.summary}"
    yield f"{_head(issues[0], style)}: {paint(style, 'bold', title)}"
    for issue in issues:
        finding = issue.finding
        doubt = "" if finding.confidence is Confidence.HIGH else f" ({finding.confidence} confidence)"
        yield f" {paint(style, 'gutter', '-->')} {safe(f'{finding.span}: {finding.message}{doubt}', style)}"
    fixes = [issue.finding.fix for issue in issues if issue.finding.fix]
    for is_safe, how in _HOW_TO_FIX.items():
        if number := sum(fix.safe is is_safe for fix in fixes):
            which = "all of them" if number == len(issues) else f"{number} of them"
            yield f"{paint(style, 'gutter', '  =')} {paint(style, 'good', 'fix')}: {which} ({how})"
    if style.fixes:
        yield from _preview(fixes, texts, style, " ")


_HOW_TO_FIX = {True: "--fix", False: "--fix --unsafe-fixes, may change behaviour"}
"""The command-line options that apply a fix: for a safe fix (True) and for an unsafe fix (False)."""


def _head(issue: Issue, style: Style) -> str:
    level = str(issue.severity)
    return link(page_url(style.rule_url, issue.rule), paint(style, level, f"{level}[{issue.rule.code} {issue.rule.name}]"))


def _issue(issue: Issue, texts: SourceTexts, style: Style) -> list[str]:
    finding, level = issue.finding, str(issue.severity)
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
    notes += [f"note: in {distro}: {safe(message, style)}" for distro, message in issue.other_messages]
    if issue.explained:
        notes.append(f"note: {safe(_explanation(issue.explained), style)}")
    if finding.fix:
        title = safe(finding.fix.title, style)
        notes.append(f"{paint(style, 'good', 'fix')}: {title} ({_HOW_TO_FIX[finding.fix.safe]})")
    equals = paint(style, "gutter", f"{gutter} =")
    bar = [paint(style, "gutter", f"{gutter} |")] if notes else []
    preview = _preview([finding.fix], texts, style, gutter) if finding.fix and style.fixes else ()
    return [
        f"{_head(issue, style)}: {paint(style, 'bold', safe(finding.message, style))}",
        *rows,
        *bar,
        *(f"{equals} {note}" for note in notes),
        *preview,
    ]


def _explanation(explained: Sequence[ExplainedFinding]) -> str:
    """Return a text about the hidden findings that an issue explains: "explains 1 finding of undeclared-dependency: 'launch'"."""
    subjects: dict[str, list[str]] = {}
    for finding in explained:
        subjects.setdefault(finding.rule, []).append(finding.subject)
    return "explains " + and_list(
        [f"{count(len(names), 'finding')} of {rule}: {shorten_list(names)}" for rule, names in subjects.items()]
    )


def _preview(fixes: Sequence[Fix], texts: SourceTexts, style: Style, gutter: str) -> Iterator[str]:
    """Yield the changes of fixes as a diff, in rows below a code frame.

    ``gutter`` has the blanks left of the bar of the frame.
    """
    from ros_lint.base.diff import unified  # noqa: PLC0415
    from ros_lint.engine.edits import EditError, apply  # noqa: PLC0415  (only for diffs)

    sources = {edit.span.path: texts(edit.span.path) for fix in fixes for edit in fix.edits}
    readable = {path: source for path, source in sources.items() if source is not None}
    if len(readable) < len(sources):
        return
    bar = paint(style, "gutter", f"{gutter} |")
    try:
        changed_texts = apply(fixes, readable.__getitem__)
    except EditError:  # the file has changed in the meantime
        return
    for path, changed in changed_texts.items():
        yield f"{gutter}{paint(style, 'gutter', ':::')} {safe(path, style)}"
        for line in unified(path, readable[path].text, changed).splitlines()[2:]:
            color = {"+": "added", "-": "removed"}.get(line[:1], "")
            shown = safe(line, style)
            yield f"{bar} {paint(style, color, shown) if color else shown}".rstrip()
