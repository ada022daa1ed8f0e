"""The collected results of a run of a package's CMake scripts."""

from __future__ import annotations

from ros_lint.base.text import Span
from ros_lint.collectors.cmake.evaluator.state import InstalledTarget, Properties
from ros_lint.facts.build import BuildProject, Component, InstalledFile
from ros_lint.facts.cmake import UnsetVariable
from ros_lint.facts.sources import Mention
from ros_lint.facts.visibility import Opaque, Problem


class Results:
    """The names, targets, files and exports that result from the commands of a package, in the order of the commands."""

    def __init__(self) -> None:
        self.project = BuildProject()
        self.mentions: dict[Mention, None] = {}
        self.opaques: dict[Opaque, None] = {}
        self.problems: dict[Problem, None] = {}
        self.errors: dict[Problem, None] = {}
        """Errors of CMake in commands whose effect is still known."""
        self.unset_references: dict[UnsetVariable, None] = {}
        """References to variables that have no value where they are read."""
        self.components: list[Component] = []
        self.interfaces: dict[str, None] = {}
        self.python_packages: dict[str, None] = {}
        self.installed: list[InstalledFile] = []
        """Installed files. A file whose source does not exist counts only if the source is generated."""
        self.installed_targets: list[InstalledTarget] = []
        self.exported_sets: dict[str, None] = {}
        """Export sets whose targets certainly reach each package that calls find_package() for this package."""
        self.targets: list[tuple[str, Properties, Span]] = []
        """Executables and libraries in the order of their definition."""
        self.links: dict[str, dict[str, Span]] = {}
        """Libraries of each target, with the place at which each is linked."""
        self.headers: dict[str, dict[str, None]] = {}
        """Packages and targets that may provide include directories, by target."""
        self.modified_targets: dict[tuple[str, str], Span] = {}
        """Places of the first command of each name that certainly modifies a target, by target and command."""
        self.undefined_targets: list[tuple[str, Span, bool]] = []
        """Installed targets that are not defined, and whether this is certain where install() is called."""
        self.missing_files: list[tuple[str, Span, bool]] = []
        """Named files that do not exist unless they are generated, and whether this may be harmless.

        The path of a folder ends with a slash."""
        self.config_extras: list[str] = []
        self.config_templates: dict[str, None] = {}
        """Templates, relative to this package, of files that packages read when they call find_package() for it."""
        self.subdirectories: dict[str, None] = {}
        """Folders below the package whose CMakeLists.txt certainly runs."""
        self.test_subdirectories: dict[str, None] = {}
        """Folders below the package whose CMakeLists.txt runs only if tests are built."""
        self.bundled_projects: dict[str, None] = {}
        """Other projects that the build of the package builds, such as those of FetchContent."""
        self.includes_outside_package = False
        """True if include directories are source folders outside of the package."""
        self.interpreted_tests: dict[str, None] = {}
        """Files and folders that an interpreter runs as tests."""
        self.insertion: Span | None = None
        """The place before ament_package(), where fixes insert install rules."""
        self.insertion_after: Span | None = None
        """The end of the command before ``insertion``, if only blank lines separate the two."""
