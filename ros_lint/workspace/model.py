"""The packages and the workspace as rules read them: the joined data from all files. This module reads no file."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from types import MappingProxyType
from typing import TYPE_CHECKING, NamedTuple

from ros_lint.base import gitignore
from ros_lint.base.by_name import ByName
from ros_lint.base.paths import join, parent, resolve, strip_folder
from ros_lint.base.questions import Memo, Questions
from ros_lint.base.text import Span, file_start
from ros_lint.collectors.manifest import conditions
from ros_lint.facts.build import ENDS, NOTHING_BUILT, BuildScript, UninstalledImport
from ros_lint.facts.cmake import Call
from ros_lint.facts.interfaces import InterfaceFile
from ros_lint.facts.launch import LaunchFile
from ros_lint.facts.manifest import ColconDepend, Depend, Manifest, Role
from ros_lint.facts.sources import ImportedType, LookUp, MachinePath, NodeCode, ParameterFile, PluginLoader, Registration, Use
from ros_lint.facts.visibility import Facet, Opaque
from ros_lint.workspace.side_by_side import workspace_of
from ros_lint.workspace.target import NamedDistro, TargetDistro, UnreadFile

if TYPE_CHECKING:
    from ros_lint.knowledge.provides import ContentKind
    from ros_lint.knowledge.world import World


class Declared(NamedTuple):
    """A dependency tag of package.xml whose condition is not false for the target distribution."""

    depend: Depend
    """The tag."""
    role: Role
    """Purposes that the tag declares, e.g. ``Role.BUILD | Role.EXEC``."""
    certain: bool
    """False if the condition of the tag reads a variable whose value is unknown."""

    @property
    def name(self) -> str:
        """Name of the package or rosdep key in the tag."""
        return self.depend.name

    @property
    def always(self) -> bool:
        """True if the tag applies in every distribution.

        The tag has no condition, or a condition that is true in every environment of ROS 2.
        """
        return conditions.always(self.depend.condition)


class Package(NamedTuple):
    """A package of the workspace as colcon identifies it."""

    name: str
    """Name in ``package.xml``, by which other manifests, rosdep and the ament index refer to the package.

    Without a name in package.xml it is the name that colcon uses.
    """
    path: str
    """Folder of the package, relative to the base folder of the run; "" is the base folder."""
    type: str
    """Type as printed by ``colcon list``: ros.ament_cmake, ros.ament_python, cmake, python ..."""
    manifest: Manifest | None
    """The parsed package.xml with the errors in it, even if colcon cannot use it; None if there is none."""
    declared: ByName[Declared]
    """Dependency tags of package.xml, without tags whose condition (REP 149) is false."""
    groups: tuple[str, ...]
    """Dependency groups that the package is a member of."""
    group_depends: tuple[Declared, ...]
    """``<group_depend>`` tags, without tags whose condition is false."""
    colcon_depends: tuple[ColconDepend, ...]
    """Dependencies from ``colcon.pkg``, ``colcon.meta`` or, for a package without package.xml, the build script."""
    files: tuple[str, ...]
    """Files below the folder of the package, sorted and relative to it, without nested packages and skipped folders."""
    unvisited_folders: tuple[str, ...]
    """Folders, relative to the package, that were not visited. Their files are unknown."""
    nested: tuple[Manifest, ...]
    """The package.xml files in subfolders, which colcon does not find."""
    script: BuildScript | None
    """The evaluated CMakeLists.txt or setup.py; None if the package has neither."""
    launch: tuple[LaunchFile, ...]
    """All launch files of the package, also tests, examples, helper modules and files that are not installed.

    ``launch.package_launch_files`` yields only the launch files that users launch.
    """
    uses: tuple[Use, ...]
    """Places in the sources, launch files and build script that need another package.

    References of launch files to packages that do not exist are left out; see ``LaunchFile.references``.
    """
    textual_mentions: Mapping[str, Span]
    """For each declared name that no code uses but that occurs in a file of the package: the place of the occurrence."""
    opaque: tuple[Opaque, ...]
    """Places that could not be evaluated, e.g. an install() of ``${UNKNOWN}``.

    :meth:`hidden` returns the places that matter to a rule.
    """
    possibly_used: frozenset[str] = frozenset()
    """Names of packages that CMake finds and that are perhaps used: no code certainly uses them, but other evidence exists."""
    registrations: tuple[Registration, ...] = ()
    """Component and plugin classes that the C++ sources register."""
    unwritten_classes: frozenset[str] = frozenset()
    """Classes in plugin descriptions whose name does not occur in the sources."""
    lookups: tuple[LookUp, ...] = ()
    """Files of packages that models, RViz configurations and parameter files refer to, e.g. ``package://robot/meshes/arm.stl``."""
    parameter_files: tuple[ParameterFile, ...] = ()
    """The YAML files of the package."""
    node_code: tuple[NodeCode, ...] = ()
    """The C++ and Python files of the package with nodes or parameters of nodes."""
    machine_paths: tuple[MachinePath, ...] = ()
    """Paths in files of the package that exist on one machine only, e.g. ``/home/me/maps``."""
    unusable_headers: tuple[str, ...] = ()
    """Installed headers that dependents cannot compile, because the headers include files that are not installed."""
    compiled_headers: Mapping[str, frozenset[str]] = MappingProxyType({})
    """For each source that is compiled in every build: the headers of the package that it certainly includes.

    Sources of tests are left out.
    """
    loaders: tuple[PluginLoader, ...] = ()
    """Plugin loaders (``pluginlib::ClassLoader``) in the C++ sources."""
    uninstalled_imports: tuple[UninstalledImport, ...] = ()
    """Imports in Python programs of modules that are not installed next to the program."""
    unreached_modules: frozenset[str] = frozenset()
    """Installed Python files that import other packages, but that no program, launch file, script or test of the package imports.

    Paths are relative to the package. Modules that other packages import are left out. In a package without programs, only
    files that Python 3 cannot import are listed.
    """
    pip_requirements: frozenset[str] = frozenset()
    """Normalized names of the Python distributions that requirement files and setup.py name.

    Empty unless the package imports a module that no dependency tag declares.
    """
    imported_types: tuple[ImportedType, ...] = ()
    """Messages, services and actions that Python files import by name."""
    interface_files: tuple[InterfaceFile, ...] = ()
    """Interface definitions (``*.msg``, ``*.srv``, ``*.action``), except for IDL files."""
    renamed: str = ""
    """Name that colcon uses instead of ``name``, "" if both names are equal.

    It comes from ``colcon.pkg``, ``colcon.meta`` or, for a package without package.xml, the build script.
    """

    @property
    def colcon_name(self) -> str:
        """The name by which colcon orders and selects the package. colcon rejects two packages with the same name."""
        return self.renamed or self.name

    @property
    def span(self) -> Span:
        """Span for findings about the whole package, always in an existing file."""
        if self.manifest is not None:
            return self.manifest.name_span
        if self.script is not None:
            return file_start(self.script.path)
        first = next((file for file in self.files if file in ("CMakeLists.txt", "setup.py", "setup.cfg")), self.files[0])
        return file_start(join(self.path, first))

    @property
    def built(self) -> BuildScript:
        """The build script; if there is none, a BuildScript that builds and installs nothing."""
        return self.script or NOTHING_BUILT

    @property
    def builds_with(self) -> str:
        """Build type that the package is written for, without "ros.": ament_cmake, ament_python, cmake ...

        It differs from ``type`` if package.xml has no build type or is rejected: colcon then assumes catkin or cmake, but the
        call of ``ament_package()`` shows that the package is written for ament_cmake.
        """
        assumed = self.manifest is not None and self.type in ("ros.catkin", "cmake")
        if assumed and not set(ENDS).isdisjoint(self.built.commands.names) and not self.declares("catkin"):
            return "ament_cmake"
        return self.type.removeprefix("ros.")

    @property
    def is_ros1(self) -> bool:
        """True for a package of ROS 1: its build type is catkin, it declares catkin, and it finds no ``ament_cmake*`` package."""
        return (
            self.builds_with == "catkin"
            and bool(self.declares("catkin"))
            and not any(mention.via == "cmake" and mention.name.startswith("ament_cmake") for mention in self.built.mentions)
        )

    def hidden(self, facet: Facet, place: str = "") -> tuple[Opaque, ...]:
        """Return the places that could not be evaluated and make ``facet``, a part of the package, incompletely known.

        Example: ``install(FILES ${UNKNOWN} DESTINATION lib/robot)`` hides a part of Facet.EXECUTABLES.
        ``place``, a path in the install prefix, limits the result to places that may hide that path.
        """
        return tuple(opaque for opaque in self.opaque if opaque.hides & facet and (not place or opaque.reaches(place)))

    def declares(self, name: str) -> Role:
        """Return all roles (build, run, test ...) of the tags for a dependency, including tags with an uncertain condition."""
        role = Role(0)
        for declared in self.tags(name):
            role |= declared.role
        return role

    def tags(self, name: str) -> Sequence[Declared]:
        """Return the tags that declare the dependency ``name``, including tags with an uncertain condition."""
        return self.declared.named(name)

    @property
    def cmake_lists(self) -> str:
        """Path of the CMakeLists.txt in the package folder, relative to the base folder of the run."""
        return join(self.path, "CMakeLists.txt")

    def calls(self, *names: str, anywhere: bool = False) -> Iterator[Call]:
        """Yield the calls of some CMake commands in the package's CMakeLists.txt; with ``anywhere``, in all its CMake files."""
        if self.script is None:
            return
        calls, path = self.script.commands.calls.named(*names), self.cmake_lists
        yield from calls if anywhere else [call for call in calls if call.path == path]

    def relative(self, path: str) -> str:
        """Return a path relative to the package. The argument is relative to the base folder of the run."""
        return strip_folder(self.path, path)

    def base_path(self, path: str) -> str:
        """Return a path relative to the base folder of the run, as in spans. The argument is relative to the package."""
        return join(self.path, path)

    def start_of(self, path: str) -> Span:
        """Return the empty span at the start of a file of the package, for findings about the whole file."""
        return file_start(join(self.path, path))


class Workspace:
    """All packages of a run, with look-ups of released packages and the target distribution."""

    def __init__(
        self,
        packages: tuple[Package, ...],
        unusable: tuple[Package, ...],
        world: World,
        target: TargetDistro,
        not_checked: tuple[UnreadFile, ...],
        source_lists: tuple[str, ...] = (),
        ignores: tuple[gitignore.Pattern, ...] = (),
        views: Mapping[str, Workspace] = MappingProxyType({}),
        named_distros: tuple[NamedDistro, ...] = (),
        untracked: frozenset[str] = frozenset(),
        memo: Questions | None = None,
    ) -> None:
        self.packages = packages
        """The packages that colcon finds, sorted by path. Several packages may have the same name."""
        self.unusable = unusable
        """Folders with a ``package.xml`` in which colcon finds no package, e.g. because it rejects the package.xml.

        Their ``name`` is the one in package.xml. No rule is called for these folders, and ``packages`` and ``by_name`` lack them.
        """
        self.world = world
        """Look-ups of names in the workspace, in underlays and among released packages."""
        self.target = target
        """The ROS distribution of the run."""
        self.not_checked = not_checked
        """Files that could not be read, and data that is missing."""
        self.source_lists = source_lists
        """Paths of files that list repositories of the workspace: ``*.repos``, ``*.rosinstall``, ``.gitmodules``.

        The repositories need not be cloned.
        """
        self._ignores = ignores
        self._views = views
        self._untracked = untracked
        self._by_name: Mapping[str, tuple[Package, ...]] = packages_by_name(packages)
        self.named_distros = named_distros
        """The distributions that the repository builds for, as far as its files name them."""
        self.memo: Questions = memo or Memo()
        """Cached results of functions decorated with ``cached_by_workspace`` or ``cached_by_package``. Not for use by rules."""

    def seen_from(self, package: Package) -> Workspace:
        """Return the workspace in which the names in ``package`` are looked up. The engine calls this, so rules need not.

        A repository may contain several workspaces, such as ``arm_ws/src`` and ``car_ws/src``. If both contain a package called
        ``driver``, the result for a package in ``arm_ws`` lacks the ``driver`` in ``car_ws``.
        """
        return self._views.get(workspace_of(package.path), self) if self._views else self

    @property
    def by_name(self) -> Mapping[str, tuple[Package, ...]]:
        """The packages, by the name in ``package.xml``."""
        return self._by_name

    def called(self, name: str) -> tuple[Package, ...]:
        """Return the packages called ``name`` in ``package.xml``; if there are none, the packages that colcon calls ``name``."""
        named = self.by_name.get(name)
        return named or tuple([package for package in self.packages if package.colcon_name == name])

    def owner(self, path: str) -> Package | None:
        """Return the innermost package, also from ``unusable``, that contains a file; None if no package contains it."""
        folders = self.memo.ask("folders", self._find_folders)
        while path and path not in folders:
            path = parent(path)
        return folders.get(path)

    def _find_folders(self) -> Mapping[str, Package]:
        return {package.path: package for package in (*reversed(self.unusable), *reversed(self.packages))}

    def surely_lacks(self, owner: str, kind: ContentKind, name: str) -> bool:
        """Return whether the package ``owner`` certainly does not provide ``name``, which was not found in it.

        The result is True for packages of the workspace, because they have been searched. A released package must lack ``name``
        in the distribution that the user chose, or in every distribution.
        """
        return owner in self.by_name or self.world.lacks(owner, kind, name, everywhere=not self.target.explicit)

    def unread(self, package: Package | None = None) -> bool:
        """Return whether a file of ``package`` could not be read, or a file of the workspace if ``package`` is None.

        An unread file may contain uses and declarations that are not known.
        """
        folder = f"{package.path}/" if package is not None and package.path else ""
        return any(entry.span is not None and entry.span.path.startswith(folder) for entry in self.not_checked)

    def is_made(self, package: Package, path: str) -> bool:
        """Return whether git ignores a path in a package. Such a file is generated or downloaded."""
        return bool(self._ignores) and gitignore.is_ignored(self._ignores, join(package.path, path))

    def is_untracked(self, package: Package, path: str) -> bool:
        """Return whether a path that a build script names exists, but is not part of the commit because git does not track it.

        ``path`` is relative to the package. The result is always False outside of pre-commit hooks.
        """
        return resolve(package.path, path) in self._untracked

    @property
    def loaded(self) -> Mapping[str, frozenset[str]]:
        """Component classes that launch files load, by the name of the package that provides the class."""
        return self.memo.ask("loaded", self._find_loaded)

    def _find_loaded(self) -> Mapping[str, frozenset[str]]:
        classes: dict[str, frozenset[str]] = {}
        for package in self.packages:
            for launch in package.launch:
                for reference in launch.references:
                    if reference.kind == "component":
                        classes[reference.package] = classes.get(reference.package, frozenset()) | {reference.name}
        return classes


def packages_by_name(packages: Iterable[Package]) -> Mapping[str, tuple[Package, ...]]:
    """Return the packages by the name in ``package.xml``."""
    result: dict[str, tuple[Package, ...]] = {}
    for package in packages:
        result[package.name] = (*result.get(package.name, ()), package)
    return result
