"""Load a workspace: find the packages, collect the facts of each file once, evaluate the build scripts, join the results.

Facts are the data that a collector extracts from one file. A loader keeps them, so that a workspace with a few changed
files (to try out a fix) is loaded again without reading the other files.
"""

from __future__ import annotations

from collections.abc import Callable, Container, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from types import MappingProxyType
from typing import NamedTuple

from ros_lint.base.paths import is_below, is_outside, join, parent, strip_folder
from ros_lint.base.paths import resolve as resolve_path
from ros_lint.base.text import Text, file_start
from ros_lint.base.tree import OverlayTree, Tree, text_of
from ros_lint.collectors.file_types import kind_of
from ros_lint.collectors.manifest import conditions
from ros_lint.facts.launch import LaunchFile
from ros_lint.facts.manifest import DEPENDENCY_KINDS, ROLES, Manifest, Role
from ros_lint.facts.repositories import ExpectedRepositories
from ros_lint.facts.suppressions import Suppression
from ros_lint.facts.visibility import Opaque
from ros_lint.knowledge import Knowledge
from ros_lint.knowledge.providers import importable_modules
from ros_lint.knowledge.underlays import Underlay
from ros_lint.knowledge.world import Member, World
from ros_lint.workspace import launch_modules
from ros_lint.workspace.build_scripts import evaluate as build_scripts
from ros_lint.workspace.build_scripts.sources import Parts
from ros_lint.workspace.cache.facts import FactCache
from ros_lint.workspace.cache.file import NO_CACHE
from ros_lint.workspace.collect import collect_all
from ros_lint.workspace.collected import Collected
from ros_lint.workspace.discovery import repository_lists
from ros_lint.workspace.discovery.discover import DiscoveredPackage, Discovery, Skipped, discover
from ros_lint.workspace.discovery.ignore_files import find_ignores
from ros_lint.workspace.discovery.named_distros import named_distros
from ros_lint.workspace.join import Progress, ReadPackage, join_packages, unusable_package
from ros_lint.workspace.model import Declared, Package, Workspace
from ros_lint.workspace.side_by_side import hidden_namesakes, workspace_of
from ros_lint.workspace.target import NamedDistro, TargetDistro, UnreadFile

_NO_ROLE = Role(0)

_MOST_CONTEXT = 20_000
"""Maximum number of folders outside packages that are searched for context packages.

Context packages are not checked, but the checked packages may depend on them.
"""


class DistroData(NamedTuple):
    """A distribution to check for, with the data about its packages."""

    target: TargetDistro
    knowledge: Knowledge
    underlays: tuple[Underlay, ...] = ()


class _Found(NamedTuple):
    """The packages of a tree with their package.xml. No other files have been read."""

    roots: tuple[str, ...]
    """The folders in which packages were searched."""
    discovery: Discovery
    packages: list[DiscoveredPackage]
    """The discovered packages without excluded files. Git submodules that are not cloned count as unvisited folders."""
    lists: tuple[str, ...]
    """Paths of files that list repositories: ``*.repos``, ``*.rosinstall``, ``.gitmodules``."""
    unread_lists: tuple[UnreadFile, ...]
    expected: ExpectedRepositories

    @property
    def depends_on_distro(self) -> bool:
        """True if the build type of a package has a condition. Another distribution may then have other packages."""
        manifests = [*(package.manifest for package in self.discovery.packages), *self.discovery.rejected]
        exports = [export for manifest in manifests if manifest for export in manifest.exports]
        return any(export.tag == "build_type" and conditions.of(export) for export in exports)


class _Read(NamedTuple):
    """The packages of a tree with the facts (extracted data) of their files, for one distribution."""

    packages: list[ReadPackage]
    evaluation: build_scripts.Evaluation
    launch: list[tuple[LaunchFile, ...]]
    """The launch files of each package. They include references that apply only to other distributions."""


class Loader:
    """Loads the packages below ``roots`` of a tree, and the packages below ``context``, on which they may depend.

    Paths are relative to the base folder of the tree. ``others`` are further distributions to check for. :meth:`load_all` shares
    between all distributions the data that does not depend on the distribution.
    """

    def __init__(
        self,
        tree: Tree,
        roots: Sequence[str],
        target: TargetDistro,
        *,
        context: Sequence[str] = (),
        underlays: Sequence[Underlay] = (),
        knowledge: Knowledge | None = None,
        others: Sequence[DistroData] = (),
        exclude: Callable[[str], bool] = lambda path: False,
        jobs: int = 0,
        cache: FactCache | None = None,
        progress: Progress = lambda step, finished, total: None,
    ) -> None:
        self.tree = tree
        self.pinned: dict[str, bytes] = {}
        """Contents, by path, of the files that :meth:`pin` has read."""
        self._original_tree = tree
        self._roots = tuple(roots)
        self._around = tuple(context)
        self._distros = (DistroData(target, knowledge or Knowledge(target.distro), tuple(underlays)), *others)
        self._exclude = exclude
        self._jobs = jobs
        self._cache = cache or FactCache(NO_CACHE)
        self._progress = progress
        self._collected: dict[str, Collected] = {}
        self._named_distros: tuple[NamedDistro, ...] | None = None

    def load(self, changed: Mapping[str, bytes] | None = None, *, sources: bool = True) -> Workspace:
        """Return the workspace for the first distribution. ``changed`` has new contents of files, by path.

        Without ``sources`` only package.xml files are read, which suffices for questions about the dependency graph. Build
        scripts, launch files and uses are then missing, so rules must not run.
        """
        return next(self._load(changed or {}, sources))

    def load_all(self, changed: Mapping[str, bytes] | None = None) -> tuple[Workspace, ...]:
        """Return the workspace for each distribution. ``changed`` has new contents of files, by path."""
        return tuple(self._load(changed or {}, sources=True))

    def _load(self, changed: Mapping[str, bytes], sources: bool) -> Iterator[Workspace]:
        """Yield the workspace for each distribution. ``changed`` has new contents of files, by path."""
        tree = OverlayTree(self.tree, changed) if changed else self.tree
        self._progress("looking for packages", 0, 0)
        found: _Found | None = None
        collected: Mapping[str, Collected] = {}
        read: _Read | None = None
        for data in self._distros:
            if found is None or found.depends_on_distro:
                found = self._find(tree, data.target)
                collected = self._collect(found.packages, changed) if sources else {}
            if sources:
                read = self._read(tree, found.packages, collected, data.target, read)
            packages = read.packages if read else [_manifest_only(package, data.target) for package in found.packages]
            yield self._join(tree, found, collected, packages, data, sources)

    def _find(self, tree: Tree, target: TargetDistro) -> _Found:
        """Return the packages that colcon finds for a distribution."""
        roots, discovery = self._discover(tree, target)
        packages = [self._without_excluded(package) for package in discovery.packages if not self._exclude(package.path)]
        files = [join(package.path, file) for package in packages for file in package.files]
        lists = repository_lists.find_lists(tree, roots, (*files, *discovery.repository_lists))
        submodules = repository_lists.submodules(tree, lists)
        packages = _without_submodules(packages, submodules)
        places = [(package.name, package.path) for package in packages]
        unread_lists = tuple(repository_lists.unreadable_lists(tree, lists))
        expected = repository_lists.expected_repositories(tree, lists, submodules, places)._replace(complete=not unread_lists)
        return _Found(roots, discovery, packages, lists, unread_lists, expected)

    def _join(
        self,
        tree: Tree,
        found: _Found,
        collected: Mapping[str, Collected],
        read_packages: Sequence[ReadPackage],
        data: DistroData,
        sources: bool,
    ) -> Workspace:
        """Return the workspace of the packages.

        If the repository contains several workspaces with packages of equal names, the result has a further Workspace object
        for each of them, see :meth:`Workspace.seen_from`.
        """
        rejected_manifests = found.discovery.rejected
        world = _world(read_packages, rejected_manifests, data, found.expected)
        hidden = hidden_namesakes(
            [
                *((package.name, package.path) for package in found.packages),
                *((manifest.name, parent(manifest.path)) for manifest in rejected_manifests),
            ]
        )
        shared = [read for read in read_packages if not hidden or workspace_of(read.discovered.path) not in hidden]
        packages = tuple(join_packages(tree, read_packages, shared, world, self._progress, search=sources))
        worlds: dict[str, World] = {}
        for folder, paths in hidden.items():
            visible = [read for read in read_packages if read.discovered.path not in paths]
            own = [read for read in visible if workspace_of(read.discovered.path) == folder]
            rejected = [manifest for manifest in rejected_manifests if parent(manifest.path) not in paths]
            worlds[folder] = _world(visible, rejected, data, found.expected)
            packages += tuple(join_packages(tree, visible, own, worlds[folder], self._progress, search=sources))
        packages = tuple(sorted(packages, key=lambda package: package.path)) if hidden else packages
        unusable = tuple(unusable_package(manifest) for manifest in rejected_manifests if not self._exclude(manifest.path))
        ignores = find_ignores(tree, ((package.path, package.files) for package in found.packages))
        unread_files = (
            *found.discovery.not_checked,
            *found.unread_lists,
            *ignores.not_checked,
            *_unreadable(collected),
        )
        not_checked = tuple(dict.fromkeys((*unread_files, *_unchecked_scripts(read_packages))))

        named = self._distros_named_in(tree, found.roots)
        untracked = frozenset(_untracked(tree, packages))

        def seen(world: World, without: Container[str] = (), views: Mapping[str, Workspace] = MappingProxyType({})) -> Workspace:
            kept = [tuple([package for package in group if package.path not in without]) for group in (packages, unusable)]
            return Workspace(
                kept[0], kept[1], world, data.target, not_checked, found.lists, ignores.patterns, views, named, untracked
            )

        return seen(world, (), {folder: seen(of_folder, hidden[folder]) for folder, of_folder in worlds.items()})

    def pin(self, paths: Iterable[str]) -> None:
        """Read some files again and fix their contents for all further loads, even if the files change on disk.

        A file that cannot be read is left out.
        """
        for path in paths:
            with suppress(OSError):
                self.pinned[path] = self._original_tree.read(path)
        self.tree = OverlayTree(self._original_tree, self.pinned)
        self._collected = dict(self._collected_with(self.pinned))

    def forget(self, paths: Iterable[str]) -> bool:
        """Discard the facts (extracted data) of some files, so that the next load reads the files again.

        Returns False if the loader had no facts of one of the files, because data of this file may then be kept elsewhere.
        """
        forgotten = [self._collected.pop(path, None) for path in paths]
        return None not in forgotten

    def text(self, path: str) -> Text | None:
        """Return the text of a file, None if the file cannot be read."""
        return text_of(self.tree, path)

    def suppressions(self, changed: Mapping[str, bytes] | None = None) -> Iterator[Suppression]:
        """Yield the suppression comments in all files of the loaded packages."""
        collected = self._collected_with(changed or {})
        for path in sorted(collected):
            yield from collected[path].suppressions

    def _discover(self, tree: Tree, target: TargetDistro) -> tuple[tuple[str, ...], Discovery]:
        """Return the folders that were searched, and the packages in them.

        The folders are those of the context: the requested folders, and the folders with packages on which the requested
        packages may depend. Only the requested folders are searched if

        * the context has too many folders, or
        * colcon finds nothing in a requested folder when it starts from the context, for example because an outer folder is
          ignored.
        """
        if self._around:
            around = discover(tree, self._around, target.context, _MOST_CONTEXT)
            places = [*(package.path for package in around.packages), *(parent(manifest.path) for manifest in around.rejected)]
            if around.complete and all(any(is_below(place, root) for place in places) for root in self._roots):
                return self._around, around
            if not around.complete:
                why = f"there are more than {_MOST_CONTEXT} folders; the requested packages were checked without context"
                requested = discover(tree, self._roots, target.context)
                return self._roots, requested._replace(not_checked=(*requested.not_checked, UnreadFile("context", why, None)))
        return self._roots, discover(tree, self._roots, target.context)

    def _distros_named_in(self, tree: Tree, roots: Sequence[str]) -> tuple[NamedDistro, ...]:
        """Return the distributions that the repository builds for."""
        if self._named_distros is None:
            known = self._distros[0].knowledge.distributions
            self._named_distros = named_distros(tree, roots, known) if known else ()
        return self._named_distros

    def _without_excluded(self, package: DiscoveredPackage) -> DiscoveredPackage:
        return package._replace(files=tuple(file for file in package.files if not self._exclude(join(package.path, file))))

    def _collect(self, discovered: Sequence[DiscoveredPackage], changed: Mapping[str, bytes]) -> Mapping[str, Collected]:
        paths = [join(package.path, file) for package in discovered for file in package.files if kind_of(file)]
        if new := [path for path in paths if path not in self._collected]:
            self._collected |= collect_all(
                self.tree, new, self._jobs, self._cache, lambda finished: self._progress("reading", finished, len(new))
            )
        return self._collected_with(changed)

    def _collected_with(self, changed: Mapping[str, bytes]) -> Mapping[str, Collected]:
        paths = [path for path in changed if path in self._collected]
        if not paths:
            return self._collected
        fresh = collect_all(OverlayTree(self.tree, changed), paths, 1, FactCache(NO_CACHE), lambda finished: None)
        return {**self._collected, **fresh}

    def _read(
        self,
        tree: Tree,
        discovered: Sequence[DiscoveredPackage],
        collected: Mapping[str, Collected],
        target: TargetDistro,
        earlier: _Read | None,
    ) -> _Read:
        """Return the packages with the facts (extracted data) of their files, for a distribution.

        ``earlier`` is the result for another distribution, which is reused as far as possible.
        """
        of_package = [
            {file: collected[path] for file in package.files if (path := join(package.path, file)) in collected}
            for package in discovered
        ]
        declared_by = [_declared(package.manifest, target) for package in discovered]
        parts = [
            Parts(
                package,
                {file: c.commands for file, c in files.items() if c.commands is not None},
                _kinds(declared),
            )
            for package, declared, files in zip(discovered, declared_by, of_package, strict=True)
        ]
        evaluation = build_scripts.evaluate(tree, parts, target.distro, earlier.evaluation if earlier else None)
        if earlier and evaluation.helpers is earlier.evaluation.helpers:  # all scripts are the same
            launch = earlier.launch
        else:
            launch = launch_modules.resolve_modules(
                tree,
                [
                    launch_modules.LaunchPackage(
                        package.name,
                        package.path,
                        package.files,
                        script,
                        tuple([c.launch for c in files.values() if c.launch is not None]),
                    )
                    for package, script, files in zip(discovered, evaluation.scripts, of_package, strict=True)
                ],
            )
        packages = [
            ReadPackage(
                package,
                declared,
                script,
                {file: c.facts for file, c in files.items() if c.facts is not None},
                tuple([launch_modules.for_distro(target.distro, file) for file in launch_files]),
                tuple([path for c in files.values() for path in c.machine_paths]),
            )
            for package, declared, script, files, launch_files in zip(
                discovered, declared_by, evaluation.scripts, of_package, launch, strict=True
            )
        ]
        return _Read(packages, evaluation, launch)


def _manifest_only(package: DiscoveredPackage, target: TargetDistro) -> ReadPackage:
    return ReadPackage(package, _declared(package.manifest, target), None, {}, ())


def _world(
    read_packages: Sequence[ReadPackage], rejected: Sequence[Manifest], data: DistroData, expected: ExpectedRepositories
) -> World:
    return World(tuple(_members(read_packages, rejected, data.target)), data.underlays, data.knowledge, expected)


def _members(read_packages: Sequence[ReadPackage], rejected: Sequence[Manifest], target: TargetDistro) -> Iterator[Member]:
    for package, declared, script, *_ in read_packages:
        modules = importable_modules(script, package.files) if script else None
        yield _member(package.name, package.manifest, declared)._replace(modules=modules)
    for manifest in rejected:
        if manifest.name:
            yield _member(manifest.name, manifest, _declared(manifest, target))


def _declared(manifest: Manifest | None, target: TargetDistro) -> tuple[Declared, ...]:
    """Return each dependency tag of a package.xml whose condition is not false, with group, conflict and replace tags."""
    result = []
    context = target.context
    for depend in manifest.depends if manifest else ():
        truth = conditions.truth(depend.condition, context) if depend.condition else True
        if truth is not False:
            result.append(Declared(depend, ROLES.get(depend.tag, _NO_ROLE), truth is True))
    return tuple(result)


def _without_submodules(discovered: Sequence[DiscoveredPackage], folders: Sequence[str]) -> list[DiscoveredPackage]:
    """Return the packages, with submodules that are not cloned added to their unvisited folders."""
    result = []
    for package in discovered:
        submodules = [folder for folder in folders if folder.startswith(f"{package.path}/" if package.path else "")]
        skipped = tuple(Skipped(strip_folder(package.path, folder), "the submodule is not cloned") for folder in submodules)
        result.append(package._replace(unvisited=(*package.unvisited, *skipped)) if skipped else package)
    return result


def _member(name: str, manifest: Manifest | None, declared: Sequence[Declared]) -> Member:
    groups = tuple(d.name for d in declared if d.depend.tag == "member_of_group")
    return Member(name, manifest.version if manifest else "", _kinds(declared), groups)


def _kinds(declared: Sequence[Declared]) -> dict[str, tuple[str, ...]]:
    names: dict[str, list[str]] = {}
    for tag in declared:
        for kind in DEPENDENCY_KINDS[tag.depend.tag].letters:
            names.setdefault(kind, []).append(tag.depend.name)
    return {kind: tuple(of_kind) for kind, of_kind in names.items()}


def _unreadable(collected: Mapping[str, Collected]) -> Iterator[UnreadFile]:
    for path, c in sorted(collected.items()):
        if c.unreadable:
            yield UnreadFile(path, c.unreadable, file_start(path))
        for fact in (c.facts, c.launch):
            yield from _unchecked(fact.opaque if fact is not None else ())


def _untracked(tree: Tree, packages: Iterable[Package]) -> Iterator[str]:
    """Yield the paths in build scripts that exist on the disk, but are not part of the commit because git does not track them."""
    for package in packages:
        for problem in package.built.problems:
            path = resolve_path(package.path, problem.subject.rstrip("/"))
            if problem.kind.startswith("missing-") and not is_outside(path) and tree.is_untracked(path):
                yield path


def _unchecked_scripts(read_packages: Sequence[ReadPackage]) -> Iterator[UnreadFile]:
    for read_package in read_packages:
        if read_package.script is not None:
            yield from _unchecked(read_package.script.opaque)


def _unchecked(opaque: Iterable[Opaque]) -> Iterator[UnreadFile]:
    """Yield the places that ros-lint does not check because of one of its limits or a bug in it."""
    yield from (UnreadFile(place.span.path, place.reason, place.span) for place in opaque if place.unchecked)
