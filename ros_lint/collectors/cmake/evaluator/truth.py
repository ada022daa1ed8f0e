"""Truth values of CMake conditions: true, false, unknown, *likely* or *unlikely*.

A likely condition is true with default options, an unlikely condition is false with default options. In both cases an option
of the user can reverse the value.
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
"""Pattern of a number at the start of a text, as scanf() in C parses it, without infinities."""
TRUE_WORDS: Final = frozenset({"1", "ON", "YES", "TRUE", "Y"})
_FALSE_WORDS: Final = frozenset({"", "0", "OFF", "NO", "FALSE", "N", "IGNORE"})


class Truth(NamedTuple):
    """The truth value of a condition, and its relation to tests.

    ``test_if_true``: the condition can be true only if tests are enabled. ``test_if_false``: it can be false only if tests
    are enabled.
    """

    value: int
    test_if_true: bool = False
    test_if_false: bool = False


class ConditionToken(NamedTuple):
    """A word of a CMake condition, evaluated."""

    text: str
    quoted: bool
    configurable: bool
    """True if the user may change the value of the word, for example with an option."""


def negated(truth: Truth) -> Truth:
    """Return the truth value of ``NOT truth``."""
    return Truth(TRUE - truth.value, truth.test_if_false, truth.test_if_true)


def both(left: Truth, right: Truth) -> Truth:
    """Return the truth value of ``left AND right``."""
    # min() is Kleene's AND. It also gives the value with default options, because of the order UNLIKELY, UNKNOWN, LIKELY.
    return Truth(
        min(left.value, right.value), left.test_if_true or right.test_if_true, left.test_if_false and right.test_if_false
    )


def either(left: Truth, right: Truth) -> Truth:
    """Return the truth value of ``left OR right``."""
    return Truth(
        max(left.value, right.value), left.test_if_true and right.test_if_true, left.test_if_false or right.test_if_false
    )


def reversible(value: int) -> int:
    """Return the truth value of a condition that a user option can reverse: LIKELY for TRUE, UNLIKELY for FALSE.

    Any other ``value`` is returned unchanged.
    """
    return {TRUE: LIKELY, FALSE: UNLIKELY}.get(value, value)


def reversible_if_configurable(value: int, run: Run, *tokens: ConditionToken) -> Truth:
    """Return the truth value of a condition, given ``value``, its value with default options.

    ``*tokens`` are the words of the condition. If one is an option that the user can change, TRUE becomes LIKELY (true by
    default) and FALSE becomes UNLIKELY (false by default).
    """
    configurable = any(token.configurable or (not token.quoted and run.is_configurable(token.text)) for token in tokens)
    return Truth(reversible(value) if configurable else value)


def is_off(text: str) -> bool:
    """Return whether CMake treats a value as false: "", 0, OFF, NO, FALSE, N, IGNORE, NOTFOUND or X-NOTFOUND.

    NOTFOUND must be in upper case; the case of the other words does not matter.
    """
    return text.upper() in _FALSE_WORDS or text == "NOTFOUND" or text.endswith("-NOTFOUND")


@cached_short(1024)
def constant(text: str) -> bool | None:
    """Return whether a constant such as ``ON`` or ``NO``, or a number, is true in if(); None for any other word."""
    if text.upper() in TRUE_WORDS:
        return True
    if is_off(text):
        return False
    number = NUMBER.fullmatch(text)
    return number_of(text) != 0 if number else None


def number_of(text: str) -> float:
    """Return the value of a number: ``0x10`` -> 16.0. The text must be a number that the pattern ``NUMBER`` matches."""
    text = text.strip()
    if "x" not in text.lower():
        return float(text)
    try:
        return float.fromhex(text)
    except OverflowError:
        return -math.inf if text.startswith("-") else math.inf
