"""From discovered packages and the facts of files to packages with evaluated scripts and launch files, for one distribution.

Facts are the data that collectors extract from one file.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from functools import partial
from typing import NamedTuple, TypeVar

from ros_lint.base.paths import join
from ros_lint.base.questions import Cell, Memo, Questions, Recorder
from ros_lint.base.text import file_start
from ros_lint.base.tree import Tree
from ros_lint.collectors.manifest import conditions
from ros_lint.facts.build import BuildScript
from ros_lint.facts.launch import LaunchFile
from ros_lint.facts.manifest import DEPENDENCY_KINDS, ROLES, Manifest, Role
from ros_lint.facts.sources import FileFacts, MachinePath
from ros_lint.facts.suppressions import Suppression
from ros_lint.facts.visibility import Opaque
from ros_lint.workspace import launch_modules
from ros_lint.workspace.build_scripts import evaluate as build_scripts
from ros_lint.workspace.build_scripts.sources import Parts
from ros_lint.workspace.collected import Collected
from ros_lint.workspace.discovery.discover import DiscoveredPackage
from ros_lint.workspace.join import ReadPackage
from ros_lint.workspace.model import Declared
from ros_lint.workspace.target import TargetDistro, UnreadFile

T = TypeVar("T")

_NO_ROLE = Role(0)


class Read(NamedTuple):
    """The packages of a tree with the facts of their files, for one distribution."""

    packages: list[ReadPackage]
    evaluation: build_scripts.Evaluation
    launch: list[tuple[LaunchFile, ...]]
    """The launch files of each package. They include references that apply only to other distributions."""


class _Entry(NamedTuple):
    """A package with all facts of its files."""

    package: DiscoveredPackage
    files: Mapping[str, Collected]
    """The facts, by path relative to the package."""


class Reading:
    """Reads packages for a distribution. With a ``recorder``, only what has changed since the last call is read again."""

    def __init__(self, tree: Tree, target: TargetDistro, recorder: Recorder | None) -> None:
        self._target = target
        self._recorder = recorder
        self._questions: Questions = recorder.scope() if recorder else Memo()
        self._entries: dict[str, _Entry] = {}
        self._cells: dict[str, Cell] = {}
        self._paths: list[str] = []
        self._scripts = build_scripts.Scripts(tree, target.distro, recorder)
        self._launch = launch_modules.LaunchModules(tree, recorder)
        self._ready: dict[str, tuple[tuple[object, ...], ReadPackage]] = {}

    def read(
        self,
        packages: Sequence[DiscoveredPackage],
        collected: Mapping[str, Collected],
        touched: Collection[str],
        earlier: Read | None = None,
    ) -> Read:
        """Return the packages with the facts of their files, which are ``collected``, by path.

        ``touched`` are the folders of packages with other facts than in the last call. Packages that were not in the last call
        may have other facts, too. ``earlier`` is the result for another distribution, which is reused as far as possible.
        """
        self._renew(packages, collected, touched)
        parts = [self._ask(path, self._parts) for path in self._paths]
        evaluation = self._scripts.evaluate(parts, earlier.evaluation if earlier else None)
        if earlier and evaluation.helpers is earlier.evaluation.helpers:  # all scripts are the same
            launch = earlier.launch
        else:
            launch = self._launch.resolve(
                [
                    launch_modules.LaunchPackage(
                        package.name, package.path, package.files, script, self._ask(package.path, self._launch_files)
                    )
                    for package, script in zip(packages, evaluation.scripts, strict=True)
                ]
            )
        read_packages = [
            self._read_package(package, script, files)
            for package, script, files in zip(packages, evaluation.scripts, launch, strict=True)
        ]
        return Read(read_packages, evaluation, launch)

    @property
    def scripts(self) -> build_scripts.Scripts:
        """The build scripts of the packages that were read last."""
        return self._scripts

    def suppressions(self) -> Iterator[tuple[str, tuple[Suppression, ...]]]:
        """Yield the path of each file with suppression comments, and these comments."""
        for path in self._paths:
            yield from self._ask(path, self._suppressions)

    def unreadable(self) -> list[UnreadFile]:
        """Return the files that cannot be read or checked, sorted by path."""
        entries = [entry for path in self._paths for entry in self._ask(path, self._unreadable)]
        return [unread for _, unread in sorted(entries, key=lambda entry: entry[0])]

    def _renew(self, packages: Sequence[DiscoveredPackage], collected: Mapping[str, Collected], touched: Collection[str]) -> None:
        changed = []
        last = set(self._paths)
        for package in packages:
            folder = package.path
            before = self._entries.get(folder)
            if before is not None and before.package is package and folder in last and folder not in touched:
                continue
            files = {file: collected[path] for file in package.files if (path := join(folder, file)) in collected}
            if (
                before is None
                or before.package != package
                or before.files.keys() != files.keys()
                or any(facts is not before.files[file] for file, facts in files.items())
            ):
                self._entries[folder] = _Entry(package, files)
                changed.append(self._cells.setdefault(folder, Cell()))
        self._paths = [package.path for package in packages]
        if self._recorder:
            self._recorder.change(changed)

    def _ask(self, path: str, answer: Callable[[str], T]) -> T:
        return self._questions.ask((answer.__name__, path), partial(answer, path))

    def _entry(self, path: str) -> _Entry:
        if self._recorder:
            self._recorder.note(self._cells[path])
        return self._entries[path]

    def _declared(self, path: str) -> tuple[Declared, ...]:
        return declared_by(self._entry(path).package.manifest, self._target)

    def _parts(self, path: str) -> Parts:
        package, files = self._entry(path)
        commands = {file: c.commands for file, c in files.items() if c.commands is not None}
        return Parts.of(package, commands, kinds(self._ask(path, self._declared)))

    def _facts(self, path: str) -> Mapping[str, FileFacts]:
        return {file: c.facts for file, c in self._entry(path).files.items() if c.facts is not None}

    def _launch_files(self, path: str) -> tuple[LaunchFile, ...]:
        return tuple([c.launch for c in self._entry(path).files.values() if c.launch is not None])

    def _machine_paths(self, path: str) -> tuple[MachinePath, ...]:
        return tuple([place for c in self._entry(path).files.values() for place in c.machine_paths])

    def _suppressions(self, path: str) -> tuple[tuple[str, tuple[Suppression, ...]], ...]:
        return tuple([(join(path, file), c.suppressions) for file, c in self._entry(path).files.items() if c.suppressions])

    def _unreadable(self, folder: str) -> tuple[tuple[str, UnreadFile], ...]:
        result = []
        for file, c in self._entry(folder).files.items():
            path = join(folder, file)
            if c.unreadable:
                result.append((path, UnreadFile(path, c.unreadable, file_start(path))))
            for fact in (c.facts, c.launch):
                result += [(path, unread) for unread in unchecked(fact.opaque if fact is not None else ())]
        return tuple(result)

    def _read_package(
        self, package: DiscoveredPackage, script: BuildScript | None, launch: tuple[LaunchFile, ...]
    ) -> ReadPackage:
        """Return a package with its facts; the object of the last call if nothing has changed."""
        path = package.path
        declared, facts = self._ask(path, self._declared), self._ask(path, self._facts)
        machine_paths = self._ask(path, self._machine_paths)
        parts = (self._entries[path].package, declared, script, facts, launch, machine_paths)
        before = self._ready.get(path)
        if before and all(part is of_before for part, of_before in zip(parts, before[0], strict=True)):
            return before[1]
        of_distro = tuple([launch_modules.for_distro(self._target.distro, file) for file in launch])
        result = ReadPackage(self._entries[path].package, declared, script, facts, of_distro, machine_paths)
        self._ready[path] = parts, result
        return result


def declared_by(manifest: Manifest | None, target: TargetDistro) -> tuple[Declared, ...]:
    """Return each dependency tag of a package.xml whose condition is not false, with group, conflict and replace tags."""
    result = []
    context = target.context
    for depend in manifest.depends if manifest else ():
        truth = conditions.truth(depend.condition, context) if depend.condition else True
        if truth is not False:
            result.append(Declared(depend, ROLES.get(depend.tag, _NO_ROLE), truth is True))
    return tuple(result)


def kinds(declared: Sequence[Declared]) -> dict[str, tuple[str, ...]]:
    """Return the declared names by the letters of the dependency kinds, see :data:`ros_lint.facts.manifest.DEPENDENCY_KINDS`."""
    names: dict[str, list[str]] = {}
    for tag in declared:
        for kind in DEPENDENCY_KINDS[tag.depend.tag].letters:
            names.setdefault(kind, []).append(tag.depend.name)
    return {kind: tuple(of_kind) for kind, of_kind in names.items()}


def unchecked(opaque: Iterable[Opaque]) -> Iterator[UnreadFile]:
    """Yield the places that ros-lint does not check because of one of its limits or a bug in it."""
    yield from (UnreadFile(place.span.path, place.reason, place.span) for place in opaque if place.unchecked)
