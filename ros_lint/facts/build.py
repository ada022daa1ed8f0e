"""What the build of a package does and installs: CMakeLists.txt and setup.py in the same words."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final, NamedTuple

from ros_lint.base.text import Span
from ros_lint.facts.cmake import BuildTarget, Call
from ros_lint.facts.setup_py import EditableList, EntryPoint, PythonModule, WrittenText
from ros_lint.facts.sources import Mention
from ros_lint.facts.visibility import Facet, NewerSyntax, Opaque, Problem


class InstalledFile(NamedTuple):
    """A file that the package installs."""

    path: str
    """Relative to the install prefix: ``lib/<package>/talker``, ``share/<package>/launch/a.launch.py``."""
    source: str
    """Relative to the package, "" when it is built or generated. It leads upwards where it lies around the package."""
    program: bool
    """Whether it is installed with the executable bit."""
    conditional: bool
    """Whether it depends on something that is not known."""
    span: Span
    target: str = ""
    """The CMake target that builds it."""
    test: bool = False
    """Whether it is installed only where tests are wanted."""

    @property
    def importable(self) -> bool:
        """Whether it lies where Python looks for modules."""
        return "site-packages/" in self.path or "dist-packages/" in self.path


class Component(NamedTuple):
    """A class that can be loaded into a component container (rclcpp_components)."""

    name: str
    conditional: bool
    span: Span
    lost: bool = False
    """Whether it is registered where ament_package() does not see it: in a function, or in a subfolder."""


class PluginClass(NamedTuple):
    """A class that a plugin description lists (pluginlib; reference, section C5.8)."""

    name: str
    """By which it is looked up."""
    type: str
    """Here and in what is said of sources: without blanks and without a leading ``::``."""
    base: str
    span: Span
    """Of the type."""


class PluginLibrary(NamedTuple):
    """A ``<library>`` of a plugin description."""

    path: str
    span: Span
    """Of the path, or of the element that has none."""
    classes: tuple[PluginClass, ...]


class PluginFile(NamedTuple):
    """A plugin description file."""

    path: str
    """Relative to the package."""
    libraries: tuple[PluginLibrary, ...]
    span: Span
    """Of its root element."""


class ScriptFile(NamedTuple):
    """A script that may be meant to be started."""

    path: str
    """Relative to the package."""
    shebang: str
    """The interpreter line without ``#!``, "" when there is none."""
    carriage_return: bool
    """Whether that line ends with a carriage return, so that nothing can run it."""
    main: bool
    """Whether it runs something when it is started: ``if __name__ == "__main__"``, or a language other than Python."""
    executable: bool
    """Whether the source has the executable bit."""
    run: Span | None = None
    """Where a text of the package says ``ros2 run`` with its name; sought only if the script is not installed."""
    helper: bool = False
    """Whether a script beside it imports it; sought only if it runs something and has no interpreter line."""


class UninstalledImport(NamedTuple):
    """An import in an installed program of what lies beside it in the sources, and not where it is installed."""

    program: str
    """Where it is installed, such as ``lib/<package>/talker.py``, or the module of an entry point, dotted."""
    module: str
    source: str
    """A file, or a folder with a slash at the end, relative to the package."""
    span: Span
    sure: bool
    """Whether the program leaves alone where modules are sought."""


REPOSITORIES: Final[Mapping[str, str]] = {"gtest": "googletest", "gmock": "googletest"}
"""What a project is called by whoever brings it along, where its targets and the folders of its headers have another name."""


class Exported(NamedTuple):
    """A target that install(TARGETS ... EXPORT) puts into a set."""

    target: str
    export_set: str
    reaches_dependents: bool
    """Whether whoever finds the package has it for sure, for ament_export_targets() names the set."""


class BuildScript(NamedTuple):
    """What the build of a package does: evaluated from CMakeLists.txt and what it includes, or from setup.py and setup.cfg."""

    path: str
    name: str = ""
    """As project() or setup(name=) gives it; "" when not known."""
    name_span: Span | None = None
    version: str = ""
    version_span: Span | None = None
    mentions: tuple[Mention, ...] = ()
    targets: tuple[BuildTarget, ...] = ()
    installs: tuple[InstalledFile, ...] = ()
    components: tuple[Component, ...] = ()
    entry_points: tuple[EntryPoint, ...] = ()
    python_packages: tuple[str, ...] = ()
    """Importable modules and packages that it installs, dotted."""
    interfaces: tuple[str, ...] = ()
    """Generated interfaces, as ``msg/Name``."""
    command_names: tuple[str, ...] = ()
    """Names of the CMake commands that ran, in lower case, sorted, each once."""
    opaque: tuple[Opaque, ...] = ()
    problems: tuple[Problem, ...] = ()
    insertion: Span | None = None
    """Where an install rule can be added: an empty span before ament_package(), or None."""
    config_extras: tuple[str, ...] = ()
    """CMake files, relative to the package, whose code runs in every package that finds this one (CONFIG_EXTRAS)."""
    calls: tuple[Call, ...] = ()
    """The commands of its CMake files as they are written, file by file."""
    entry_point_modules: tuple[PythonModule, ...] = ()
    """Modules that its entry points name."""
    plugin_files: tuple[PluginFile, ...] = ()
    """Its plugin descriptions."""
    editable_lists: tuple[EditableList, ...] = ()
    referenced_resources: tuple[tuple[str, Span], ...] = ()
    """Resources that it does not install, each with a place where a text of the package names it in its folder."""
    scripts: tuple[ScriptFile, ...] = ()
    """Scripts that it installs to lib/<package> or bin, and those that lie beside them or in folders for scripts."""
    build_inputs: tuple[str, ...] = ()
    """Resources that it does not install and that its CMake files name all the same: what it is built from. Folders of
    them end with a slash."""
    editable_texts: tuple[WrittenText, ...] = ()
    subdirectories: tuple[str, ...] = ()
    """Folders below the package whose CMakeLists.txt is part of every build, relative to it."""
    test_subdirectories: tuple[str, ...] = ()
    """Folders below the package whose CMakeLists.txt is part of the build where tests are wanted, relative to it."""
    exported_packages: tuple[tuple[Mention, bool], ...] = ()
    """Packages that the CMake files for those who find this one search, and whether they do so under no condition."""
    unused_optional_finds: tuple[Span, ...] = ()
    """Where packages are searched that need not be there, and of which nothing is taken."""
    bundled_projects: tuple[str, ...] = ()
    """Projects that are built along with the package, by name: fetched ones, and those of its own folders."""
    interpreted_tests: tuple[str, ...] | None = None
    """Files and folders that are run as tests by an interpreter, relative to the package, "" for any; None where nobody
    knows."""
    relocated_modules: tuple[str, ...] = ()
    """Files with Python modules that it installs, relative to the package, and folders of them, with a slash at the end,
    where they lie elsewhere than the names say: ``package_dir`` of a setup.py."""
    exported: tuple[Exported, ...] = ()
    failed: bool = False
    """Whether it could not be evaluated by a mistake of ours, which ``opaque`` then tells."""
    insertion_after: Span | None = None
    """Where the command before ``end`` ends, if nothing but blank lines stand between the two."""
    runs_tests: bool = False
    """Whether it is a CMake script that calls what runs tests by an interpreter, going by the names of commands."""
    includes_outside_package: bool = False
    """Whether it is a CMake script that takes headers from folders of the sources outside of the package."""
    makes_nothing: bool = False
    """Whether it is a CMake script that builds, installs and tests nothing but the style of what is there."""
    commented_interfaces: tuple[str, ...] = ()
    """Interfaces that stand in comments of its CMake files, as ``msg/Name``: somebody took them off a list."""

    syntax: tuple[NewerSyntax, ...] = ()
    """What not every version of Python reads in a setup.py."""
    cmake_errors: tuple[Problem, ...] = ()
    """What CMake refuses in commands that are seen through all the same, so that it hides nothing: "undefined-target" of what
    commands are given targets for, "no-package" of what they are given packages for. The subject is the name."""

    @property
    def of_cmake(self) -> bool:
        """Whether it is a CMake script, and none of Python."""
        return self.path.endswith("CMakeLists.txt")

    @property
    def installed(self) -> frozenset[str]:
        """The files that are installed, by where they lie in the package. Generated ones are none of them."""
        return frozenset([provided.source for provided in self.installs if provided.source])

    @property
    def is_empty(self) -> bool:
        """Whether it is a CMake script without a command: empty, or all of it a comment."""
        return self.of_cmake and not (self.command_names or self.problems or self.opaque)

    def hides(self, facet: Facet) -> bool:
        """Whether the script cannot be seen through as to a facet. What code computes when it runs is no matter here."""
        return any(opaque.hides & facet for opaque in self.opaque)


NOTHING_BUILT: Final = BuildScript("")
"""What stands for the script of a package that has none: it builds and installs nothing."""
