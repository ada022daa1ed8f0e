"""CMake's regular expressions (KWSys RegularExpression.cxx), translated to those of Python.

CMake's expressions have fewer constructs than Python's, and match bytes.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from functools import lru_cache
from typing import TYPE_CHECKING, Final, NamedTuple

from ros_lint.base.budget import Budget
from ros_lint.base.text import from_bytes, octets
from ros_lint.collectors.cmake.evaluator.regex_matching import Anchor, Expression, Instruction, Jump, Letter, Match, Save, Split
from ros_lint.collectors.cmake.evaluator.values import BINARY, HOLE, PREFIX, TREE, is_fixed, is_known, natural

if TYPE_CHECKING:
    from ros_lint.collectors.cmake.evaluator.run import Run


class RegexError(Exception):
    """A regular expression cannot be evaluated.

    The reason is one of: CMake rejects the expression, its meaning depends on the version of CMake, or matching could take
    exponential time.
    """


@lru_cache(maxsize=512)
def _compiled(text: str) -> Expression:
    translator = _Translator(octets(text))
    pattern, program = translator.whole()
    ambiguous = translator.ambiguous or translator.choices > _MOST_CHOICES
    return Expression(re.compile(pattern, re.DOTALL), tuple(program), translator.repeats, ambiguous)


class Searcher(NamedTuple):
    """A compiled regular expression, and the budget that its searches charge for their steps."""

    expression: Expression
    budget: Budget

    def search(self, text: str, at: int = 0) -> Match | None:
        """Return the first match at or after the offset ``at``, None if there is none.

        ``text`` has one character for each byte (see :func:`~ros_lint.base.text.octets`). Raises BudgetExceeded if the search
        takes too many steps.
        """
        return self.expression.search(text, self.budget, at)


def translated(text: str, budget: Budget) -> Searcher | None:
    """Return the compiled form of a regular expression of CMake, given as ``text``.

    The result is None if the expression cannot be evaluated (see :class:`RegexError`) or is too long.
    """
    try:
        return Searcher(_compiled(text), budget) if len(text) <= _LONGEST else None
    except RegexError:
        return None


_MOST_CHOICES: Final = 12
"""Maximum number of alternatives and optional parts of an expression for Python's re, because each may double its time."""
_LONGEST: Final = 4096
"""Maximum length of an expression in characters, because a longer one takes long to compile."""


def is_in(searcher: Searcher, text: str) -> bool:
    """Return whether a compiled regular expression matches anywhere in a text."""
    return searcher.search(octets(text)) is not None


def _text(text: str) -> str:
    return text if text.isascii() else from_bytes(text.encode("latin-1"))


_MOST_MATCHES: Final = 10_000
"""Maximum number of matches of one expression in a text. If there are more, the result is unknown."""


class _Piece(NamedTuple):
    """A translated part of a regular expression."""

    pattern: str
    """The part as a Python regular expression."""
    program: list[Instruction]
    """The part as instructions for the matcher. Their jump targets are relative to the first instruction."""
    empty: bool
    """True if the part can match the empty text."""


class _Translator:
    def __init__(self, text: str) -> None:
        self.text = text
        self.at = 0
        self.groups = 0
        self.repeats = 0
        """Number of parts so far with an unlimited repetition (``*`` or ``+``)."""
        self.choices = 0
        """Number of alternatives and optional parts so far."""
        self.ambiguous = False
        """True if some repeated part has alternatives or optional parts."""

    def whole(self) -> tuple[str, list[Instruction]]:
        piece = self.branches()
        if self.at != len(self.text):
            raise RegexError(self.text)
        return piece.pattern, piece.program

    def branches(self) -> _Piece:
        """Return the translated alternatives ``a|b`` up to a closing parenthesis or the end of the expression."""
        branch = self.branch()
        alternatives = [branch]
        while self.text[self.at : self.at + 1] == "|":
            self.at += 1
            self.choices += 1
            alternatives.append(self.branch())
        program = alternatives[-1].program
        for alternative in reversed(alternatives[:-1]):
            first = alternative.program
            jump = Jump(len(first) + 2 + len(program))
            program = [Split(1, len(first) + 2), *_moved(first, 1), jump, *_moved(program, len(first) + 2)]
        pattern = "|".join(alternative.pattern for alternative in alternatives)
        return _Piece(pattern, program, any(alternative.empty for alternative in alternatives))

    def branch(self) -> _Piece:
        pieces: list[str] = []
        program: list[Instruction] = []
        empty = True
        while self.at < len(self.text) and self.text[self.at] not in "|)":
            piece = self.piece()
            pieces.append(piece.pattern)
            program += _moved(piece.program, len(program))
            empty = empty and piece.empty
        return _Piece("".join(pieces), program, empty)

    def piece(self) -> _Piece:
        repeats_before, choices_before = self.repeats, self.choices
        pattern, program, empty = atom = self.atom()
        sign = self.text[self.at : self.at + 1]
        if sign not in ("*", "+", "?"):
            return atom
        if empty and sign != "?":
            raise RegexError(self.text)
        self.at += 1
        if self.text[self.at : self.at + 1] in ("*", "+", "?"):
            raise RegexError(self.text)
        size = len(program)
        if sign == "?":
            self.choices += 1
            return _Piece(f"{pattern}?", [Split(1, size + 1), *_moved(program, 1)], empty=True)
        if self.repeats > repeats_before:
            raise RegexError(self.text)  # (a+)+ takes exponential time
        self.repeats += 1
        self.ambiguous = self.ambiguous or self.choices > choices_before
        if sign == "+":
            return _Piece(f"{pattern}+", [*program, Split(0, size + 1)], empty=False)
        return _Piece(f"{pattern}*", [Split(1, size + 2), *_moved(program, 1), Jump(0)], empty=True)

    def atom(self) -> _Piece:
        letter = self.text[self.at]
        self.at += 1
        if letter == "^":
            return _Piece(r"(?:\A)", [Anchor(end=False)], empty=True)
        if letter == "$":
            return _Piece(r"(?:\Z)", [Anchor(end=True)], empty=True)
        if letter == ".":
            return _Piece(".", [Letter(_OCTETS)], empty=False)
        if letter == "[":
            letters = self.letters()
            return _Piece(letters, [Letter(frozenset(re.findall(letters, "".join(sorted(_OCTETS)))))], empty=False)
        if letter == "(":
            self.groups += 1
            slot = 2 * self.groups
            group = self.branches()
            if self.text[self.at : self.at + 1] != ")":
                raise RegexError(self.text)
            self.at += 1
            program: list[Instruction] = [Save(slot), *_moved(group.program, 1), Save(slot + 1)]
            return _Piece(f"({group.pattern})", program, group.empty)
        if letter in "*+?" or (letter == "\\" and self.at == len(self.text)):
            raise RegexError(self.text)
        if letter == "\\":
            letter = self.text[self.at]
            self.at += 1
        return _Piece(re.escape(letter), [Letter(frozenset(letter))], empty=False)

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


_OCTETS: Final = frozenset(map(chr, range(256)))


def _moved(program: Iterable[Instruction], by: int) -> list[Instruction]:
    """Return instructions with their jump targets increased by ``by``.

    This is needed if ``by`` other instructions are inserted before them.
    """
    moved: list[Instruction] = []
    for instruction in program:
        if isinstance(instruction, Split):
            moved.append(Split(instruction.first + by, instruction.second + by))
        else:
            moved.append(Jump(instruction.to + by) if isinstance(instruction, Jump) else instruction)
    return moved


# --- use -----------------------------------------------------------------------------------------------------------


def clear(run: Run) -> None:
    """Empty the variables CMAKE_MATCH_0 and so on, as CMake does before it applies a regular expression."""
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
    """Set CMAKE_MATCH_0 and so on to ``groups``, the groups of a match. The first group is the whole match."""
    highest = ""
    for index, group in enumerate(groups[:10]):
        if group:
            run.set(f"CMAKE_MATCH_{index}", group)
            highest = str(index)
    run.set("CMAKE_MATCH_COUNT", highest)


def forget(run: Run) -> None:
    """Set the variables CMAKE_MATCH_0 and so on to unknown values."""
    for index in range(10):
        run.set(f"CMAKE_MATCH_{index}", HOLE)
    run.set("CMAKE_MATCH_COUNT", HOLE)


def find(run: Run, regex: str, text: str) -> bool | None:
    """Return whether a regular expression matches anywhere in a text, and set CMAKE_MATCH_0 and so on.

    The result is None if the expression cannot be evaluated.
    """
    pattern = translated(regex, run.budget)
    if pattern is None:
        forget(run)
        return None
    clear(run)
    match = pattern.search(octets(text))
    if match is None:
        return False
    store(run, _groups(match))
    return True


def _groups(match: Match) -> tuple[str, ...]:
    return tuple(_text(group or "") for group in (match[0], *match.groups()))


def all_matches(regex: str, text: str, budget: Budget) -> list[tuple[str, str, tuple[str, ...]]]:
    """Return all matches from left to right, each as the text before the match, the match and its groups.

    The last entry is the text after the last match, without groups. Raises RegexError for an empty match, where CMake has an
    error, and for ``^`` with more than one match, where the result depends on the CMake version (policy CMP0186).
    """
    pattern = translated(regex, budget)
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
"""Two examples of a workspace folder.

A result that is equal for both examples does not depend on the folder."""


def independent_of_folder(compute: Callable[..., str], *values: str) -> str:
    """Return ``compute(*values)``, where ``values`` may contain the unknown folder of the workspace.

    The result is HOLE (unknown) if it depends on this folder: it is computed for two example folders and compared. Raises the
    exceptions of ``compute``.
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
