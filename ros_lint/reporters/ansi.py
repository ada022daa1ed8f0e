"""Text for a terminal: colours, links, the width of characters, and escapes for control characters."""

from __future__ import annotations

import re
from functools import lru_cache
from typing import NamedTuple

from ros_lint.base.controls import HARMFUL, LOG_COMMAND

TAB = 4
"""Number of columns for which a tab is replaced by blanks."""


class Style(NamedTuple):
    """The style of the output: what the terminal can show and what the user requests."""

    color: bool = False
    """True if the output has colours."""
    ascii: bool = False
    """True if the output has only ASCII characters; others are escaped."""
    width: int = 120
    """Width in columns. Longer source lines are shortened, but messages are not."""
    fixes: bool = False
    """True if the changes of each fix are shown as a diff."""
    summary: bool = True
    """True if a summary follows the findings."""
    rule_url: str = ""
    """URL of the page of a rule, with ``{rule}`` in place of its name; "" if the terminal shows no links (OSC 8)."""


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
    """Return a text in a colour (a key of ``_CODES``) if the style has colours, otherwise unchanged."""
    return f"\x1b[{_CODES[color]}m{text}\x1b[0m" if style.color and text else text


def link(url: str, text: str) -> str:
    """Return a text as a link to a URL for a terminal (OSC 8). If ``url`` is "", return the text unchanged."""
    return f"\x1b]8;;{url}\x1b\\{text}\x1b]8;;\x1b\\" if url else text


def safe(text: str, style: Style) -> str:
    """Return a text with escapes in place of characters that move the cursor, or change colours or the direction of writing."""
    text = LOG_COMMAND.sub(r"#\\x23", text)
    return text if _PLAIN.match(text) else "".join(glyph(character, style.ascii)[0] for character in text)


def harmless(text: str) -> str:
    """Return a text of any number of lines with escapes in place of the characters that :func:`safe` escapes in a line."""
    return HARMFUL.sub(lambda match: _escape(ord(match[0])), LOG_COMMAND.sub(r"#\\x23", text))


def cells(line: str, style: Style) -> tuple[list[str], list[int]]:
    """Return a list with the text to show for each code point of a line, and a list with the width of each in columns."""
    commands = [match.start() + 1 for match in LOG_COMMAND.finditer(line)]
    if not commands and _PLAIN.match(line):
        return list(line), [1] * len(line)
    pairs = [glyph(character, style.ascii) for character in line]
    for second in commands:
        pairs[second] = ("\\x23", 4)
    return [shown for shown, _ in pairs], [width for _, width in pairs]


@lru_cache(maxsize=1024)
def glyph(character: str, only_ascii: bool) -> tuple[str, int]:
    """Return the text to show for a code point (the code point itself or an escape), and the width of the text in columns."""
    if " " <= character <= "~":
        return character, 1
    if character == "\t":
        return " " * TAB, TAB
    from ros_lint.reporters.widths import columns  # noqa: PLC0415  (most runs do not need it)

    width = None if only_ascii or character < " " or character == "\x7f" else columns(character)
    if width is None:
        shown = _escape(ord(character))
        return shown, len(shown)
    return character, width


def _escape(code: int) -> str:
    if 0xDC80 <= code <= 0xDCFF:
        return f"\\x{code - 0xDC00:02x}"  # an undecodable byte, see text.decode
    return f"\\x{code:02x}" if code < 0x100 else f"\\u{code:04x}" if code < 0x10000 else f"\\U{code:08x}"
