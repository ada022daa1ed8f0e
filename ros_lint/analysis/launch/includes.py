"""Includes between launch files, and the arguments that a launch file accepts."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import Final, NamedTuple

from ros_lint.analysis.launch.workspace_files import file_owners, launch_file, launch_places
from ros_lint.analysis.memo import cached_by_name, cached_by_workspace
from ros_lint.base.paths import parent, resolve
from ros_lint.base.text import Span
from ros_lint.collectors.symbolic_text import OWN_FOLDER, UNKNOWN, fill, installed_place, is_plain, is_settled, named_in
from ros_lint.facts.launch import ACCEPTED_PROBLEMS, LaunchAction, LaunchFile, LaunchValue, values_of_action, walk_actions
from ros_lint.workspace.model import Package, Workspace


class InstalledLaunchFile(NamedTuple):
    """A launch file of the workspace at its install path."""

    package: Package
    """The package that installs the launch file."""
    file: LaunchFile
    """The launch file."""
    path: str
    """Path below share/<package>."""


MOST_RELATED: Final = 500
"""Maximum number of launch files above or below a launch file that are followed. Measured in 285 repositories: at most 61."""


class AcceptedArguments(NamedTuple):
    """The launch configurations that a launch file and its included files accept."""

    required: Mapping[str, Span]
    """Arguments that the file itself declares unconditionally and without a default, with the places of the declarations."""
    known: frozenset[str]
    """Names of all configurations that the file or an included file declares, sets or reads."""
    complete: bool
    """True if every include could be resolved, so that no other name is accepted.

    False, too, if there are more than :data:`MOST_RELATED` files below the file.
    """


class _Own(NamedTuple):
    """The configurations of one launch file, without those of its included files, and the files that it includes."""

    required: Mapping[str, Span]
    known: frozenset[str]
    complete: bool
    includes: tuple[str, ...]
    """The paths of the launch files of the workspace that the file certainly includes."""


@cached_by_name
def _sets(workspace: Workspace, path: str) -> Mapping[str, tuple[str, ...]]:
    """Return what :func:`_set_in` returns for the launch file at ``path``."""
    file = launch_file(workspace, path)
    return _set_in(file) if file is not None else {}


@cached_by_name
def _owns(workspace: Workspace, path: str) -> _Own | None:
    """Return the own configurations of the launch file at ``path``, None if there is none."""
    file = launch_file(workspace, path)
    return _own(file, include_resolver(workspace)) if file is not None else None


@cached_by_name
def _takes(workspace: Workspace, path: str) -> AcceptedArguments | None:
    """Return the configurations that the launch file at ``path`` and its included files accept, None if there is no such file."""
    own = _owns(workspace, path)
    return _with_included(workspace, path, own) if own is not None else None


def _with_included(workspace: Workspace, path: str, own: _Own) -> AcceptedArguments:
    known, complete = set(own.known), own.complete
    seen = {path}
    waiting = list(own.includes)
    while waiting:
        inner = waiting.pop()
        own_of_inner = _owns(workspace, inner) if inner not in seen else None
        if own_of_inner is not None:
            if len(seen) > MOST_RELATED:
                complete = False
                break
            seen.add(inner)
            known |= own_of_inner.known
            complete = complete and own_of_inner.complete
            waiting += own_of_inner.includes
    return AcceptedArguments(own.required, frozenset(known), complete)


class IncludeResolver:
    """Resolves includes to the launch files of a workspace by their install paths.

    The answers about one launch file depend only on this file and the files that it includes, so that they remain valid if
    another file changes.
    """

    def __init__(self, workspace: Workspace) -> None:
        self._workspace = workspace

    def target(self, value: LaunchValue | None, source: LaunchFile) -> InstalledLaunchFile | None:
        """Return the launch file of the workspace to which an include in ``source`` refers.

        ``value`` is the path in the include. The result is None if the path is unknown, or if not exactly one launch file of the
        workspace is installed there.
        """
        if value is None:
            return None
        texts = value.texts
        if not all(map(is_settled, texts)):
            of_workspace = self._is_of_workspace(source)
            texts = substitute(value, _sets(self._workspace, source.path) if of_workspace else _set_in(source))
        if len(texts) != 1:
            return None
        place = self.installed_at(texts[0], source)
        return self._only_file(*place) if place is not None else None

    def installed_at(self, text: str, source: LaunchFile) -> tuple[str, str] | None:
        """Return the installed file to which the path ``text`` in the launch file ``source`` leads.

        The result is a package and the path below its share folder, or None if the path is not completely known or is not in a
        share folder.
        """
        if not is_settled(text):
            return None
        if text.startswith(f"{OWN_FOLDER}/"):
            installed = self.place(source)
            if installed is None:
                return None
            return installed.package.name, resolve(parent(installed.path), text[len(OWN_FOLDER) + 1 :])
        place = installed_place(text)
        return (place.package, place.share) if place is not None and place.share else None

    def place(self, file: LaunchFile) -> InstalledLaunchFile | None:
        """Return a launch file with its install path, or None if it is not installed."""
        owner = file_owners(self._workspace).get(file.path)
        path = launch_places(owner, self._workspace).installed.get(file.path) if owner is not None else None
        return InstalledLaunchFile(owner, file, path) if owner is not None and path is not None else None

    def included(self, path: str) -> LaunchFile | None:
        """Return the launch file of the workspace that is installed at ``path``; None if there are none or several."""
        place = installed_place(path)
        found = self._only_file(place.package, place.share or "") if place is not None else None
        return found.file if found is not None else None

    def includes(self, file: LaunchFile) -> list[LaunchFile]:
        """Return the launch files of the workspace that a file certainly includes."""
        own = _owns(self._workspace, file.path) if self._is_of_workspace(file) else None
        paths = (own or _own(file, self)).includes
        return [inner for path in paths if (inner := launch_file(self._workspace, path)) is not None]

    def takes(self, file: LaunchFile) -> AcceptedArguments:
        """Return the launch configurations that a file and its included files accept."""
        done = _takes(self._workspace, file.path) if self._is_of_workspace(file) else None
        return done or _with_included(self._workspace, file.path, _own(file, self))

    def _only_file(self, package: str, path: str) -> InstalledLaunchFile | None:
        """Return the launch file that is installed to a path below share/<package>; None if there are none or several."""
        named = self._workspace.by_name.get(package, ())
        found = [(owner, source) for owner in named for source in launch_places(owner, self._workspace).sources.get(path, ())]
        if len(found) != 1:
            return None
        owner, source = found[0]
        file = launch_file(self._workspace, source)
        return InstalledLaunchFile(owner, file, path) if file is not None else None

    def _is_of_workspace(self, file: LaunchFile) -> bool:
        """Return whether a file is the launch file that the workspace has at its path, and not one that was read by a command."""
        known = launch_file(self._workspace, file.path)
        return known is file or known == file


def _own(file: LaunchFile, links: IncludeResolver) -> _Own:
    """Return the configurations of a file without those of its included files."""
    known = configurations_read(file)
    complete = _is_read_completely(file) and all(map(is_plain, known))
    includes: list[str] = []
    for action in walk_actions(file.actions):
        if action.kind in ("argument", "set") and action.target is not None:
            known.update(action.target.texts)
            complete = complete and all(is_plain(text) for text in action.target.texts)
        if action.kind == "include":
            inner = links.target(action.target, file)
            complete = complete and inner is not None
            includes += [inner.file.path] if inner is not None else []
    return _Own(dict(_required(file.actions)), frozenset(known), complete, tuple(includes))


def _set_in(file: LaunchFile) -> Mapping[str, tuple[str, ...]]:
    """Return the values of the launch configurations that a file sets.

    Launch arguments of the file are left out, because callers can change them.
    """
    targets = [action.target for action in walk_actions(file.actions) if action.kind == "argument" and action.target]
    arguments = {name for target in targets for name in target.texts}
    return {name: texts for name, texts in assigned_configurations(file).items() if name not in arguments}


_OF_VALUES = ACCEPTED_PROBLEMS | {"no-condition", "no-text", "removed-keyword", "substitution-refused", "text-divided"}
"""Kinds of problems in single values. In spite of them, all actions and arguments of the file are known."""


def _is_read_completely(file: LaunchFile) -> bool:
    return not file.opaque and all(problem.kind in _OF_VALUES for problem in file.problems)


def configurations_read(file: LaunchFile) -> set[str]:
    """Return the configurations that a launch file reads, and UNKNOWN if the file may read further configurations.

    Those that launch itself reads for the actions of the file are included.
    """
    names = set(file.configurations_read)
    for action in walk_actions(file.actions):
        names.update(_READ_BY_LAUNCH.get(action.kind, ()))
        if file.language == "python":  # in XML and YAML files, ``configurations_read`` is complete
            for text, _ in values_of_action(action):
                if not text.isascii():
                    names.update(name for name in named_in(text) or () if not name.startswith("$"))
    return names


_OF_PROCESSES = ("emulate_tty", "launch-prefix", "launch-prefix-filter", "sigkill_timeout", "sigterm_timeout")
"""Configurations read by ExecuteLocal (launch/actions/execute_local.py) and Executable (launch/descriptions/executable.py)."""
_OF_NODES = ("global_params", "ros_namespace", "ros_remaps")
"""Configurations read by Node (launch_ros/actions/node.py) and LoadComposableNodes (.../load_composable_nodes.py)."""
_READ_BY_LAUNCH = {"process": _OF_PROCESSES, "node": (*_OF_PROCESSES, *_OF_NODES), "component": _OF_NODES}
"""The configurations that launch itself reads when it performs an action of a kind."""


def assigned_configurations(file: LaunchFile) -> dict[str, tuple[str, ...]]:
    """Return the launch configurations that a file sets or declares with a default, each with all its values."""
    result: dict[str, list[str]] = {}
    for action in walk_actions(file.actions):
        if action.kind in ("argument", "set") and action.target is not None and action.value is not None:
            for name in action.target.texts:
                result.setdefault(name, []).extend(action.value.texts)
    return {name: tuple(texts) for name, texts in result.items()}


def substitute(value: LaunchValue | None, defaults: Mapping[str, tuple[str, ...]]) -> tuple[str, ...]:
    """Return the possible values of a text in a launch file.

    Launch configurations in the text are replaced by their values in ``defaults``. The result is () if ``value`` is None.
    """
    if value is None:
        return ()
    if all(map(is_settled, value.texts)):
        return value.texts
    texts = (filled for text in value.texts for filled in fill(text, defaults.get, lambda expression: UNKNOWN))
    return tuple(dict.fromkeys(texts))


def _required(actions: Iterable[LaunchAction]) -> Iterator[tuple[str, Span]]:
    """Yield the arguments that are declared at the top level, unconditionally and without a default, with their places."""
    for action in actions:
        if action.kind == "argument" and action.value is None and not action.conditions and action.target is not None:
            yield from ((text, action.span) for text in action.target.texts if is_plain(text))


@cached_by_workspace
def include_resolver(workspace: Workspace) -> IncludeResolver:
    """Return the resolver of includes for a workspace."""
    return IncludeResolver(workspace)
