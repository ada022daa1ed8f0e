"""Includes between launch files, and the arguments that a launch file accepts."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import NamedTuple, TypeVar

from ros_lint.analysis.memo import cached_by_workspace
from ros_lint.base.paths import parent, resolve, strip_folder
from ros_lint.base.text import Span
from ros_lint.collectors.symbolic_text import OWN_FOLDER, UNKNOWN, fill, installed_place, is_plain, is_settled, named_in
from ros_lint.facts.launch import ACCEPTED_PROBLEMS, LaunchAction, LaunchFile, LaunchValue, values_of_action, walk_actions
from ros_lint.facts.sources import ParameterFile
from ros_lint.workspace.model import Package, Workspace

File = TypeVar("File", LaunchFile, ParameterFile)


class InstalledLaunchFile(NamedTuple):
    """A launch file of the workspace at its install path."""

    package: Package
    """The package that installs the launch file."""
    file: LaunchFile
    """The launch file."""
    path: str
    """Path below share/<package>."""


class AcceptedArguments(NamedTuple):
    """The launch configurations that a launch file and its included files accept."""

    required: Mapping[str, Span]
    """Arguments that the file itself declares unconditionally and without a default, with the places of the declarations."""
    known: frozenset[str]
    """Names of all configurations that the file or an included file declares, sets or reads."""
    complete: bool
    """True if every include could be resolved, so that no other name is accepted."""


class _Own(NamedTuple):
    """The configurations of one launch file, without those of its included files, and the files that it includes."""

    required: Mapping[str, Span]
    known: set[str]
    complete: bool
    includes: list[LaunchFile]


def installed_below_share(package: Package, files: Iterable[File]) -> Iterator[tuple[File, str]]:
    """Yield the files that the package installs below share/<package>, each with its path below that folder."""
    by_source = {strip_folder(package.path, file.path): file for file in files}
    share = f"share/{package.name}/"
    for provided in package.built.products.installs if by_source else ():
        file = by_source.get(provided.source)
        if file is not None and provided.path.startswith(share):
            yield file, provided.path[len(share) :]


class IncludeResolver:
    """Resolves includes to the launch files of a workspace by their install paths."""

    def __init__(self, packages: Iterable[Package]) -> None:
        self._by_path: dict[tuple[str, str], list[InstalledLaunchFile]] = {}
        self._places: dict[str, InstalledLaunchFile] = {}
        self._takes: dict[str, AcceptedArguments] = {}
        self._owns: dict[str, _Own] = {}
        self._sets: dict[str, Mapping[str, tuple[str, ...]]] = {}
        self._launch: list[tuple[LaunchFile, ...]] = []
        for package in packages:
            self._launch.append(package.launch)
            for file, path in installed_below_share(package, package.launch):
                linked = InstalledLaunchFile(package, file, path)
                self._by_path.setdefault((package.name, path), []).append(linked)
                self._places.setdefault(file.path, linked)

    def __eq__(self, other: object) -> bool:
        """Return whether both resolvers have equal launch files at equal places, and so give the same answers."""
        if not isinstance(other, IncludeResolver):
            return False
        return (self._launch, self._by_path, self._places) == (other._launch, other._by_path, other._places)

    __hash__ = None  # type: ignore[assignment]

    def target(self, value: LaunchValue | None, source: LaunchFile) -> InstalledLaunchFile | None:
        """Return the launch file of the workspace to which an include in ``source`` refers.

        ``value`` is the path in the include. The result is None if the path is unknown, or if not exactly one launch file of the
        workspace is installed there.
        """
        texts = (
            () if value is None else value.texts if all(map(is_settled, value.texts)) else substitute(value, self._set_in(source))
        )
        if len(texts) != 1:
            return None
        place = self.installed_at(texts[0], source)
        candidates = self._by_path.get(place, []) if place is not None else []
        return candidates[0] if len(candidates) == 1 else None

    def _set_in(self, file: LaunchFile) -> Mapping[str, tuple[str, ...]]:
        """Return the values of the launch configurations that a file sets.

        Launch arguments of the file are left out, because callers can change them.
        """
        done = self._sets.get(file.path)
        if done is None:
            targets = [action.target for action in walk_actions(file.actions) if action.kind == "argument" and action.target]
            arguments = {name for target in targets for name in target.texts}
            done = {name: texts for name, texts in assigned_configurations(file).items() if name not in arguments}
            self._sets[file.path] = done
        return done

    def installed_at(self, text: str, source: LaunchFile) -> tuple[str, str] | None:
        """Return the installed file to which the path ``text`` in the launch file ``source`` leads.

        The result is a package and the path below its share folder, or None if the path is not completely known or is not in a
        share folder.
        """
        if not is_settled(text):
            return None
        if text.startswith(f"{OWN_FOLDER}/"):
            installed = self._places.get(source.path)
            if installed is None:
                return None
            return installed.package.name, resolve(parent(installed.path), text[len(OWN_FOLDER) + 1 :])
        place = installed_place(text)
        return (place.package, place.share) if place is not None and place.share else None

    def place(self, file: LaunchFile) -> InstalledLaunchFile | None:
        """Return a launch file with its install path, or None if it is not installed."""
        return self._places.get(file.path)

    def included(self, path: str) -> LaunchFile | None:
        """Return the launch file of the workspace that is installed at ``path``; None if there are none or several."""
        place = installed_place(path)
        candidates = self._by_path.get((place.package, place.share or ""), []) if place is not None else []
        return candidates[0].file if len(candidates) == 1 else None

    def includes(self, file: LaunchFile) -> list[LaunchFile]:
        """Return the launch files of the workspace that a file certainly includes."""
        return self._own(file).includes

    def takes(self, file: LaunchFile) -> AcceptedArguments:
        """Return the launch configurations that a file and its included files accept."""
        done = self._takes.get(file.path)
        if done is not None:
            return done
        record = self._own(file)
        known, complete = set(record.known), record.complete
        seen = {file.path}
        waiting = list(record.includes)
        while waiting:
            inner = waiting.pop()
            if inner.path not in seen:
                seen.add(inner.path)
                own_of_inner = self._own(inner)
                known |= own_of_inner.known
                complete = complete and own_of_inner.complete
                waiting += own_of_inner.includes
        takes = self._takes[file.path] = AcceptedArguments(record.required, frozenset(known), complete)
        return takes

    def _own(self, file: LaunchFile) -> _Own:
        done = self._owns.get(file.path)
        if done is not None:
            return done
        known = configurations_read(file)
        complete = _is_read_completely(file) and all(map(is_plain, known))
        includes: list[LaunchFile] = []
        for action in walk_actions(file.actions):
            if action.kind in ("argument", "set") and action.target is not None:
                known.update(action.target.texts)
                complete = complete and all(is_plain(text) for text in action.target.texts)
            if action.kind == "include":
                inner = self.target(action.target, file)
                complete = complete and inner is not None
                includes += [inner.file] if inner is not None else []
        record = self._owns[file.path] = _Own(dict(_required(file.actions)), known, complete, includes)
        return record


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
    result: dict[str, tuple[str, ...]] = {}
    for action in walk_actions(file.actions):
        if action.kind in ("argument", "set") and action.target is not None and action.value is not None:
            for name in action.target.texts:
                result[name] = (*result.get(name, ()), *action.value.texts)
    return result


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
    return IncludeResolver(workspace.packages)
