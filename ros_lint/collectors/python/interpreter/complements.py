"""Opposites of the conditions under which the code of a program runs."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from ros_lint.collectors.python.interpreter.values import PERHAPS
from ros_lint.collectors.symbolic_text import UNKNOWN, expression, package_of_presence, quoted
from ros_lint.facts.launch import LaunchCondition


def opposite_of(condition: LaunchCondition) -> LaunchCondition:
    """Return the condition that holds if and only if ``condition`` does not hold."""
    return condition._replace(wanted=not condition.wanted)


def complement(conditions: Iterable[LaunchCondition], fresh: Callable[[LaunchCondition], LaunchCondition]) -> LaunchCondition:
    """Return the condition that holds if and only if at least one of ``conditions`` does not hold.

    If no Python expression can represent this condition, return ``fresh(PERHAPS)``, which creates a new unknown condition.
    """
    conditions = tuple(conditions)
    if len(conditions) == 1:
        return opposite_of(conditions[0])
    parts = [_negated(condition) for condition in conditions]
    if not parts or None in parts:
        return fresh(PERHAPS)
    return LaunchCondition((expression(" or ".join(part for part in parts if part)),), None)


def _negated(condition: LaunchCondition) -> str | None:
    """Return a Python expression for the opposite of a condition: ``'x' != 'a'`` for ``x`` equals ``a``.

    The result is None if no such expression exists, because a value in the condition is unknown.
    """
    text = condition.texts[0]
    if len(condition.texts) > 1 or UNKNOWN in text or package_of_presence(text):
        return None
    if condition.equals is not None:
        return f"{quoted(text)} {'!=' if condition.wanted else '=='} {quoted(condition.equals)}"
    return f"{quoted(text)}.strip().lower() {'not in' if condition.wanted else 'in'} ('true', '1')"
