"""Characters on a terminal: colour, width, and what must not reach it as it is."""

from __future__ import annotations

import re
from functools import lru_cache
from typing import NamedTuple

TAB = 4


class Style(NamedTuple):
    """How to write for people. The caller knows where the text goes."""

    color: bool = False
    ascii: bool = False
    """Whether whatever reads it can show ASCII only."""
    width: int = 120
    """In columns; longer source lines are shortened. Messages are not."""
    fixes: bool = False
    """Whether to show what each fix would change."""


_CODES = {
    "error": "1;31",
    "warning": "1;33",
    "info": "1;36",
    "bold": "1",
    "gutter": "1;34",
    "related": "1;34",
    "good": "32",
    "added": "32",
    "removed": "31",
}
_PLAIN = re.compile(r"[ -~]*\Z")


def paint(style: Style, color: str, text: str) -> str:
    """Return a text in one of the colours of the house, if there is colour."""
    return f"\x1b[{_CODES[color]}m{text}\x1b[0m" if style.color and text else text


def safe(text: str, style: Style) -> str:
    """Return a text in which nothing moves the cursor, changes colours, or turns the direction of writing."""
    return text if _PLAIN.match(text) else "".join(glyph(character, style.ascii)[0] for character in text)


def cells(line: str, style: Style) -> tuple[list[str], list[int]]:
    """Return what to show for each code point of a line, and how many columns each takes."""
    if _PLAIN.match(line):
        return list(line), [1] * len(line)
    pairs = [glyph(character, style.ascii) for character in line]
    return [shown for shown, _ in pairs], [width for _, width in pairs]


@lru_cache(maxsize=1024)
def glyph(character: str, only_ascii: bool) -> tuple[str, int]:
    """Return what to show for a code point, and how many columns that takes."""
    if " " <= character <= "~":
        return character, 1
    if character == "\t":
        return " " * TAB, TAB
    from ros_lint.reporters.widths import columns  # noqa: PLC0415  (most runs do without)

    width = None if only_ascii or character < " " or character == "\x7f" else columns(character)
    if width is None:
        shown = _escape(ord(character))
        return shown, len(shown)
    return character, width


def _escape(code: int) -> str:
    if 0xDC80 <= code <= 0xDCFF:
        return f"\\x{code - 0xDC00:02x}"  # a byte that is no UTF-8, see text.decode
    return f"\\x{code:02x}" if code < 0x100 else f"\\u{code:04x}" if code < 0x10000 else f"\\U{code:08x}"
