"""Answers that rules share, by names that are the same in the next run.

They are the answers of the functions that ``analysis/memo.py`` caches.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ros_lint.analysis.memo import CACHED, NAMES

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from ros_lint.base.questions import Cell, Recorder
    from ros_lint.workspace.handles import Handles

PREFIX = "answer "
"""Prefix of the names of answers."""


class SharedAnswers:
    """The shared answers about a recorded workspace. The name of an answer has the function and its argument."""

    def __init__(self, handles: Handles) -> None:
        self._workspace = handles.workspace
        self._packages = {package.path: package for package in handles.workspace.packages}

    def named(self, recorder: Recorder) -> Iterator[tuple[Cell, str]]:
        """Yield each answer that has a name and whose value can be compared with the value in another run."""
        paths = {id(package): path for path, package in self._packages.items()}
        for question, answer, value in recorder.answers(self._workspace.memo):
            function, *arguments = question if isinstance(question, tuple) else (question,)
            name = NAMES.get(function, "")
            argument = _argument(arguments, paths) if name else None
            if argument is not None and " object at 0x" not in repr(value):
                yield answer, f"{PREFIX}{name} {argument}"

    def value(self, name: str) -> object:
        """Return the value of an answer in the loaded workspace. Raises LookupError for an answer that does not exist there."""
        function, kind, argument = name.removeprefix(PREFIX).split(" ", 2)
        ask = CACHED[function]
        if kind == "package":
            return ask(self._packages[argument], self._workspace)
        return ask(self._workspace, argument) if kind == "name" else ask(self._workspace)


def _argument(arguments: Sequence[object], paths: Mapping[int, str]) -> str | None:
    """Return the argument of a question as text; None for a package that colcon does not find.

    ``paths`` has the paths of the packages by their ids, which are the arguments of questions about packages.
    """
    match arguments:
        case []:
            return "workspace "
        case [int(package)]:
            return f"package {paths[package]}" if package in paths else None
        case [str(name)]:
            return f"name {name}"
    return None
