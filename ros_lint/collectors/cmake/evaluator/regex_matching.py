"""Matching of regular expressions in bounded time.

Python's re tries all ways in which repetitions can divide a text, which may take polynomial or exponential time. An
expression that may take long is matched by trying each of its instructions at each position of the text at most once.
Both ways find the same match.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Final, NamedTuple, Protocol

from ros_lint.base.budget import Budget, BudgetExceeded
from ros_lint.collectors.cmake.evaluator.values import SLOW

_QUICK: Final = 1 << 18
"""Steps that Python's re may need for a match."""
_LARGEST: Final = 1 << 25
"""Bytes of the marks of one match."""
_AT_ONCE: Final = 256
"""Steps that are charged together."""


class Letter(NamedTuple):
    """Matches one of the letters."""

    letters: frozenset[str]


class Split(NamedTuple):
    """Continues at ``first``, and if that does not match, at ``second``."""

    first: int
    second: int


class Jump(NamedTuple):
    """Continues at another instruction."""

    to: int


class Save(NamedTuple):
    """Records the position as the beginning or the end of a group: 0 and 1 for the whole match, 2 and 3 for the first group."""

    slot: int


class Anchor(NamedTuple):
    """Matches at the end of the text, or at its beginning."""

    end: bool


Instruction = Letter | Split | Jump | Save | Anchor


class Match(Protocol):
    """What the matches of Python's re and those of this module have in common."""

    def __getitem__(self, group: int, /) -> str: ...
    def groups(self) -> Sequence[str | None]: ...
    def start(self) -> int: ...
    def end(self) -> int: ...


class _Found:
    def __init__(self, text: str, slots: Sequence[int]) -> None:
        self._text = text
        self._slots = slots

    def __getitem__(self, group: int, /) -> str:
        start, end = self._slots[2 * group : 2 * group + 2]
        return self._text[start:end] if end >= 0 else ""

    def groups(self) -> Sequence[str | None]:
        return [self[group] for group in range(1, len(self._slots) // 2)]

    def start(self) -> int:
        return self._slots[0]

    def end(self) -> int:
        return self._slots[1]


class Expression(NamedTuple):
    """A compiled expression."""

    pattern: re.Pattern[str]
    program: tuple[Instruction, ...]
    """The instructions of the same expression. The expression matches where they end."""
    repeats: int
    """The number of unlimited repetitions."""
    ambiguous: bool
    """True if Python's re may take exponential time, because a repetition has alternatives or because there are many of them."""

    def search(self, text: str, budget: Budget, at: int = 0) -> Match | None:
        """Return the first match in a text from position ``at`` on, None if there is none. Raises BudgetExceeded."""
        length = len(text) - at + 1
        steps: int = length if not self.repeats else length ** (self.repeats + 1)
        if steps <= _QUICK and not self.ambiguous:
            budget.charge(steps // 4)
            return self.pattern.search(text, at)
        return _search(self.program, self.pattern.groups, text, budget, at)


def _search(program: Sequence[Instruction], groups: int, text: str, budget: Budget, at: int) -> Match | None:
    size, width = len(program), len(text) - at + 1
    if size * width > _LARGEST:
        raise BudgetExceeded
    budget.charge(size * width // 8)
    tried = bytearray(size * width)
    steps = 0
    for begin in range(at, len(text) + 1):
        stack: list[tuple[int, int, tuple[int, ...]]] = [(0, begin, (begin, -1) + (-1, -1) * groups)]
        while stack:
            index, place, slots = stack.pop()
            while True:
                if index == size:
                    return _Found(text, (slots[0], place, *slots[2:]))
                mark = index * width + place - at
                if tried[mark]:
                    break
                tried[mark] = 1
                steps += 1
                if steps % _AT_ONCE == 0:
                    budget.charge(_AT_ONCE * SLOW)
                instruction = program[index]
                index += 1
                if type(instruction) is Letter:
                    if place == len(text) or text[place] not in instruction.letters:
                        break
                    place += 1
                elif type(instruction) is Split:
                    stack.append((instruction.second, place, slots))
                    index = instruction.first
                elif type(instruction) is Jump:
                    index = instruction.to
                elif type(instruction) is Save:
                    slots = (*slots[: instruction.slot], place, *slots[instruction.slot + 1 :])
                elif type(instruction) is Anchor and place != (len(text) if instruction.end else 0):
                    break
    return None
