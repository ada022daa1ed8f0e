"""Load a workspace: find the packages, collect the facts of each file once, evaluate the build scripts, join the results.

Facts are the data that a collector extracts from one file. A loader keeps them, so that a workspace with a few changed
files (to try out a fix) is loaded again without reading the other files.
"""

from __future__ import annotations

from collections.abc import Callable, Container, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from functools import partial
from types import MappingProxyType
from typing import NamedTuple

from ros_lint.base.paths import is_below, is_outside, join, parent, strip_folder
from ros_lint.base.paths import resolve as resolve_path
from ros_lint.base.questions import Recorder, same
from ros_lint.base.text import Text
from ros_lint.base.tree import OverlayTree, Tree, text_of
from ros_lint.base.watched_tree import WatchedTree
from ros_lint.collectors.file_types import kind_of
from ros_lint.collectors.manifest import conditions
from ros_lint.facts.repositories import ExpectedRepositories
from ros_lint.facts.suppressions import Suppression
from ros_lint.knowledge import Knowledge
from ros_lint.knowledge.underlays import Underlay
from ros_lint.knowledge.world import World
from ros_lint.workspace.cache.facts import FactCache
from ros_lint.workspace.cache.file import NO_CACHE
from ros_lint.workspace.collect import collect_all
from ros_lint.workspace.collected import Collected
from ros_lint.workspace.discovery import repository_lists
from ros_lint.workspace.discovery.discover import DiscoveredPackage, Discovery, Skipped, discover
from ros_lint.workspace.discovery.ignore_files import Ignores, find_ignores
from ros_lint.workspace.discovery.named_distros import named_distros
from ros_lint.workspace.handles import Handles
from ros_lint.workspace.join import Progress, ReadPackage, unusable_package
from ros_lint.workspace.model import Package, Workspace
from ros_lint.workspace.reading import Read, declared_by, unchecked
from ros_lint.workspace.side_by_side import hidden_namesakes, workspace_of
from ros_lint.workspace.state import DistroData, State
from ros_lint.workspace.target import NamedDistro, TargetDistro, UnreadFile

_MOST_CONTEXT = 20_000
"""Maximum number of folders outside packages that are searched for context packages.

Context packages are not checked, but the checked packages may depend on them.
"""


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
        again: bool = False,
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
        self._recorder = Recorder() if again else None
        self._watched = WatchedTree(tree, self._recorder) if self._recorder else None
        self._states: list[State] = []
        """What is kept of the last load with sources, for each distribution."""
        self._facts: dict[str, Collected] = {}
        """The facts of the files of the last load, by path."""
        self._overlaid: dict[str, tuple[bytes, Collected]] = {}
        self._touched: set[str] = set()
        """Paths that may have changed since the last load."""
        self._found: _Found | None = None
        self._packages: dict[str, DiscoveredPackage] = {}
        """The packages that were found last, by path."""

    def load(self, changed: Mapping[str, bytes] | None = None, *, sources: bool = True) -> Workspace:
        """Return the workspace for the first distribution. ``changed`` has new contents of files, by path.

        Without ``sources`` only package.xml files are read, which suffices for questions about the dependency graph. Build
        scripts, launch files and uses are then missing, so rules must not run.
        """
        return next(self._load(changed or {}, sources))

    def load_all(self, changed: Mapping[str, bytes] | None = None) -> tuple[Workspace, ...]:
        """Return the workspace for each distribution. ``changed`` has new contents of files, by path."""
        return tuple(self._load(changed or {}, sources=True))

    @property
    def recorded(self) -> tuple[Recorder, Handles] | None:
        """The answers of the rules, and the packages as last loaded.

        None unless the loader loads again, for one distribution and a repository without several workspaces.
        """
        handles = self._states[0].handles if len(self._states) == 1 else None
        if self._recorder is None or handles is None or handles.workspace.now["_views"]:
            return None
        return self._recorder, handles

    def _load(self, changed: Mapping[str, bytes], sources: bool) -> Iterator[Workspace]:
        """Yield the workspace for each distribution. ``changed`` has new contents of files, by path."""
        tree: Tree = OverlayTree(self.tree, changed) if changed else self.tree
        recorder = self._recorder if sources else None
        touched: set[str] = set()
        if recorder and self._watched:
            recorder.begin()
            touched = self._touched | self._watched.lay(self.tree, changed)
            self._touched = set()
            tree = self._watched
        states = (self._states if recorder else None) or [State(tree, data, recorder) for data in self._distros]
        if sources:
            self._states = states
        for state in states:
            state.touched |= touched
        self._progress("looking for packages", 0, 0)
        found: _Found | None = None
        read: Read | None = None
        for state in states:
            if found is None or found.depends_on_distro:
                found = state.questions.ask("find", partial(self._find, tree, state))
                if sources:
                    self._collect(found, changed, touched)
            state.take(found.packages)
            if sources:
                read = state.reading.read(found.packages, self._facts, state.touched_packages(), read)
                yield self._join(tree, found, read.packages, state, sources=True)
                read = None if recorder else read
            else:
                of_manifests = [_manifest_only(package, state.data.target) for package in found.packages]
                yield self._join(tree, found, of_manifests, state, sources=False)

    def _find(self, tree: Tree, state: State) -> _Found:
        """Return the packages that colcon finds for a distribution."""
        roots, discovery = self._discover(tree, state)
        packages = [self._without_excluded(package) for package in discovery.packages if not self._exclude(package.path)]
        files = [join(package.path, file) for package in packages for file in package.files]
        lists = repository_lists.find_lists(tree, roots, (*files, *discovery.repository_lists))
        submodules = repository_lists.submodules(tree, lists)
        packages = [self._known(package) for package in _without_submodules(packages, submodules)]
        places = [(package.name, package.path) for package in packages]
        unread_lists = tuple(repository_lists.unreadable_lists(tree, lists))
        expected = repository_lists.expected_repositories(tree, lists, submodules, places)._replace(complete=not unread_lists)
        return _Found(roots, discovery, packages, lists, unread_lists, expected)

    def _join(self, tree: Tree, found: _Found, read_packages: Sequence[ReadPackage], state: State, sources: bool) -> Workspace:
        """Return the workspace of the packages.

        If the repository contains several workspaces with packages of equal names, the result has a further Workspace object
        for each of them, see :meth:`Workspace.seen_from`.
        """
        rejected_manifests = found.discovery.rejected
        hidden = hidden_namesakes(
            [
                *((package.name, package.path) for package in found.packages),
                *((manifest.name, parent(manifest.path)) for manifest in rejected_manifests),
            ]
        )
        state.begin(hidden)
        shared = [read for read in read_packages if not hidden or workspace_of(read.discovered.path) not in hidden]
        world, join = state.view(None, read_packages, rejected_manifests, found.expected)
        packages = tuple(join.packages(shared, self._progress, search=sources))
        worlds: dict[str, World] = {}
        for folder, paths in hidden.items():
            visible = [read for read in read_packages if read.discovered.path not in paths]
            own = [read for read in visible if workspace_of(read.discovered.path) == folder]
            rejected = [manifest for manifest in rejected_manifests if parent(manifest.path) not in paths]
            worlds[folder], join = state.view(folder, visible, rejected, found.expected)
            packages += tuple(join.packages(own, self._progress, search=sources))
        packages = tuple(sorted(packages, key=lambda package: package.path)) if hidden else packages
        unusable = tuple(unusable_package(manifest) for manifest in rejected_manifests if not self._exclude(manifest.path))
        ignores = state.questions.ask("ignores", lambda: _ignores(tree, state.found))
        unread_files = (
            *found.discovery.not_checked,
            *found.unread_lists,
            *ignores.not_checked,
            *state.reading.unreadable(),
        )
        not_checked = tuple(dict.fromkeys((*unread_files, *_unchecked_scripts(read_packages))))

        named = state.questions.ask(("distros", found.roots), partial(self._distros_named_in, tree, found.roots))
        untracked = frozenset(_untracked(tree, packages))

        def seen(world: World, without: Container[str] = (), views: Mapping[str, Workspace] = MappingProxyType({})) -> Workspace:
            kept = [tuple([package for package in group if package.path not in without]) for group in (packages, unusable)]
            return Workspace(
                kept[0], kept[1], world, state.data.target, not_checked, found.lists, ignores.patterns, views, named, untracked
            )

        views = {folder: seen(of_folder, hidden[folder]) for folder, of_folder in worlds.items()}
        workspace = seen(world, (), views)
        return state.handles.renew(workspace) if state.handles else workspace

    def pin(self, paths: Iterable[str]) -> None:
        """Read some files again and fix their contents for all further loads, even if the files change on disk.

        A file that cannot be read is left out.
        """
        for path in paths:
            with suppress(OSError):
                self.pinned[path] = self._original_tree.read(path)
        self.tree = OverlayTree(self._original_tree, self.pinned)
        self.forget(self.pinned)

    def unpin(self) -> None:
        """Read the files that :meth:`pin` has read from the disk again."""
        self.tree, pinned = self._original_tree, self.pinned
        self.pinned = {}
        self.forget(pinned)

    def forget(self, paths: Iterable[str]) -> None:
        """Record that files or folders may have changed, appeared or disappeared, so that the next load reads them again."""
        doubted = set(paths)
        if self._watched:
            self._watched.lay(self.tree, self._watched.overlay)
            doubted = self._watched.doubt(doubted)
        self._touched |= doubted
        for path in doubted:
            self._collected.pop(path, None)
            self._overlaid.pop(path, None)

    def text(self, path: str) -> Text | None:
        """Return the text of a file, None if the file cannot be read."""
        return text_of(self.tree, path)

    def variable_values(self, package: str, path: str, line: int, variable: str, *, assigned: bool) -> tuple[str | None, ...]:
        """Return the values of a CMake variable in the last load, for the first distribution.

        ``path`` and ``line`` are a place in the package at the path ``package``. See
        :func:`ros_lint.collectors.cmake.variable_values.values_at`.
        """
        scripts = self._states[0].reading.scripts
        return scripts.variable_values(package, path, line, variable, assigned=assigned)

    def suppressions(self) -> Iterator[Suppression]:
        """Yield the suppression comments in all files of the packages of the last load."""
        by_path = {path: comments for state in self._states for path, comments in state.reading.suppressions()}
        for path in sorted(by_path):
            yield from by_path[path]

    def _discover(self, tree: Tree, state: State) -> tuple[tuple[str, ...], Discovery]:
        """Return the folders that were searched, and the packages in them.

        The folders are those of the context: the requested folders, and the folders with packages on which the requested
        packages may depend. Only the requested folders are searched if

        * the context has too many folders, or
        * colcon finds nothing in a requested folder when it starts from the context, for example because an outer folder is
          ignored.
        """
        context = state.data.target.context
        if self._around:
            around = discover(tree, self._around, context, _MOST_CONTEXT, state.questions)
            places = [*(package.path for package in around.packages), *(parent(manifest.path) for manifest in around.rejected)]
            if around.complete and all(any(is_below(place, root) for place in places) for root in self._roots):
                return self._around, around
            if not around.complete:
                why = f"there are more than {_MOST_CONTEXT} folders; the requested packages were checked without context"
                requested = discover(tree, self._roots, context, questions=state.questions)
                return self._roots, requested._replace(not_checked=(*requested.not_checked, UnreadFile("context", why, None)))
        return self._roots, discover(tree, self._roots, context, questions=state.questions)

    def _distros_named_in(self, tree: Tree, roots: Sequence[str]) -> tuple[NamedDistro, ...]:
        """Return the distributions that the repository builds for."""
        known = self._distros[0].knowledge.distributions
        return named_distros(tree, roots, known) if known else ()

    def _known(self, package: DiscoveredPackage) -> DiscoveredPackage:
        """Return the package as found last if nothing has changed, else the package itself."""
        before = self._packages.get(package.path)
        if before is not None and same(before, package):
            return before
        self._packages[package.path] = package
        return package

    def _without_excluded(self, package: DiscoveredPackage) -> DiscoveredPackage:
        files = tuple([file for file in package.files if not self._exclude(join(package.path, file))])
        return package if len(files) == len(package.files) else package._replace(files=files)

    def _collect(self, found: _Found, changed: Mapping[str, bytes], touched: Iterable[str]) -> None:
        """Bring the facts of the files of the found packages up to date. ``changed`` has new contents of files, by path."""
        if found is self._found:
            paths = [path for path in touched if path in self._facts]
        else:
            paths = [join(package.path, file) for package in found.packages for file in package.files if kind_of(file)]
        if new := [path for path in paths if path not in self._collected]:
            self._collected |= collect_all(
                self.tree, new, self._jobs, self._cache, lambda finished: self._progress("reading", finished, len(new))
            )
        laid = [path for path, data in changed.items() if path in self._collected and self._data_laid(path) != data]
        fresh = collect_all(OverlayTree(self.tree, changed), laid, 1, FactCache(NO_CACHE), lambda finished: None)
        self._overlaid |= {path: (changed[path], facts) for path, facts in fresh.items()}
        facts = {path: self._overlaid[path][1] if path in changed else self._collected[path] for path in paths}
        before = self._facts
        facts = {path: before[path] if path in before and same(before[path], new) else new for path, new in facts.items()}
        if found is self._found:
            self._facts |= facts
        else:
            self._found, self._facts = found, facts

    def _data_laid(self, path: str) -> bytes | None:
        """Return the contents in the overlay for which a file has facts, None if it has none."""
        laid = self._overlaid.get(path)
        return laid[0] if laid else None


def _ignores(tree: Tree, packages: Iterable[DiscoveredPackage]) -> Ignores:
    return find_ignores(tree, ((package.path, package.files) for package in packages))


def _manifest_only(package: DiscoveredPackage, target: TargetDistro) -> ReadPackage:
    return ReadPackage(package, declared_by(package.manifest, target), None, {}, ())


def _without_submodules(discovered: Sequence[DiscoveredPackage], folders: Sequence[str]) -> list[DiscoveredPackage]:
    """Return the packages, with submodules that are not cloned added to their unvisited folders."""
    result = []
    for package in discovered:
        submodules = [folder for folder in folders if folder.startswith(f"{package.path}/" if package.path else "")]
        skipped = tuple(Skipped(strip_folder(package.path, folder), "the submodule is not cloned") for folder in submodules)
        result.append(package._replace(unvisited=(*package.unvisited, *skipped)) if skipped else package)
    return result


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
            yield from unchecked(read_package.script.opaque)
