"""Items of dictionaries that exist only under conditions.

If a branch adds an item, the item exists only under the conditions of the branch, which are stored with its value
(``Guarded``). If a branch replaces an item, the item exists in any case, and has the old and the new value as alternatives.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import TYPE_CHECKING, Any

from ros_lint.collectors.python.interpreter.alternatives import around, plain, union
from ros_lint.collectors.python.interpreter.complements import complement, opposite_of
from ros_lint.collectors.python.interpreter.values import (
    PERHAPS,
    Conditions,
    Guarded,
    Value,
)
from ros_lint.collectors.symbolic_text import UNKNOWN
from ros_lint.facts.launch import LaunchCondition

if TYPE_CHECKING:
    from ros_lint.collectors.python.interpreter.protocol import Interpreter


def store(machine: Interpreter, owner: dict[Any, Value], key: Any, value: Value) -> None:
    """Set ``owner[key] = value`` in a dictionary, if the conditions hold under which the interpreted code runs."""
    now = machine.conditions
    if not now or (key not in owner and not isinstance(value, Guarded)):
        owner[key] = machine.guard(value)
        return
    if key not in owner:
        owner[key] = Guarded(plain(value), (*now, *around(value)))
        return
    before, held = owner[key], around(owner[key])
    if isinstance(key, str) and UNKNOWN in key:  # the items may have different keys
        owner[key] = guarded(union([before, Guarded(value, now)]), (machine.fresh(PERHAPS),) if held else ())
        return
    if held == now:
        owner[key] = Guarded(value, now)
        return
    beyond = _without(now, held)
    replaced = union([machine.removed(before) if beyond else before, Guarded(value, now)])
    if set(held) <= set(now):
        owner[key] = Guarded(replaced, held) if held else replaced
        return
    either = union([before, Guarded(value, now)])
    if held[:-1] == now[:-1] and held[-1] == opposite_of(now[-1]):
        owner[key] = Guarded(either, held[:-1]) if held[:-1] else either
    else:
        owner[key] = Guarded(either, (machine.fresh(PERHAPS),))


def value_or_default(machine: Interpreter, owner: Mapping[Any, Value], key: Any, default: Value) -> Value:
    """Return the value of the item ``key`` if the item exists, else ``default``; both as alternatives if it may exist."""
    if key not in owner or not machine.is_here(owner[key]):
        return default
    value = machine.possible(owner[key])
    missing = _without(around(value), machine.conditions)
    return (
        union([Guarded(plain(value), missing), Guarded(default, (complement(missing, machine.fresh),))])
        if missing
        else plain(value)
    )


def entries(machine: Interpreter, owner: Mapping[Any, Value]) -> Iterator[tuple[Any, Value, Conditions]]:
    """Yield the items of a dictionary: key, value, and the conditions under which the item exists.

    Items that certainly do not exist where the interpreted code runs are left out.
    """
    for key, value in owner.items():
        if machine.is_here(value):
            yield key, machine.possible(plain(value)), around(value)


def guarded(value: Value, conditions: Conditions) -> Value:
    """Return ``value`` as a value that exists only under ``conditions``, unchanged if ``conditions`` is empty."""
    return Guarded(value, conditions) if conditions else value


def _without(conditions: Conditions, known: Iterable[LaunchCondition]) -> Conditions:
    excluded = set(known)
    return tuple([condition for condition in conditions if condition not in excluded])
