"""Evaluation of constant Python expressions in launch files: ``$(eval ...)`` and PythonExpression."""

from __future__ import annotations

import ast
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import lru_cache
from typing import Any, NamedTuple

from ros_lint.base.budget import Budget, BudgetExceeded
from ros_lint.collectors.python.methods import LENGTH_PRESERVING
from ros_lint.collectors.python.operators import ARITHMETIC, COMPARISONS, is_wide
from ros_lint.collectors.python.source_errors import NotPythonError
from ros_lint.collectors.python.syntax import read_expression
from ros_lint.collectors.python.versions import BUILTINS, MATH
from ros_lint.collectors.symbolic_text import UNKNOWN

_MAX_LENGTH = 2_000
_MAX_SIZE = 10_000
"""The maximum size of a value, in characters and items. Nested items count, too."""
_MAX_STEPS = 20_000
"""The maximum number of values that are computed for an expression."""


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
        tree = read_expression(text.strip())
        value = _value(tree, _Scope({}, Budget(_MAX_STEPS)))
        if isinstance(tree, ast.GeneratorExp):
            return UNKNOWN  # the text of a generator has its address
        return UNKNOWN if isinstance(value, _SETS) and len(value) > 1 else str(value)  # the order of a set is not defined
    except (
        _Unknown,
        BudgetExceeded,
        NotPythonError,
        ValueError,
        TypeError,
        ArithmeticError,
        LookupError,
        RecursionError,
        MemoryError,
    ):
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
_DICTIONARY_METHODS = frozenset({"get", "items", "keys", "values"})
_METHODS = LENGTH_PRESERVING | {"strip", "lstrip", "rstrip", "replace", "split", "find", "count"}


class _Scope(NamedTuple):
    """The names that comprehensions define, and the budget of the evaluation."""

    names: Mapping[str, Any]
    budget: Budget


def _value(node: ast.expr, scope: _Scope) -> Any:
    scope.budget.step()
    match node:
        case ast.Constant(value=value):
            return value
        case ast.Name(id=name) if name in scope.names:
            return scope.names[name]
        case ast.Name(id=name) if name in ("true", "false"):
            return name == "true"
        case ast.UnaryOp(op=op, operand=operand):
            value = _value(operand, scope)
            return not value if isinstance(op, ast.Not) else -value if isinstance(op, ast.USub) else _unknown()
        case ast.BoolOp(op=op, values=values):
            result: Any = None
            for part in values:
                result = _value(part, scope)
                if bool(result) is isinstance(op, ast.Or):
                    return result
            return result
        case ast.BinOp(left=left, op=op, right=right) if type(op) in ARITHMETIC:
            return _arithmetic(op, _value(left, scope), _value(right, scope))
        case ast.Compare(left=left, ops=ops, comparators=comparators):
            previous = _value(left, scope)
            for comparison, comparator in zip(ops, comparators, strict=True):
                current = _value(comparator, scope)
                if not _COMPARE[type(comparison)](previous, current):
                    return False
                previous = current
            return True
        case ast.IfExp(test=test, body=body, orelse=orelse):
            return _value(body, scope) if _value(test, scope) else _value(orelse, scope)
        case ast.List(elts=elts):
            return _small([_value(element, scope) for element in elts])
        case ast.Set(elts=elts):
            return _small({_value(element, scope) for element in elts})
        case ast.Tuple(elts=elts):
            return _small(tuple([_value(element, scope) for element in elts]))
        case ast.Dict(keys=keys, values=values):
            return _small(
                {_value(key, scope): _value(value, scope) for key, value in zip(keys, values, strict=True) if key is not None}
            )
        case ast.Subscript(value=owner, slice=ast.Slice(lower=lower, upper=upper, step=step)):
            return _value(owner, scope)[slice(*[None if part is None else _value(part, scope) for part in (lower, upper, step)])]
        case ast.Subscript(value=owner, slice=key):
            return _value(owner, scope)[_value(key, scope)]
        case ast.ListComp() | ast.GeneratorExp():
            return _items(node.elt, node.generators, scope)
        case ast.SetComp():
            return set(_items(node.elt, node.generators, scope))
        case ast.DictComp():
            return dict(_items(ast.Tuple([node.key, node.value], ast.Load()), node.generators, scope))
        case ast.JoinedStr(values=values):
            return _small("".join([str(_value(value, scope)) for value in values]))
        case ast.FormattedValue(value=inner_value, conversion=-1, format_spec=None):
            return _value(inner_value, scope)
        case ast.Call():
            return _call(node, scope)
    return _unknown()


def _items(element: ast.expr, generators: Sequence[ast.comprehension], scope: _Scope) -> list[Any]:
    """Return the values of an element of a comprehension. Raises _Unknown as soon as they are too large."""
    result: list[Any] = []
    size = 0
    for inner in _rounds(generators, scope):
        result.append(_value(element, inner))
        size += _size(result[-1])
        if size > _MAX_SIZE:
            raise _Unknown
    return result


def _rounds(generators: Sequence[ast.comprehension], scope: _Scope) -> Iterator[_Scope]:
    """Yield the names that a comprehension defines in each of its rounds."""
    if not generators:
        yield scope
        return
    first, *others = generators
    for item in _value(first.iter, scope) if not first.is_async else _unknown():
        inner = scope._replace(names={**scope.names, **_bound(first.target, item)})
        if all(_value(test, inner) for test in first.ifs):
            yield from _rounds(others, inner)


def _bound(target: ast.expr, item: Any) -> Mapping[str, Any]:
    match target:
        case ast.Name(id=name):
            return {name: item}
        case ast.Tuple(elts=elts):
            parts = [_bound(inner, part) for inner, part in zip(elts, item, strict=True)]
            return {name: value for part in parts for name, value in part.items()}
    raise _Unknown


def _call(node: ast.Call, scope: _Scope) -> Any:
    name = node.func.id if isinstance(node.func, ast.Name) and node.func.id not in scope.names else ""
    if name == "isinstance" and len(node.args) == 2 and not node.keywords:
        return isinstance(_value(node.args[0], scope), _types(node.args[1]))
    arguments = [_value(argument, scope) for argument in node.args]
    if isinstance(node.func, ast.Attribute) and node.func.attr == "format":
        named = {keyword.arg: _value(keyword.value, scope) for keyword in node.keywords if keyword.arg is not None}
        return _formatted(_value(node.func.value, scope), arguments, named) if len(named) == len(node.keywords) else _unknown()
    if node.keywords:
        return _unknown()
    if isinstance(node.func, ast.Attribute) and node.func.attr in _METHODS | _SET_METHODS | _DICTIONARY_METHODS | {"join"}:
        owner = _value(node.func.value, scope)
        if isinstance(owner, _SETS) and node.func.attr in _SET_METHODS:
            return _small(getattr(owner, node.func.attr)(*arguments))
        if node.func.attr == "join" and isinstance(owner, str) and len(arguments) == 1:
            items = list(arguments[0])
            return _small(owner.join(items)) if (len(owner) + 1) * len(items) <= _MAX_SIZE else _unknown()
        if isinstance(owner, dict) and node.func.attr in _DICTIONARY_METHODS:
            result = getattr(owner, node.func.attr)(*arguments)
            return result if node.func.attr == "get" else list(result)
        if not isinstance(owner, str) or node.func.attr not in _METHODS:
            return _unknown()
        if node.func.attr == "replace" and len(owner) * sum(map(len, arguments[1:2])) > _MAX_SIZE:
            return _unknown()
        return _small(getattr(owner, node.func.attr)(*arguments))
    if name in _FUNCTIONS:
        return _FUNCTIONS[name](*arguments)
    return _unknown()


_TYPES = {kind.__name__: kind for kind in (bool, dict, float, frozenset, int, list, set, str, tuple)}


def _types(node: ast.expr) -> tuple[type, ...]:
    """Return the types that the second argument of isinstance() names."""
    names = node.elts if isinstance(node, ast.Tuple) else [node]
    return tuple([_TYPES[name.id] if isinstance(name, ast.Name) else _unknown() for name in names])


_FIELD = re.compile(r"\{(\w*)\}")


def _formatted(text: Any, arguments: Sequence[Any], named: Mapping[str, Any]) -> str:
    """Return the result of str.format() for a text whose fields are plain, as in ``{}``, ``{0}`` and ``{name}``."""
    if not isinstance(text, str) or set("{}").intersection(_FIELD.sub("", text)):
        raise _Unknown
    sizes = [len(str(value)) for value in (*arguments, *named.values())]
    if len(text) + len(_FIELD.findall(text)) * max(sizes, default=0) > _MAX_SIZE:
        raise _Unknown
    return text.format(*arguments, **named)


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
    "dict": dict,
    "enumerate": lambda items: list(enumerate(items)),
    "list": list,
    "max": max,
    "min": min,
    "range": lambda *bounds: list(range(*bounds)) if len(range(*bounds)) <= _MAX_SIZE else _unknown(),
    "reversed": lambda items: list(reversed(items)),
    "round": round,
    "set": set,
    "sorted": sorted,
    "sum": sum,
    "tuple": tuple,
    "zip": lambda *lists: list(zip(*lists, strict=False)),
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
