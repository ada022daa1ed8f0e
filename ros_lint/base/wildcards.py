"""Compile wildcards to regular expressions that run in linear time. Each format defines its wildcards."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence

LONGEST = 4096
"""Maximum length of a pattern or a path in characters: PATH_MAX of Linux."""


def spaced(pieces: Sequence[str], gap: str, numbers: Iterator[int]) -> str:
    """Return an expression for expressions with gaps between them; ``gap`` is one that ends with ``*``.

    Each piece except the last one keeps its first match, because a later match leaves less text for the other
    pieces. ``numbers`` are unused numbers for names of groups.
    """
    first, *others = pieces
    if not others:
        return first
    *middle, last = others
    # A lookahead is not retried: it works like an atomic group, which Python has from 3.11.
    kept = [f"(?=(?P<g{number}>{gap}?{piece}))(?P=g{number})" for piece, number in zip(middle, numbers, strict=False)]
    return f"{first}{''.join(kept)}{gap}{last}"


def letters(ranges: Iterable[tuple[int, int]], *, negated: bool) -> str:
    """Return an expression for a character, not a slash, in ranges of code points or in none of them."""
    inside = "".join([f"{_escaped(low)}-{_escaped(high)}" for low, high in ranges if low <= high])
    if negated:
        return f"[^/{inside}]"
    return f"(?!/)[{inside}]" if inside else "(?!)"


def _escaped(code: int) -> str:
    return re.escape(chr(code)) if code < 128 else chr(code)
