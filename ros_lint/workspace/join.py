"""Join the facts of packages: find their uses of other packages, and create the objects that rules read.

Facts are the data that collectors extract from one file.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import NamedTuple

from ros_lint.base.by_name import ByName
from ros_lint.base.paths import parent
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
from ros_lint.workspace.usage.unreached_modules import unreached_modules

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


def join_packages(
    tree: Tree,
    visible: Sequence[ReadPackage],
    read_packages: Sequence[ReadPackage],
    world: World,
    progress: Progress,
    *,
    search: bool,
) -> Iterator[Package]:
    """Yield the packages ``read_packages`` as rules read them, with the places that use other packages.

    Names are looked up in the packages ``visible`` and in ``world``. ``search`` also searches the text of files for declared
    names and for modules that are never imported.
    """
    if not read_packages:
        return
    sources = [read_package.source for read_package in visible]
    resolver = Resolver(sources, world)
    types = unqualified_types.Types(sources, tree, lambda name: world.closure((name,)))
    for number, read_package in enumerate(read_packages):
        progress("analysing", number, len(read_packages))
        discovered, source = read_package.discovered, read_package.source
        files = own_files.OwnFiles(source.name, source.files, source.script, source.facts)
        uses = resolve(source, resolver, files)
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
                unreached_modules=unreached_modules(
                    tree, source, undeclared, [other for other in sources if other is not source]
                ),
            )
        yield package


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
