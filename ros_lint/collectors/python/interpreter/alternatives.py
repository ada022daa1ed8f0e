"""Operations on values with alternatives: their union, their conditions, and whether two values are equal."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from ros_lint.collectors.conditional_text import are_consistent, conditional, conditions_of
from ros_lint.collectors.python.interpreter.values import Conditions, Guarded, Union, Unknown, Value
from ros_lint.collectors.symbolic_text import MOST


def union(values: Iterable[Value]) -> Value:
    """Return a value with all alternatives of ``values``. If all alternatives are the same, return that alternative itself.

    The result is Unknown if there are too many alternatives, or none.
    """
    results: list[Guarded] = []
    by_value: dict[object, list[Guarded]] = {}
    for value in values:
        for alternative in _possible(value):
            equal = by_value.setdefault(_key(alternative.value), [])
            if not any(same(alternative.value, other.value) and alternative.conditions == other.conditions for other in equal):
                equal.append(alternative)
                results.append(alternative)
        if len(results) > MOST:
            return Unknown("one of too many values")
    if not results:
        return Unknown("no value")
    if len(by_value) == 1 and all(same(alternative.value, results[0].value) for alternative in results):
        return results[0].value
    return Union(tuple(results))


def _key(value: Value) -> object:
    """Return a key that is the same for values that :func:`same` compares as equal."""
    if isinstance(value, str):
        return value
    return type(value) if isinstance(value, (int, float, tuple, type(None))) else id(value)


def _possible(value: Value) -> Iterable[Guarded]:
    """Return the alternatives of a value whose conditions can hold together.

    The alternatives of a :class:`Union` are known to be possible, so that only conditions around it have to be compared.
    """
    conditions: Conditions = ()
    while isinstance(value, Guarded):
        conditions = _together(conditions, value.conditions) if conditions else value.conditions
        value = value.value
    if not isinstance(value, Union):
        return (Guarded(value, conditions),) if are_consistent(conditions) else ()
    if not conditions:
        return value.values
    if not are_consistent(conditions):
        return ()
    texts = {condition.texts for condition in conditions}
    possible: list[Guarded] = []
    for alternative in value.values:
        both = (*conditions, *alternative.conditions)
        if not texts.isdisjoint([condition.texts for condition in alternative.conditions]):
            if not are_consistent(both):
                continue
            both = tuple(dict.fromkeys(both))
        possible.append(Guarded(alternative.value, both))
    return possible


def _together(conditions: Conditions, others: Conditions) -> Conditions:
    """Return all conditions once. Without that, their number would double with each operation on a value with itself."""
    return tuple(dict.fromkeys((*conditions, *others)))


def alternatives(value: Value, conditions: Conditions = ()) -> Iterator[Guarded]:
    """Yield every alternative of a value with its conditions; a value without alternatives is yielded itself.

    ``conditions`` are added to the conditions of each alternative.
    """
    if isinstance(value, Union):
        for alternative in value.values:
            yield from alternatives(alternative, conditions)
    elif isinstance(value, Guarded):
        both = conditions and value.conditions
        yield from alternatives(value.value, _together(conditions, value.conditions) if both else conditions or value.conditions)
    else:
        yield Guarded(value, conditions)


def guarded_text(text: str, made: Value) -> Value:
    """Return the value ``made``, which was computed from ``text``, with the conditions under which ``text`` applies."""
    conditions = conditions_of(text)
    return Guarded(made, conditions) if conditions else made


def under(texts: Iterable[str], conditions: Conditions) -> Iterator[str]:
    """Yield ``texts`` with ``conditions`` added to the conditions under which each text applies."""
    for text in texts:
        yield conditional(text, (*conditions, *conditions_of(text))) if conditions else text


def plain(value: Value) -> Value:
    """Return a value without the conditions under which it exists (``Guarded``). Other values are returned unchanged."""
    while isinstance(value, Guarded):
        value = value.value
    return value


def cause(value: Value, reason: str) -> Unknown:
    """Return ``value`` if it is an unknown value whose origin is recorded, else a new unknown value with ``reason``."""
    return value if isinstance(value, Unknown) and value.node is not None else Unknown(reason)


def around(value: Value) -> Conditions:
    """Return the conditions under which a value exists (``Guarded``), () if it exists in any case."""
    conditions: Conditions = ()
    while isinstance(value, Guarded):
        conditions += value.conditions
        value = value.value
    return conditions


def same(left: Value, right: Value) -> bool:
    """Return whether two values are certainly equal."""
    if left is right:
        return True
    if isinstance(left, str) and isinstance(right, str):
        return left == right
    simple = (int, float, bool, type(None), tuple)
    return type(left) is type(right) and isinstance(left, simple) and bool(left == right)
