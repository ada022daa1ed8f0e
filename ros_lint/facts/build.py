"""Facts about the build script of a package. The same types describe CMakeLists.txt and setup.py."""

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
    """A file that a package installs."""

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
    """Place of the command, or of the element of a list in setup.py, that installs the file."""
    target: str = ""
    """Name of the CMake target that builds the file; "" if no target builds it."""
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
    """Place of the class name in the command that registers it."""
    unregistered: bool = False
    """True if ament_package() does not register the class, because the registering command is in a function or subdirectory."""


class PluginClass(NamedTuple):
    """A class that a plugin description file of pluginlib lists."""

    name: str
    """Name by which ``pluginlib::ClassLoader`` finds the class."""
    type: str
    """C++ type of the class without blanks and without a leading ``::``."""
    base: str
    """C++ type of the base class without blanks and without a leading ``::``."""
    span: Span
    """Place of the type."""


class PluginLibrary(NamedTuple):
    """A ``<library>`` element of a plugin description file."""

    path: str
    """Path or name of the library as written, "" if the element has none."""
    span: Span
    """Place of the path, or of the element if it has no path."""
    classes: tuple[PluginClass, ...]
    """The plugins in the library."""


class PluginFile(NamedTuple):
    """A plugin description file of pluginlib."""

    path: str
    """Path relative to the package."""
    libraries: tuple[PluginLibrary, ...]
    """The libraries that the file describes."""
    span: Span
    """Place of the root element."""


class ScriptFile(NamedTuple):
    """A script that may be intended to be installed as a program."""

    path: str
    """Path relative to the package."""
    shebang: str
    """Interpreter line without ``#!``, "" if the script has none."""
    carriage_return: bool
    """True if the interpreter line ends with a carriage return: the kernel then finds no interpreter."""
    main: bool
    """True if the script does something when it is run: it has a ``__main__`` guard, or is not Python."""
    executable: bool
    """True if the source file has the executable bit."""
    run: Span | None = None
    """Place where a text of the package, such as a README, has the name of the script after ``ros2 run``; None if there is none.

    This place is determined only for a script that is not installed.
    """
    helper: bool = False
    """True if another script in the same folder imports this script.

    This is determined only for a script with a ``__main__`` guard and without an interpreter line.
    """


class UninstalledImport(NamedTuple):
    """An import that may fail after installation, because the imported module is next to the program only in the sources."""

    program: str
    """Install path of the importing program, such as ``lib/<package>/talker.py``, or the dotted module of an entry point."""
    module: str
    """Dotted name of the imported module."""
    source: str
    """File of the imported module, or folder with a slash at the end, relative to the package."""
    span: Span
    """Place of the import statement."""
    sure: bool
    """True if the importing program does not change ``sys.path``."""


REPOSITORIES: Final[Mapping[str, str]] = {"gtest": "googletest", "gmock": "googletest"}
"""For libraries whose targets and header folders are not named like their upstream project, the name of this project."""


class ExportedTarget(NamedTuple):
    """A target that install(TARGETS ... EXPORT) puts into an export set."""

    target: str
    """Name of the target."""
    export_set: str
    """Name of the export set, the argument of EXPORT."""
    reaches_dependents: bool
    """True if each package that calls find_package() for this package gets the target, because of ament_export_targets()."""


class BuildProject(NamedTuple):
    """Name and version of a project, from the arguments of project() or setup() in the build script."""

    name: str = ""
    """Name of the project, "" if unknown."""
    name_span: Span | None = None
    """Place of the name; None if it is unknown."""
    version: str = ""
    """Version of the project, "" if unknown."""
    version_span: Span | None = None
    """Place of the version; None if it is unknown."""


class BuildProducts(NamedTuple):
    """The products of a build script: targets, installed files, components, entry points, Python packages and interfaces."""

    targets: tuple[BuildTarget, ...] = ()
    """Executables and libraries that CMake builds."""
    installs: tuple[InstalledFile, ...] = ()
    """Installed files, including built and generated ones."""
    components: tuple[Component, ...] = ()
    """Component classes that the script registers (rclcpp_components)."""
    entry_points: tuple[EntryPoint, ...] = ()
    """Entry points of a setup.py; entry points of the group "console_scripts" are programs."""
    python_packages: tuple[str, ...] = ()
    """Dotted names of the importable Python modules and packages that the build installs."""
    interfaces: tuple[str, ...] = ()
    """Messages, services and actions for which code is generated, as ``msg/Name``."""

    @property
    def installed(self) -> frozenset[str]:
        """Source paths of the installed files, relative to the package. Files that the build generates are left out."""
        return frozenset([provided.source for provided in self.installs if provided.source])


class BuildFiles(NamedTuple):
    """Files of a package that rules compare with the files that its build script installs."""

    plugin_files: tuple[PluginFile, ...] = ()
    """Plugin description files of the package."""
    scripts: tuple[ScriptFile, ...] = ()
    """Scripts that are installed to lib/<package> or bin, other scripts in their folders, and scripts in folders for scripts."""
    referenced_resources: tuple[tuple[str, Span], ...] = ()
    """Resources, such as meshes, that are not installed, each with the place where a text of the package refers to it.

    A reference is the name of the file after the name of its folder: ``meshes/arm.stl`` or ``"meshes", "arm.stl"``.
    """
    build_inputs: tuple[str, ...] = ()
    """Resources that commands in CMake files name but do not install, because the build reads them.

    Folders end with a slash.
    """


class BuildExports(NamedTuple):
    """The exports of a package: files, packages and targets that its CMake script passes on to dependents by find_package()."""

    config_extras: tuple[str, ...] = ()
    """CMake files (CONFIG_EXTRAS), relative to the package, that run in each package that calls find_package() for this one."""
    packages: tuple[tuple[Mention, bool], ...] = ()
    """Packages that the CMake configuration file of this package searches for when a dependent calls find_package() for it.

    The second element is True if the search is unconditional.
    """
    targets: tuple[ExportedTarget, ...] = ()
    """Targets that the script adds to an export set."""


class CMakeCommands(NamedTuple):
    """The commands of the CMake files of a package, and the place at which a fix inserts an install command."""

    names: tuple[str, ...] = ()
    """Names of the commands that CMake runs: lower case, sorted, without duplicates."""
    calls: ByName[Call] = ByName()
    """All commands as written, file by file."""
    insertion: Span | None = None
    """Place for a new install command: an empty span before ament_package(), or None."""
    insertion_after: Span | None = None
    """End of the command before ``insertion``, if only blank lines are between the two; otherwise None."""


class CMakeBuild(NamedTuple):
    """Facts that exist only for a CMakeLists.txt."""

    subdirectories: tuple[str, ...] = ()
    """Folders whose CMakeLists.txt is part of every build, relative to the package."""
    test_subdirectories: tuple[str, ...] = ()
    """Folders whose CMakeLists.txt is part of the build when tests are built, relative to the package."""
    bundled_projects: tuple[str, ...] = ()
    """Names of projects that are built along with the package: fetched projects and vendored folders."""
    unused_optional_finds: tuple[Span, ...] = ()
    """Places of optional find_package() calls whose results no command uses."""
    commented_interfaces: tuple[str, ...] = ()
    """Interfaces that only a comment of the script lists, as ``msg/Name``. They were removed from the build."""
    errors: tuple[Problem, ...] = ()
    """Errors that CMake reports, in commands whose effects are known nevertheless.

    The kind is "undefined-target" for a missing target and "no-package" for a missing package. The subject is the name of
    the target or package.
    """
    lost_exports: tuple[CommandPlace, ...] = ()
    """Calls of ament_export_...() in a function or subdirectory. The variables that they set do not exist in ament_package()."""
    unset_variables: tuple[UnsetVariable, ...] = ()
    """References to variables that no command sets, in commands that build, link, install or export."""
    interpreted_tests: tuple[str, ...] | None = None
    """Files and folders that an interpreter runs as tests, relative to the package; None if unknown.

    The element "" means any file.
    """
    runs_tests: bool = False
    """True if the script calls a command that runs tests with an interpreter, judging by the name of the command."""
    includes_outside_package: bool = False
    """True if the script adds include directories that are in the source tree but outside the package."""
    compiles_outside_package: bool = False
    """True if the script compiles sources that are in the source tree but outside the package."""
    makes_nothing: bool = False
    """True if the script builds and installs nothing, and tests at most the style of the sources."""


class SetupScript(NamedTuple):
    """Facts that exist only for a setup.py, with its setup.cfg."""

    editable_lists: tuple[EditableList, ...] = ()
    """Lists that a fix can add an element to."""
    editable_texts: tuple[WrittenText, ...] = ()
    """Places where a fix can change a text."""
    entry_point_modules: tuple[PythonModule, ...] = ()
    """Modules of this package that the entry points use."""
    relocated_modules: tuple[str, ...] = ()
    """Installed Python files and folders whose source path does not correspond to their module name.

    The cause is ``package_dir`` in setup.py. Paths are relative to the package; folders end with a slash.
    """
    newer_syntax: tuple[NewerSyntax, ...] = ()
    """Constructs in the script that older versions of Python reject."""


class BuildScript(NamedTuple):
    """The result of evaluating the build script of a package.

    The build script is CMakeLists.txt with the files that it includes, or setup.py with setup.cfg.
    """

    path: str
    """Path of the CMakeLists.txt or setup.py, relative to the base folder of the run; "" if the package has none."""
    project: BuildProject = BuildProject()
    """Name and version of the project."""
    mentions: tuple[Mention, ...] = ()
    """Names of other packages, and names of modules, headers, targets and so on that may belong to other packages."""
    products: BuildProducts = BuildProducts()
    """Targets, installed files and other products."""
    files: BuildFiles = BuildFiles()
    """Files of the package that may or may not be installed: scripts, plugin description files, resources."""
    exports: BuildExports = BuildExports()
    """Files, packages and targets that dependents of the package get by find_package()."""
    commands: CMakeCommands = CMakeCommands()
    """Commands of CMake as written."""
    cmake: CMakeBuild = CMakeBuild()
    """Further facts about a CMakeLists.txt; all empty for a setup.py."""
    python: SetupScript = SetupScript()
    """Further facts about a setup.py; all empty for a CMakeLists.txt."""
    opaque: tuple[Opaque, ...] = ()
    """Parts of the script that ros-lint could not evaluate."""
    problems: tuple[Problem, ...] = ()
    """Errors of the script."""
    distros: frozenset[str] | None = None
    """The distributions of ROS for which the script has this result; None if it has the result for every distribution."""

    @property
    def of_cmake(self) -> bool:
        """True for a CMakeLists.txt, False for a setup.py."""
        return self.path.endswith("CMakeLists.txt")

    @property
    def is_empty(self) -> bool:
        """True for a CMakeLists.txt without commands: the file is empty or has only comments."""
        return self.of_cmake and not (self.commands.names or self.problems or self.opaque)

    def hides(self, facet: Facet) -> bool:
        """Return whether a part of the script that could not be evaluated may add to ``facet``, e.g. to the executables.

        Only the build script is considered. An import by a computed name in a source file, for example, is not.
        """
        return any(opaque.hides & facet for opaque in self.opaque)


NOTHING_BUILT: Final = BuildScript("")
"""Result in place of the build script for a package that has no build script."""

ENDS: Final = ("ament_package", "ament_auto_package")
"""Commands that write the CMake configuration and the exports of a package. They come last in a CMakeLists.txt."""
