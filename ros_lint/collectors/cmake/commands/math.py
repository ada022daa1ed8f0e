"""math(EXPR): expressions of 64-bit integers with the operators of C (cmake-commands(7))."""

from __future__ import annotations

import re
from typing import Final

from ros_lint.collectors.cmake.evaluator.run import Handler, Run
from ros_lint.collectors.cmake.evaluator.values import ELEMENT, HOLE, is_known

_TOKEN = re.compile(r"\s*(?:(0[xX][0-9a-fA-F]+|[0-9]+)|(<<|>>|[-+*/%|&^~()]))")
_BINARY: Final = {"|": 1, "^": 2, "&": 3, "<<": 4, ">>": 4, "+": 5, "-": 5, "*": 6, "/": 6, "%": 6}
_MOST_DIGITS: Final = 19
"""Maximum number of digits of a signed 64-bit number."""
_LOWEST, _HIGHEST = -(1 << 63), (1 << 63) - 1


class _MathError(Exception):
    """CMake rejects an expression of math(EXPR), or C does not define the value of the expression."""


def _math(run: Run, args: list[str]) -> None:
    if len(args) < 3 or args[0] != "EXPR" or HOLE in args[1]:
        return
    text = args[2]
    run.budget.charge(4 * ELEMENT * len(text))
    value = HOLE
    if is_known(text):
        try:
            number = evaluate(text)
        except _MathError:
            pass
        else:
            value = hex(number) if args[3:] == ["OUTPUT_FORMAT", "HEXADECIMAL"] and number >= 0 else str(number)
            if args[3:] == ["OUTPUT_FORMAT", "HEXADECIMAL"] and number < 0:
                value = hex(number & ((1 << 64) - 1))
    run.set(args[1], value)


def evaluate(text: str) -> int:
    """Return the value of an expression of math(EXPR), such as ``2 * (3 + 0x10)``.

    Raises _MathError if CMake rejects the expression or C does not define its value.
    """
    tokens: list[str] = []
    at = 0
    text = text.rstrip()
    while at < len(text):
        match = _TOKEN.match(text, at)
        if match is None:
            raise _MathError(text)
        tokens.append(match[1] or match[2])
        at = match.end()
    value, end = _expression(tokens, 0, 1)
    if end != len(tokens):
        raise _MathError(text)
    return value


def _expression(tokens: list[str], at: int, least: int) -> tuple[int, int]:
    value, at = _unary(tokens, at)
    while at < len(tokens) and _BINARY.get(tokens[at], 0) >= least:
        sign = tokens[at]
        operand, at = _expression(tokens, at + 1, _BINARY[sign] + 1)
        value = _bounded(_operate(sign, value, operand))
    return value, at


def _unary(tokens: list[str], at: int) -> tuple[int, int]:
    if at >= len(tokens):
        raise _MathError
    sign = tokens[at]
    if sign in ("+", "-", "~"):
        value, at = _unary(tokens, at + 1)
        return _bounded({"+": value, "-": -value, "~": ~value}[sign]), at
    if sign == "(":
        value, at = _expression(tokens, at + 1, 1)
        if at >= len(tokens) or tokens[at] != ")":
            raise _MathError
        return value, at + 1
    base = 16 if sign[1:2] in ("x", "X") else 10
    digits = sign[2 * (base == 16) :].lstrip("0") or "0"
    if not sign[0].isdigit() or len(digits) > _MOST_DIGITS:
        raise _MathError
    return _bounded(int(digits, base)), at + 1


def _operate(sign: str, left: int, right: int) -> int:
    if sign in ("/", "%"):
        if not right:
            raise _MathError
        quotient = abs(left) // abs(right) * (1 if (left < 0) == (right < 0) else -1)
        return quotient if sign == "/" else left - quotient * right
    if sign in ("<<", ">>"):
        if not 0 <= right < 63 or left < 0:
            raise _MathError
        return left << right if sign == "<<" else left >> right
    results = {"|": left | right, "^": left ^ right, "&": left & right, "+": left + right, "-": left - right}
    return left * right if sign == "*" else results[sign]


def _bounded(value: int) -> int:
    if not _LOWEST <= value <= _HIGHEST:
        raise _MathError
    return value


COMMANDS: Final[dict[str, Handler]] = {"math": _math}
