"""Evaluation of constant Python expressions in launch files: ``$(eval ...)`` and PythonExpression."""

from __future__ import annotations

import ast
from collections.abc import Callable, Mapping
from functools import lru_cache
from typing import Any

from ros_lint.collectors.python.methods import LENGTH_PRESERVING
from ros_lint.collectors.python.operators import ARITHMETIC, COMPARISONS, is_wide
from ros_lint.collectors.python.source_errors import NotPythonError
from ros_lint.collectors.python.syntax import read_expression
from ros_lint.collectors.python.versions import BUILTINS, MATH
from ros_lint.collectors.symbolic_text import UNKNOWN

_MAX_LENGTH = 2_000
_MAX_SIZE = 10_000
"""The maximum size of a value, in characters and items. Nested items count, too."""


class _Unknown(Exception):  # noqa: N818
    """The value of an expression cannot be determined."""


@lru_cache(maxsize=1_024)
def evaluate(text: str) -> str:
    """Return the value of a constant expression as a text: ``1 + 1`` -> ``2``.

    The result is UNKNOWN if ``text`` is not a constant expression.
    """
    if len(text) > _MAX_LENGTH:
        return UNKNOWN
    try:
        value = _value(read_expression(text.strip()))
        return UNKNOWN if isinstance(value, _SETS) and len(value) > 1 else str(value)  # the order of a set is not defined
    except (_Unknown, NotPythonError, ValueError, TypeError, ArithmeticError, LookupError, RecursionError, MemoryError):
        return UNKNOWN


@lru_cache(maxsize=1_024)
def unresolved_names(text: str) -> tuple[str, ...] | None:
    """Return the names in an expression that launch cannot resolve, None if the text is not a Python expression."""
    try:
        tree = read_expression(text.lstrip())
    except NotPythonError:
        return None
    names = [node for node in ast.walk(tree) if isinstance(node, ast.Name)]
    bound = {node.id for node in names if not isinstance(node.ctx, ast.Load)}
    bound.update(node.arg for node in ast.walk(tree) if isinstance(node, ast.arg))
    return tuple(dict.fromkeys([node.id for node in names if node.id not in bound and node.id not in _RESOLVED_NAMES]))


_RESOLVED_NAMES = BUILTINS | MATH | {"math"}
"""The names that PythonExpression resolves: builtins, and all names in ``math``."""


def means_true(text: str) -> bool | None:
    """Return the truth value of the text of a condition: ``true`` and ``1`` -> True, ``false`` and ``0`` -> False.

    The result is None if launch rejects the text (``evaluate_condition_expression``).
    """
    word = text.strip().lower()
    if word in ("true", "1"):
        return True
    return False if word in ("false", "0") else None


_COMPARE: Mapping[type[ast.cmpop], Callable[[Any, Any], Any]] = {
    **COMPARISONS,
    ast.Is: lambda a, b: a is b or a == b,
    ast.IsNot: lambda a, b: not (a is b or a == b),
    ast.In: lambda a, b: a in b,
    ast.NotIn: lambda a, b: a not in b,
}
_SETS = (set, frozenset)
_SET_METHODS = frozenset({"difference", "intersection", "isdisjoint", "issubset", "issuperset", "symmetric_difference", "union"})
_METHODS = LENGTH_PRESERVING | {"strip", "lstrip", "rstrip", "replace", "split", "find", "count"}


def _value(node: ast.expr) -> Any:
    match node:
        case ast.Constant(value=value):
            return value
        case ast.Name(id=name) if name in ("true", "false"):
            return name == "true"
        case ast.UnaryOp(op=op, operand=operand):
            value = _value(operand)
            return not value if isinstance(op, ast.Not) else -value if isinstance(op, ast.USub) else _unknown()
        case ast.BoolOp(op=op, values=values):
            result: Any = None
            for part in values:
                result = _value(part)
                if bool(result) is isinstance(op, ast.Or):
                    return result
            return result
        case ast.BinOp(left=left, op=op, right=right) if type(op) in ARITHMETIC:
            return _arithmetic(op, _value(left), _value(right))
        case ast.Compare(left=left, ops=ops, comparators=comparators):
            previous = _value(left)
            for comparison, comparator in zip(ops, comparators, strict=True):
                current = _value(comparator)
                if not _COMPARE[type(comparison)](previous, current):
                    return False
                previous = current
            return True
        case ast.IfExp(test=test, body=body, orelse=orelse):
            return _value(body) if _value(test) else _value(orelse)
        case ast.List(elts=elts):
            return _small([_value(element) for element in elts])
        case ast.Set(elts=elts):
            return _small({_value(element) for element in elts})
        case ast.Tuple(elts=elts):
            return _small(tuple([_value(element) for element in elts]))
        case ast.Dict(keys=keys, values=values):
            return _small({_value(key): _value(value) for key, value in zip(keys, values, strict=True) if key is not None})
        case ast.Subscript(value=owner, slice=ast.Slice(lower=lower, upper=upper, step=step)):
            return _value(owner)[slice(*[None if part is None else _value(part) for part in (lower, upper, step)])]
        case ast.Subscript(value=owner, slice=key):
            return _value(owner)[_value(key)]
        case ast.Call():
            return _call(node)
    return _unknown()


def _call(node: ast.Call) -> Any:
    arguments = [_value(argument) for argument in node.args]
    if node.keywords:
        return _unknown()
    if isinstance(node.func, ast.Attribute) and node.func.attr in _METHODS | _SET_METHODS:
        owner = _value(node.func.value)
        if isinstance(owner, _SETS) and node.func.attr in _SET_METHODS:
            return _small(getattr(owner, node.func.attr)(*arguments))
        if not isinstance(owner, str) or node.func.attr not in _METHODS:
            return _unknown()
        if node.func.attr == "replace" and len(owner) * sum(map(len, arguments[1:2])) > _MAX_SIZE:
            return _unknown()
        return _small(getattr(owner, node.func.attr)(*arguments))
    name = node.func.id if isinstance(node.func, ast.Name) else ""
    if name in _FUNCTIONS:
        return _FUNCTIONS[name](*arguments)
    return _unknown()


def _truth(text: Any) -> bool:
    truth = means_true(str(text))
    return _unknown() if truth is None else truth


def _equals(left: Any, right: Any) -> bool:
    """Return whether EqualsSubstitution considers two values equal. For example, "true" equals "1"."""
    left_truth, right_truth = means_true(str(left)), means_true(str(right))
    return left_truth == right_truth if left_truth is not None and right_truth is not None else str(left) == str(right)


_FUNCTIONS: Mapping[str, Callable[..., Any]] = {
    "str": str,
    "int": int,
    "float": float,
    "bool": bool,
    "len": len,
    "abs": abs,
    "all": all,
    "any": any,
    "list": list,
    "max": max,
    "min": min,
    "round": round,
    "set": set,
    "sorted": sorted,
    "sum": sum,
    "tuple": tuple,
    "_equals": _equals,
    "_not_equals": lambda left, right: not _equals(left, right),
    "_if": lambda condition, if_value, else_value: if_value if _truth(condition) else else_value,
    "_not": lambda value: not _truth(value),
    "_and": lambda *values: all(_truth(value) for value in values),
    "_or": lambda *values: any(_truth(value) for value in values),
}


def _arithmetic(op: ast.operator, left: Any, right: Any) -> Any:
    if isinstance(op, ast.Mult):
        for sequence, times in ((left, right), (right, left)):
            if isinstance(sequence, (str, list, tuple)) and isinstance(times, int) and _size(sequence) * times > _MAX_SIZE:
                raise _Unknown
    if isinstance(op, ast.Mod) and isinstance(left, str) and is_wide(left):
        raise _Unknown
    return _small(ARITHMETIC[type(op)](left, right))


def _small(value: Any) -> Any:
    """Return ``value`` unchanged. Raises _Unknown if the value is too large."""
    if isinstance(value, int) and abs(value) > 1 << 64:
        raise _Unknown
    if isinstance(value, (str, list, tuple, dict, *_SETS)) and _size(value) > _MAX_SIZE:
        raise _Unknown
    return value


def _size(value: Any) -> int:
    """Return the number of characters and items in a value and its nested values.

    Counting stops above the limit ``_MAX_SIZE``.
    """
    size = 0
    pending = [value]
    while pending and size <= _MAX_SIZE:
        item = pending.pop()
        size += len(item) if isinstance(item, (str, list, tuple, dict, *_SETS)) else 1
        if isinstance(item, dict):
            pending += [*item.keys(), *item.values()]
        elif isinstance(item, (list, tuple, *_SETS)):
            pending += item
    return size


def _unknown() -> Any:
    raise _Unknown
