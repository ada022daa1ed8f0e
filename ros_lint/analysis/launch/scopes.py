"""Scopes of launch: an argument passed to an include stays set after the include, up to the end of the scoped group."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

from ros_lint.analysis.launch.includes import IncludeResolver, include_resolver
from ros_lint.analysis.memo import cached_by_workspace
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


def includes(file: LaunchFile) -> Iterator[PlacedInclude]:
    """Yield the includes of a launch file in the order of the file, also includes in groups."""
    return _includes(file.actions, tuple(walk_actions(file.actions)), 0, leaves=True)


def _includes(
    actions: Sequence[LaunchAction], scope: tuple[LaunchAction, ...], position: int, *, leaves: bool
) -> Iterator[PlacedInclude]:
    """Yield the includes in ``actions``, also in groups.

    ``scope`` has all actions that share their launch configurations, in order, and ``position`` is the index of the first of
    ``actions`` in it. ``leaves`` is True if a configuration that is set in ``scope`` is still set at the end of the launch file.
    """
    for action in actions:
        after = position + 1 + (sum(1 for _ in walk_actions(action.children)) if action.children else 0)
        if action.kind == "include":
            yield PlacedInclude(action, scope, after, leaves)
        if action.children and action.has_scope:
            yield from _includes(action.children, tuple(walk_actions(action.children)), 0, leaves=False)
        elif action.children:
            yield from _includes(action.children, scope, position + 1, leaves=leaves)
        position = after


class _Taker(NamedTuple):
    """An include whose launch file may read launch configurations that were set before the include."""

    position: int
    """Index of the include in the scope."""
    passed: frozenset[str]
    """The arguments that the include passes. They replace values that were set before the include."""


class _Readers:
    """The last action in a scope that may read a launch configuration, by the name of the configuration."""

    def __init__(self, scope: Sequence[LaunchAction], source: LaunchFile, links: IncludeResolver) -> None:
        self.scope = scope  # keeps the scope alive, because ScopeLeaks finds this object by the id of the scope
        self._last: dict[str, int] = {}
        self._known: dict[str, int] = {}
        """Results of :meth:`last` by name of the configuration."""
        self._of_any: list[_Taker] = []
        """Includes that may read any configuration."""
        self._by_file: dict[str, list[_Taker]] = {}
        self._files: dict[str, list[str]] = {}
        """Paths of the included files that read a configuration, by the name of the configuration."""
        for position, action in enumerate(scope):
            for text, _ in values_of_action(action):
                self._last.update({name: position for name, _, _ in configurations(text)})
            if action.kind == "include":
                self._add(_Taker(position, frozenset(name for name, _ in action.arguments)), action, source, links)

    def _add(self, taker: _Taker, action: LaunchAction, source: LaunchFile, links: IncludeResolver) -> None:
        target = links.target(action.target, source)
        takes = links.takes(target.file) if target is not None else None
        if target is None or takes is None or not takes.complete:
            self._of_any.append(taker)
            return
        if target.file.path not in self._by_file:
            for name in takes.known:
                self._files.setdefault(name, []).append(target.file.path)
        self._by_file.setdefault(target.file.path, []).append(taker)

    def last(self, name: str) -> int:
        """Return the index of the last action that may read the configuration ``name``, -1 if there is none."""
        if name not in self._known:
            groups = [self._of_any, *(self._by_file[path] for path in self._files.get(name, ()))]
            takers = (next((taker.position for taker in reversed(group) if name not in taker.passed), -1) for group in groups)
            self._known[name] = max(self._last.get(name, -1), *takers)
        return self._known[name]


class ScopeLeaks:
    """Finds actions that may read a launch configuration after the include that has set it."""

    def __init__(self, files: Iterable[LaunchFile], links: IncludeResolver) -> None:
        self._links = links
        self._by_scope: dict[int, _Readers] = {}
        self._above: dict[str, list[tuple[LaunchFile, PlacedInclude]]] = {}
        for file in files:
            for include in includes(file):
                if (target := links.target(include.action.target, file)) is not None:
                    self._above.setdefault(target.file.path, []).append((file, include))

    def is_taken_later(self, name: str, include: PlacedInclude, source: LaunchFile) -> bool:
        """Return whether an action after ``include`` in the launch file ``source`` may read the configuration ``name``."""
        return self._readers(include.scope, source).last(name) >= include.later

    def is_taken_above(self, name: str, include: PlacedInclude, source: LaunchFile) -> bool:
        """Return whether a launch file that includes ``source`` may read the configuration ``name`` after ``source`` has run.

        ``include`` is the include in ``source`` that sets ``name``.
        """
        seen, waiting = {source.path}, [source.path] if include.leaves else []
        while waiting:
            for file, above in self._above.get(waiting.pop(), ()):
                if self.is_taken_later(name, above, file):
                    return True
                if above.leaves and file.path not in seen:
                    seen.add(file.path)
                    waiting.append(file.path)
        return False

    def _readers(self, scope: Sequence[LaunchAction], source: LaunchFile) -> _Readers:
        readers = self._by_scope.get(id(scope))
        if readers is None:
            readers = self._by_scope[id(scope)] = _Readers(scope, source, self._links)
        return readers


@cached_by_workspace
def scope_leaks(workspace: Workspace) -> ScopeLeaks:
    """Return a :class:`ScopeLeaks` for the launch files of the workspace.

    It finds launch configurations that are read after the include that has set them.
    """
    files = [file for package in workspace.packages for file in package.launch]
    return ScopeLeaks(files, include_resolver(workspace))
