"""Texts that apply only under conditions: the alternatives of a value in a launch file or in setup.py."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from itertools import islice, product

from ros_lint.collectors.symbolic_text import LONGEST, MOST, UNKNOWN
from ros_lint.facts.launch import LaunchCondition

_MAX_CHOICES = 3_000


class Conditional(str):
    """A possible value of a text, such as the executable of a node, that applies only if all its ``conditions`` hold."""

    __slots__ = ("conditions",)

    conditions: tuple[LaunchCondition, ...]


def conditional(text: str, conditions: tuple[LaunchCondition, ...]) -> str:
    """Return a text that applies only if all conditions hold: a Conditional, or ``text`` itself if there are none."""
    if not conditions:
        return text
    result = Conditional(text)
    result.conditions = conditions
    return result


def conditions_of(text: str) -> tuple[LaunchCondition, ...]:
    """Return the conditions of a text that :func:`conditional` returned, () for any other text."""
    return text.conditions if isinstance(text, Conditional) else ()


def are_consistent(conditions: Iterable[LaunchCondition]) -> bool:
    """Return whether conditions can hold at the same time.

    The result is False if one condition is the negation of another, or if two conditions require different values of one text.
    """
    conditions = tuple(conditions)
    if len({condition.texts for condition in conditions}) == len(conditions):
        return True  # about different texts
    truths: dict[tuple[tuple[str, ...], str | None], bool] = {}
    values: dict[tuple[str, ...], str] = {}
    for texts, equals, wanted in conditions:
        if truths.setdefault((texts, equals), wanted) is not wanted:
            return False
        if wanted and equals is not None and values.setdefault(texts, equals) != equals:
            return False
    return True


def distinct(texts: Iterable[str]) -> tuple[str, ...]:
    """Return texts without duplicates. Equal texts with different conditions are distinct.

    A text with conditions is dropped if the same text occurs without conditions. If there are more than ``MOST`` pairs of
    text and conditions, each text is returned once, without conditions if it occurs with several.
    """
    by_conditions = {(text, conditions_of(text)): text for text in texts}
    if len(by_conditions) <= MOST:
        return tuple(
            [text for (plain, conditions), text in by_conditions.items() if not conditions or (plain, ()) not in by_conditions]
        )
    by_text: dict[str, str] = {}
    for (plain, _), text in by_conditions.items():
        by_text[plain] = str(text) if plain in by_text else text
    return tuple(by_text.values())


def joined(rows: Iterable[tuple[str, ...]], function: Callable[[tuple[str, ...]], str]) -> tuple[str, ...]:
    """Return the results of ``function`` for every choice of one alternative from each row.

    Example: the rows ``("a",)`` and ``("x", "y")`` give ``function(("a", "x"))`` and ``function(("a", "y"))``. Choices
    whose conditions contradict each other are left out. The result is ``(UNKNOWN,)`` if no choice remains, or if there
    are more than ``MOST`` results.
    """
    rows = tuple(rows)
    if all(len(row) == 1 and not isinstance(row[0], Conditional) for row in rows):
        choice = tuple([row[0] for row in rows])
        return (function(choice) if sum(map(len, choice)) <= LONGEST else UNKNOWN,)
    results: list[str] = []
    for choice in islice(product(*rows), _MAX_CHOICES):
        conditions = tuple(dict.fromkeys(condition for text in choice for condition in conditions_of(text)))
        if conditions and not are_consistent(conditions):
            continue
        results.append(conditional(function(choice) if sum(map(len, choice)) <= LONGEST else UNKNOWN, conditions))
    texts = distinct(results)
    return texts if 0 < len(texts) <= MOST else (UNKNOWN,)
