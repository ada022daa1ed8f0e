"""Wildcards as regular expressions that take linear time; what a wildcard is, each format says for itself."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence

LONGEST = 4096
"""Characters of a pattern or a path. A longer one is that of no file: PATH_MAX of Linux."""


def spaced(pieces: Sequence[str], gap: str, numbers: Iterator[int]) -> str:
    """Return an expression for pieces with gaps between them, given expressions; that of a gap ends with ``*``.

    Every piece but the last one takes the first place where it fits and keeps it, because a later place leaves less of the
    text to the other pieces. ``numbers`` are free names of groups.
    """
    first, *others = pieces
    if not others:
        return first
    *middle, last = others
    # A lookahead is never tried again: what atomic groups do from Python 3.11 on.
    kept = [f"(?=(?P<g{number}>{gap}?{piece}))(?P=g{number})" for piece, number in zip(middle, numbers, strict=False)]
    return f"{first}{''.join(kept)}{gap}{last}"


def letters(ranges: Iterable[tuple[int, int]], *, negated: bool) -> str:
    """Return an expression for one character in ranges of code points, or in none of them, and for no slash."""
    inside = "".join([f"{_escaped(low)}-{_escaped(high)}" for low, high in ranges if low <= high])
    if negated:
        return f"[^/{inside}]"
    return f"(?!/)[{inside}]" if inside else "(?!)"


def _escaped(code: int) -> str:
    return re.escape(chr(code)) if code < 128 else chr(code)
