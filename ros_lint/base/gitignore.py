"""Find out which paths the patterns of ``.gitignore`` files ignore, because ignored files are generated or downloaded."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from functools import lru_cache
from itertools import count
from typing import Final, NamedTuple

from ros_lint.base.text import octets
from ros_lint.base.wildcards import LONGEST, letters, spaced

_NAME = ".gitignore"


class Pattern(NamedTuple):
    """One pattern of a ``.gitignore`` file (gitignore(5))."""

    folder: str
    """Folder of the ``.gitignore`` file. The pattern applies to paths below this folder."""
    glob: str
    """The pattern as a wildcard for a path relative to ``folder``, e.g. "**/*.pyc". It is compiled when it is first used."""
    negated: bool
    """True if the pattern begins with "!": it re-includes paths that an earlier pattern ignores."""


def patterns(folder: str, text: str) -> Iterator[Pattern]:
    """Yield the patterns of a ``.gitignore`` file, in order. ``folder`` is its folder and ``text`` its contents.

    Of equal lines, only the last one counts, because the last matching pattern decides.
    """
    for raw_line in reversed(dict.fromkeys(reversed(text.split("\n")))):
        line = raw_line.removesuffix("\r")
        if line.endswith(" "):
            line = _trimmed(line)
        if not line or line.startswith("#"):
            continue
        negated = line.startswith("!")
        glob = line[negated:].removesuffix("/")
        if glob:
            yield Pattern(folder, glob.removeprefix("/") if "/" in glob else f"**/{glob}", negated)


def _trimmed(line: str) -> str:
    """Return a line without its trailing spaces. A space after a backslash is kept."""
    stripped = line.rstrip(" ")
    backslashes = len(stripped) - len(stripped.rstrip("\\"))
    return line[: len(stripped) + backslashes % 2]


def is_ignored(candidates: Iterable[Pattern], path: str) -> bool:
    """Return whether git ignores a path because of patterns for the path itself or for a folder above it.

    The path need not exist. ``candidates`` are the patterns in the order in which git reads them. The last matching
    pattern decides.
    """
    applicable = [
        (regex, len(octets(pattern.folder)) + 1 if pattern.folder else 0, pattern.negated)
        for pattern in candidates
        if (not pattern.folder or path.startswith(f"{pattern.folder}/")) and (regex := _compiled(pattern.glob))
    ]
    parts = octets(path).split("/")
    for depth in range(len(parts)) if applicable else ():
        ancestor = "/".join(parts[: depth + 1])
        ignores = [not negated for regex, start, negated in applicable if len(ancestor) > start and regex.match(ancestor, start)]
        if ignores and ignores[-1]:
            return True
    return False


# --- patterns (wildmatch.c of git) ----------------------------------------------------------------------------------

_TOKEN = re.compile(r"((?:\A|(?<=/))\*\*+(?=/|\Z))|(\*+)|(\?)|(\[)|(\\?/)|\\(.)|([^\\])", re.DOTALL)
# Groups: 1 any number of folders, 2 star, 3 question mark, 4 bracket, 5 slash, 6 escaped and 7 other characters.
_ELEMENT = re.compile(r"\[:([^\]]*):\]|(?:\\(.)|([^\\]))(?:-(?:\\(.)|([^\]\\])))?", re.DOTALL)
"""An item in brackets, such as ``[:alpha:]`` or ``a-z``.

Groups: 1 a class name, 2 or 3 the first character, 4 or 5 the last one.
"""
_CLASSES: Final = {
    "alnum": "09AZaz", "alpha": "AZaz", "blank": "\t\t  ", "cntrl": "\0\x1f\x7f\x7f", "digit": "09", "graph": "!~",
    "lower": "az", "print": " ~", "punct": "!/:@[`{~", "space": "\t\n\r\r  ", "upper": "AZ", "xdigit": "09AFaf",
}  # fmt: skip
"""Ranges of characters by class name, e.g. "AZaz" for A to Z and a to z."""


class _MalformedError(Exception):
    """The pattern is malformed, so git never matches it."""


@lru_cache(maxsize=1024)
def _compiled(glob: str) -> re.Pattern[str] | None:
    """Return the regular expression for a wildcard, None if the wildcard is malformed.

    The expression matches a path that :func:`ros_lint.base.text.octets` has encoded.
    """
    try:
        names = _names(octets(glob))
    except _MalformedError:
        return None
    numbers = count()
    pieces = [""]
    for rest, name in zip(range(len(names) - 1, -1, -1), names, strict=True):
        if name:
            pieces[-1] += spaced(name, "[^/]*", numbers) + ("/" if rest else "")
        else:
            pieces.append("" if rest else "[^/]+")
    return re.compile(spaced(pieces, "(?:[^/]+/)*", numbers) + r"\Z")


def _names(glob: str) -> list[list[str]]:
    """Return a wildcard as regular expressions: for each path component a list of its pieces between ``*``; [] for ``**``.

    Example: ``src/**/a*b`` -> ``[["src"], [], ["a", "b"]]``. Raises _MalformedError.
    """
    if len(glob) > LONGEST:
        raise _MalformedError
    names = [[""]]
    at = 0
    while at < len(glob):
        match = _TOKEN.match(glob, at)
        if match is None:
            raise _MalformedError
        at = match.end()
        pieces = names[-1]
        match match.lastindex:
            case 1:
                pieces.clear()
            case 2:
                pieces.append("")
            case 3:
                pieces[-1] += "[^/]"
            case 4:
                letter, at = _letter(glob, at)
                pieces[-1] += letter
            case 5:
                names.append([""])
            case _:
                pieces[-1] += re.escape(match[6] or match[7])
    return names


def _letter(glob: str, at: int) -> tuple[str, int]:
    """Return the regular expression for a bracket expression such as ``[a-z]``, and the offset after its closing bracket.

    ``at`` is the offset after the opening bracket.
    """
    negated = glob[at : at + 1] in ("!", "^")
    at += negated
    ranges: list[tuple[int, int]] = []
    while not ranges or glob[at : at + 1] != "]":
        match = _ELEMENT.match(glob, at)
        if match is None or (match[1] is not None and match[1] not in _CLASSES):
            raise _MalformedError
        at = match.end()
        if match[1] is not None:
            ends = _CLASSES[match[1]]
        else:
            low = match[2] or match[3]
            ends = low + low + low + (match[4] or match[5] or low)  # the first character counts even if the range is empty
        ranges += [(ord(low), ord(high)) for low, high in zip(ends[::2], ends[1::2], strict=True)]
    return letters(ranges, negated=negated), at + 1
