"""Glob patterns of CMake (KWSys Glob.cxx) as regular expressions; ``*`` and ``?`` match no slash."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from functools import lru_cache
from itertools import count

from ros_lint.base.text import octets
from ros_lint.base.wildcards import LONGEST, letters, spaced


def path_pattern(parts: Sequence[str], *, recurse: bool) -> re.Pattern[str]:
    """Return the regular expression for a whole path, from a glob pattern for each component: ``["src", "*.cpp"]``.

    The expression matches the :func:`~ros_lint.base.text.octets` of the path. With ``recurse``, any
    folders may precede the last component. An invalid pattern matches nothing.
    """
    numbers = count()
    *heads, last = (_expression(part, numbers) or "(?!)" for part in parts)
    return re.compile("".join(f"{head}/" for head in heads) + ("(?:[^/]+/)*" if recurse else "") + last)


def end_pattern(pattern: str) -> re.Pattern[str] | None:
    """Return the regular expression for the last components of a path, from a glob pattern such as ``*.h``.

    The expression searches the :func:`~ros_lint.base.text.octets` of the path. None if CMake rejects the pattern.
    """
    expression = _expression(pattern, count())
    return None if expression is None else re.compile(rf"/{expression}\Z")


def _expression(pattern: str, numbers: Iterator[int]) -> str | None:
    pieces = _pieces(octets(pattern))
    if pieces is None:
        return None
    return spaced(pieces, "[^/]*", numbers)


@lru_cache(maxsize=256)
def _pieces(pattern: str) -> tuple[str, ...] | None:
    """Return regular expressions for the parts of a glob pattern, split at ``*``: ``a*b`` -> ``("a", "b")``.

    None if a range in brackets is invalid.
    """
    if len(pattern) > LONGEST:
        return None
    pieces = [""]
    at = 0
    while at < len(pattern):
        letter = pattern[at]
        at += 1
        if letter == "*":
            if pieces[-1] or len(pieces) == 1:
                pieces.append("")
        elif letter == "?":
            pieces[-1] += "[^/]"
        elif letter == "[" and (end := _end(pattern, at)) >= 0:
            expression = _letter(pattern[at:end])
            if expression is None:
                return None
            pieces[-1] += expression
            at = end + 1
        else:
            pieces[-1] += re.escape(letter)
    return tuple(pieces)


def _end(pattern: str, at: int) -> int:
    """Return the offset of the closing bracket, given the offset after the opening one.

    -1 if there is no closing bracket.
    """
    at += pattern[at : at + 1] in ("!", "^")
    return pattern.find("]", at + 1)


def _letter(inside: str) -> str | None:
    """Return a regular expression for one of the characters in brackets; None for an inverted range such as ``z-a``.

    ``inside`` is the text between the brackets of a glob pattern.
    """
    negated = inside[:1] in ("!", "^")
    body = inside[negated:].replace("\\", "\\\\")  # KWSys escapes it so, which adds a second backslash to the set
    ranges = [(ord(letter), ord(letter)) for letter in body[:1]]
    at = 1
    while at < len(body):
        if body[at] == "-" and at + 1 < len(body):
            low, high = ord(body[at - 1]), ord(body[at + 1])
            if low > high:
                return None
            ranges.append((low, high))
            at += 2
        else:
            ranges.append((ord(body[at]), ord(body[at])))
            at += 1
    return letters(ranges, negated=negated)
