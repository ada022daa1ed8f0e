"""From files to the model: discover, collect each file once, evaluate the build scripts, join.

Only this module knows all steps. A loader keeps the facts of files, so that a workspace with a few changed files
(the trial of a fix) is joined again without reading the others.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from typing import NamedTuple

from ros_lint.base.paths import join, strip_folder
from ros_lint.base.text import Text, file_start
from ros_lint.base.tree import OverlayTree, Tree, text_of
from ros_lint.collectors.file_types import kind_of
from ros_lint.collectors.manifest import conditions
from ros_lint.facts.build import BuildScript
from ros_lint.facts.launch import LaunchFile
from ros_lint.facts.manifest import DEPENDENCY_KINDS, ROLES, Manifest, Role
from ros_lint.facts.sources import FileFacts, MachinePath
from ros_lint.facts.suppressions import Suppression
from ros_lint.facts.visibility import Opaque
from ros_lint.knowledge import Knowledge
from ros_lint.knowledge.providers import offered
from ros_lint.knowledge.underlays import Underlay
from ros_lint.knowledge.world import Member, World
from ros_lint.workspace import launch_modules as launch_around
from ros_lint.workspace.build_scripts import evaluate as scripts
from ros_lint.workspace.build_scripts.sources import Parts
from ros_lint.workspace.collect import Collected, collect_all
from ros_lint.workspace.discovery import repository_lists as source_lists
from ros_lint.workspace.discovery.discover import DiscoveredPackage, Skipped, discover
from ros_lint.workspace.discovery.ignore_files import find_ignores
from ros_lint.workspace.fact_cache import FactCache
from ros_lint.workspace.model import Declared, Package, Workspace
from ros_lint.workspace.target import TargetDistro, UnreadFile
from ros_lint.workspace.usage import own_files, public_headers
from ros_lint.workspace.usage import resolve as evidence
from ros_lint.workspace.usage import textual_mentions as traces
from ros_lint.workspace.usage import unqualified_types as type_names
from ros_lint.workspace.usage.package_files import Source, opaque_of

Progress = Callable[[str, int, int], None]
"""Called with the current step, the number of finished items and the number of all items."""

_NO_ROLE = Role(0)


class _Read(NamedTuple):
    """A package with the facts of its files."""

    found: DiscoveredPackage
    declared: tuple[Declared, ...]
    script: BuildScript | None
    facts: Mapping[str, FileFacts]
    launch: tuple[LaunchFile, ...]
    machine_paths: tuple[MachinePath, ...] = ()


class Loader:
    """Loads the packages below ``roots`` of a tree. Paths are relative to the base of the tree."""

    def __init__(
        self,
        tree: Tree,
        roots: Sequence[str],
        target: TargetDistro,
        *,
        underlays: Sequence[Underlay] = (),
        knowledge: Knowledge | None = None,
        exclude: Callable[[str], bool] = lambda path: False,
        jobs: int = 0,
        cache: FactCache | None = None,
        progress: Progress = lambda what, done, all_: None,
    ) -> None:
        self.tree = tree
        self.held: dict[str, bytes] = {}
        """Contents of files as read by :meth:`hold`."""
        self._unheld = tree
        self.target = target
        self._context = target.context
        self._roots = tuple(roots)
        self._underlays = tuple(underlays)
        self._knowledge = knowledge or Knowledge(target.distro)
        self._exclude = exclude
        self._jobs = jobs
        self._cache = cache or FactCache("", "")
        self._progress = progress
        self._collected: dict[str, Collected] = {}

    def load(self, changed: Mapping[str, bytes] | None = None, *, sources: bool = True) -> Workspace:
        """Return the workspace, with the contents of some files replaced.

        Without ``sources`` only manifests are read, which suffices for questions about the graph. Scripts, launch
        files and uses are then missing, so rules must not run.
        """
        tree = OverlayTree(self.tree, changed) if changed else self.tree
        self._progress("looking for packages", 0, 0)
        discovery = discover(tree, self._roots, self.target.context)
        founds = [self._without_excluded(found) for found in discovery.packages if not self._exclude(found.path)]
        lists = source_lists.find(tree, self._roots, (join(found.path, file) for found in founds for file in found.files))
        submodules = source_lists.submodules(tree, lists)
        founds = _without_submodules(founds, submodules)
        collected = self._collect(founds, changed or {}) if sources else {}
        reads = (
            self._read(tree, founds, collected)
            if sources
            else [_Read(found, self._declared(found.manifest), None, {}, ()) for found in founds]
        )
        awaited = source_lists.awaited(tree, lists, submodules)
        world = World(tuple(self._members(reads, discovery.rejected)), self._underlays, self._knowledge, awaited)
        packages = tuple(self._join(tree, reads, world, sources))
        unusable = tuple(self._unusable(manifest) for manifest in discovery.rejected if not self._exclude(manifest.path))
        ignores = find_ignores(tree, ((found.path, found.files) for found in founds))
        unread = (*discovery.not_checked, *source_lists.unreadable(tree, lists), *ignores.not_checked, *_unreadable(collected))
        not_checked = tuple(dict.fromkeys((*unread, *_failed(reads))))
        return Workspace(packages, unusable, world, self.target, not_checked, lists, ignores.patterns)

    def hold(self, paths: Iterable[str]) -> None:
        """Read some files again and fix their contents for all further loads, even if they change on disk.

        A file that cannot be read is left out.
        """
        for path in paths:
            with suppress(OSError):
                self.held[path] = self._unheld.read(path)
        self.tree = OverlayTree(self._unheld, self.held)
        self._collected = dict(self._changed(self.held))

    def text(self, path: str) -> Text | None:
        """Return the text of a file, None if it cannot be read."""
        return text_of(self.tree, path)

    def suppressions(self, changed: Mapping[str, bytes] | None = None) -> Iterator[Suppression]:
        """Yield the suppressions in all files of the loaded packages."""
        collected = self._changed(changed or {})
        for path in sorted(collected):
            yield from collected[path].suppressions

    def _without_excluded(self, found: DiscoveredPackage) -> DiscoveredPackage:
        return found._replace(files=tuple(file for file in found.files if not self._exclude(join(found.path, file))))

    def _collect(self, founds: Sequence[DiscoveredPackage], changed: Mapping[str, bytes]) -> Mapping[str, Collected]:
        paths = [join(found.path, file) for found in founds for file in found.files if kind_of(file)]
        if not self._collected:
            self._collected = collect_all(
                self.tree, paths, self._jobs, self._cache, lambda done: self._progress("reading", done, len(paths))
            )
        return self._changed(changed)

    def _changed(self, changed: Mapping[str, bytes]) -> Mapping[str, Collected]:
        again = [path for path in changed if path in self._collected]
        if not again:
            return self._collected
        fresh = collect_all(OverlayTree(self.tree, changed), again, 1, FactCache("", ""), lambda done: None)
        return {**self._collected, **fresh}

    def _read(self, tree: Tree, founds: Sequence[DiscoveredPackage], collected: Mapping[str, Collected]) -> list[_Read]:
        of_package = [
            {file: collected[path] for file in found.files if (path := join(found.path, file)) in collected} for found in founds
        ]
        declared_by = [self._declared(found.manifest) for found in founds]
        parts = [
            Parts(
                found,
                {file: c.commands for file, c in files.items() if c.commands is not None},
                _kinds(declared),
            )
            for found, declared, files in zip(founds, declared_by, of_package, strict=True)
        ]
        built = scripts.evaluate(tree, parts, self.target.distro)
        launch = launch_around.resolve_modules(
            tree,
            [
                launch_around.LaunchPackage(
                    found.name,
                    found.path,
                    found.files,
                    script,
                    tuple([c.launch for c in files.values() if c.launch is not None]),
                )
                for found, script, files in zip(founds, built, of_package, strict=True)
            ],
            self.target.distro,
        )
        return [
            _Read(
                found,
                declared,
                script,
                {file: c.facts for file, c in files.items() if c.facts is not None},
                followed,
                tuple([path for c in files.values() for path in c.machine_paths]),
            )
            for found, declared, script, files, followed in zip(founds, declared_by, built, of_package, launch, strict=True)
        ]

    def _members(self, reads: Sequence[_Read], rejected: Sequence[Manifest]) -> Iterator[Member]:
        for found, declared, script, *_ in reads:
            modules = offered(script, found.files) if script else None
            yield _member(found.name, found.manifest, declared)._replace(modules=modules)
        for manifest in rejected:
            if manifest.name:
                yield _member(manifest.name, manifest, self._declared(manifest))

    def _join(self, tree: Tree, reads: Sequence[_Read], world: World, search: bool) -> Iterator[Package]:
        sources = [
            Source(r.found.name, r.found.path, r.found.files, r.script, r.facts, r.launch, r.found.type.removeprefix("ros."))
            for r in reads
        ]
        resolver = evidence.Resolver(sources, world)
        types = type_names.Types(sources, tree, lambda name: world.closure((name,)))
        for number, (done, source) in enumerate(zip(reads, sources, strict=True)):
            self._progress("analysing", number, len(reads))
            found = done.found
            own = own_files.OwnFiles(source.name, source.files, source.script, source.facts)
            uses = evidence.resolve(source, resolver, own)
            declared = done.declared
            package = Package(
                name=found.name,
                path=found.path,
                type=found.type,
                manifest=found.manifest,
                declared=tuple(d for d in declared if d.depend.tag in ROLES),
                groups=tuple(d.name for d in declared if d.depend.tag == "member_of_group"),
                group_depends=tuple(d for d in declared if d.depend.tag == "group_depend"),
                colcon_depends=found.colcon_depends,
                files=found.files,
                unvisited_folders=tuple(skipped.path for skipped in found.unseen),
                nested=found.nested,
                script=done.script,
                launch=done.launch,
                uses=uses,
                textual_mentions={},
                opaque=opaque_of(source),
                registrations=tuple([made for facts in done.facts.values() for made in facts.registrations]),
                loaders=tuple([loader for facts in done.facts.values() for loader in facts.loaders]),
                imported_types=tuple([imported for facts in done.facts.values() for imported in facts.types]),
                interface_files=tuple([f.interface for f in done.facts.values() if f.interface is not None]),
                lookups=tuple([look_up for facts in done.facts.values() for look_up in facts.lookups]),
                parameter_files=tuple([f.parameters for f in done.facts.values() if f.parameters is not None]),
                unusable_headers=public_headers.unusable(source.built, done.facts, found.files),
                machine_paths=done.machine_paths,
                compiled_headers=own.compiled_along(),
                uninstalled_imports=tuple(own_files.uninstalled_imports(found.files, source.built, done.facts)),
                renamed=found.colcon_name if found.colcon_name != found.name else "",
            )
            if package.registrations and done.script and done.script.files.plugin_files:
                package = package._replace(unwritten_classes=traces.unwritten(tree, package))
            if search:
                package = package._replace(
                    textual_mentions=traces.of_package(tree, package, source, world, types),
                    possibly_used=traces.possibly_used(tree, package, source, world, types),
                )
            yield package

    def _declared(self, manifest: Manifest | None) -> tuple[Declared, ...]:
        """Return each dependency element whose condition is not false.

        Groups, conflicts and replaces are included.
        """
        found = []
        for depend in manifest.depends if manifest else ():
            truth = conditions.truth(depend.condition, self._context) if depend.condition else True
            if truth is not False:
                found.append(Declared(depend, ROLES.get(depend.tag, _NO_ROLE), truth is True))
        return tuple(found)

    def _unusable(self, manifest: Manifest) -> Package:
        folder = manifest.path.rpartition("/")[0]
        return Package(
            name=manifest.name,
            path=folder,
            type="",
            manifest=manifest,
            declared=(),
            groups=(),
            group_depends=(),
            colcon_depends=(),
            files=(),
            unvisited_folders=("",),
            nested=(),
            script=None,
            launch=(),
            uses=(),
            textual_mentions={},
            opaque=(),
        )


def _without_submodules(founds: Sequence[DiscoveredPackage], folders: Sequence[str]) -> list[DiscoveredPackage]:
    """Return the packages, with submodules that are not cloned added to the unvisited folders."""
    result = []
    for found in founds:
        inside = [folder for folder in folders if folder.startswith(f"{found.path}/" if found.path else "")]
        more = tuple(Skipped(strip_folder(found.path, folder), "the submodule is not cloned") for folder in inside)
        result.append(found._replace(unseen=(*found.unseen, *more)) if more else found)
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


def _failed(reads: Sequence[_Read]) -> Iterator[UnreadFile]:
    for done in reads:
        if done.script is not None:
            yield from _unchecked(done.script.opaque)


def _unchecked(opaque: Iterable[Opaque]) -> Iterator[UnreadFile]:
    """Yield the places that ros-lint does not check because of a limit or a bug of its own."""
    yield from (UnreadFile(place.span.path, place.reason, place.span) for place in opaque if place.unchecked)
