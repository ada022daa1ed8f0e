"""Suppression comments of ros-lint: their places, the lines to which they apply, and the edits that remove them."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from ros_lint.base.edit import Edit
from ros_lint.collectors.comments import comments
from ros_lint.facts.suppressions import MARKER, Name, Suppression

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ros_lint.base.text import Text

_HOW = "write ros-lint: ignore[rule-name] reason"

_MARK = re.compile(r"ros-lint:[ \t]*(?P<word>[A-Za-z][\w-]*)?(?P<bracket>[ \t]*\[(?P<names>[^\]\r\n]*)(?P<close>\])?)?")
_OPENING = re.compile(r"(?:<!--|#\[=*\[|#+|;|//+[!<]?|/\*+[!<]?)\s*")
_CLOSING = re.compile(r"-->|\*+/|\]=*\]")
_PROLOG = re.compile(r"[\ufeff \t\r\n\f]+|<\?.*?\?>|<!DOCTYPE[^>\[]*(?:\[.*?\]\s*)?>", re.DOTALL)
_AFTER_REASON = re.compile(r"(?<![ \t])[ \t]+(?:#|//)[ \t]|[\r\n]|\Z")
_SIGN = re.compile(r"[ \t]*(?:#+|//+)?[ \t]*")
_BLANK = re.compile(r"[ \t\f]*(?:\r\n|\r|\n|\Z)")


def collect(text: Text) -> tuple[Suppression, ...]:
    """Return the suppressions in the comments of a file, in order."""
    return tuple(_suppressions(text)) if MARKER in text.text else ()


def _suppressions(text: Text) -> Iterator[Suppression]:
    content = text.text
    ranges = comments(text)
    lines = {start: (text.position(start)[0], text.position(end)[0]) for start, end in ranges}
    ends = [0, *(lines[start][1] for start, _ in ranges)]  # a comment after another one in its line is not alone
    standalone = {
        start
        for (start, end), before in zip(ranges, ends, strict=False)
        if lines[start][0] != before and _is_standalone(content, text.offset(lines[start][0], 1), start, end)
    }
    own_lines = {line for start in standalone for line in range(lines[start][0], lines[start][1] + 1)}
    following_line: dict[int, int] = {}  # a line with only a comment -> the next line without one
    for line in sorted(own_lines, reverse=True):
        following_line[line] = following_line.get(line + 1, line + 1)
    leading = True
    previous_end = 0
    for start, end in ranges:
        leading = leading and _is_prolog(content[previous_end:start])
        previous_end = end
        first, last = lines[start]
        alone = start in standalone
        yield from _in_comment(text, (start, end), (first, following_line[last] if alone else last), leading, alone)


def _in_comment(
    text: Text, comment: tuple[int, int], lines: tuple[int, int], leading: bool, standalone: bool
) -> Iterator[Suppression]:
    """Yield the suppressions in a comment.

    ``comment`` is its offset range, and ``lines`` are the first and last line to which they apply. ``leading`` is True if only
    comments and XML declarations precede the comment in its file, ``standalone`` if nothing else is on its lines.
    """
    start, end = comment
    content = text.text
    marks = list(_MARK.finditer(content, start, end))
    for number, mark in enumerate(marks, 1):
        opens = number == 1 and _OPENING.fullmatch(content, start, mark.start()) is not None
        problem = _problem(mark, leading)
        if problem is None or (not opens and mark["word"] not in ("ignore", "ignore-file")):
            continue  # a sentence that mentions ros-lint
        stop = _reason_end(content, mark.end(), marks[number].start() if number < len(marks) else end)
        if opens and len(marks) == 1 and _closes(content[stop:end]):
            cut = _cut_comment(content, start, end, standalone)
        else:
            cut = _cut_mark(content, (mark.start(), stop), comment, opens)
        names_range = mark.span("names") if mark["names"] is not None else (mark.end(), mark.end())
        yield Suppression(
            tuple(_names(text, *names_range)),
            content[mark.end() : stop].strip().lstrip("-:").strip(),
            None if mark["word"] == "ignore-file" else lines,
            text.span(*mark.span()),
            text.span(*names_range),
            Edit(text.span(*cut), _separator(content, *cut)),
            problem,
        )


def _problem(mark: re.Match[str], leading: bool) -> str | None:
    """Return the error in a suppression, "" for a valid suppression, None for a comment that only mentions ros-lint.

    ``leading`` is True if only comments and XML declarations precede the comment in its file.
    """
    if mark["word"] not in ("ignore", "ignore-file"):
        return f"'{mark[0].strip()}' has no effect; {_HOW}" if mark["word"] else None
    if mark["names"] is not None and not mark["close"]:
        return f"the bracket of this suppression is not closed on its line; {_HOW}"
    if not (mark["names"] or "").replace(",", "").strip():
        return f"this suppression names no rule; {_HOW}"
    if mark["word"] == "ignore-file" and not leading:
        return "'ros-lint: ignore-file' only works in the first comments of a file; move it there, or write 'ros-lint: ignore'"
    return ""


def _names(text: Text, start: int, end: int) -> Iterator[Name]:
    for word in re.finditer(r"[^,\s](?:[^,]*[^,\s])?", text.text[start:end]):
        yield Name(word[0], text.span(start + word.start(), start + word.end()))


def _is_standalone(content: str, line: int, start: int, end: int) -> bool:
    """Return whether only white space is before and after a comment in its lines. ``line`` is the offset of its first line."""
    return not content[line:start].strip() and _BLANK.match(content, end) is not None


def _is_prolog(between: str) -> bool:
    """Return whether the text between two comments contains only white space, XML declarations and document types."""
    at = 0
    while at < len(between) and (match := _PROLOG.match(between, at)):
        at = match.end()
    return at == len(between)


def _reason_end(content: str, start: int, limit: int) -> int:
    """Return the offset at which the reason of a suppression ends.

    That is the end of its line or of its comment, or a further ``#`` or ``//``: ``# ros-lint: ignore[x] reason # noqa``.
    """
    after = _AFTER_REASON.search(content, start, limit)
    reason = content[start : after.start() if after else limit].rstrip()
    if reason.endswith("-->"):
        reason = reason[:-3]
    elif reason.endswith("*/"):
        reason = reason[:-2].rstrip("*")
    elif reason.endswith("]") and (brackets := reason[:-1].rstrip("=")).endswith("]"):
        reason = brackets[:-1]
    return start + len(reason.rstrip().rstrip("#/ \t"))


def _closes(rest: str) -> bool:
    """Return whether a comment contains nothing but its closing sign, if it has one, after a suppression."""
    sign = rest.strip()
    return not sign or _CLOSING.fullmatch(sign) is not None


def _cut_comment(content: str, start: int, end: int, standalone: bool) -> tuple[int, int]:
    """Return the offset range to delete in order to remove a comment with the white space before it.

    If nothing else is on its lines (``standalone``), the range includes the line end.
    """
    lines = _BLANK.match(content, end) if standalone else None
    while start and content[start - 1] in " \t":
        start -= 1
    return start, lines.end() if lines else end


def _cut_mark(content: str, mark: tuple[int, int], comment: tuple[int, int], opens: bool) -> tuple[int, int]:
    """Return the offset range to delete in order to remove a suppression and keep the rest of its comment.

    ``mark`` and ``comment`` are the ranges of the suppression with its reason, and of the comment that contains it; ``opens``
    says that nothing precedes the suppression in the comment. The range includes one comment sign:
    ``# a # ros-lint: ignore[x]`` -> ``# a``, ``# ros-lint: ignore[x] # a`` -> ``# a``.
    """
    start, stop = mark
    if opens:
        following = _SIGN.match(content, stop, comment[1])
        return start, following.end() if following else stop
    while start > comment[0] and content[start - 1] in " \t#/":
        start -= 1
    return start, stop


def _separator(content: str, start: int, end: int) -> str:
    """Return the text that replaces a deleted range: a space if the words before and after it would be joined, else ""."""
    return " " if start and end < len(content) and not (content[start - 1].isspace() or content[end].isspace()) else ""
