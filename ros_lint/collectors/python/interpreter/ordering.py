"""The order and equality of values, for sorted(), min(), max() and sets."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

from ros_lint.collectors.python.interpreter.alternatives import plain
from ros_lint.collectors.python.interpreter.values import (
    Guarded,
    ProgramRaised,
    Value,
)
from ros_lint.collectors.symbolic_text import UNKNOWN, is_plain

if TYPE_CHECKING:
    import ast

    from ros_lint.collectors.python.interpreter.protocol import Interpreter
    from ros_lint.collectors.python.interpreter.values import Frame

MOST_COMPARED = 500
"""The maximum size of collections that are compared with each other."""


def arranged(
    machine: Interpreter, values: list[Value], keywords: Mapping[str, Value], node: ast.Call, frame: Frame
) -> list[Value]:
    """Return values in the order of ``list.sort(**keywords)``, unchanged if their order is unknown."""
    keys = sort_keys(machine, values, keywords, node, frame)
    if keys is None:
        return values
    return [values[index] for index in positions(keys, reverse=bool(plain(keywords.get("reverse"))))]


def sort_keys(
    machine: Interpreter, values: list[Value], keywords: Mapping[str, Value], node: ast.Call, frame: Frame
) -> list[Any] | None:
    """Return the keys by which values are sorted: the results of ``keywords["key"]``, else the values themselves.

    The result is None if any key is unknown.
    """
    key = keywords.get("key")
    keys = [plain(value if key is None else machine.call(key, [plain(value)], {}, node, frame)) for value in values]
    return keys if all(is_small(key) and is_known(key) for key in keys) else None


def is_known(value: Value) -> bool:
    """Return whether a value is None, a number, a known text, or a collection of such values."""
    if isinstance(value, dict):
        return all(map(is_known, value.values())) and all(map(is_known, value))
    if isinstance(value, (list, tuple)):
        return all(map(is_known, value))
    return value is None or isinstance(value, (int, float)) or (isinstance(value, str) and is_plain(value))


def is_small(value: Any) -> bool:
    """Return whether a value has at most MOST_COMPARED elements, including the elements of nested collections."""
    stack, count = [value], 0
    while stack:
        item = stack.pop()
        count += 1
        if count > MOST_COMPARED:
            return False
        if isinstance(item, dict):
            stack += item.values()
        elif isinstance(item, (list, tuple, set)):
            stack += item
    return True


def positions(keys: list[Any], *, reverse: bool = False) -> list[int]:
    """Return the positions of the sorted keys: ``["b", "a"]`` -> ``[1, 0]``. Raises ProgramRaised if keys cannot be compared."""
    try:
        return sorted(range(len(keys)), key=keys.__getitem__, reverse=reverse)
    except TypeError:
        raise ProgramRaised("TypeError") from None


def unique(values: Iterable[Value]) -> list[Value]:
    """Return the elements of the set of ``values``: all values except those that certainly equal an earlier value."""
    elements: list[Value] = []
    seen: set[Any] = set()
    for value in values:
        inner = plain(value)
        if not _has_known_equality(inner):
            elements.append(value)
        elif inner not in seen:
            elements.append(value)
            if not isinstance(value, Guarded):
                seen.add(inner)
    return elements


def _has_known_equality(value: Value) -> bool:
    if isinstance(value, tuple):
        return is_small(value) and all(map(_has_known_equality, value))
    return value is None or isinstance(value, (int, float)) or (isinstance(value, str) and UNKNOWN not in value)
