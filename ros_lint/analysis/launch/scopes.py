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
    """An include, and the actions that may read the launch configurations set by the include, because they run after it."""

    action: LaunchAction
    """The include."""
    later: list[LaunchAction]
    """The later actions of the file for which the configurations of the include are still set."""
    leaves: bool
    """True if the configurations of the include are still set at the end of the file."""


def includes(file: LaunchFile) -> Iterator[PlacedInclude]:
    """Yield the includes of a launch file in the order of the file, including includes in groups."""
    return _includes(file.actions, (), leaves=True)


def _includes(actions: Sequence[LaunchAction], after: Sequence[LaunchAction], *, leaves: bool) -> Iterator[PlacedInclude]:
    for index, action in enumerate(actions):
        if action.kind != "include" and not action.children:
            continue
        later = [*walk_actions(actions[index + 1 :]), *after]
        if action.kind == "include":
            yield PlacedInclude(action, later, leaves)
        scoped = action.has_scope
        yield from _includes(action.children, () if scoped else later, leaves=leaves and not scoped)


class ScopeLeaks:
    """Finds actions that may read a launch configuration after the include that has set it."""

    def __init__(self, files: Iterable[LaunchFile], links: IncludeResolver) -> None:
        self._links = links
        self._above: dict[str, list[tuple[LaunchFile, PlacedInclude]]] = {}
        for file in files:
            for include in includes(file):
                if (target := links.target(include.action.target, file)) is not None:
                    self._above.setdefault(target.file.path, []).append((file, include))

    def is_taken_later(self, name: str, include: PlacedInclude, source: LaunchFile) -> bool:
        """Return whether an action after ``include`` in the launch file ``source`` may read the configuration ``name``."""
        return any(self._may_take(action, name, source) for action in include.later)

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

    def _may_take(self, action: LaunchAction, name: str, source: LaunchFile) -> bool:
        if any(name == configuration for text, _ in values_of_action(action) for configuration, _, _ in configurations(text)):
            return True
        if action.kind != "include" or name in dict(action.arguments):
            return False
        target = self._links.target(action.target, source)
        if target is None:
            return True
        takes = self._links.takes(target.file)
        return not takes.complete or name in takes.known


@cached_by_workspace
def scope_leaks(workspace: Workspace) -> ScopeLeaks:
    """Return the object that answers, for this workspace, whether a configuration left set by an include is read later."""
    files = [file for package in workspace.packages for file in package.launch]
    return ScopeLeaks(files, include_resolver(workspace))
