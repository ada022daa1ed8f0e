"""Regular expressions of CMake (KWSys RegularExpression.cxx), translated to Python's.

CMake's expressions have fewer constructs than Python's, and match bytes.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import lru_cache
from typing import TYPE_CHECKING, Final

from ros_lint.base.text import from_bytes, octets
from ros_lint.collectors.cmake.evaluator.values import BINARY, HOLE, PREFIX, TREE, is_fixed, is_known, natural

if TYPE_CHECKING:
    from ros_lint.collectors.cmake.evaluator.run import Run


class RegexError(Exception):
    """The expression cannot be evaluated.

    CMake rejects it, its versions treat it differently, or matching could take exponential time.
    """


@lru_cache(maxsize=512)
def _compiled(text: str) -> re.Pattern[str]:
    return re.compile(_Translator(octets(text)).whole(), re.DOTALL)


def translated(text: str) -> re.Pattern[str] | None:
    """Return the expression for Python's re, which matches the octets of a text (see :func:`is_in`).

    None if the expression cannot be evaluated (see :class:`RegexError`) or is too long.
    """
    try:
        return _compiled(text) if len(text) <= _LONGEST else None
    except RegexError:
        return None


_LONGEST: Final = 4096
"""Characters of the longest expression that is evaluated, because a longer one takes long to compile."""


def is_in(pattern: re.Pattern[str], text: str) -> bool:
    """Return whether a translated expression matches anywhere in a text."""
    return pattern.search(octets(text)) is not None


def _text(text: str) -> str:
    return text if text.isascii() else from_bytes(text.encode("latin-1"))


_MOST_MATCHES: Final = 10_000
"""Matches of one expression in a text. If there are more, the result is unknown."""


class _Translator:
    def __init__(self, text: str) -> None:
        self.text = text
        self.at = 0
        self.repeats = 0
        """Number of pieces so far with an unlimited repetition (``*`` or ``+``)."""

    def whole(self) -> str:
        pattern = self.branches()
        if self.at != len(self.text):
            raise RegexError(self.text)
        return pattern[0]

    def branches(self) -> tuple[str, bool]:
        """Return the translated alternatives ``a|b`` up to a closing parenthesis or the end of the expression.

        The second value is True if an alternative can match the empty text.
        """
        pieces, empty = self.branch()
        while self.text[self.at : self.at + 1] == "|":
            self.at += 1
            branch, may_be_empty = self.branch()
            pieces, empty = f"{pieces}|{branch}", empty or may_be_empty
        return pieces, empty

    def branch(self) -> tuple[str, bool]:
        pieces: list[str] = []
        empty = True
        while self.at < len(self.text) and self.text[self.at] not in "|)":
            piece, may_be_empty = self.piece()
            pieces.append(piece)
            empty = empty and may_be_empty
        return "".join(pieces), empty

    def piece(self) -> tuple[str, bool]:
        repeats_before = self.repeats
        atom, empty = self.atom()
        sign = self.text[self.at : self.at + 1]
        if sign not in ("*", "+", "?"):
            return atom, empty
        if empty and sign != "?":
            raise RegexError(self.text)
        self.at += 1
        if self.text[self.at : self.at + 1] in ("*", "+", "?"):
            raise RegexError(self.text)
        if sign != "?":
            if self.repeats > repeats_before:
                raise RegexError(self.text)  # (a+)+ takes exponential time
            self.repeats += 1
        return f"{atom}{sign}", empty or sign != "+"

    def atom(self) -> tuple[str, bool]:
        letter = self.text[self.at]
        self.at += 1
        if letter == "^":
            return r"(?:\A)", True
        if letter == "$":
            return r"(?:\Z)", True
        if letter == ".":
            return ".", False
        if letter == "[":
            return self.letters(), False
        if letter == "(":
            group, empty = self.branches()
            if self.text[self.at : self.at + 1] != ")":
                raise RegexError(self.text)
            self.at += 1
            return f"({group})", empty
        if letter in "*+?" or (letter == "\\" and self.at == len(self.text)):
            raise RegexError(self.text)
        if letter == "\\":
            letter = self.text[self.at]
            self.at += 1
        return re.escape(letter), False

    def letters(self) -> str:
        end = self.at + (self.text[self.at : self.at + 1] == "^")
        end = self.text.find("]", end + 1)
        if end < 0:
            raise RegexError(self.text)
        body = self.text[self.at : end]
        self.at = end + 1
        negated = body.startswith("^")
        body = body[negated:]
        ranges: list[str] = []
        index = 0
        while index < len(body):
            if body[index + 1 : index + 2] == "-" and index + 2 < len(body):
                low, high = body[index], body[index + 2]
                if low > high:
                    raise RegexError(self.text)
                ranges.append(f"{re.escape(low)}-{re.escape(high)}")
                index += 3
            else:
                ranges.append(re.escape(body[index]))
                index += 1
        return f"[{'^' if negated else ''}{''.join(ranges)}]"


# --- use -----------------------------------------------------------------------------------------------------------


def clear(run: Run) -> None:
    """Empty the CMAKE_MATCH variables, as CMake does before it applies an expression."""
    last = run.get("CMAKE_MATCH_COUNT")
    if last is None:
        return
    highest = 0 if not last else natural(last)
    for index in range(10 if highest is None else min(highest + 1, 10)):
        if run.get(f"CMAKE_MATCH_{index}"):
            run.set(f"CMAKE_MATCH_{index}", "")
    # An empty CMAKE_MATCH_COUNT may also be unset, and then it stays unset.
    run.set("CMAKE_MATCH_COUNT", "0" if last and is_known(last) else HOLE)


def store(run: Run, groups: tuple[str, ...]) -> None:
    """Set CMAKE_MATCH_0 and so on; the first group is the whole match."""
    highest = ""
    for index, group in enumerate(groups[:10]):
        if group:
            run.set(f"CMAKE_MATCH_{index}", group)
            highest = str(index)
    run.set("CMAKE_MATCH_COUNT", highest)


def forget(run: Run) -> None:
    """Make the CMAKE_MATCH variables unknown."""
    for index in range(10):
        run.set(f"CMAKE_MATCH_{index}", HOLE)
    run.set("CMAKE_MATCH_COUNT", HOLE)


def find(run: Run, regex: str, text: str) -> bool | None:
    """Return whether an expression matches anywhere in a text, and set the CMAKE_MATCH variables.

    None if the expression cannot be evaluated.
    """
    pattern = translated(regex)
    if pattern is None:
        forget(run)
        return None
    clear(run)
    match = pattern.search(octets(text))
    if match is None:
        return False
    store(run, _groups(match))
    return True


def _groups(match: re.Match[str]) -> tuple[str, ...]:
    return tuple(_text(group or "") for group in (match[0], *match.groups()))


def all_matches(regex: str, text: str) -> list[tuple[str, str, tuple[str, ...]]]:
    """Return all matches from left to right, each as the text before it, the match and its groups.

    The last entry is the text after the last match, without groups. Raises RegexError for empty matches, where CMake has an
    error, and for ``^`` with more than one match, where the versions of CMake differ (policy CMP0186).
    """
    pattern = translated(regex)
    if pattern is None:
        raise RegexError(regex)
    encoded = octets(text)
    anchored = "^" in regex.replace("[^", "")
    at = 0
    matches: list[tuple[str, str, tuple[str, ...]]] = []
    while match := pattern.search(encoded, at):
        if not match[0] or len(matches) > _MOST_MATCHES:
            raise RegexError(regex)
        matches.append((_text(encoded[at : match.start()]), _text(match[0]), _groups(match)))
        at = match.end()
        if anchored and pattern.search(encoded[at:]):
            raise RegexError(regex)
    matches.append((_text(encoded[at:]), "", ()))
    return matches


_EXAMPLE_FOLDERS: Final = ("/zq7x/wk", "/vj9/pq-5yz/hb_w")
"""Two example folders of a workspace.

A result that is the same for both does not depend on the folder."""


def independent_of_folder(compute: Callable[..., str], *values: str) -> str:
    """Return ``compute(*values)``, where values may contain the unknown folder of the workspace.

    HOLE if the result depends on this folder: it is computed for two example folders and compared. Raises the exceptions
    of ``compute``.
    """
    if not any("\1" in value for value in values):
        return compute(*values)
    if not all(map(is_fixed, values)):
        return HOLE
    results = []
    for number, stand_in in enumerate(_EXAMPLE_FOLDERS):
        pairs = [(root, f"{stand_in}{number}{name}") for root, name in ((TREE, "s"), (BINARY, "b"), (PREFIX, "p"))]
        placed = list(values)
        for root, place in pairs:
            placed = [value.replace(root, place) for value in placed]
        if any("\1" in value for value in placed):
            return HOLE
        result = compute(*placed)
        for root, place in pairs:
            result = result.replace(place, root)
        if any(part in result for part in stand_in.split("/") if part):
            return HOLE
        results.append(result)
    return results[0] if results[0] == results[1] else HOLE
