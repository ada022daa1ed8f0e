"""Answers to conditions: true, false, unknown, or *likely* and *unlikely*, which an option or the user can turn round."""

from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING, Final, NamedTuple

from ros_lint.collectors.cmake.evaluator.values import kept

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
"""As much of a text as C's scanf() takes for a number, infinities left out."""
TRUE_WORDS: Final = frozenset({"1", "ON", "YES", "TRUE", "Y"})
_FALSE_WORDS: Final = frozenset({"", "0", "OFF", "NO", "FALSE", "N", "IGNORE"})


class Truth(NamedTuple):
    """An answer, and whether the tests must be enabled for it to be true, or to be false."""

    value: int
    test_if_true: bool = False
    test_if_false: bool = False


class Token(NamedTuple):
    """A word of a condition, evaluated."""

    text: str
    quoted: bool
    soft: bool
    """Whether its value is one that a user may change."""


def negated(truth: Truth) -> Truth:
    """Return the answer to NOT."""
    return Truth(TRUE - truth.value, truth.test_if_false, truth.test_if_true)


def both(left: Truth, right: Truth) -> Truth:
    """Return the answer to AND."""
    # min() is Kleene's AND, and with the two half-sure answers between the others it keeps what is true by default.
    return Truth(
        min(left.value, right.value), left.test_if_true or right.test_if_true, left.test_if_false and right.test_if_false
    )


def either(left: Truth, right: Truth) -> Truth:
    """Return the answer to OR."""
    return Truth(
        max(left.value, right.value), left.test_if_true and right.test_if_true, left.test_if_false or right.test_if_false
    )


def softened(value: int) -> int:
    """Return an answer that holds unless the user wants it otherwise."""
    return {TRUE: LIKELY, FALSE: UNLIKELY}.get(value, value)


def softened_by(value: int, run: Run, *tokens: Token) -> Truth:
    """Return an answer, less sure if it rests on something that a user may change."""
    soft = any(token.soft or (not token.quoted and run.is_soft(token.text)) for token in tokens)
    return Truth(softened(value) if soft else value)


def is_off(text: str) -> bool:
    """Return whether a value counts as false."""
    return text.upper() in _FALSE_WORDS or text == "NOTFOUND" or text.endswith("-NOTFOUND")


@kept(1024)
def constant(text: str) -> bool | None:
    """Return what a word means as a condition, or None when it is neither a true nor a false constant nor a number."""
    if text.upper() in TRUE_WORDS:
        return True
    if is_off(text):
        return False
    number = NUMBER.fullmatch(text)
    return number_of(text) != 0 if number else None


def number_of(text: str) -> float:
    """Return the value of a text that NUMBER matches."""
    text = text.strip()
    if "x" not in text.lower():
        return float(text)
    try:
        return float.fromhex(text)
    except OverflowError:
        return -math.inf if text.startswith("-") else math.inf
