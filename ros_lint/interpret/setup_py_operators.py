"""Operators of Python on values that may be unknown, and never on more than a setup.py has use for."""

from __future__ import annotations

import ast
import operator
import re
from collections.abc import Callable
from typing import Any, Final

from ros_lint.interpret.setup_py_values import Unknown, Value, Word, certain, located, same, unknown_in

LONGEST: Final = 100_000
"""Elements or characters of a value that is made by multiplication."""

_BINARY: dict[type[ast.operator], Callable[[Any, Any], Any]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Div: operator.truediv,
    ast.FloorDiv: operator.floordiv,
    ast.BitOr: operator.or_,
    ast.BitAnd: operator.and_,
}
_COMPARE: dict[type[ast.cmpop], Callable[[Any, Any], Any]] = {
    ast.Eq: operator.eq,
    ast.NotEq: operator.ne,
    ast.Lt: operator.lt,
    ast.LtE: operator.le,
    ast.Gt: operator.gt,
    ast.GtE: operator.ge,
    ast.Is: operator.is_,
    ast.IsNot: operator.is_not,
}
_CONVERSIONS: dict[str, Callable[[Any], str]] = {"r": repr, "s": str, "a": ascii}
_WIDE = re.compile(r"\d{4,}|\*")


def binary(operation: ast.operator, left: Value, right: Value, node: ast.AST) -> Value:
    """Return what a binary operator gives. Raises what the operator raises, and ValueError for too large a value."""
    if isinstance(operation, ast.Add):
        if isinstance(left, list) and isinstance(right, (list, Unknown)):
            return [*left, *(right if isinstance(right, list) else [right])]
        if isinstance(left, Unknown) and isinstance(right, list):
            return [left, *right]
    unknown = unknown_in([left, right])
    if unknown:
        return unknown
    if isinstance(operation, ast.Mod) and isinstance(left, str):
        if _WIDE.search(left):
            raise ValueError
        return Word.at(left % right, node)
    if isinstance(operation, ast.Mult):
        if _size(left) * _size(right) > LONGEST:
            raise ValueError
        return located(left * right, node)
    return located(_BINARY[type(operation)](left, right), node)


def _size(value: Value) -> float:
    return abs(value) if isinstance(value, (int, float)) else len(value)


def compare(operation: ast.cmpop, left: Value, right: Value) -> Value:
    """Return whether a comparison holds, or Unknown. Raises what the comparison raises."""
    if isinstance(operation, (ast.In, ast.NotIn)):
        negated = isinstance(operation, ast.NotIn)
        if not certain(left) or isinstance(right, Unknown):
            return unknown_in([left, right])
        if isinstance(right, dict):
            right = list(right)
        if not isinstance(right, str) and any(same(left, item) for item in right):
            return not negated
        return unknown_in([right]) or (left in right) is not negated
    return unknown_in([left, right]) or bool(_COMPARE[type(operation)](left, right))


def formatted(value: Value, conversion: int, spec: str) -> str:
    """Return what a replacement field of an f-string gives. Raises ValueError for a field that is too wide."""
    if _WIDE.search(spec):
        raise ValueError
    if conversion >= 0:
        value = _CONVERSIONS[chr(conversion)](value)
    return format(value, spec)
