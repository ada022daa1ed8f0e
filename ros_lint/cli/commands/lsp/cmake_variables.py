"""Hover texts of CMake variables: the name at a place of a script, and its values as Markdown."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, NamedTuple

from ros_lint.base.text import Span
from ros_lint.collectors.cmake.variable_values import readable

if TYPE_CHECKING:
    from ros_lint.base.text import Text
    from ros_lint.cli.commands.lsp.positions import Place

_NAME = r"[\w./+-]+"
_READ = re.compile(rf"\$\{{({_NAME})\}}")
_ASSIGNED = re.compile(rf"^\s*(?:set|option|unset|list\s*\(\s*[A-Z_]+|string\s*\(\s*APPEND)\s*\(?\s*({_NAME})", re.IGNORECASE)
_CONDITION = re.compile(r"\s*(?:if|elseif|while)\s*\(", re.IGNORECASE)
_WORD = re.compile(rf"(?<![\"\w.])([A-Za-z_]{_NAME})")
_OPERATORS = frozenset(
    [
        "NOT",
        "AND",
        "OR",
        "DEFINED",
        "TARGET",
        "EXISTS",
        "COMMAND",
        "IS_DIRECTORY",
        "MATCHES",
        "IN_LIST",
        "EQUAL",
        "LESS",
        "GREATER",
        "STREQUAL",
        "STRLESS",
        "STRGREATER",
        "VERSION_EQUAL",
        "VERSION_LESS",
        "VERSION_GREATER",
        "VERSION_LESS_EQUAL",
        "VERSION_GREATER_EQUAL",
    ]
)
_MOST = 20
"""Maximum number of values, and of elements of a value, in a hover text."""


class Variable(NamedTuple):
    """The name of a variable in a CMake script."""

    name: str
    span: Span
    """The place of the name in the file."""
    assigned: bool
    """True if the command at the place sets the variable."""


def variable_at(text: Text, place: Place) -> Variable | None:
    """Return the variable at a place of a script: a reference such as ``${X}``, or the name that ``set(X a)`` sets.

    The result is None for other places, and for files that are no CMake scripts.
    """
    if not text.path.endswith((".cmake", "CMakeLists.txt")):
        return None
    try:
        line = text.line(place.line)
    except IndexError:
        return None
    for match, assigned in _names(line):
        start, end = match.span(1)
        if start < place.column <= end + 1:
            return Variable(match[1], Span(text.path, place.line, start + 1, place.line, end + 1), assigned)
    return None


def _names(line: str) -> Iterator[tuple[re.Match[str], bool]]:
    """Yield the names of variables in a line of a script, each with whether the command sets the variable."""
    yield from ((match, False) for match in _READ.finditer(line))
    yield from ((match, True) for match in _ASSIGNED.finditer(line))
    if condition := _CONDITION.match(line):
        words = _WORD.finditer(line, condition.end())
        yield from ((match, False) for match in words if match[1] not in _OPERATORS)


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
