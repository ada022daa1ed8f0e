"""Matching of regular expressions in bounded time.

Python's re tries all ways to divide a text among repetitions, which may take polynomial or exponential time. An expression
that may take long is therefore matched by a program of instructions. Each instruction is tried at most once at each position
of the text. Python's re and the program find the same match.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Final, NamedTuple, Protocol

from ros_lint.base.budget import Budget, BudgetExceeded
from ros_lint.collectors.cmake.evaluator.values import SLOW

_QUICK: Final = 1 << 18
"""Maximum number of steps of Python's re for a match. If more may be needed, the program of instructions is used."""
_LARGEST: Final = 1 << 25
"""Maximum memory for one match, in bytes: one byte for each instruction and position of the text."""
_AT_ONCE: Final = 256
"""Number of steps that are charged to the budget at once."""


class Letter(NamedTuple):
    """An instruction that matches one of the characters ``letters``."""

    letters: frozenset[str]


class Split(NamedTuple):
    """An instruction that continues at the instruction ``first``, and if this does not match, at ``second``."""

    first: int
    second: int


class Jump(NamedTuple):
    """An instruction that continues at the instruction ``to``."""

    to: int


class Save(NamedTuple):
    """An instruction that records the position in the text as the beginning or the end of a group.

    Slots 0 and 1 are for the whole match, 2 and 3 for the first group, and so on.
    """

    slot: int


class Anchor(NamedTuple):
    """An instruction that matches only at the end of the text if ``end`` is true, else only at its beginning."""

    end: bool


Instruction = Letter | Split | Jump | Save | Anchor


class Match(Protocol):
    """The methods of a match that Python's re and the matcher of this module both provide."""

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
    """A compiled regular expression, for Python's re and for the matcher of this module."""

    pattern: re.Pattern[str]
    program: tuple[Instruction, ...]
    """The instructions of the expression. The expression has matched when the last instruction is done."""
    repeats: int
    """The number of unlimited repetitions (``*`` or ``+``) in the expression."""
    ambiguous: bool
    """True if Python's re may take exponential time: a repetition has alternatives, or the expression has many alternatives."""

    def search(self, text: str, budget: Budget, at: int = 0) -> Match | None:
        """Return the first match at or after the offset ``at``, None if there is none.

        Raises BudgetExceeded if the search takes too many steps.
        """
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
