"""Build regular expressions for wildcards such as ``*``. The expressions match in linear time.

The callers define the syntax of their wildcards, because it differs between git, CMake and others.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence

LONGEST = 4096
"""Maximum length in characters of a pattern or a path: PATH_MAX of Linux."""


def spaced(pieces: Sequence[str], gap: str, numbers: Iterator[int]) -> str:
    """Return a regular expression that matches ``pieces`` in order, with ``gap`` between them: ``a``, ``b`` -> ``a[^/]*b``.

    ``pieces`` and ``gap`` are regular expressions; ``gap`` ends with ``*``. ``numbers`` yields unused numbers for the
    names of groups. To match in linear time, the expression tries only the first match of each piece before the last one:
    a later match would leave less text for the following pieces.
    """
    first, *later_pieces = pieces
    if not later_pieces:
        return first
    *middle, last = later_pieces
    # A lookahead is not retried. It replaces an atomic group, which Python has only from 3.11.
    lookaheads = [f"(?=(?P<g{number}>{gap}?{piece}))(?P=g{number})" for piece, number in zip(middle, numbers, strict=False)]
    return f"{first}{''.join(lookaheads)}{gap}{last}"


def letters(ranges: Iterable[tuple[int, int]], *, negated: bool) -> str:
    """Return a regular expression for one character other than a slash in the given ranges of code points.

    If ``negated`` is True, the character must be in none of the ranges.
    """
    inside = "".join([f"{_escaped(low)}-{_escaped(high)}" for low, high in ranges if low <= high])
    if negated:
        return f"[^/{inside}]"
    return f"(?!/)[{inside}]" if inside else "(?!)"


def _escaped(code: int) -> str:
    return re.escape(chr(code)) if code < 128 else chr(code)
