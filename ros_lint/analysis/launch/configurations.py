"""Which launch configurations a launch file declares, sets and asks for, and what it gets from those that include it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import NamedTuple

from ros_lint.analysis.launch.includes import IncludeResolver, configurations_read
from ros_lint.base.text import Span
from ros_lint.collectors.symbolic_text import configurations, is_plain
from ros_lint.facts.launch import LaunchFile, values_of_action, walk_actions


class FileConfigurations(NamedTuple):
    """The launch configurations of one file."""

    declared: Mapping[str, Span]
    """Its arguments."""
    made: frozenset[str]
    """Those that it sets in other ways, or passes to a file that it includes, which leaves them set."""
    asked: frozenset[str]
    """Those that it asks for."""
    whole: bool
    """Whether no other name can be meant."""
    fills: bool
    """Whether files of parameters, which anybody can replace by others, may ask for any name."""


def names_of(file: LaunchFile) -> FileConfigurations:
    """Return what a file itself does."""
    declared: dict[str, Span] = {}
    made: set[str] = set()
    asked = configurations_read(file)
    whole = not file.problems and not file.opaque and all(map(is_plain, asked))
    for action in walk_actions(file.actions):
        if action.kind in ("include", "group"):
            made.update(name for name, _ in action.arguments)
        elif action.kind == "set" and action.target is not None:
            made.update(action.target.texts)
        elif action.kind == "argument" and action.target is not None:
            declared.update((name, action.span) for name in action.target.texts if name not in declared)
    whole = whole and all(map(is_plain, (*made, *declared)))
    return FileConfigurations(declared, frozenset(made), frozenset(asked), whole, file.substitutes_parameters)


def required_configurations(file: LaunchFile, names: frozenset[str]) -> dict[str, Span]:
    """Return those names that must be there, since the file has no default where it asks for them."""
    return {name: span for (name, has_default), span in read_sites(file, names).items() if not has_default}


def read_sites(file: LaunchFile, names: frozenset[str]) -> dict[tuple[str, bool], Span]:
    """Return where a file first asks for names, for each with and without a default."""
    found: dict[tuple[str, bool], Span] = {}
    for action in walk_actions(file.actions):
        for text, span in values_of_action(action):
            for name, has_default, _ in configurations(text):
                if name in names:
                    found.setdefault((name, bool(has_default)), span)
    return found


class IncludeTree:
    """Who includes whom among the launch files of a workspace."""

    def __init__(self, files: Iterable[LaunchFile], links: IncludeResolver) -> None:
        self._names = {file.path: names_of(file) for file in files}
        self._includers: dict[str, set[str]] = {}
        self._included: dict[str, set[str]] = {}
        self.made = frozenset().union(*(names.made for names in self._names.values()))
        """What any of the files sets, or passes to another one."""
        self._filling = {path for path, names in self._names.items() if names.fills}
        self._filled: dict[str, bool] = {}
        for file in files:
            for inner in links.includes(file):
                self._includers.setdefault(inner.path, set()).add(file.path)
                self._included.setdefault(file.path, set()).add(inner.path)

    def names(self, file: LaunchFile) -> FileConfigurations:
        """Return what a file itself does."""
        return self._names[file.path]

    def fill(self, file: LaunchFile) -> bool:
        """Whether parameters are filled in from launch configurations by a file, one that it includes or one that includes it."""
        if not self._filling:
            return False
        path = file.path
        if path not in self._filled:
            related = {path} | _reached(self._includers, path) | _reached(self._included, path)
            self._filled[path] = not related.isdisjoint(self._filling)
        return self._filled[path]

    def above(self, file: LaunchFile) -> list[FileConfigurations]:
        """Return the same of every file that includes it, itself or by way of others."""
        return [self._names[path] for path in sorted(_reached(self._includers, file.path))]


def _reached(edges: Mapping[str, set[str]], start: str) -> set[str]:
    """Return what is reached from a path, itself left out."""
    seen = {start}
    waiting = [start]
    while waiting:
        new = edges.get(waiting.pop(), set()) - seen
        seen |= new
        waiting += new
    return seen - {start}
