"""Facts about the build of a package: the same types describe CMakeLists.txt and setup.py."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final, NamedTuple

from ros_lint.base.by_name import ByName
from ros_lint.base.text import Span
from ros_lint.facts.cmake import BuildTarget, Call, CommandPlace, UnsetVariable
from ros_lint.facts.setup_py import EditableList, EntryPoint, PythonModule, WrittenText
from ros_lint.facts.sources import Mention
from ros_lint.facts.visibility import Facet, NewerSyntax, Opaque, Problem


class InstalledFile(NamedTuple):
    """A file that the package installs."""

    path: str
    """Path relative to the install prefix:

    ``lib/<package>/talker``, ``share/<package>/launch/a.launch.py``.
    """
    source: str
    """Source path relative to the package, "" for a built or generated file.

    It begins with ``..`` if the source is outside the package folder.
    """
    program: bool
    """True if the file is installed with the executable bit."""
    conditional: bool
    """True if the installation depends on a condition whose value is unknown."""
    span: Span
    """Place of the command or list element that installs the file."""
    target: str = ""
    """Name of the CMake target that builds the file."""
    test: bool = False
    """True if the file is installed only when tests are built."""

    @property
    def importable(self) -> bool:
        """True if the file is installed into a folder of ``sys.path`` (site-packages or dist-packages)."""
        return "site-packages/" in self.path or "dist-packages/" in self.path


class Component(NamedTuple):
    """A class that can be loaded into a component container (rclcpp_components)."""

    name: str
    """Name of the class, with its namespaces."""
    conditional: bool
    """True if the registration depends on a condition whose value is unknown."""
    span: Span
    """Place of the registration."""
    unregistered: bool = False
    """True if ament_package() does not register the class, because the call is in a function or a subdirectory."""


class PluginClass(NamedTuple):
    """A class that a plugin description lists (pluginlib)."""

    name: str
    """Name by which a loader looks the class up."""
    type: str
    """C++ type of the class, without blanks and without a leading ``::``, like ``Registration.name``."""
    base: str
    """C++ type of the base class, written like ``type``."""
    span: Span
    """Span of the type."""


class PluginLibrary(NamedTuple):
    """A ``<library>`` of a plugin description."""

    path: str
    """Path or name of the library as written, "" if there is none."""
    span: Span
    """Span of the path, or of the element if it has no path."""
    classes: tuple[PluginClass, ...]
    """The plugins in the library."""


class PluginFile(NamedTuple):
    """A plugin description file."""

    path: str
    """Path relative to the package."""
    libraries: tuple[PluginLibrary, ...]
    """The libraries that the file describes."""
    span: Span
    """Span of the root element."""


class ScriptFile(NamedTuple):
    """A script that may be intended as a program."""

    path: str
    """Path relative to the package."""
    shebang: str
    """Interpreter line without ``#!``, "" if the script has none."""
    carriage_return: bool
    """True if the interpreter line ends with a carriage return: the kernel then finds no interpreter."""
    main: bool
    """True if the script does something when run: it has a ``__main__`` guard, or it is not Python."""
    executable: bool
    """True if the source file has the executable bit."""
    run: Span | None = None
    """Place where a text of the package names the script after ``ros2 run``.

    Searched for only if the script is not installed.
    """
    helper: bool = False
    """True if another script of the same folder imports this script.

    Determined only for a script with a main part and no interpreter line.
    """


class UninstalledImport(NamedTuple):
    """An import that may fail after installation, because the module is next to the program only in the sources."""

    program: str
    """Install path such as ``lib/<package>/talker.py``, or the dotted module of an entry point."""
    module: str
    """Dotted name of the module."""
    source: str
    """File, or folder with a slash at the end, relative to the package."""
    span: Span
    """Place of the import."""
    sure: bool
    """True if the program does not change ``sys.path``."""


REPOSITORIES: Final[Mapping[str, str]] = {"gtest": "googletest", "gmock": "googletest"}
"""Upstream project of a library, where targets and header folders have a different name."""


class ExportedTarget(NamedTuple):
    """A target that install(TARGETS ... EXPORT) puts into an export set."""

    target: str
    """Name of the target."""
    export_set: str
    """Name of the set."""
    reaches_dependents: bool
    """True if each package that calls find_package() for this package gets the target: ament_export_targets() names the set."""


class BuildProject(NamedTuple):
    """Name and version of the project, from the arguments of project() or setup() in the build script."""

    name: str = ""
    """Name, "" if unknown."""
    name_span: Span | None = None
    """Place of the name; None if it is unknown."""
    version: str = ""
    """Version, "" if unknown."""
    version_span: Span | None = None
    """Place of the version; None if it is unknown."""


class BuildProducts(NamedTuple):
    """The products of a build script: targets, installed files, components, entry points, Python packages and interfaces."""

    targets: tuple[BuildTarget, ...] = ()
    """Executables and libraries that CMake builds."""
    installs: tuple[InstalledFile, ...] = ()
    """Installed files, also built and generated ones."""
    components: tuple[Component, ...] = ()
    """Registered classes (rclcpp_components)."""
    entry_points: tuple[EntryPoint, ...] = ()
    """Entry points of a setup.py; entry points of the group "console_scripts" are programs."""
    python_packages: tuple[str, ...] = ()
    """Dotted names of importable modules and packages that the build installs."""
    interfaces: tuple[str, ...] = ()
    """Generated interfaces, as ``msg/Name``."""

    @property
    def installed(self) -> frozenset[str]:
        """Source paths of the installed files, relative to the package. Generated files have none and are left out."""
        return frozenset([provided.source for provided in self.installs if provided.source])


class BuildFiles(NamedTuple):
    """Files of the package that rules compare with what the script installs."""

    plugin_files: tuple[PluginFile, ...] = ()
    """Plugin descriptions of the package."""
    scripts: tuple[ScriptFile, ...] = ()
    """Scripts installed to lib/<package> or bin, their neighbours, and scripts in folders for scripts."""
    referenced_resources: tuple[tuple[str, Span], ...] = ()
    """Resources that are not installed, each with the place where a text of the package refers to it.

    A reference is the name of the file after the name of its folder: ``meshes/arm.stl`` or ``"meshes", "arm.stl"``.
    """
    build_inputs: tuple[str, ...] = ()
    """Resources that CMake files name without installing them, because the build reads them.

    Folders end with a slash.
    """


class BuildExports(NamedTuple):
    """The exports of a package: what its CMake script passes on to each package that calls find_package() for it."""

    config_extras: tuple[str, ...] = ()
    """CMake files, relative to the package, that run in each package that calls find_package() for it (CONFIG_EXTRAS)."""
    packages: tuple[tuple[Mention, bool], ...] = ()
    """Packages that the CMake configuration of this package finds for its dependents.

    The second value is True if the search is unconditional.
    """
    targets: tuple[ExportedTarget, ...] = ()
    """Targets that the script puts into an export set."""


class CMakeCommands(NamedTuple):
    """The commands of the CMake files, and the place at which a fix inserts an install rule."""

    names: tuple[str, ...] = ()
    """Names of the commands that ran: lower case, sorted, without duplicates."""
    calls: ByName[Call] = ByName()
    """Commands as written, file by file."""
    insertion: Span | None = None
    """Place for a new install rule: an empty span before ament_package(), or None."""
    insertion_after: Span | None = None
    """End of the command before ``insertion``, if only blank lines separate the two."""


class CMakeBuild(NamedTuple):
    """Facts that only a CMakeLists.txt has."""

    subdirectories: tuple[str, ...] = ()
    """Folders whose CMakeLists.txt is part of every build, relative to the package."""
    test_subdirectories: tuple[str, ...] = ()
    """Folders whose CMakeLists.txt is part of the build when tests are built, relative to the package."""
    bundled_projects: tuple[str, ...] = ()
    """Names of projects built along with the package: fetched projects and vendored folders."""
    unused_optional_finds: tuple[Span, ...] = ()
    """Places of optional find_package() calls whose results are not used."""
    commented_interfaces: tuple[str, ...] = ()
    """Interfaces listed only in comments, as ``msg/Name``: they were removed."""
    errors: tuple[Problem, ...] = ()
    """Errors of CMake in commands whose effect is still known, so that they hide nothing.

    The kind is "undefined-target" for a missing target and "no-package" for a missing package; the subject is the
    name of the target or package.
    """
    lost_exports: tuple[CommandPlace, ...] = ()
    """Calls of ament_export_...() in a function or subfolder, whose variables ament_package() does not see."""
    unset_variables: tuple[UnsetVariable, ...] = ()
    """References to variables that nothing sets, in commands that build, link, install or export."""
    interpreted_tests: tuple[str, ...] | None = None
    """Files and folders that an interpreter runs as tests, relative to the package.

    "" means any file; None means unknown.
    """
    runs_tests: bool = False
    """True if the script calls a command that runs tests by an interpreter.

    The name of the command decides.
    """
    includes_outside_package: bool = False
    """True if the script adds include directories of the source tree outside the package."""
    makes_nothing: bool = False
    """True if the script builds and installs nothing and tests at most the style of the sources."""


class SetupScript(NamedTuple):
    """Facts that only a setup.py with its setup.cfg has."""

    editable_lists: tuple[EditableList, ...] = ()
    """Lists that a fix can add an element to."""
    editable_texts: tuple[WrittenText, ...] = ()
    """Places where a fix can change a text."""
    entry_point_modules: tuple[PythonModule, ...] = ()
    """Modules that the entry points name."""
    relocated_modules: tuple[str, ...] = ()
    """Installed Python files and folders whose place in the sources differs from their module name.

    The cause is ``package_dir`` of a setup.py. Paths are relative to the package; folders end with a slash.
    """
    newer_syntax: tuple[NewerSyntax, ...] = ()
    """Constructs that older versions of Python reject."""


class BuildScript(NamedTuple):
    """The result of evaluating the build script of a package.

    The script is CMakeLists.txt with the files that it includes, or setup.py with setup.cfg.
    """

    path: str
    """Path of the CMakeLists.txt or setup.py, relative to the base of the run; "" if there is none."""
    project: BuildProject = BuildProject()
    """Name and version."""
    mentions: tuple[Mention, ...] = ()
    """Names of other packages and of their contents."""
    products: BuildProducts = BuildProducts()
    """Targets, installed files and other products."""
    files: BuildFiles = BuildFiles()
    """Files that are not necessarily installed: scripts, plugin descriptions, resources."""
    exports: BuildExports = BuildExports()
    """Files, packages and targets that dependents get by find_package()."""
    commands: CMakeCommands = CMakeCommands()
    """Commands of CMake as written."""
    cmake: CMakeBuild = CMakeBuild()
    """Further facts about a CMakeLists.txt; empty for a setup.py."""
    python: SetupScript = SetupScript()
    """Further facts about a setup.py; empty for a CMakeLists.txt."""
    opaque: tuple[Opaque, ...] = ()
    """Places that could not be evaluated."""
    problems: tuple[Problem, ...] = ()
    """Errors of the script."""
    distros: frozenset[str] | None = None
    """The distributions for which the script has this result; None if it does not depend on the distribution."""

    @property
    def of_cmake(self) -> bool:
        """True if the script is a CMakeLists.txt, not a setup.py."""
        return self.path.endswith("CMakeLists.txt")

    @property
    def is_empty(self) -> bool:
        """True if the script is a CMakeLists.txt without commands: empty, or only comments."""
        return self.of_cmake and not (self.commands.names or self.problems or self.opaque)

    def hides(self, facet: Facet) -> bool:
        """Return whether a part of the script that cannot be evaluated hides ``facet``.

        Only the build script counts: an import or a lookup by a computed name in the sources hides nothing here.
        """
        return any(opaque.hides & facet for opaque in self.opaque)


NOTHING_BUILT: Final = BuildScript("")
"""The build script of a package that has none: it builds and installs nothing."""
