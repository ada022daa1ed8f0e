"""The results of a run of a package's CMake scripts."""

from __future__ import annotations

from ros_lint.base.text import Span
from ros_lint.collectors.cmake.evaluator.state import InstalledTarget, Properties
from ros_lint.facts.build import BuildProject, Component, InstalledFile
from ros_lint.facts.cmake import UnsetVariable
from ros_lint.facts.sources import Mention
from ros_lint.facts.visibility import Opaque, Problem


class Results:
    """The targets, files, exports and mentioned names that the commands of a package produce, in the order of the commands."""

    def __init__(self) -> None:
        self.project = BuildProject()
        self.mentions: dict[Mention, None] = {}
        self.opaques: dict[Opaque, None] = {}
        self.problems: dict[Problem, None] = {}
        self.errors: dict[Problem, None] = {}
        """Errors of CMake in commands whose effect is known despite the error."""
        self.unset_references: dict[UnsetVariable, None] = {}
        """References to variables that have no value where a command reads them."""
        self.components: list[Component] = []
        self.interfaces: dict[str, None] = {}
        self.python_packages: dict[str, None] = {}
        self.installed: list[InstalledFile] = []
        """Installed files. A file whose source does not exist counts only if the build generates the source."""
        self.installed_targets: list[InstalledTarget] = []
        self.exported_sets: dict[str, None] = {}
        """Names of export sets whose targets are certainly defined in each package that calls find_package() for this package."""
        self.targets: list[tuple[str, Properties, Span]] = []
        """Executables and libraries, in the order of their definition: name, properties and place."""
        self.links: dict[str, dict[str, Span]] = {}
        """By target: the linked libraries, each with the place of the library in the link command."""
        self.headers: dict[str, dict[str, None]] = {}
        """By target: the packages and targets from which the target may get include directories."""
        self.modified_targets: dict[tuple[str, str], Span] = {}
        """By target and command name: the place of the first command that certainly modifies the target."""
        self.undefined_targets: list[tuple[str, Span, bool]] = []
        """Installed targets without a definition: name, place, and whether it is certainly undefined when install() runs."""
        self.missing_files: list[tuple[str, Span, bool]] = []
        """Files that a command names and that exist only if the build generates them.

        Each entry is the path, the place, and whether a missing file may be harmless. The path of a folder ends with a slash."""
        self.config_extras: list[str] = []
        self.config_templates: dict[str, None] = {}
        """Templates of CMake files, relative to this package, that run in packages that call find_package() for this package."""
        self.subdirectories: dict[str, None] = {}
        """Folders below the package whose CMakeLists.txt certainly runs."""
        self.test_subdirectories: dict[str, None] = {}
        """Folders below the package whose CMakeLists.txt runs only if tests are enabled (BUILD_TESTING)."""
        self.bundled_projects: dict[str, None] = {}
        """Names of other projects that the build of the package also builds, such as those of FetchContent."""
        self.includes_outside_package = False
        """True if some include directory is a source folder outside of the package."""
        self.compiles_outside_package = False
        """True if some target has a source file outside of the package."""
        self.interpreted_tests: dict[str, None] = {}
        """Files and folders with tests that are run by an interpreter, for example by pytest."""
        self.insertion: Span | None = None
        """The place before ament_package() where fixes insert install rules; None if there is none."""
        self.insertion_after: Span | None = None
        """The end of the command before ``insertion`` if only blank lines separate it from ``insertion``, else None."""
