"""Elements and slices of collections and texts, for owners and keys that may be unknown or have alternatives."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from ros_lint.collectors.python.interpreter.alternatives import plain, union
from ros_lint.collectors.python.interpreter.operations import hashable
from ros_lint.collectors.python.interpreter.recorder import are_unknown
from ros_lint.collectors.python.interpreter.values import (
    PERHAPS,
    Conditions,
    Guarded,
    ProgramRaised,
    Unknown,
    Value,
)
from ros_lint.collectors.symbolic_text import MOST, UNKNOWN, expression, is_plain, named_in, quoted
from ros_lint.facts.launch import LaunchCondition

if TYPE_CHECKING:
    from ros_lint.collectors.python.interpreter.protocol import Interpreter


def sliced(machine: Interpreter, owner: Value, parts: list[Value]) -> Value:
    """Return the slice ``owner[start:stop:step]``; ``parts`` are the values of start, stop and step."""
    known = all(part is None or isinstance(part, int) for part in parts)
    if isinstance(owner, (list, tuple)):
        owner = machine.present(owner) if isinstance(owner, list) else owner
        if machine.any_perhaps(owner) and any(part is not None for part in parts[:2]):
            return [Guarded(element, (PERHAPS,)) for element in owner]
    if known and (isinstance(owner, (list, tuple)) or (isinstance(owner, str) and is_plain(owner))):
        try:
            return owner[slice(*parts)]
        except ValueError:
            raise ProgramRaised from None
    if known and isinstance(owner, str) and waits(owner):
        return expression(f"{quoted(owner)}[{':'.join(['' if part is None else str(part) for part in parts])}]")
    return Unknown("part of an unknown value")


def waits(text: str) -> bool:
    """Return whether launch can compute a text, because it depends only on launch configurations and environment variables.

    True for the text of ``LaunchConfiguration("a")``. False for UNKNOWN, and for a plain text such as ``robot.yaml``.
    """
    return UNKNOWN not in text and bool(named_in(text))


def chosen(owner: dict[Any, Value], key: str) -> list[Value]:
    """Return the values of a dictionary for a key that is known only at launch.

    Each value has the condition that the key of its item equals ``key``. If a key of the dictionary is not a known text, the
    values have no conditions.
    """
    if not _is_choice(owner, key):
        return list(owner.values())
    return [Guarded(value, (LaunchCondition((str(key),), str(name)),)) for name, value in owner.items()]


def without(owner: dict[Any, Value], key: str) -> Conditions:
    """Return the conditions under which a dictionary has no item ``key``. The value of ``key`` is known only at launch.

    The result is () if the conditions are unknown, for example because a key of the dictionary is not a known text.
    """
    if not _is_choice(owner, key):
        return ()
    return tuple([LaunchCondition((str(key),), str(name), wanted=False) for name in owner])


def _is_choice(owner: dict[Any, Value], key: str) -> bool:
    return len(owner) <= MOST and waits(key) and all(isinstance(key_name, str) and is_plain(key_name) for key_name in owner)


def may_have_more(values: Sequence[Value]) -> bool:
    """Return whether the number of elements of a collection is unknown.

    It is unknown if an element is unknown or may be missing, because such an element represents any number of elements.
    """
    return any(isinstance(value, (Guarded, Unknown)) for value in values)


def append(machine: Interpreter, owner: list[Value], value: Value) -> None:
    """Append an element to a list, if the conditions hold under which the interpreted code runs.

    An unknown element that may be missing represents any number of elements (:func:`may_have_more`). It is therefore not
    appended again if it is among the last elements and these are all of this kind, as in a loop over unknown values.
    """
    if _is_unknown(value) and machine.conditions and are_unknown(machine.conditions):
        for place in range(len(owner) - 1, -1, -1):
            last = owner[place]
            if not (isinstance(last, Guarded) and _is_unknown(last.value) and are_unknown(last.conditions)):
                break
            if _is_again(last.value, value) and last.conditions != machine.conditions:
                owner[place] = Guarded(last.value, (machine.fresh(PERHAPS),))
                return
    owner.append(machine.guard(value))


def _is_unknown(value: Value) -> bool:
    return isinstance(value, Unknown) or (isinstance(value, str) and UNKNOWN in value)


def _is_again(before: Value, value: Value) -> bool:
    """Return whether nothing distinguishes an unknown value from an earlier unknown value."""
    if isinstance(before, Unknown) and isinstance(value, Unknown):
        return (before.reason, before.condition, before.node) == (value.reason, value.condition, value.node)
    return isinstance(before, str) and isinstance(value, str) and before == value


def subscript(machine: Interpreter, owner: Value, key: Value) -> Value:
    """Return the value of ``owner[key]``, where ``key`` is not a slice."""
    if isinstance(owner, dict):
        if isinstance(key, str) and not is_plain(key):
            return union(chosen(owner, key)) if owner else Unknown("element of an empty dictionary")
        name = hashable(machine, key)
        if name in owner:
            return machine.possible(plain(owner[name]))  # otherwise, the program raises KeyError
        if isinstance(key, Unknown):
            return union(owner.values()) if owner else Unknown("element of an empty dictionary")
        if UNKNOWN in owner:
            return union(value for other, value in owner.items() if isinstance(other, str) and not is_plain(other))
        raise ProgramRaised("KeyError")
    if isinstance(owner, (list, tuple)):
        owner = machine.present(owner)
        if isinstance(key, int) and machine.is_at(owner, key) and (-len(owner) <= key < len(owner) or not may_have_more(owner)):
            try:
                return plain(owner[key])
            except IndexError:
                raise ProgramRaised("IndexError") from None
        if isinstance(key, str):
            raise ProgramRaised("TypeError")
        return union(owner) if owner else Unknown("element of an empty list")
    if isinstance(owner, str) and is_plain(owner) and isinstance(key, int):
        try:
            return owner[key]
        except IndexError:
            raise ProgramRaised("IndexError") from None
    if isinstance(owner, str) and isinstance(key, int) and waits(owner):
        return expression(f"{quoted(owner)}[{key}]")
    return machine.library.subscript(machine, owner, key)
