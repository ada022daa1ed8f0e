"""Join the facts of packages: find their uses of other packages, and create the objects that rules read.

Facts are the data that collectors extract from one file.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from typing import NamedTuple

from ros_lint.base.by_name import ByName
from ros_lint.base.paths import parent
from ros_lint.base.questions import Cell, Memo, Questions, Recorder
from ros_lint.base.tree import Tree
from ros_lint.facts.build import BuildScript
from ros_lint.facts.launch import LaunchFile
from ros_lint.facts.manifest import ROLES, Manifest
from ros_lint.facts.sources import FileFacts, MachinePath, Use
from ros_lint.knowledge.world import World
from ros_lint.workspace.discovery.discover import DiscoveredPackage
from ros_lint.workspace.model import Declared, Package
from ros_lint.workspace.usage import own_files, public_headers, textual_mentions, unqualified_types
from ros_lint.workspace.usage.package_files import PackageSource, opaque_of
from ros_lint.workspace.usage.pip_requirements import pip_requirements
from ros_lint.workspace.usage.resolve import Resolver, resolve
from ros_lint.workspace.usage.unreached_modules import imported_modules, unreached_modules

Progress = Callable[[str, int, int], None]
"""Called with the name of the current step, the number of finished items and the number of all items."""


class ReadPackage(NamedTuple):
    """A package with the facts (data extracted by collectors) of its files."""

    discovered: DiscoveredPackage
    declared: tuple[Declared, ...]
    script: BuildScript | None
    facts: Mapping[str, FileFacts]
    launch: tuple[LaunchFile, ...]
    machine_paths: tuple[MachinePath, ...] = ()

    @property
    def source(self) -> PackageSource:
        """The package in the form that the resolution of names to packages needs."""
        package = self.discovered
        builds_with = package.type.removeprefix("ros.")
        return PackageSource(package.name, package.path, package.files, self.script, self.facts, self.launch, builds_with)


class Join:
    """Joins packages. Names are looked up in the visible packages and in ``world``.

    With a ``recorder``, a package is joined again only if something that its join has read has changed.
    """

    def __init__(self, tree: Tree, world: World, recorder: Recorder | None = None) -> None:
        self._tree = tree
        self._world = world
        self._recorder = recorder
        self._questions: Questions = recorder.scope() if recorder else Memo()
        self._resolver = Resolver(world, recorder)
        self._types = unqualified_types.Types(tree, lambda name: world.closure((name,)), recorder)
        self._visible: dict[str, tuple[ReadPackage, PackageSource]] = {}
        self._cells: dict[str, Cell] = {}
        self._paths: tuple[str, ...] = ()
        self._of_paths = Cell()

    def renew(self, visible: Sequence[ReadPackage]) -> None:
        """Take the packages in which names are looked up."""
        changed = []
        for read_package in visible:
            path = read_package.discovered.path
            if (known := self._visible.get(path)) is None or known[0] is not read_package:
                self._visible[path] = read_package, read_package.source
                changed.append(self._cells.setdefault(path, Cell()))
        paths = tuple([read_package.discovered.path for read_package in visible])
        if paths != self._paths:
            self._paths = paths
            changed.append(self._of_paths)
        if self._recorder:
            self._recorder.change(changed)
        sources = [self._visible[path][1] for path in paths]
        self._resolver.renew(sources)
        self._types.renew(sources)

    def packages(self, read_packages: Sequence[ReadPackage], progress: Progress, *, search: bool) -> Iterator[Package]:
        """Yield the packages as rules read them, with the places that use other packages.

        ``search`` also searches the text of files for declared names and for modules that are never imported.
        """
        for number, read_package in enumerate(read_packages):
            progress("analysing", number, len(read_packages))
            path = read_package.discovered.path
            yield self._questions.ask(("join", path), partial(self._join, path, search=search))

    def _own(self, path: str) -> tuple[ReadPackage, PackageSource]:
        if self._recorder:
            self._recorder.note(self._cells[path])
        return self._visible[path]

    def _imported(self, top: str) -> Mapping[str, frozenset[str]]:
        """Return the full names of the modules below a top-level module that packages import, by path of the package."""
        return self._questions.ask(("imported", top), lambda: self._find_imported(top))

    def _find_imported(self, top: str) -> Mapping[str, frozenset[str]]:
        if self._recorder:
            self._recorder.note(self._of_paths)
        by_package = ((path, self._questions.ask(("imports", path), partial(self._imports, path))) for path in self._paths)
        return {path: of_package[top] for path, of_package in by_package if top in of_package}

    def _imports(self, path: str) -> Mapping[str, frozenset[str]]:
        return imported_modules(self._own(path)[1])

    def _join(self, path: str, *, search: bool) -> Package:
        tree, world, types = self._tree, self._world, self._types
        read_package, source = self._own(path)
        discovered = read_package.discovered
        files = own_files.OwnFiles(source.name, source.files, source.script, source.facts)
        uses = resolve(source, self._resolver, files)
        declared = read_package.declared
        package = Package(
            name=discovered.name,
            path=discovered.path,
            type=discovered.type,
            manifest=discovered.manifest,
            declared=ByName(d for d in declared if d.depend.tag in ROLES),
            groups=tuple(d.name for d in declared if d.depend.tag == "member_of_group"),
            group_depends=tuple(d for d in declared if d.depend.tag == "group_depend"),
            colcon_depends=discovered.colcon_depends,
            files=discovered.files,
            unvisited_folders=tuple(skipped.path for skipped in discovered.unvisited),
            nested=discovered.nested,
            script=read_package.script,
            launch=read_package.launch,
            uses=uses,
            textual_mentions={},
            opaque=opaque_of(source),
            registrations=tuple([registration for facts in read_package.facts.values() for registration in facts.registrations]),
            loaders=tuple([loader for facts in read_package.facts.values() for loader in facts.loaders]),
            imported_types=tuple([imported for facts in read_package.facts.values() for imported in facts.types]),
            interface_files=tuple([f.interface for f in read_package.facts.values() if f.interface is not None]),
            lookups=tuple([look_up for facts in read_package.facts.values() for look_up in facts.lookups]),
            parameter_files=tuple([f.parameters for f in read_package.facts.values() if f.parameters is not None]),
            node_code=tuple([f.nodes for f in read_package.facts.values() if f.nodes is not None]),
            unusable_headers=public_headers.unusable(source.built, read_package.facts, discovered.files),
            machine_paths=read_package.machine_paths,
            compiled_headers=files.headers_by_source(),
            uninstalled_imports=tuple(own_files.uninstalled_imports(discovered.files, source.built, read_package.facts)),
            renamed=discovered.colcon_name if discovered.colcon_name != discovered.name else "",
        )
        if package.registrations and read_package.script and read_package.script.files.plugin_files:
            package = package._replace(unwritten_classes=textual_mentions.find_unwritten_classes(tree, package))
        if search:
            undeclared = _undeclared(package)
            package = package._replace(
                textual_mentions=textual_mentions.find_textual_mentions(tree, package, source, world, types),
                possibly_used=textual_mentions.possibly_used(tree, package, source, world, types),
                pip_requirements=pip_requirements(tree, package.path, package.files)
                if any(use.via == "import" for use in undeclared)
                else frozenset(),
                unreached_modules=unreached_modules(tree, source, undeclared, self._imported),
            )
        return package


def _undeclared(package: Package) -> list[Use]:
    """Return the places that need another package without a dependency tag for it."""
    names = {declared.name for declared in package.declared}
    return [use for use in package.uses if names.isdisjoint(use.providers)]


def unusable_package(manifest: Manifest) -> Package:
    """Return an empty package for a package.xml that colcon cannot use."""
    return Package(
        name=manifest.name,
        path=parent(manifest.path),
        type="",
        manifest=manifest,
        declared=ByName(),
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
