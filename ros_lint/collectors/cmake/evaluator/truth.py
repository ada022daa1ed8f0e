"""Answers to conditions: true, false, unknown, *likely* or *unlikely*.

The user can reverse the last two by an option.
"""

from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING, Final, NamedTuple

from ros_lint.collectors.cmake.evaluator.values import cached_short

if TYPE_CHECKING:
    from ros_lint.collectors.cmake.evaluator.run import Run

FALSE: Final = 0
UNLIKELY: Final = 1
UNKNOWN: Final = 2
LIKELY: Final = 3
TRUE: Final = 4


NUMBER = re.compile(
    r"\s*[-+]?(?:0[xX](?:[0-9a-fA-F]+(?:\.[0-9a-fA-F]*)?|\.[0-9a-fA-F]+)(?:[pP][-+]?\d+)?"
    r"|(?!0[xX])(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][-+]?\d+)?)",
    re.ASCII,
)
"""The part of a text that scanf() in C parses as a number, without infinities."""
TRUE_WORDS: Final = frozenset({"1", "ON", "YES", "TRUE", "Y"})
_FALSE_WORDS: Final = frozenset({"", "0", "OFF", "NO", "FALSE", "N", "IGNORE"})


class Truth(NamedTuple):
    """An answer, and whether tests must be enabled for it to be true, or for it to be false."""

    value: int
    test_if_true: bool = False
    test_if_false: bool = False


class ConditionToken(NamedTuple):
    """An evaluated word of a condition."""

    text: str
    quoted: bool
    configurable: bool
    """True if a user may change its value."""


def negated(truth: Truth) -> Truth:
    """Return the answer to NOT of an answer."""
    return Truth(TRUE - truth.value, truth.test_if_false, truth.test_if_true)


def both(left: Truth, right: Truth) -> Truth:
    """Return the answer to AND of two answers."""
    # min() is Kleene's AND. With LIKELY and UNLIKELY ordered between the others, it also gives the default answer.
    return Truth(
        min(left.value, right.value), left.test_if_true or right.test_if_true, left.test_if_false and right.test_if_false
    )


def either(left: Truth, right: Truth) -> Truth:
    """Return the answer to OR of two answers."""
    return Truth(
        max(left.value, right.value), left.test_if_true and right.test_if_true, left.test_if_false or right.test_if_false
    )


def reversible(value: int) -> int:
    """Return an answer that the user can reverse: LIKELY for TRUE, UNLIKELY for FALSE."""
    return {TRUE: LIKELY, FALSE: UNLIKELY}.get(value, value)


def reversible_if_configurable(value: int, run: Run, *tokens: ConditionToken) -> Truth:
    """Return an answer, reversible if a token depends on a value that a user may change."""
    configurable = any(token.configurable or (not token.quoted and run.is_configurable(token.text)) for token in tokens)
    return Truth(reversible(value) if configurable else value)


def is_off(text: str) -> bool:
    """Return whether CMake treats a value as false."""
    return text.upper() in _FALSE_WORDS or text == "NOTFOUND" or text.endswith("-NOTFOUND")


@cached_short(1024)
def constant(text: str) -> bool | None:
    """Return the truth of a word that is a constant or a number, None for any other word."""
    if text.upper() in TRUE_WORDS:
        return True
    if is_off(text):
        return False
    number = NUMBER.fullmatch(text)
    return number_of(text) != 0 if number else None


def number_of(text: str) -> float:
    """Return the number in a text that matches NUMBER."""
    text = text.strip()
    if "x" not in text.lower():
        return float(text)
    try:
        return float.fromhex(text)
    except OverflowError:
        return -math.inf if text.startswith("-") else math.inf
