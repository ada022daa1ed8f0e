"""Convert places in files between ros-lint and the Language Server Protocol.

Lines and columns of a :class:`Span` count from 1, columns in code points. In the protocol both count from 0, and columns
are in the units that server and client agreed on, by default UTF-16 code units.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import TYPE_CHECKING, NamedTuple

from lsprotocol import types

if TYPE_CHECKING:
    from ros_lint.base.text import Span, Text

ENCODINGS = {
    types.PositionEncodingKind.Utf8: "utf-8",
    types.PositionEncodingKind.Utf16: "utf-16-le",
    types.PositionEncodingKind.Utf32: "utf-32-le",
}
_LINE = re.compile(r"[^\r\n]*(?:\r\n|\r|\n)|[^\r\n]+\Z")
_UNIT_BYTES = {"utf-8": 1, "utf-16-le": 2, "utf-32-le": 4}


class Place(NamedTuple):
    """A position in a text. Line and column count from 1, the column in code points."""

    line: int
    column: int

    def is_in(self, span: Span) -> bool:
        """Return whether the position is in a span or at its end, because the cursor is at the end after typing."""
        return (span.line, span.column) <= self <= (span.end_line, span.end_column)


class Positions:
    """Converts places to positions of the protocol and back. ``encoding`` is the Python codec for the units of columns."""

    def __init__(self, encoding: str, text: Callable[[str], Text | None]) -> None:
        self._encoding = encoding
        self._text = text

    def range(self, span: Span) -> types.Range:
        """Return a span as a range of the protocol."""
        text = self._text(span.path)
        start, end = (span.line, span.column), (span.end_line, span.end_column)
        return types.Range(self._position(text, *start), self._position(text, *end))

    def place(self, text: Text, position: types.Position) -> Place:
        """Return a position of the protocol in ``text`` as a place.

        A position behind the end of a line becomes the end of the line.
        """
        try:
            line = text.line(position.line + 1)
        except IndexError:
            return Place(position.line + 1, 1)
        data = line.encode(self._encoding, "surrogatepass")[: position.character * _UNIT_BYTES[self._encoding]]
        return Place(position.line + 1, len(data.decode(self._encoding, "ignore")) + 1)

    def change(self, path: str, new: str) -> types.TextEdit:
        """Return the smallest edit of whole lines that changes the text of the file at ``path`` to ``new``."""
        text = self._text(path)
        old_lines, new_lines = _lines(text.text if text else ""), _lines(new)
        most = min(len(old_lines), len(new_lines))
        first = next((number for number in range(most) if old_lines[number] != new_lines[number]), most)
        most -= first
        last = next((number for number in range(most) if old_lines[-1 - number] != new_lines[-1 - number]), most)
        return types.TextEdit(
            types.Range(types.Position(first, 0), types.Position(len(old_lines) - last, 0)),
            "".join(new_lines[first : len(new_lines) - last]),
        )

    def _position(self, text: Text | None, line: int, column: int) -> types.Position:
        try:
            before = text.line(line)[: column - 1] if text else ""
        except IndexError:
            before = ""
        units = len(before.encode(self._encoding, "surrogatepass")) // _UNIT_BYTES[self._encoding]
        return types.Position(line - 1, units if text else column - 1)


def _lines(text: str) -> list[str]:
    """Return the lines of a text with their line ends: LF, CR LF or CR, as in the protocol."""
    return _LINE.findall(text)
