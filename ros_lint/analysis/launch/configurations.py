"""The launch configurations that launch files declare, set and read."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import NamedTuple

from ros_lint.analysis.launch.includes import MOST_RELATED, configurations_read, include_resolver
from ros_lint.analysis.launch.workspace_files import launch_file
from ros_lint.analysis.memo import cached_by_name, cached_by_workspace
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


@cached_by_name
def _names(workspace: Workspace, path: str) -> FileConfigurations | None:
    file = launch_file(workspace, path)
    return names_of(file) if file is not None else None


class _Includes(NamedTuple):
    """The include relation between the launch files of a workspace, by path."""

    includers: Mapping[str, frozenset[str]]
    included: Mapping[str, frozenset[str]]


@cached_by_workspace
def _relation(workspace: Workspace) -> _Includes:
    links = include_resolver(workspace)
    includers: dict[str, set[str]] = {}
    included: dict[str, frozenset[str]] = {}
    for package in workspace.packages:
        for file in package.launch:
            if inner := frozenset([target.path for target in links.includes(file)]):
                included[file.path] = inner
                for path in inner:
                    includers.setdefault(path, set()).add(file.path)
    return _Includes({path: frozenset(paths) for path, paths in includers.items()}, included)


@cached_by_workspace
def _all_set_or_passed(workspace: Workspace) -> frozenset[str]:
    return frozenset(name for names in _of_all(workspace) for name in names.set_or_passed)


@cached_by_workspace
def _filling(workspace: Workspace) -> frozenset[str]:
    """Return the paths of the launch files that may read any configuration."""
    paths = [file.path for package in workspace.packages for file in package.launch]
    return frozenset([path for path in paths if (names := _names(workspace, path)) is not None and names.may_read_any])


def _of_all(workspace: Workspace) -> Iterator[FileConfigurations]:
    for package in workspace.packages:
        for file in package.launch:
            if (names := _names(workspace, file.path)) is not None:
                yield names


@cached_by_name
def _fills(workspace: Workspace, path: str) -> bool:
    if not _filling(workspace):
        return False
    related = _related(workspace, path)
    return related is None or not related.isdisjoint(_filling(workspace))


def _related(workspace: Workspace, path: str) -> set[str] | None:
    """Return the paths of a file and of the files above and below it in the tree of includes. None if there are too many."""
    includers, included = _relation(workspace)
    above, below = _reached(includers, path), _reached(included, path)
    return {path} | above | below if above is not None and below is not None else None


@cached_by_name
def _declares_all(workspace: Workspace, path: str) -> bool:
    related, all_above = _related(workspace, path), _above(workspace, path)
    if related is None or all_above is None or any(_may_declare_any(workspace, other) for other in sorted(related)):
        return False
    return not any(_is_for_callers(workspace, above) for above in all_above)


@cached_by_name
def _is_for_callers(workspace: Workspace, path: str) -> bool:
    """Return whether launch files outside of the workspace probably include a launch file, so that they may set configurations.

    It requires arguments, but no launch file of the workspace includes it.
    """
    file = launch_file(workspace, path)
    return file is not None and _above(workspace, path) == () and bool(include_resolver(workspace).takes(file).required)


@cached_by_name
def _may_declare_any(workspace: Workspace, path: str) -> bool:
    """Return whether a launch file has an action that may declare or set unknown configurations."""
    file, names, links = launch_file(workspace, path), _names(workspace, path), include_resolver(workspace)
    if file is None or names is None or not names.complete:
        return True
    return any(
        action.kind == "other" or (action.kind == "include" and links.target(action.target, file) is None)
        for action in walk_actions(file.actions)
    )


@cached_by_name
def _above(workspace: Workspace, path: str) -> tuple[str, ...] | None:
    above = _reached(_relation(workspace).includers, path)
    return tuple(sorted(above)) if above is not None else None


class IncludeTree:
    """The include relation between the launch files of a workspace: the files that each launch file includes."""

    def __init__(self, workspace: Workspace) -> None:
        self._workspace = workspace

    @property
    def set_or_passed(self) -> frozenset[str]:
        """Configurations that any launch file sets, or passes to another launch file."""
        return _all_set_or_passed(self._workspace)

    def names(self, file: LaunchFile) -> FileConfigurations:
        """Return the configurations of a launch file itself, not of its included files."""
        return _names(self._workspace, file.path) or names_of(file)

    def fill(self, file: LaunchFile) -> bool:
        """Return whether ``file``, or a launch file above or below it in the tree of includes, may read any configuration.

        This is the case for a launch file that substitutes configurations in a parameter file: users can replace the
        parameter file by one with further configurations. It is assumed if there are too many files above or below.
        """
        return _fills(self._workspace, file.path)

    def declares_all(self, file: LaunchFile) -> bool:
        """Return whether all configurations are known that ``file`` and the files above and below it declare or set.

        They are not known if one of these files includes an unknown launch file, or has an action of an unknown class. Nor are
        they if a file above requires arguments, but nothing in the workspace includes it, because a file outside may do so, or
        if there are too many files above or below.
        """
        return _declares_all(self._workspace, file.path)

    def above(self, file: LaunchFile) -> list[FileConfigurations] | None:
        """Return the configurations of every file that includes ``file``, directly or indirectly. None if there are too many."""
        paths = _above(self._workspace, file.path)
        if paths is None:
            return None
        found = [_names(self._workspace, path) for path in paths]
        return [names for names in found if names is not None]

    def includers(self, path: str) -> frozenset[str]:
        """Return the paths of the launch files that certainly include the launch file at ``path``."""
        return _relation(self._workspace).includers.get(path, frozenset())


@cached_by_workspace
def include_tree(workspace: Workspace) -> IncludeTree:
    """Return the include relation between the launch files of a workspace."""
    return IncludeTree(workspace)


def _reached(edges: Mapping[str, frozenset[str]], start: str) -> set[str] | None:
    """Return the paths that can be reached over ``edges`` from the path ``start``, without ``start`` itself.

    The result is None if there are more than :data:`MOST_RELATED`.
    """
    seen = {start}
    waiting = [start]
    while waiting:
        if len(seen) > MOST_RELATED:
            return None
        new = edges.get(waiting.pop(), frozenset()) - seen
        seen |= new
        waiting += new
    return seen - {start}
