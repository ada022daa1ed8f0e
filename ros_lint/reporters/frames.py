"""Code frames: the source lines of a finding, with its places underlined."""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from functools import lru_cache
from itertools import accumulate
from typing import TYPE_CHECKING, NamedTuple

from ros_lint.reporters.ansi import Style, cells, paint, safe

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from ros_lint.base.text import Span, Text
    from ros_lint.reporters import SourceTexts

_ELLIPSIS = "..."
_CONTEXT = 20
"""Number of columns to show before a place in a line that is too long."""
_MOST_CHARACTERS = 8_000
"""Maximum number of characters of a line that are processed. No screen shows so many."""
_FIRST_LINES, _LAST_LINES = 3, 2
"""Number of first lines, and number of last lines, that are shown of a place with many lines."""
_MIN_WIDTH = 40
"""Minimum width in columns for source text."""


class Mark(NamedTuple):
    """A place to underline in a code frame."""

    span: Span
    label: str
    """Text next to the underline, "" if there is none."""
    color: str
    sign: str
    """Character of the underline: ``^`` for the place of the finding, ``-`` for related places."""


def frame(marks: Sequence[Mark], texts: SourceTexts, style: Style, most: int | None = None) -> tuple[list[str], str]:
    """Return the rows of a code frame, and the blanks to the left of its vertical bar.

    A caller puts these blanks before further rows below the frame, to align them with the bar.
    The frame shows the lines of the places in the first ``most`` files. For places in other files, it shows only path,
    line and label. ``most`` None means all files.
    """
    files: dict[str, list[Mark]] = {}
    for mark in marks:
        files.setdefault(mark.span.path, []).append(mark)
    rest = [mark for path in list(files)[most:] for mark in files.pop(path)] if most else []
    sources = {path: texts(path) for path in files}
    visible = [(mark, source) for mark in marks if (source := sources.get(mark.span.path)) and _is_in(mark, source)]
    digits = max((len(str(min(mark.span.end_line, source.line_count))) for mark, source in visible), default=1)
    gutter = " " * digits
    bar = paint(style, "gutter", f"{gutter} |")
    rows: list[str] = []
    for path, in_file in files.items():
        if rows:
            rows.append(bar)
        arrow = ":::" if rows else "-->"
        rows.append(f"{gutter}{paint(style, 'gutter', arrow)} {safe(str(in_file[0].span), style)}")
        source = sources[path]
        shown = [mark for mark in in_file if source and _is_in(mark, source)]
        if source and shown:
            rows += [bar, *_File(source, shown, digits, style).rows()]
        rows += [
            f"{bar} {paint(style, mark.color, safe(mark.label, style))}" for mark in in_file if mark.label and mark not in shown
        ]
    if rest:
        rows.append(bar)
    arrow = paint(style, "gutter", ":::")
    rows += [f"{gutter}{arrow} {safe(f'{mark.span}: {mark.label}', style)}" for mark in rest]
    return rows, gutter


def _is_in(mark: Mark, source: Text) -> bool:
    return 0 < mark.span.line <= source.line_count


class _MarkRange(NamedTuple):
    """A place to underline, limited to the existing lines of its file. Columns count from 0; the end is exclusive."""

    line: int
    start: int
    end_line: int
    end: int
    mark: Mark


class _File:
    """Formats the source lines of one file for a code frame."""

    def __init__(self, source: Text, marks: Sequence[Mark], digits: int, style: Style) -> None:
        self._source = source
        self._digits = digits
        self._style = style
        self._single_line: list[_MarkRange] = []
        self._multi_line: list[_MarkRange] = []
        for mark in marks:
            place = _place(source, mark)
            if place.line == place.end_line:
                self._single_line.append(place)
            elif any(place.line <= shown.end_line and shown.line <= place.end_line for shown in self._multi_line):
                # There is one column of bars: of two overlapping places, only the first line of the second one is
                # shown.
                length = len(source.line(place.line))
                self._single_line.append(place._replace(end_line=place.line, end=max(length, place.start)))
            else:
                self._multi_line.append(place)
        self._single_line.sort(key=lambda place: (place.line, place.start, place.end))
        self._width = max(style.width - digits - (5 if self._multi_line else 3), _MIN_WIDTH)

    def rows(self) -> Iterator[str]:
        before = 0
        for number in self._numbers():
            if before and number == before + 2:
                yield from self._line(before + 1)
            elif before and number > before + 2:
                yield self._row(_ELLIPSIS, self._side(before + 1), "")
            yield from self._line(number)
            before = number

    def _numbers(self) -> list[int]:
        numbers = {place.line for place in self._single_line}
        for place in self._multi_line:
            lines = range(place.line, place.end_line + 1)
            is_short = len(lines) <= _FIRST_LINES + _LAST_LINES + 1
            numbers.update(lines if is_short else (*lines[:_FIRST_LINES], *lines[-_LAST_LINES:]))
        return sorted(numbers)

    def _line(self, number: int) -> Iterator[str]:
        """Yield the rows for a source line: the line, and a row for each place that begins or ends in it."""
        line = self._source.line(number)
        shown, columns = _columns(line[:_MOST_CHARACTERS], self._style)
        beginning = [place for place in self._multi_line if place.line == number and not self._opens(place)]
        single_line = [place for place in self._single_line if place.line == number]
        ending = [place for place in self._multi_line if place.end_line == number]
        marked = [*beginning, *single_line, *ending]
        side = self._side(number)
        if (len(line) <= _MOST_CHARACTERS and columns[-1] <= self._width) or not marked:
            views = [(_view(shown, columns, 0, 0, self._width), marked)]
        else:
            # A line that is too long is shown once for each place in it.
            views = [(self._around(line, *_extent(place, number)), [place]) for place in marked]
        for view, places in views:
            yield self._row(str(number), side, view.text)
            for place in places:
                yield self._underline(place, number, view)

    def _around(self, line: str, start: int, end: int) -> _View:
        """Return the part of a long line to show around the range of characters from ``start`` to ``end``."""
        half = _MOST_CHARACTERS // 2
        # Places that are close to each other share a part of the line, which is converted to columns once.
        skipped = max(start - half // 2, 0) // half * half if len(line) > _MOST_CHARACTERS else 0
        shown, columns = _columns(line[skipped : skipped + _MOST_CHARACTERS], self._style)
        view = _view(shown, columns, start - skipped, min(end - skipped, len(shown)), self._width)
        return view._replace(skipped=skipped)

    def _underline(self, place: _MarkRange, number: int, view: _View) -> str:
        start, end = _extent(place, number)
        sign = place.mark.sign
        label = f" {safe(place.mark.label, self._style)}" if place.mark.label else ""
        if place in self._single_line:
            column = view.column(start)
            line = sign * max(view.column(end) - column, 1)
            return self._row("", self._side(number), " " * column + self._paint(place, line + label))
        if number == place.line:
            return self._row("", "", self._paint(place, f" {'_' * (view.column(start) + 1)}{sign}"))
        return self._row("", "", self._paint(place, f"|{'_' * (view.column(start) + 1)}{sign}{label}"))

    def _side(self, number: int) -> str:
        """Return the bar to the left of source line ``number`` if a place that spans several lines covers it, otherwise blanks.

        Return "" if no place in the file spans several lines.
        """
        for place in self._multi_line:
            if place.line < number <= place.end_line:
                return self._paint(place, "|") + " "
            if place.line == number and self._opens(place):
                return self._paint(place, "/") + " "
        return "  " if self._multi_line else ""

    def _opens(self, place: _MarkRange) -> bool:
        """Return whether only blanks precede a place on its first line."""
        return not self._source.line(place.line)[: place.start].strip()

    def _row(self, number: str, side: str, text: str) -> str:
        return f"{paint(self._style, 'gutter', f'{number:>{self._digits}} |')} {side}{text}".rstrip()

    def _paint(self, place: _MarkRange, text: str) -> str:
        return paint(self._style, place.mark.color, text)


class _View(NamedTuple):
    """The part of a source line that is shown."""

    text: str
    columns: Sequence[int]
    """For each character of the line and for its end, the column in the line, from 0."""
    offset: int
    """What to add to a column in the line for the column in the shown text."""
    end: int
    """The column in the shown text where the part of the line ends."""
    skipped: int = 0
    """Number of characters at the start of the line that ``columns`` has no entries for."""

    def column(self, index: int) -> int:
        """Return the column in the shown text of the character at ``index`` of the line."""
        column = self.columns[min(max(index - self.skipped, 0), len(self.columns) - 1)]
        return min(max(column + self.offset, 0), self.end)


@lru_cache(maxsize=4)
def _columns(line: str, style: Style) -> tuple[Sequence[str], Sequence[int]]:
    """Return the text to show for each character of a line, and the column where each character and the line's end are shown."""
    shown, widths = cells(line, style)
    return shown, [0, *accumulate(widths)]


def _view(shown: Sequence[str], columns: Sequence[int], start: int, end: int, width: int) -> _View:
    """Return the part of a line that contains the start of the range ``start`` to ``end`` and fits into ``width`` columns."""
    if columns[-1] <= width:
        return _View("".join(shown), columns, 0, columns[-1])
    first = 0
    if columns[end] > width - len(_ELLIPSIS):
        first = bisect_left(columns, columns[start] - _CONTEXT)
        first = min(bisect_right(columns, columns[first]) - 1, start)  # no combining characters without their letter
    lead = _ELLIPSIS if first else ""
    offset = len(lead) - columns[first]
    last = max(first, bisect_right(columns, width - len(_ELLIPSIS) - offset) - 1)
    tail = _ELLIPSIS if last < len(shown) else ""
    return _View(f"{lead}{''.join(shown[first:last])}{tail}", columns, offset, columns[last] + offset)


def _extent(place: _MarkRange, number: int) -> tuple[int, int]:
    """Return the range of characters to underline in line ``number``, which is the first or the last line of a place."""
    if place.line == place.end_line:
        return place.start, place.end
    return (place.start, place.start + 1) if number == place.line else (max(place.end - 1, 0), place.end)


def _place(source: Text, mark: Mark) -> _MarkRange:
    span = mark.span
    length = len(source.line(span.line))
    start = min(span.column - 1, length)
    end_line, end = span.end_line, span.end_column - 1
    if end == 0 and end_line > span.line:
        end_line -= 1
        end = len(source.line(min(end_line, source.line_count)))
    if end_line > source.line_count:
        end_line, end = source.line_count, len(source.line(source.line_count))
    if end_line <= span.line:
        return _MarkRange(span.line, start, span.line, max(start, min(end, length)), mark)
    return _MarkRange(span.line, start, end_line, min(end, len(source.line(end_line))), mark)
