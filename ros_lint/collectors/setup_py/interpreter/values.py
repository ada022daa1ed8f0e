"""The values of the options of setup(), reduced to the alternatives that can hold under the conditions of the call.

Texts and unknown values keep their origins in the source.
"""

from __future__ import annotations

import ast
from collections.abc import Iterable, Mapping
from functools import reduce
from typing import Final

from ros_lint.base.text import Span
from ros_lint.collectors.conditional_text import are_consistent
from ros_lint.collectors.python.interpreter.alternatives import alternatives, around, plain
from ros_lint.collectors.python.interpreter.values import (
    Conditions,
    Globbed,
    Guarded,
    Union,
    Unknown,
    Value,
    globbed,
)
from ros_lint.collectors.setup_py.interpreter.expression_text import at
from ros_lint.collectors.symbolic_text import UNKNOWN

REST: Final = UNKNOWN
"""The key that represents all unknown keys of a dictionary. The value of this key is an Unknown."""


class Word(str):
    """A text from a configuration file such as setup.cfg. ``node`` is its span."""

    __slots__ = ("node",)
    node: Span

    @classmethod
    def at(cls, text: str, node: Span) -> Word:
        word = cls(text)
        word.node = node
        return word


LARGEST: Final = 1 << 25
"""The maximum size in characters of a value that is evaluated. Lists that contain a list repeatedly could exceed the memory."""
_DEEPEST: Final = 50
"""The maximum nesting depth of containers in a value that is evaluated."""
_ELEMENT: Final = 128
"""The size in characters that each element of a container adds to the size of a value."""


def is_followed(values: Iterable[Value]) -> bool:
    """Return whether values are small and flat enough to be evaluated.

    A container that occurs in several containers counts each time.
    """
    size = 0
    level = [*values]
    for _ in range(_DEEPEST):
        size += sum(len(value) if isinstance(value, str) else _ELEMENT * len(_inner(value)) for value in level)
        if size > LARGEST:
            return False
        level = [item for value in level for item in _inner(value)]
        if not level:
            return True
    return False


def _inner(value: Value) -> tuple[Value, ...]:
    """Return the elements of a container, the alternatives of a Union, or the value inside a Guarded; () for other values."""
    if isinstance(value, dict):
        return tuple(value.values())
    if isinstance(value, Guarded):
        return (value.value,)
    return tuple(value) if isinstance(value, (list, tuple)) else value.values if isinstance(value, Union) else ()


def unknown_in(values: Iterable[Value], tests: Mapping[tuple[str, ...], ast.expr]) -> Unknown | None:
    """Return the first unknown value among ``values`` and their elements, None if everything is known.

    If the values are too large, or an element depends on an unknown condition, return an Unknown with this reason. ``tests``
    has the tested expression of each condition, which the reason quotes.
    """
    waiting = [*values]
    if not is_followed(waiting):
        return Unknown("it is too large to be evaluated")
    undecided = None
    while waiting:
        value = waiting.pop(0)
        if isinstance(value, Unknown):
            return value
        if isinstance(value, (Guarded, Union)) and undecided is None:
            undecided = _undecided(value, tests)
        waiting[:0] = _inner(value)
    return undecided


def _undecided(value: Value, tests: Mapping[tuple[str, ...], ast.expr]) -> Unknown:
    for alternative in alternatives(value):
        for condition in alternative.conditions:
            test = tests.get(condition.texts)
            if test is not None:
                return Unknown(f"the condition {at(test)} is not known", None, test)
    return Unknown("it depends on something that is not known")


class Deciding:
    """Chooses, for the options of a call of setup(), the possible values that do not contradict the conditions of the call."""

    def __init__(self, conditions: Conditions, tests: Mapping[tuple[str, ...], ast.expr]) -> None:
        self._conditions = conditions
        self._tests = tests

    def option(self, value: Value) -> Value:
        """Return the value of an option of setup() without the alternatives that contradict the conditions.

        If several alternatives are left, the result is Unknown. Exception: several lists become one list. List elements that may
        be missing are Guarded, that is, they have the conditions under which they exist.
        """
        return self._of(value) if is_followed((value,)) else Unknown("it is too large to be evaluated")

    def _of(self, value: Value) -> Value:
        value = plain(value)
        if isinstance(value, Union):
            return self._of_union(value)
        if isinstance(value, list):
            elements = [element for element in map(self._element, value) if element is not None]
            return globbed(value.pattern, elements) if isinstance(value, Globbed) else elements
        if isinstance(value, tuple):
            return tuple(map(self._of, value))
        if isinstance(value, dict):
            return {key: self._of(item) for key, item in value.items()}
        return Unknown("a part of it is not known") if isinstance(value, str) and UNKNOWN in value else value

    def _element(self, value: Value) -> Value:
        """Return the value of a list element under the conditions: Guarded if it may be missing, None if it is missing."""
        if not isinstance(value, Guarded):
            return self._of(value)
        conditions = around(value)
        if not are_consistent((*self._conditions, *conditions)):
            return None
        inner = self._of(value)
        missing = [condition for condition in conditions if condition not in self._conditions]
        return Guarded(inner, tuple(missing)) if missing and not isinstance(inner, Unknown) else inner

    def _of_union(self, value: Union) -> Value:
        values: list[Value] = []
        for alternative in alternatives(value):
            conditions = (*self._conditions, *alternative.conditions)
            if are_consistent(conditions):
                values.append(Deciding(conditions, self._tests)._of(alternative.value))
        if not values:
            return Unknown("it has no value")
        if all(_same(values[0], other) for other in values):
            return values[0]
        if all(isinstance(other, list) for other in values):
            return reduce(_merged, values)
        return unknown_in(values, {}) or _undecided(value, self._tests)


def _same(left: Value, right: Value) -> bool:
    """Return whether two values are the same object, or are known, equal and of the same type."""
    return left is right or (unknown_in((left, right), {}) is None and type(left) is type(right) and bool(left == right))


def _merged(left: list[Value], right: list[Value]) -> list[Value]:
    """Return one list for two alternative lists.

    Elements that are not in the common start or end of the lists may be missing, and are Guarded.
    """
    start, end, shorter = 0, 0, min(len(left), len(right))
    while start < shorter and _same(left[start], right[start]):
        start += 1
    while end < shorter - start and _same(left[-1 - end], right[-1 - end]):
        end += 1
    rest = [*left[start : len(left) - end], *right[start : len(right) - end]]
    perhaps = [item if isinstance(item, (Guarded, Unknown)) else Guarded(item, ()) for item in rest]
    return [*left[:start], *perhaps, *left[len(left) - end :]]
