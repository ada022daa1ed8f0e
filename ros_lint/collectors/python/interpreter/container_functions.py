"""Results of Python's functions on collections, such as ``sorted`` and ``zip``, in a program that is interpreted symbolically.

An element of a collection may exist only under conditions, for example because a branch appends it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from itertools import product
from math import prod
from typing import TYPE_CHECKING

from ros_lint.collectors.python.interpreter.alternatives import around, plain
from ros_lint.collectors.python.interpreter.calls import LibraryCall, Rule, unknown
from ros_lint.collectors.python.interpreter.methods import items, more
from ros_lint.collectors.python.interpreter.operations import truth
from ros_lint.collectors.python.interpreter.ordering import arranged, positions, sort_keys, unique
from ros_lint.collectors.python.interpreter.values import (
    Conditions,
    Guarded,
    ProgramRaised,
    SetOf,
    Unknown,
    Value,
)

if TYPE_CHECKING:
    from ros_lint.collectors.python.interpreter.protocol import Interpreter


def _set(call: LibraryCall) -> Value:
    elements = call.items(0) if call.arguments else []
    return unknown(call) if elements is None else SetOf(unique(elements))


def _zip(call: LibraryCall) -> Value:
    rows = _rows(call, 0)
    return unknown(call) if rows is None else [_under(conditions, tuple(row)) for row, conditions in rows]


def _rows(call: LibraryCall, start: int) -> list[tuple[list[Value], Conditions]] | None:
    """Return the tuples that ``zip()`` makes of the arguments from position ``start`` on, each with its conditions.

    The result is None if the elements of an argument are unknown.
    """
    columns = [items(call.machine, argument) for argument in call.arguments[start:]]
    if any(column is None for column in columns):
        return None
    rows = zip(*[column or [] for column in columns], strict=False)
    return [
        ([plain(element) for element in row], tuple([condition for element in row for condition in around(element)]))
        for row in rows
    ]


def _under(conditions: Conditions, value: Value) -> Value:
    return Guarded(value, conditions) if conditions else value


def _extreme(function: Callable[..., int]) -> Rule:
    """Return a function that computes the result of a call of ``min`` or ``max`` in an interpreted program."""

    def rule(call: LibraryCall) -> Value:
        values = call.items(0) if len(call.arguments) == 1 else call.arguments
        if values is None or any(isinstance(value, Guarded) for value in values):
            return Unknown("the minimum or maximum of an unknown value")
        if not values:
            if "default" not in call.keywords:
                raise ProgramRaised
            return call.keywords["default"]
        keys = sort_keys(call.machine, values, call.keywords, call.node, call.frame)
        if keys is None:
            return Unknown("the minimum or maximum of an unknown value")
        positions(keys)
        return values[function(range(len(values)), key=keys.__getitem__)]

    return rule


def _sorted(call: LibraryCall) -> Value:
    elements = call.items(0)
    if elements is None:
        return unknown(call)
    return call.like(0, arranged(call.machine, elements, call.keywords, call.node, call.frame))


def _reversed(call: LibraryCall) -> Value:
    elements = call.items(0)
    return elements[::-1] if elements is not None else unknown(call)


def _map(call: LibraryCall) -> Value:
    rows = _rows(call, 1)
    if not rows:
        return unknown(call) if rows is None else []
    results: list[Value] = []
    for row, conditions in rows:
        with call.machine.under(*conditions):
            results.append(_under(conditions, call.machine.call(call.arguments[0], row, {}, call.node, call.frame)))
    return results


def _filter(call: LibraryCall) -> Value:
    elements = call.items(1)
    if elements is None:
        return unknown(call)
    kept = []
    for element in elements:
        result = (
            call.machine.call(call.arguments[0], [plain(element)], {}, call.node, call.frame) if call.arguments[0] else element
        )
        answer, condition = truth(call.machine, result)
        if answer is not False:
            kept.append(element if answer else Guarded(element, (condition,)))
    return kept


def _any_all(wanted: bool) -> Rule:
    def rule(call: LibraryCall) -> Value:
        elements = call.items(0)
        answers = [_answer(call.machine, element, wanted) for element in elements] if elements is not None else [None]
        if wanted in answers:
            return wanted
        return Unknown("any or all") if None in answers else not wanted

    return rule


def _answer(machine: Interpreter, value: Value, wanted: bool) -> bool | None:
    """Return whether ``value``, an element of the argument of any() or all(), is true; None if that is unknown.

    ``wanted`` is the truth value of the first element that ends the call: True for any(), False for all(). None is also returned
    for an element that has this truth value but may be missing.
    """
    answer, _ = truth(machine, value)
    return None if answer is wanted and isinstance(value, Guarded) else answer


def _sum(call: LibraryCall) -> Value:
    start, parts = plain(call.get(1, "start")), call.items(0)
    if parts is None:
        return unknown(call)
    if not isinstance(start, (list, tuple)):
        values = [0 if start is None else start, *parts]
        known = all(isinstance(value, (int, float)) for value in values)
        return sum(values) if known else Unknown("a number")
    elements = list(start)
    for part in parts:
        inner = items(call.machine, part)
        if inner is None:
            return unknown(call)
        call.machine.budget.step(len(inner))
        elements += [_under(around(part), element) for element in inner]
    return elements if isinstance(start, list) else tuple(elements)


def _chain(call: LibraryCall) -> Value:
    return _chained(call, call.arguments)


def _chain_of(call: LibraryCall) -> Value:
    parts = call.items(0)
    return unknown(call) if parts is None else _chained(call, parts)


def _chained(call: LibraryCall, parts: list[Value]) -> Value:
    elements: list[Value] = []
    for part in parts:
        inner = items(call.machine, part)
        if inner is None:
            call.machine.escape(part)
            inner = [more(part)]
        elements += [_under(around(part), element) for element in inner]
    return elements


def _product(call: LibraryCall) -> Value:
    columns = [column for position in range(len(call.arguments)) if (column := call.items(position)) is not None]
    size = prod(map(len, columns))
    if len(columns) < len(call.arguments) or call.keywords or size * len(columns) > call.machine.most_items:
        return unknown(call)
    call.machine.budget.step(size)
    return [
        _under(tuple([condition for part in row for condition in around(part)]), tuple([plain(part) for part in row]))
        for row in product(*columns)
    ]


FUNCTIONS: Mapping[str, Rule] = {
    "itertools.chain": _chain,
    "itertools.chain.from_iterable": _chain_of,
    "itertools.product": _product,
    "builtins.set": _set,
    "builtins.frozenset": _set,
    "builtins.zip": _zip,
    "builtins.sorted": _sorted,
    "builtins.reversed": _reversed,
    "builtins.map": _map,
    "builtins.filter": _filter,
    "builtins.any": _any_all(True),
    "builtins.all": _any_all(False),
    "builtins.min": _extreme(min),
    "builtins.max": _extreme(max),
    "builtins.sum": _sum,
}
"""The models that compute the results of functions, by the full name of the function such as ``builtins.zip``."""
