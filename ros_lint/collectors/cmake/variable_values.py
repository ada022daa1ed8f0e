"""The CMake variable at a place of a script, and its values there, for the hover text of editors."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from typing import Any, Final, NamedTuple

from ros_lint.base.text import Span, Text
from ros_lint.collectors.cmake.commands.ament import run_external_command
from ros_lint.collectors.cmake.evaluate import run_script
from ros_lint.collectors.cmake.evaluator import condition_tests
from ros_lint.collectors.cmake.evaluator.run import Run
from ros_lint.collectors.cmake.evaluator.sources import Helper, Sources
from ros_lint.collectors.cmake.evaluator.state import Variables
from ros_lint.collectors.cmake.evaluator.values import ATOM, BINARY, HOLE, PREFIX, TREE, UNPAIRED_HOLE, elements, strip_mark

UNKNOWN: Final = "..."
"""Stands for an unknown part of a value."""

_PLACES: Final = {TREE: "<workspace>", BINARY: "<build folder>", PREFIX: "<install prefix>"}
_ATOM: Final = re.compile(rf"/?{ATOM}[\w-]+|{HOLE}")
_NAME = r"[\w./+-]+"
_READ = re.compile(rf"\$\{{({_NAME})\}}")
_ASSIGNED = re.compile(rf"^\s*(?:set|option|unset|list\s*\(\s*[A-Z_]+|string\s*\(\s*APPEND)\s*\(?\s*({_NAME})", re.IGNORECASE)
_CONDITION = re.compile(r"\s*(?:if|elseif|while)\s*\(", re.IGNORECASE)
_WORD = re.compile(rf"(?<![\"\w.])([A-Za-z_]{_NAME})")
_OPERATORS: Final = frozenset({"NOT", "AND", "OR", *condition_tests.UNARY, *condition_tests.BINARY})


class Variable(NamedTuple):
    """The name of a variable in a CMake script."""

    name: str
    span: Span
    """The place of the name in the file."""
    assigned: bool
    """True if the command at the place sets the variable."""


def variable_at(text: Text, line: int, column: int) -> Variable | None:
    """Return the variable at a place of a script: a reference such as ``${X}``, or the name that ``set(X a)`` sets.

    Lines and columns count from 1. The result is None for other places, and for files that are no CMake scripts.
    """
    if not text.path.endswith((".cmake", "CMakeLists.txt")):
        return None
    try:
        words = text.line(line)
    except IndexError:
        return None
    for match, assigned in _names(words):
        start, end = match.span(1)
        if start < column <= end + 1:
            return Variable(match[1], Span(text.path, line, start + 1, line, end + 1), assigned)
    return None


def _names(line: str) -> Iterator[tuple[re.Match[str], bool]]:
    """Yield the names of variables in a line of a script, each with whether the command sets the variable."""
    yield from ((match, False) for match in _READ.finditer(line))
    yield from ((match, True) for match in _ASSIGNED.finditer(line))
    if condition := _CONDITION.match(line):
        words = _WORD.finditer(line, condition.end())
        yield from ((match, False) for match in words if match[1] not in _OPERATORS)


def values_at(
    sources: Sources, distro: str, helpers: Mapping[str, Helper], path: str, line: int, variable: str, *, assigned: bool
) -> tuple[str | None, ...]:
    """Return the values of a variable in the command at a line of a file, each once, in the order of the evaluation.

    ``assigned``: the values that the command sets, such as those of ``set(X a)``; otherwise those that it reads. None stands
    for an unset variable. The result is () if the command does not run or the package has no CMakeLists.txt. For ``sources``,
    ``distro`` and ``helpers`` see :func:`ros_lint.collectors.cmake.evaluate.evaluate`.
    """
    probe = _Probe(sources, distro, helpers, run_external_command)
    probe.place, probe.variable = (path, line), variable
    if "CMakeLists.txt" in sources.scripts:
        run_script(probe, sources)
    return tuple(dict.fromkeys(probe.assigned if assigned else probe.read))


def readable(value: str) -> list[str]:
    """Return the elements of a value as text for users: ``...`` for an unknown part, and a note if an element may be missing."""
    return [_readable(*strip_mark(element)) for element in elements(value)]


def _readable(element: str, certain: bool) -> str:
    text = element.replace(UNPAIRED_HOLE, HOLE)
    for place, words in _PLACES.items():
        text = text.replace(place, words)
    return _ATOM.sub(UNKNOWN, text) + ("" if certain else " (may be missing)")


class _Probe(Run):
    """A run that records the values of a variable in the commands at a place. The first rounds of loops do not count."""

    place: tuple[str, int]
    variable: str

    def __init__(self, *arguments: Any) -> None:
        super().__init__(*arguments)
        self.read: list[str | None] = []
        self.assigned: list[str | None] = []

    def get(self, name: str) -> str | None:
        value = super().get(name)
        if name == self.variable and self._is_here():
            self.read.append(value)
        return value

    def evaluate(self, text: str) -> str:
        arguments = self.frames[-1].macro_arguments
        if arguments is not None and self.variable in arguments and self._is_here():
            self.read.append(arguments[self.variable])
        return super().evaluate(text)

    def put(self, mapping: dict[str, Any], key: str, value: Any) -> None:
        super().put(mapping, key, value)
        if key == self.variable and isinstance(mapping, Variables) and self._is_here():
            self.assigned.append(mapping[key])

    def _is_here(self) -> bool:
        if not self.frames or self.muted:
            return False
        frame, (path, line) = self.frames[-1], self.place
        command = frame.command
        return command is not None and frame.path == path and command.line <= line <= command.line + len(command.breaks)
