"""Launch files that include each other: what an include means in the workspace, and what a file takes and uses."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import NamedTuple, TypeVar

from ros_lint.analysis.memo import cached_by_workspace
from ros_lint.base.paths import parent, resolve, strip_folder
from ros_lint.base.text import Span
from ros_lint.collectors.symbolic_text import OWN_FOLDER, UNKNOWN, fill, installed_place, is_plain, is_settled, named_in
from ros_lint.facts.launch import LaunchAction, LaunchFile, LaunchValue, values_of_action, walk_actions
from ros_lint.facts.sources import ParameterFile
from ros_lint.workspace.model import Package, Workspace

File = TypeVar("File", LaunchFile, ParameterFile)


class InstalledLaunchFile(NamedTuple):
    """A launch file of the workspace, where it is installed."""

    package: Package
    file: LaunchFile
    path: str
    """Below share/<package>."""


class AcceptedArguments(NamedTuple):
    """What a launch file and those that it includes do with launch configurations."""

    required: Mapping[str, Span]
    """Arguments without default that the file itself declares, whatever else is so, with where it does."""
    known: frozenset[str]
    """Names that are declared, set or used."""
    complete: bool
    """Whether every include could be followed, so that no other name can matter."""


class _Own(NamedTuple):
    """The same of one file, and the files that it includes."""

    required: Mapping[str, Span]
    known: set[str]
    complete: bool
    includes: list[LaunchFile]


def installed_below_share(package: Package, files: Iterable[File]) -> Iterator[tuple[File, str]]:
    """Yield those files of a package that it installs below share/<package>, each with its path there."""
    by_source = {strip_folder(package.path, file.path): file for file in files}
    share = f"share/{package.name}/"
    for provided in package.built.installs if by_source else ():
        file = by_source.get(provided.source)
        if file is not None and provided.path.startswith(share):
            yield file, provided.path[len(share) :]


class IncludeResolver:
    """All launch files of a workspace by where they are installed."""

    def __init__(self, packages: Iterable[Package]) -> None:
        self._by_path: dict[tuple[str, str], list[InstalledLaunchFile]] = {}
        self._places: dict[str, InstalledLaunchFile] = {}
        self._takes: dict[str, AcceptedArguments] = {}
        self._owns: dict[str, _Own] = {}
        self._sets: dict[str, Mapping[str, tuple[str, ...]]] = {}
        for package in packages:
            for file, path in installed_below_share(package, package.launch):
                linked = InstalledLaunchFile(package, file, path)
                self._by_path.setdefault((package.name, path), []).append(linked)
                self._places.setdefault(file.path, linked)

    def target(self, value: LaunchValue | None, source: LaunchFile) -> InstalledLaunchFile | None:
        """Return the one launch file of the workspace that an include in a file means, None when it is not that clear."""
        texts = (
            () if value is None else value.texts if all(map(is_settled, value.texts)) else substitute(value, self._set_in(source))
        )
        if len(texts) != 1:
            return None
        place = self.installed_at(texts[0], source)
        found = self._by_path.get(place, []) if place is not None else []
        return found[0] if len(found) == 1 else None

    def _set_in(self, file: LaunchFile) -> Mapping[str, tuple[str, ...]]:
        """Return the configurations that a file sets for itself, and that nobody can give it as arguments."""
        done = self._sets.get(file.path)
        if done is None:
            asked = [action.target for action in walk_actions(file.actions) if action.kind == "argument" and action.target]
            arguments = {name for target in asked for name in target.texts}
            done = {name: texts for name, texts in assigned_configurations(file).items() if name not in arguments}
            self._sets[file.path] = done
        return done

    def installed_at(self, text: str, source: LaunchFile) -> tuple[str, str] | None:
        """Return the package, and the place below its share folder, that a path in a launch file means; None if unclear."""
        if not is_settled(text):
            return None
        if text.startswith(f"{OWN_FOLDER}/"):
            own = self._places.get(source.path)
            if own is None:
                return None
            return own.package.name, resolve(parent(own.path), text[len(OWN_FOLDER) + 1 :])
        place = installed_place(text)
        return (place.package, place.share) if place is not None and place.share else None

    def place(self, file: LaunchFile) -> InstalledLaunchFile | None:
        """Return where a launch file is installed, None when it is not."""
        return self._places.get(file.path)

    def included(self, path: str) -> LaunchFile | None:
        """Return the launch file at an install place, such as includes name."""
        place = installed_place(path)
        found = self._by_path.get((place.package, place.share or ""), []) if place is not None else []
        return found[0].file if len(found) == 1 else None

    def includes(self, file: LaunchFile) -> list[LaunchFile]:
        """Return the launch files of the workspace that a file is sure to mean where it includes some."""
        return self._own(file).includes

    def takes(self, file: LaunchFile) -> AcceptedArguments:
        """Return what a file does with launch configurations, and those that it includes, each read once."""
        done = self._takes.get(file.path)
        if done is not None:
            return done
        own = self._own(file)
        known, complete = set(own.known), own.complete
        seen = {file.path}
        waiting = list(own.includes)
        while waiting:
            inner = waiting.pop()
            if inner.path not in seen:
                seen.add(inner.path)
                found = self._own(inner)
                known |= found.known
                complete = complete and found.complete
                waiting += found.includes
        takes = self._takes[file.path] = AcceptedArguments(own.required, frozenset(known), complete)
        return takes

    def _own(self, file: LaunchFile) -> _Own:
        done = self._owns.get(file.path)
        if done is not None:
            return done
        known = configurations_read(file)
        complete = not file.problems and not file.opaque and all(map(is_plain, known))
        includes: list[LaunchFile] = []
        for action in walk_actions(file.actions):
            if action.kind in ("argument", "set") and action.target is not None:
                known.update(action.target.texts)
                complete = complete and all(is_plain(text) for text in action.target.texts)
            if action.kind == "include":
                inner = self.target(action.target, file)
                complete = complete and inner is not None
                includes += [inner.file] if inner is not None else []
        own = self._owns[file.path] = _Own(dict(_required(file.actions)), known, complete, includes)
        return own


def configurations_read(file: LaunchFile) -> set[str]:
    """Return the launch configurations that a file asks for, UNKNOWN among them if others may be meant."""
    found = set(file.configurations_read)
    if file.language == "python":  # of the others, the text says it all
        for action in walk_actions(file.actions):
            for text, _ in values_of_action(action):
                if not text.isascii():
                    found.update(name for name in named_in(text) or () if not name.startswith("$"))
    return found


def assigned_configurations(file: LaunchFile) -> dict[str, tuple[str, ...]]:
    """Return the launch arguments and configurations that a file sets, each with all values that it gives it."""
    found: dict[str, tuple[str, ...]] = {}
    for action in walk_actions(file.actions):
        if action.kind in ("argument", "set") and action.target is not None and action.value is not None:
            for name in action.target.texts:
                found[name] = (*found.get(name, ()), *action.value.texts)
    return found


def substitute(value: LaunchValue | None, defaults: Mapping[str, tuple[str, ...]]) -> tuple[str, ...]:
    """Return what a value can be when launch configurations have some values, () for none."""
    if value is None:
        return ()
    if all(map(is_settled, value.texts)):
        return value.texts
    texts = (one for text in value.texts for one in fill(text, defaults.get, lambda expression: UNKNOWN))
    return tuple(dict.fromkeys(texts))


def _required(actions: Iterable[LaunchAction]) -> Iterator[tuple[str, Span]]:
    """Yield the arguments that must be given, each with its place: declared at the top, without default, under no condition."""
    for action in actions:
        if action.kind == "argument" and action.value is None and not action.conditions and action.target is not None:
            yield from ((text, action.span) for text in action.target.texts if is_plain(text))


@cached_by_workspace
def include_resolver(workspace: Workspace) -> IncludeResolver:
    """Return which launch file of the workspace an include means."""
    return IncludeResolver(workspace.packages)
