"""The model that rules look at: facts, joined. It answers questions, and reads nothing."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cached_property
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, NamedTuple

from ros_lint.base import gitignore as ignored
from ros_lint.base.paths import join, strip_folder
from ros_lint.base.text import Span, file_start
from ros_lint.collectors.manifest import conditions
from ros_lint.facts.build import NOTHING_BUILT, BuildScript, UninstalledImport
from ros_lint.facts.cmake import Call
from ros_lint.facts.interfaces import InterfaceFile
from ros_lint.facts.launch import LaunchFile
from ros_lint.facts.manifest import ColconDepend, Depend, Manifest, Role
from ros_lint.facts.sources import ImportedType, LookUp, MachinePath, ParameterFile, PluginLoader, Registration, Use
from ros_lint.facts.visibility import Facet, Opaque
from ros_lint.workspace.target import TargetDistro, UnreadFile

if TYPE_CHECKING:
    from ros_lint.knowledge.provides import Offer
    from ros_lint.knowledge.world import World


class Declared(NamedTuple):
    """A dependency tag whose condition is not false for the target."""

    depend: Depend
    role: Role
    certain: bool
    """False when the condition has a variable that nobody knows here."""

    @property
    def name(self) -> str:
        return self.depend.name

    @property
    def always(self) -> bool:
        """Whether it counts whatever the distribution: without a condition, or with one that any environment of ROS 2 meets."""
        return conditions.always(self.depend.condition)


class Package(NamedTuple):
    """A package of the workspace, as colcon sees it."""

    name: str
    """The name in ``package.xml``, by which other manifests, rosdep and the ament index know the package. Where no manifest
    gives one it is the name that colcon uses."""
    path: str
    """Its folder, relative to the base; "" is the base."""
    type: str
    """As ``colcon list`` prints it: ros.ament_cmake, ros.ament_python, cmake, python ..."""
    manifest: Manifest | None
    """Also there, with its problems, when colcon cannot use it."""
    declared: tuple[Declared, ...]
    groups: tuple[str, ...]
    """That it is a member of."""
    group_depends: tuple[Declared, ...]
    colcon_depends: tuple[ColconDepend, ...]
    files: tuple[str, ...]
    """Every file below the folder, relative to it and sorted; nested packages and skipped folders left out."""
    unvisited_folders: tuple[str, ...]
    """Folders, relative to the package, that were not looked into: whether a file exists there is unknown."""
    nested: tuple[Manifest, ...]
    """Manifests further down, which colcon does not see."""
    script: BuildScript | None
    launch: tuple[LaunchFile, ...]
    uses: tuple[Use, ...]
    textual_mentions: Mapping[str, Span]
    """For declared names that nothing uses: a place where the name stands in some text all the same."""
    opaque: tuple[Opaque, ...]
    possibly_used: frozenset[str] = frozenset()
    """Names that CMake finds and no code is seen to use, while something else says that they are used."""
    registrations: tuple[Registration, ...] = ()
    """Classes that its C++ sources make loadable."""
    unwritten_classes: frozenset[str] = frozenset()
    """Classes that its plugin descriptions name and none of its sources does."""
    lookups: tuple[LookUp, ...] = ()
    """Files that its models, displays and parameters look up in packages."""
    parameter_files: tuple[ParameterFile, ...] = ()
    """Its YAML files."""
    machine_paths: tuple[MachinePath, ...] = ()
    """Paths below somebody's home directory that its files have."""
    unusable_headers: tuple[str, ...] = ()
    """Those installed headers, relative to it, that do not compile anywhere else: what they include is not installed."""
    compiled_headers: Mapping[str, frozenset[str]] = MappingProxyType({})
    """For each source that every build compiles, tests left out: the headers of the package that it certainly includes."""
    loaders: tuple[PluginLoader, ...] = ()
    """What its C++ sources load plugins by."""
    uninstalled_imports: tuple[UninstalledImport, ...] = ()
    """What its programs in Python import and that is not installed beside them."""
    imported_types: tuple[ImportedType, ...] = ()
    """Messages, services and actions that its Python files import by name."""
    interface_files: tuple[InterfaceFile, ...] = ()
    """Its definitions of interfaces, but for those in IDL."""
    renamed: str = ""
    """The name that colcon uses instead, from ``colcon.pkg``, ``colcon.meta`` or the script of a plain package; "" where both
    names are the same."""

    @property
    def colcon_name(self) -> str:
        """Return the name by which colcon orders and selects the package, and refuses a second one."""
        return self.renamed or self.name

    @property
    def span(self) -> Span:
        """Where to point when the whole package is meant: always into a file."""
        if self.manifest is not None:
            return self.manifest.name_span
        if self.script is not None:
            return file_start(self.script.path)
        first = next((file for file in self.files if file in ("CMakeLists.txt", "setup.py", "setup.cfg")), self.files[0])
        return file_start(join(self.path, first))

    @property
    def built(self) -> BuildScript:
        """Return the build script, one that builds and installs nothing where there is none."""
        return self.script or NOTHING_BUILT

    @property
    def builds_with(self) -> str:
        """Return the build type: ament_cmake, ament_python, cmake ..."""
        return self.type.removeprefix("ros.")

    def hidden(self, facet: Facet, place: str = "") -> tuple[Opaque, ...]:
        """Return what hides a facet of the package, or of it what may be at a ``place`` in the prefix. Empty: all can be seen."""
        return tuple(opaque for opaque in self.opaque if opaque.hides & facet and (not place or opaque.reaches(place)))

    def declares(self, name: str) -> Role:
        """Return everything that the package declares a name for, conditions that may be false included."""
        role = Role(0)
        for declared in self.tags(name):
            role |= declared.role
        return role

    def tags(self, name: str) -> list[Declared]:
        """Return the tags that declare a name, conditions that may be false included."""
        return [declared for declared in self.declared if declared.depend.name == name]

    @property
    def cmake_lists(self) -> str:
        """The path of the package's own CMakeLists.txt, relative to the base."""
        return join(self.path, "CMakeLists.txt")

    def calls(self, *names: str, anywhere: bool = False) -> Iterator[Call]:
        """Yield the calls of CMake commands in the package's own CMakeLists.txt, or ``anywhere`` in its CMake files."""
        if self.script is None:
            return
        calls = [call for call in self.script.calls if call.name in names]
        yield from calls if anywhere else [call for call in calls if call.path == self.cmake_lists]

    def relative(self, path: str) -> str:
        """Return a path relative to the package."""
        return strip_folder(self.path, path)

    def base_path(self, path: str) -> str:
        """Return a path of the package relative to the base, as spans have it: the reverse of :meth:`relative`."""
        return join(self.path, path)

    def start_of(self, path: str) -> Span:
        """Return the empty span at the start of a file of the package: for findings about the file as a whole."""
        return file_start(join(self.path, path))


class Workspace:
    """All packages, and the world they live in.

    ``packages`` are those that colcon sees, sorted by path; a name may be there twice. ``unusable`` are folders with a
    ``package.xml`` for which colcon sees no package at all, under the name that the manifest gives, if any.
    ``source_lists`` are files that name repositories which belong to the workspace and need not be there: ``*.repos``,
    ``*.rosinstall``, ``.gitmodules``. ``ignores`` says what git leaves out.
    """

    def __init__(
        self,
        packages: tuple[Package, ...],
        unusable: tuple[Package, ...],
        world: World,
        target: TargetDistro,
        not_checked: tuple[UnreadFile, ...],
        source_lists: tuple[str, ...] = (),
        ignores: tuple[ignored.Pattern, ...] = (),
    ) -> None:
        self.packages = packages
        self.unusable = unusable
        self.world = world
        self.target = target
        self.not_checked = not_checked
        self.source_lists = source_lists
        self._ignores = ignores
        self.memo: dict[object, Any] = {}
        """What functions that remember have said: :func:`per_workspace`, :func:`per_package`."""

    @cached_property
    def by_name(self) -> Mapping[str, tuple[Package, ...]]:
        found: dict[str, tuple[Package, ...]] = {}
        for package in self.packages:
            found[package.name] = (*found.get(package.name, ()), package)
        return found

    def called(self, name: str) -> tuple[Package, ...]:
        """Return the packages that a user means by a name: by that of ``package.xml``, else by the one that colcon uses."""
        named = self.by_name.get(name)
        return named or tuple([package for package in self.packages if package.colcon_name == name])

    def surely_lacks(self, owner: str, offer: Offer, wanted: str) -> bool:
        """Whether it is beyond doubt that a package does not offer what was not found in it.

        Packages of the workspace were looked through. A released one must be known to lack it: in every distribution, where
        nobody said which one is meant.
        """
        return owner in self.by_name or self.world.lacks(owner, offer, wanted, everywhere=not self.target.explicit)

    def unread(self, package: Package | None = None) -> bool:
        """Whether a file of a package, or any at all, could not be read: what nobody says in sight may stand there."""
        folder = f"{package.path}/" if package is not None and package.path else ""
        return any(entry.span is not None and entry.span.path.startswith(folder) for entry in self.not_checked)

    def is_made(self, package: Package, path: str) -> bool:
        """Whether a path in a package, which need not exist, is one that git ignores: then it is made or fetched."""
        return bool(self._ignores) and ignored.is_ignored(self._ignores, join(package.path, path))

    @cached_property
    def loaded(self) -> Mapping[str, frozenset[str]]:
        """The component classes that launch files load, by package."""
        found: dict[str, frozenset[str]] = {}
        for package in self.packages:
            for launch in package.launch:
                for reference in launch.references:
                    if reference.kind == "component":
                        found[reference.package] = found.get(reference.package, frozenset()) | {reference.name}
        return found
