"""Hover texts of CMake variables in Markdown."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from ros_lint.collectors.cmake.variable_values import readable

if TYPE_CHECKING:
    from ros_lint.collectors.cmake.variable_values import Variable

_MOST = 20
"""Maximum number of values, and of elements of a value, in a hover text."""


def describe(variable: Variable, values: Sequence[str | None]) -> str:
    """Return the hover text in Markdown of a variable. Its values are those of ``values_at``."""
    name = f"**{variable.name}**"
    if not values:
        return f"{name}: this command does not run"
    if len(values) == 1:
        return f"{name} {'is' if not values[0] else '='} {_value(values[0])}"
    more = [f"- and {len(values) - _MOST} more"] if len(values) > _MOST else []
    listed = [f"- {_value(value)}" for value in values[:_MOST]]
    return "\n".join([f"{name} has several values here, one after the other or by condition:\n", *listed, *more])


def _value(value: str | None) -> str:
    if value is None:
        return "not set"
    items = readable(value)
    if not items:
        return "empty"
    more = f" and {len(items) - _MOST} more" if len(items) > _MOST else ""
    return f"{'; '.join(f'`{item}`' for item in items[:_MOST])}{more}"
