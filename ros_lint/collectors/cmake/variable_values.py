"""The values of a CMake variable at a place of a script, for the hover text of editors."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any, Final

from ros_lint.collectors.cmake.commands.ament import run_external_command
from ros_lint.collectors.cmake.evaluate import run_script
from ros_lint.collectors.cmake.evaluator.run import Run
from ros_lint.collectors.cmake.evaluator.sources import Helper, Sources
from ros_lint.collectors.cmake.evaluator.state import Variables
from ros_lint.collectors.cmake.evaluator.values import ATOM, BINARY, HOLE, PREFIX, TREE, UNPAIRED_HOLE, elements, strip_mark

UNKNOWN: Final = "..."
"""Stands for an unknown part of a value."""

_PLACES: Final = {TREE: "<workspace>", BINARY: "<build folder>", PREFIX: "<install prefix>"}
_ATOM: Final = re.compile(rf"/?{ATOM}[\w-]+|{HOLE}")


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
