"""Functions of Python from sequences to sequences, as setup.py files use them."""

from __future__ import annotations

import ast
from collections.abc import Callable
from itertools import product
from math import prod

from ros_lint.collectors.setup_py.interpreter.expressions import Expressions
from ros_lint.collectors.setup_py.interpreter.operators import LONGEST, TooLargeError
from ros_lint.collectors.setup_py.interpreter.values import Globbed, Maybe, Unknown, Value, certain, globbed


def _elements(program: Expressions, node: ast.Call, *values: Value) -> list[Value]:
    return list(program.elements(values[0], node)) if values else []


def _sequence(program: Expressions, node: ast.Call, *values: Value) -> Value:
    found = _elements(program, node, *values)
    if values and isinstance(values[0], Globbed):
        return globbed(values[0].pattern, found)
    return found


def _in_reverse(program: Expressions, node: ast.Call, values: Value) -> Value:
    return _elements(program, node, values)[::-1]


def in_order(program: Expressions, node: ast.Call, values: Value, key: Value = None, reverse: Value = False) -> Value:
    """Return the result of sorted(); unsorted if an element is unknown."""
    found = _sequence(program, node, values)
    program.weigh(found)
    if all(map(certain, found)):
        keys = [item if key is None else program.call(key, [item], {}, node) for item in found]
        order = sorted(range(len(found)), key=keys.__getitem__, reverse=bool(reverse))
        found[:] = [found[index] for index in order]
    return found


def _as_tuple(program: Expressions, node: ast.Call, *values: Value) -> Value:
    return tuple(_elements(program, node, *values))


def _chain(program: Expressions, node: ast.Call, *lists: Value) -> Value:
    return [item for values in lists for item in program.elements(values, node)]


def _chain_from(program: Expressions, node: ast.Call, lists: Value) -> Value:
    return _chain(program, node, *program.elements(lists, node))


def _products(_: Expressions, __: ast.Call, *lists: Value) -> Value:
    if prod(map(len, lists)) * len(lists) > LONGEST:
        raise TooLargeError
    return list(product(*lists))


def _total(program: Expressions, node: ast.Call, lists: Value, start: Value = 0) -> Value:
    total = start
    for item in program.elements(lists, node):
        total = program.binary(ast.Add(), total, item.value if isinstance(item, Maybe) else item, node)
    return total


def _mapped(program: Expressions, node: ast.Call, function: Value, *lists: Value) -> Value:
    rows = zip(*(list(program.elements(values, node)) for values in lists), strict=False)
    return [program.call(function, list(row), {}, node) for row in rows]


def _filtered(program: Expressions, node: ast.Call, function: Value, values: Value) -> Value:
    found: list[Value] = []
    for item in program.elements(values, node):
        kept = program.truth(item if function is None else program.call(function, [item], {}, node))
        if kept is not False:
            found.append(item if kept or isinstance(item, (Unknown, Maybe)) else Maybe(item))
    return found


FUNCTIONS: dict[str, Callable[..., Value]] = {
    "itertools.chain": _chain,
    "itertools.chain.from_iterable": _chain_from,
    "itertools.product": _products,
    "list": _sequence,
    "sorted": in_order,
    "reversed": _in_reverse,
    "iter": _sequence,
    "tuple": _as_tuple,
    "map": _mapped,
    "filter": _filtered,
    "sum": _total,
}
"""Functions by name. The parameters of each are the program, the call and the arguments of the call."""
