"""Scopes of launch: an argument passed to an include stays set after the include, up to the end of the scoped group."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

from ros_lint.analysis.launch.configurations import include_tree
from ros_lint.analysis.launch.includes import IncludeResolver, include_resolver
from ros_lint.analysis.launch.workspace_files import launch_file
from ros_lint.analysis.memo import cached_by_name, cached_by_workspace
from ros_lint.collectors.symbolic_text import configurations
from ros_lint.facts.launch import LaunchAction, LaunchFile, values_of_action, walk_actions
from ros_lint.workspace.model import Workspace


class PlacedInclude(NamedTuple):
    """An include in a launch file, and its scope. Configurations that the include sets stay set up to the end of the scope."""

    action: LaunchAction
    """The include."""
    scope: tuple[LaunchAction, ...]
    """All actions of the launch file, or of the innermost scoped group around the include, in order."""
    later: int
    """The index in ``scope`` of the first action after the include."""
    leaves: bool
    """True if the configurations that the include sets are still set at the end of the file."""
    number: int
    """The number of ``scope`` among the scopes of the file that have includes, from 0."""


class _Scope(NamedTuple):
    """All actions of a launch file, or of a scoped group in it, that share their launch configurations, in order."""

    actions: tuple[LaunchAction, ...]
    leaves: bool
    """True if a configuration that is set in the scope is still set at the end of the launch file."""


def includes(file: LaunchFile) -> Iterator[PlacedInclude]:
    """Yield the includes of a launch file in the order of the file, also includes in groups."""
    numbers: dict[int, tuple[int, _Scope]] = {}
    for action, scope, later in _includes(file.actions, _Scope(tuple(walk_actions(file.actions)), leaves=True), 0):
        number, _ = numbers.setdefault(id(scope), (len(numbers), scope))  # keeps the scope, so that its id stays unique
        yield PlacedInclude(action, scope.actions, later, scope.leaves, number)


def _includes(actions: Sequence[LaunchAction], scope: _Scope, position: int) -> Iterator[tuple[LaunchAction, _Scope, int]]:
    """Yield the includes in ``actions``, also in groups, each with its scope and the index of the next action in the scope.

    ``scope`` contains ``actions``, and ``position`` is the index of the first of them in it.
    """
    for action in actions:
        after = position + 1 + (sum(1 for _ in walk_actions(action.children)) if action.children else 0)
        if action.kind == "include":
            yield action, scope, after
        if action.children and action.has_scope:
            yield from _includes(action.children, _Scope(tuple(walk_actions(action.children)), leaves=False), 0)
        elif action.children:
            yield from _includes(action.children, scope, position + 1)
        position = after


class _Taker(NamedTuple):
    """An include whose launch file may read launch configurations that were set before the include."""

    position: int
    """Index of the include in the scope."""
    passed: frozenset[str]
    """The arguments that the include passes. They replace values that were set before the include."""


class _Readers(NamedTuple):
    """The actions of a scope that may read launch configurations."""

    last_action: Mapping[str, int]
    """The index of the last action that reads a configuration itself, by the name of the configuration."""
    of_any: tuple[_Taker, ...]
    """Includes that may read any configuration."""
    by_file: Mapping[str, tuple[_Taker, ...]]
    """Includes by the path of the included file, if its configurations are all known."""
    files: Mapping[str, tuple[str, ...]]
    """Paths of the included files that read a configuration, by the name of the configuration."""

    @classmethod
    def of(cls, scope: Sequence[LaunchAction], source: LaunchFile, links: IncludeResolver) -> _Readers:
        """Return the actions in ``scope``, a part of the launch file ``source``, that may read launch configurations."""
        last: dict[str, int] = {}
        of_any: list[_Taker] = []
        by_file: dict[str, tuple[_Taker, ...]] = {}
        files: dict[str, tuple[str, ...]] = {}
        for position, action in enumerate(scope):
            for text, _ in values_of_action(action):
                last.update({name: position for name, _, _ in configurations(text)})
            if action.kind != "include":
                continue
            taker = _Taker(position, frozenset(name for name, _ in action.arguments))
            target = links.target(action.target, source)
            takes = links.takes(target.file) if target is not None else None
            if target is None or takes is None or not takes.complete:
                of_any.append(taker)
                continue
            path = target.file.path
            if path not in by_file:
                files.update({name: (*files.get(name, ()), path) for name in takes.known})
            by_file[path] = (*by_file.get(path, ()), taker)
        return cls(last, tuple(of_any), by_file, files)

    def last(self, name: str) -> int:
        """Return the index of the last action that may read the configuration ``name``, -1 if there is none."""
        groups = [self.of_any, *(self.by_file[path] for path in self.files.get(name, ()))]
        takers = (next((taker.position for taker in reversed(group) if name not in taker.passed), -1) for group in groups)
        return max(self.last_action.get(name, -1), *takers)


@cached_by_name
def _readers(workspace: Workspace, path: str) -> tuple[_Readers, ...]:
    """Return the readers in each scope with includes of the launch file at ``path``."""
    file = launch_file(workspace, path)
    scopes = {include.number: include.scope for include in includes(file)} if file is not None else {}
    return tuple([_Readers.of(scope, file, include_resolver(workspace)) for scope in scopes.values() if file is not None])


@cached_by_name
def _placed_above(workspace: Workspace, path: str) -> tuple[tuple[str, PlacedInclude], ...]:
    """Return the includes of the launch file at ``path``, each with the path of the including file."""
    links = include_resolver(workspace)
    result = []
    for includer in sorted(include_tree(workspace).includers(path)):
        file = launch_file(workspace, includer)
        for include in includes(file) if file is not None else ():
            target = links.target(include.action.target, file) if file is not None else None
            if target is not None and target.file.path == path:
                result.append((includer, include))
    return tuple(result)


class ScopeLeaks:
    """Finds actions that may read a launch configuration after the include that has set it."""

    def __init__(self, workspace: Workspace) -> None:
        self._workspace = workspace

    def is_taken_later(self, name: str, include: PlacedInclude, source: LaunchFile) -> bool:
        """Return whether an action after ``include`` in the launch file ``source`` may read the configuration ``name``."""
        return self._is_taken_later(name, include, source.path)

    def is_taken_above(self, name: str, include: PlacedInclude, source: LaunchFile) -> bool:
        """Return whether a launch file that includes ``source`` may read the configuration ``name`` after ``source`` has run.

        ``include`` is the include in ``source`` that sets ``name``.
        """
        seen, waiting = {source.path}, [source.path] if include.leaves else []
        while waiting:
            for path, above in _placed_above(self._workspace, waiting.pop()):
                if self._is_taken_later(name, above, path):
                    return True
                if above.leaves and path not in seen:
                    seen.add(path)
                    waiting.append(path)
        return False

    def _is_taken_later(self, name: str, include: PlacedInclude, path: str) -> bool:
        return _readers(self._workspace, path)[include.number].last(name) >= include.later


@cached_by_workspace
def scope_leaks(workspace: Workspace) -> ScopeLeaks:
    """Return a :class:`ScopeLeaks` for the launch files of the workspace.

    It finds launch configurations that are read after the include that has set them.
    """
    return ScopeLeaks(workspace)
