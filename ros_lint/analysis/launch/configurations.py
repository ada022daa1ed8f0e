"""The launch configurations that launch files declare, set and read."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import NamedTuple

from ros_lint.analysis.launch.includes import IncludeResolver, configurations_read, include_resolver
from ros_lint.analysis.memo import cached_by_workspace
from ros_lint.base.text import Span
from ros_lint.collectors.symbolic_text import configurations, is_plain
from ros_lint.facts.launch import LaunchFile, values_of_action, walk_actions
from ros_lint.workspace.model import Workspace


class FileConfigurations(NamedTuple):
    """The launch configurations of one launch file."""

    declared: Mapping[str, Span]
    """The launch arguments that the file declares, with the place of each declaration."""
    set_or_passed: frozenset[str]
    """Configurations that the file sets by an action, or passes to an included file. They stay set after the include."""
    read: frozenset[str]
    """Configurations that the file reads."""
    complete: bool
    """True if all names of configurations in the file are known."""
    may_read_any: bool
    """True if the file substitutes configurations in parameter files.

    Users can replace the parameter files, so that any configuration may be read.
    """


def names_of(file: LaunchFile) -> FileConfigurations:
    """Return the launch configurations that a file itself, not its included files, declares, sets, passes and reads."""
    declared: dict[str, Span] = {}
    set_or_passed: set[str] = set()
    read = configurations_read(file)
    complete = not file.problems and not file.opaque and all(map(is_plain, read))
    for action in walk_actions(file.actions):
        if action.kind in ("include", "group"):
            set_or_passed.update(name for name, _ in action.arguments)
        elif action.kind == "set" and action.target is not None:
            set_or_passed.update(action.target.texts)
        elif action.kind == "argument" and action.target is not None:
            declared.update((name, action.span) for name in action.target.texts if name not in declared)
    complete = complete and all(map(is_plain, (*set_or_passed, *declared)))
    return FileConfigurations(declared, frozenset(set_or_passed), frozenset(read), complete, file.substitutes_parameters)


def required_configurations(file: LaunchFile, names: frozenset[str]) -> dict[str, Span]:
    """Return the configurations in ``names`` that callers of a launch file have to set, because it reads them without a default.

    Each comes with the place where the file first reads it without a default.
    """
    return {name: span for (name, has_default), span in read_sites(file, names).items() if not has_default}


def read_sites(file: LaunchFile, names: frozenset[str]) -> dict[tuple[str, bool], Span]:
    """Return the first places where a launch file reads the configurations in ``names``: with a default, and without.

    The keys are pairs: the name of a configuration, and True if the file reads it with a default.
    """
    result: dict[tuple[str, bool], Span] = {}
    for action in walk_actions(file.actions):
        for text, span in values_of_action(action):
            for name, has_default, _ in configurations(text):
                if name in names:
                    result.setdefault((name, bool(has_default)), span)
    return result


class IncludeTree:
    """The include relation between the launch files of a workspace: the files that each launch file includes."""

    def __init__(self, files: Iterable[LaunchFile], links: IncludeResolver) -> None:
        self._names = {file.path: names_of(file) for file in files}
        self._includers: dict[str, set[str]] = {}
        self._included: dict[str, set[str]] = {}
        self.set_or_passed = frozenset().union(*(names.set_or_passed for names in self._names.values()))
        """Configurations that any launch file sets, or passes to another launch file."""
        self._filling = {path for path, names in self._names.items() if names.may_read_any}
        self._filled: dict[str, bool] = {}
        for file in files:
            for inner in links.includes(file):
                self._includers.setdefault(inner.path, set()).add(file.path)
                self._included.setdefault(file.path, set()).add(inner.path)

    def names(self, file: LaunchFile) -> FileConfigurations:
        """Return the configurations of a launch file itself, not of its included files."""
        return self._names[file.path]

    def fill(self, file: LaunchFile) -> bool:
        """Return whether ``file``, or a launch file above or below it in the tree of includes, may read any configuration.

        This is the case for a launch file that substitutes configurations in a parameter file: users can replace the
        parameter file by one with further configurations.
        """
        if not self._filling:
            return False
        path = file.path
        if path not in self._filled:
            related = {path} | _reached(self._includers, path) | _reached(self._included, path)
            self._filled[path] = not related.isdisjoint(self._filling)
        return self._filled[path]

    def above(self, file: LaunchFile) -> list[FileConfigurations]:
        """Return the configurations of every file that includes ``file``, directly or indirectly."""
        return [self._names[path] for path in sorted(_reached(self._includers, file.path))]


@cached_by_workspace
def include_tree(workspace: Workspace) -> IncludeTree:
    """Return the include relation between the launch files of a workspace."""
    files = [file for package in workspace.packages for file in package.launch]
    return IncludeTree(files, include_resolver(workspace))


def _reached(edges: Mapping[str, set[str]], start: str) -> set[str]:
    """Return the paths that can be reached over ``edges`` from the path ``start``, without ``start`` itself."""
    seen = {start}
    waiting = [start]
    while waiting:
        new = edges.get(waiting.pop(), set()) - seen
        seen |= new
        waiting += new
    return seen - {start}
