"""Comments that suppress findings.

``ros-lint: ignore[rule, ...] reason`` speaks for the line it stands on or, when the comment has its lines to itself,
for the next line that is no comment. ``ros-lint: ignore-file[rule, ...] reason`` stands before everything but comments,
and speaks for the file. docs/suppressions.md has the whole of it.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, NamedTuple

from ros_lint.rule import Edit

if TYPE_CHECKING:
    from collections.abc import Container, Iterable, Iterator

    from ros_lint.report import Issue
    from ros_lint.rule import Rule
    from ros_lint.text import Span, Text

MARKER = "ros-lint:"
"""Only files that hold this can suppress anything."""

_HOW = "write ros-lint: ignore[rule-name] reason"


class Name(NamedTuple):
    """A rule as a suppression names it, by name or code."""

    text: str
    span: Span


class Suppression(NamedTuple):
    """A comment that suppresses findings of some rules, or a ``problem`` that keeps it from doing so."""

    names: tuple[Name, ...]
    reason: str
    lines: tuple[int, int] | None
    """First and last line that it speaks for, its own included; None stands for the whole file."""
    span: Span
    """From ``ros-lint:`` to the closing bracket."""
    inside: Span
    """Between the brackets."""
    removal: Edit
    """Takes it out of the file, with the comment when there is nothing else in it."""
    problem: str = ""
    """Why it suppresses nothing, as a message."""

    def covers(self, issue: Issue) -> bool:
        """Whether it speaks for the place of an issue, if not for its rule. Any line of the issue's place will do."""
        span = issue.finding.span
        if self.problem or span.path != self.span.path:
            return False
        if self.lines is None:
            return True
        last = span.end_line - 1 if span.end_column == 1 and span.end_line > span.line else span.end_line
        return span.line <= self.lines[1] and self.lines[0] <= last

    def without(self, names: Iterable[Name]) -> Edit:
        """Return the edit that takes some of the names out, and the whole suppression when none would be left."""
        gone = set(names)
        left = [name.text for name in self.names if name not in gone]
        return Edit(self.inside, ", ".join(left)) if left else self.removal


class Unused(NamedTuple):
    """Names in a suppression for which their rules found nothing to suppress."""

    suppression: Suppression
    names: tuple[Name, ...]


class Unknown(NamedTuple):
    """A name in a suppression that no rule has."""

    suppression: Suppression
    name: Name
    suggestion: str
    """The nearest name or code, or ""."""


class Outcome(NamedTuple):
    """What suppressions did to the issues."""

    kept: tuple[Issue, ...]
    suppressed: tuple[tuple[Issue, Suppression], ...]
    unused: tuple[Unused, ...]
    unknown: tuple[Unknown, ...]
    broken: tuple[Suppression, ...]
    """Those that have a problem."""


def collect(text: Text) -> tuple[Suppression, ...]:
    """Return the suppressions in the comments of a file, in order."""
    if MARKER not in text.text:
        return ()
    from ros_lint.comments import comments  # noqa: PLC0415  (one run in ten meets a suppression)

    return tuple(_in_comments(text, comments(text)))


def apply(
    issues: Iterable[Issue], suppressions: Iterable[Suppression], known: Iterable[Rule], ran: Container[str | None]
) -> Outcome:
    """Return which issues stay.

    ``known`` are all rules there are; ``ran`` has the names of those that looked at everything: only these can leave a
    suppression unused. To be called before issues are hidden for other reasons, or their suppressions will seem unused,
    and once more for what rules say about the outcome, of which the issues kept are all that matters.
    """
    names = {key.lower(): rule.name for rule in known for key in (rule.name, rule.code)}
    judging = {rule.name for rule in known if rule.suppressions}  # they speak later, so what they need is not known
    in_file: dict[str, list[Suppression]] = {}
    for suppression in suppressions:
        in_file.setdefault(suppression.span.path, []).append(suppression)
    used: set[tuple[Suppression, Name]] = set()
    kept: list[Issue] = []
    suppressed: list[tuple[Issue, Suppression]] = []
    for issue in issues:
        hits = [
            (suppression, name)
            for suppression in in_file.get(issue.finding.span.path, ())
            if suppression.covers(issue)
            for name in suppression.names
            if names.get(name.text.lower()) == issue.rule.name
        ]
        used.update(hits)
        if hits:
            suppressed.append((issue, hits[0][0]))
        else:
            kept.append(issue)
    unused: list[Unused] = []
    unknown: list[Unknown] = []
    broken: list[Suppression] = []
    for suppression in (each for path in sorted(in_file) for each in in_file[path]):
        if suppression.problem:
            broken.append(suppression)
            continue
        idle = [
            name
            for name in suppression.names
            if (rule := names.get(name.text.lower())) in ran and rule not in judging and (suppression, name) not in used
        ]
        if idle:
            unused.append(Unused(suppression, tuple(idle)))
        unknown += [
            Unknown(suppression, name, _nearest(name.text, names))
            for name in suppression.names
            if name.text.lower() not in names
        ]
    return Outcome(tuple(kept), tuple(suppressed), tuple(unused), tuple(unknown), tuple(broken))


def _nearest(word: str, names: Iterable[str]) -> str:
    import difflib  # noqa: PLC0415

    close = difflib.get_close_matches(word.lower(), list(names), 1)
    return (close[0].upper() if close[0].startswith("ros") and close[0][3:].isdigit() else close[0]) if close else ""


_MARK = re.compile(r"ros-lint:[ \t]*(?P<word>[A-Za-z][\w-]*)?(?P<bracket>[ \t]*\[(?P<names>[^\]\r\n]*)(?P<close>\])?)?")
_OPENING = re.compile(r"(?:<!--|#\[=*\[|#+|;|//+[!<]?|/\*+[!<]?)\s*")
_CLOSING = re.compile(r"\s*(?:-->|\*+/|\]=*\])?\s*\Z")
_DECLARATION = re.compile(r"<\?.*?\?>|<!DOCTYPE[^>\[]*(?:\[.*?\]\s*)?>", re.DOTALL)
_REASON = re.compile(r"[^\r\n]*?(?=[ \t]+(?:#|//)[ \t]|[\r\n]|\Z)")
_SIGN = re.compile(r"[ \t]*(?:#+|//+)?[ \t]*")
_BLANK = re.compile(r"[ \t\f]*(?:\r\n|\r|\n|\Z)")


def _in_comments(text: Text, ranges: tuple[tuple[int, int], ...]) -> Iterator[Suppression]:
    whole = text.text
    lines = {start: (text.position(start)[0], text.position(end)[0]) for start, end in ranges}
    alone = {start for start, end in ranges if _is_alone(whole, start, end)}
    own_lines = {line for start in alone for line in range(lines[start][0], lines[start][1] + 1)}
    leading = True
    before = 0
    for start, end in ranges:
        leading = leading and _says_nothing(whole[before:start])
        before = end
        first, last = lines[start]
        if start in alone:
            last += 1
            while last in own_lines:
                last += 1
        yield from _in_comment(text, start, end, (first, last), leading)


def _in_comment(text: Text, start: int, end: int, lines: tuple[int, int], leading: bool) -> Iterator[Suppression]:
    whole = text.text
    marks = list(_MARK.finditer(whole, start, end))
    for number, mark in enumerate(marks, 1):
        opens = _OPENING.fullmatch(whole, start, mark.start()) is not None
        problem = _problem(mark, leading)
        if problem is None or (not opens and mark["word"] not in ("ignore", "ignore-file")):
            continue  # a sentence that speaks of ros-lint
        stop = _reason_end(whole, mark.end(), marks[number].start() if number < len(marks) else end)
        sole = opens and len(marks) == 1 and _CLOSING.fullmatch(whole, stop, end) is not None
        cut = _cut_comment(whole, start, end) if sole else _cut_mark(whole, start, mark.start(), stop, end)
        inside = mark.span("names") if mark["names"] is not None else (mark.end(), mark.end())
        yield Suppression(
            tuple(_names(text, *inside)),
            whole[mark.end() : stop].strip().lstrip("-:").strip(),
            None if mark["word"] == "ignore-file" else lines,
            text.span(*mark.span()),
            text.span(*inside),
            Edit(text.span(*cut), _joint(whole, *cut)),
            problem,
        )


def _problem(mark: re.Match[str], leading: bool) -> str | None:
    """Return what is wrong with a suppression, "" when nothing is, or None if it may be no suppression at all."""
    if mark["word"] not in ("ignore", "ignore-file"):
        return f"{mark[0].strip()} means nothing, {_HOW}" if mark["word"] else None
    if mark["names"] is not None and not mark["close"]:
        return f"the bracket of this suppression is not closed on its line, {_HOW}"
    if not (mark["names"] or "").replace(",", "").strip():
        return f"this suppression names no rule, {_HOW}"
    if mark["word"] == "ignore-file" and not leading:
        return "ignore-file works in the first comments of a file only, move it there or use ignore"
    return ""


def _names(text: Text, start: int, end: int) -> Iterator[Name]:
    for word in re.finditer(r"[^,\s](?:[^,]*[^,\s])?", text.text[start:end]):
        yield Name(word[0], text.span(start + word.start(), start + word.end()))


def _is_alone(whole: str, start: int, end: int) -> bool:
    line_start = max(whole.rfind("\n", 0, start), whole.rfind("\r", 0, start)) + 1
    return not whole[line_start:start].strip() and _BLANK.match(whole, end) is not None


def _says_nothing(between: str) -> bool:
    """Whether what stands between two comments leaves them the first: space, and the declarations of XML."""
    return not _DECLARATION.sub("", between).strip("\ufeff \t\r\n\f")


def _reason_end(whole: str, start: int, limit: int) -> int:
    """Return where the reason ends: with the line, the comment, or the sign of another comment within it."""
    line = _REASON.match(whole, start, limit)
    return start + len(_CLOSING.sub("", line[0] if line else "").rstrip("#/ \t"))


def _cut_comment(whole: str, start: int, end: int) -> tuple[int, int]:
    """Return what to cut to be rid of a comment: its lines, or with it the space before it."""
    lines = _BLANK.match(whole, end) if _is_alone(whole, start, end) else None
    while start and whole[start - 1] in " \t":
        start -= 1
    return start, lines.end() if lines else end


def _cut_mark(whole: str, comment: int, start: int, stop: int, end: int) -> tuple[int, int]:
    """Return what to cut to be rid of a mark in a comment that says more: with it, one comment sign."""
    if _OPENING.fullmatch(whole, comment, start):
        following = _SIGN.match(whole, stop, end)
        return start, following.end() if following else stop
    while start > comment and whole[start - 1] in " \t#/":
        start -= 1
    return start, stop


def _joint(whole: str, start: int, end: int) -> str:
    """Return a space where a cut would glue two words together."""
    return " " if start and end < len(whole) and not (whole[start - 1].isspace() or whole[end].isspace()) else ""
