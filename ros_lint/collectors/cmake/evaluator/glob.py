"""Translation of CMake's glob patterns (KWSys Glob.cxx) to regular expressions. ``*`` and ``?`` match no slash."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from functools import lru_cache
from itertools import count

from ros_lint.base.text import octets
from ros_lint.base.wildcards import LONGEST, letters, spaced


def path_pattern(parts: Sequence[str], *, recurse: bool) -> re.Pattern[str]:
    """Return the regular expression of a whole path, given a glob pattern for each path component: ``["src", "*.cpp"]``.

    The expression matches the path converted with :func:`~ros_lint.base.text.octets`. With ``recurse``, the last component
    may be in any subfolder. An invalid glob pattern gives an expression that matches nothing.
    """
    numbers = count()
    *heads, last = (_expression(part, numbers) or "(?!)" for part in parts)
    return re.compile("".join(f"{head}/" for head in heads) + ("(?:[^/]+/)*" if recurse else "") + last)


def end_pattern(pattern: str) -> re.Pattern[str] | None:
    """Return the regular expression of the end of a path, given a glob pattern such as ``*.h`` or ``include/*.h``.

    The expression is to be searched in the path converted with :func:`~ros_lint.base.text.octets`. The result is None if
    CMake rejects the glob pattern.
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
    """Return regular expressions of the parts of a glob pattern between its ``*``: ``a*b`` -> ``("a", "b")``.

    The result is None if a range in brackets is invalid or the pattern is too long.
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
    """Return the offset of the bracket ``]`` that closes a set of characters, given the offset after its opening bracket.

    The result is -1 if there is no closing bracket.
    """
    at += pattern[at : at + 1] in ("!", "^")
    return pattern.find("]", at + 1)


def _letter(inside: str) -> str | None:
    """Return a regular expression for a set of characters, given the text between its brackets in a glob pattern.

    The result is None if the set has an inverted range such as ``z-a``.
    """
    negated = inside[:1] in ("!", "^")
    body = inside[negated:].replace("\\", "\\\\")  # as in KWSys, which adds a second backslash to the set
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
