"""Operators of Python on values that may be unknown, with a limit on the size of results."""

from __future__ import annotations

import ast
import operator
import re
from collections.abc import Callable, Iterable
from typing import Any, Final

from ros_lint.collectors.python.operators import COMPARISONS
from ros_lint.collectors.setup_py.interpreter.state import at
from ros_lint.collectors.setup_py.interpreter.values import (
    REST,
    Unknown,
    Value,
    Word,
    certain,
    is_path,
    located,
    path_of,
    same,
    unknown_in,
)

LONGEST: Final = 100_000
"""Greatest number of elements or characters of a computed value."""


class TooLargeError(ValueError):
    """A computed value would exceed LONGEST."""


_BINARY: dict[type[ast.operator], Callable[[Any, Any], Any]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Div: operator.truediv,
    ast.FloorDiv: operator.floordiv,
    ast.BitOr: operator.or_,
    ast.BitAnd: operator.and_,
    ast.Mod: operator.mod,
}
_COMPARE: dict[type[ast.cmpop], Callable[[Any, Any], Any]] = {
    **COMPARISONS,
    ast.Is: operator.is_,
    ast.IsNot: operator.is_not,
}
UNARY: Final[dict[type[ast.unaryop], Callable[[Any], Any]]] = {
    ast.UAdd: operator.pos,
    ast.USub: operator.neg,
    ast.Invert: operator.invert,
}
_CONVERSIONS: dict[str, Callable[[Any], str]] = {"r": repr, "s": str, "a": ascii}
_WIDE = re.compile(r"\d{4,}|\*")


def binary(operation: ast.operator, left: Value, right: Value, node: ast.AST) -> Value:
    """Return the result of a binary operator. Raises TooLargeError and the exceptions of the operator."""
    if isinstance(operation, ast.Add):
        if hasattr(left, "__len__") and hasattr(right, "__len__") and len(left) + len(right) > LONGEST:
            raise TooLargeError
        if isinstance(left, list) and isinstance(right, (list, Unknown)):
            return [*left, *(right if isinstance(right, list) else [right])]
        if isinstance(left, Unknown) and isinstance(right, list):
            return [left, *right]
    unknown = unknown_in([left, right])
    if unknown:
        return unknown
    if isinstance(operation, ast.Mod) and isinstance(left, str):
        check_format(left)
        check_size(left, right if type(right) is tuple else (right,))
        return Word.at(left % right, node)
    if isinstance(operation, ast.Mult):
        if _size(left) * _size(right) > LONGEST:
            raise TooLargeError
        return located(left * right, node)
    if isinstance(operation, ast.Div) and (is_path(left) or is_path(right)):
        return path_of(left, right)
    function = _BINARY.get(type(operation))
    if function is None:
        return Unknown(f"the operator of {at(node)} is not followed", node)
    return located(function(left, right), node)


def check_size(template: str, values: Iterable[Value]) -> None:
    """Raise TooLargeError if a template filled with values may become too long."""
    longest = max((len(value) if isinstance(value, str) else 100 for value in values), default=0)
    if len(template) * longest > 100 * LONGEST:
        raise TooLargeError


def check_format(template: str) -> None:
    """Raise TooLargeError if a field of a format is too wide, or if a value determines its width."""
    if _WIDE.search(template):
        raise TooLargeError


def _size(value: Value) -> float:
    return abs(value) if isinstance(value, (int, float)) else len(value)


def compare(operation: ast.cmpop, left: Value, right: Value) -> Value:
    """Return whether a comparison holds, or Unknown. Raises the exceptions of the comparison."""
    if isinstance(operation, (ast.In, ast.NotIn)):
        negated = isinstance(operation, ast.NotIn)
        if not certain(left) or isinstance(right, Unknown):
            return unknown_in([left, right])
        if isinstance(right, dict):
            if REST in right and left not in right:
                return right[REST]
            right = list(right)
        if not isinstance(right, str) and any(same(left, item) for item in right):
            return not negated
        return unknown_in([right]) or (left in right) is not negated
    return unknown_in([left, right]) or bool(_COMPARE[type(operation)](left, right))


def formatted(value: Value, conversion: int, spec: str) -> str:
    """Return the text of a replacement field of an f-string.

    Raises TooLargeError for a field that is too wide.
    """
    check_format(spec)
    if conversion >= 0:
        value = _CONVERSIONS[chr(conversion)](value)
    return format(value, spec)
