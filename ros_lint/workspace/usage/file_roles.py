"""What the files of a package serve, and whether they are alive: built, installed, included, tested, or lying around.

By target membership first, by include from what is alive second, by folder names last (reference, section C6.4).
"""

from __future__ import annotations

from collections.abc import Collection, Iterable
from functools import cached_property
from itertools import accumulate

from ros_lint.base import auxiliary_files as apart
from ros_lint.base.paths import folders_of
from ros_lint.collectors.suffixes import HEADERS, INTERFACES, SOURCES
from ros_lint.facts.build import NOTHING_BUILT
from ros_lint.facts.manifest import Role
from ros_lint.facts.visibility import Facet
from ros_lint.workspace.usage.own_files import OwnFiles

_TEST_FOLDERS = apart.TEST_FOLDERS | {"gtest"}
"""Folders whose files serve tests when nothing else says what they serve."""

_IDLE_FOLDERS = frozenset({"doc", "docs", "example", "examples", "tutorial", "tutorials", "tools", "sphinx"})
"""Folders whose files are often not part of what the package builds and installs."""

_OF_OTHERS = frozenset({"3rd_party", "3rdparty", "extern", "external", "externals", "third_party", "thirdparty"})
"""Folders for what others have made: who builds that does not test it."""

_RESOURCES = (".urdf", ".xacro", ".sdf", ".world", ".rviz", ".yaml", ".yml", ".xml")

_RECIPES = frozenset({"conanfile.py", "noxfile.py"})
"""Files of tools that have no part in a build by colcon."""

_OF_PAGES = frozenset({"doc", "docs", "sphinx"})
"""Folders with the pages of a package: programs in them make the pages."""

_STAND_INS = (".jinja.", ".j2.", ".tmpl.", ".template.")
"""Parts of the names of templates: what is made of them is of other packages."""

_PROJECTS = frozenset({"CMakeLists.txt", "setup.py", "pyproject.toml", "package.xml"})
"""Files that make a folder a project."""

_PROGRAMS = ("lib/", "bin/")

_OFFERS = frozenset({"ament_export_include_directories", "ament_export_interfaces", "ament_export_targets", "export"})
"""Commands that tell other packages of headers, which are then meant to be installed."""

PRODUCTION = Role.BUILD | Role.EXEC
PUBLIC = Role.BUILD | Role.EXPORT | Role.EXEC


class FileRoles:
    """Answers for the files of one package. Paths are relative to it; ``launched`` are its launch files."""

    def __init__(self, own: OwnFiles, launched: Collection[str]) -> None:
        self._own = own
        self._files = own.files
        known = own.script is not None
        self._script = script = own.script or NOTHING_BUILT
        self._sees_script = known
        self._facts = own.facts
        self._launched = launched
        hidden = around = beside = Facet(0)
        for opaque in script.opaque:
            hidden |= opaque.hides
            around |= opaque.hides if not (opaque.inside or opaque.below) else Facet(0)
            beside |= opaque.hides if not (opaque.inside or opaque.undefined) else Facet(0)
        self._sees_targets = known and not hidden & (Facet.LIBRARIES | Facet.EXECUTABLES)
        self._sees_share = known and not hidden & Facet.SHARE
        # What is built in a folder that is not there, such as a submodule, takes no sources and installs no modules from around
        # it; a target, no modules; and what is merely installed somewhere compiles nothing.
        self._sees_compiled = known and not around & (Facet.LIBRARIES | Facet.EXECUTABLES)
        self._sees_python = known and not beside & (Facet.PYTHON | Facet.EXECUTABLES)

    def place(self, path: str) -> tuple[Role, bool]:
        """Return what a file is needed for, and whether it is sure to be alive."""
        role, sure = self._place(path)
        return role, sure and not (self._idle and self._is_idle(path))

    def is_foreign(self, path: str) -> bool:
        """Return whether a file has no part in the package: a template for others, a recipe, what makes the pages, a copy."""
        folder, _, name = path.rpartition("/")
        folders = folder.split("/")
        if not apart.EDITORS_COPIES.isdisjoint(folders):
            return True
        looks_so = any(part in name for part in _STAND_INS) or (name.startswith("setup.py.") and folder)
        if not looks_so and name.endswith(".py"):
            # The recipe of Sphinx lies beside the first page, in a folder of any name.
            of_sphinx = name == "conf.py" and not {f"{folder}/index.rst", f"{folder}/index.md"}.isdisjoint(self._files)
            looks_so = of_sphinx or name in _RECIPES or not _OF_PAGES.isdisjoint(folders)
        return bool(looks_so) and path not in self._installed_python and path not in self._production

    def is_optional(self, path: str) -> bool:
        """Return whether only some builds compile a file, going by a condition that need not be true."""
        return path in self._optional and (path not in self._public or _stem(path) in self._optional_stems)

    def is_started(self, path: str) -> bool:
        """Return whether people start a file: a launch file, or a program that is always installed."""
        return path in self._started

    def serves_tests(self, path: str) -> bool:
        """Return whether a header is there for tests: nothing that is built and no test takes it, unless by including it."""
        return path not in self._production

    def _place(self, path: str) -> tuple[Role, bool]:
        name = path.rpartition("/")[2]
        if path in self._public:
            if path in self._installed_for_tests and path not in self._production:
                return Role.TEST, True
            left = path in self._left_over or path in self._kept or self._is_of_ros_1(path)
            return PUBLIC, path in self._production or not left
        if path in self._production:
            return PRODUCTION, True
        if path in self._tests:
            return Role.TEST, True
        if name.endswith(INTERFACES):
            return PUBLIC, self._generates is None or path in self._generates
        python = name.endswith((".py", ".py.in")) or "." not in name
        resource = name.endswith(_RESOURCES)
        folders = set(path.split("/")[:-1])
        if _TEST_FOLDERS & folders or self._is_of_tests(path) or (python and _is_test(name) and path not in self._started):
            # pytest takes what is called test, and beside it lie its helpers; elsewhere lies anything.
            taken = self._runs_python_tests and (self._is_run(path) or path in self._started_by_tests)
            alive = not (self._sees_compiled or resource or self._is_left_out(path) or _OF_OTHERS & folders)
            return Role.TEST, (taken or self._may_be_launched(path)) if python else alive
        if path in self._launched and (path in self._installed or path in self._installed_python):
            return Role.EXEC, not apart.is_backup_copy(path)
        idle = bool(_IDLE_FOLDERS & folders)
        if path in self._launched:
            return Role.EXEC, not (self._sees_share or idle)
        if path == "setup.py":
            return Role.TOOL, True
        if resource:
            return Role.EXEC, path in self._installed or not (self._sees_share or idle)
        if python:
            alive = path in self._installed_python or (path in self._installed and path in self._beside_launch_files)
            return Role.EXEC, alive or (not self._sees_python and self._is_of_python_package(path, idle=idle))
        return PRODUCTION, not (self._sees_compiled or idle or self._is_left_out(path))

    def _may_be_launched(self, path: str) -> bool:
        """Whether a file among the tests is a launch file, and not one that is left out of what is known to be run."""
        sees_all = self._script.interpreted_tests is not None or self._tests_nothing
        return path in self._launched and (not sees_all or path in self._installed)

    def _is_of_ros_1(self, path: str) -> bool:
        """Whether a header includes those of roscpp whatever the build, so that it compiles nowhere in ROS 2."""
        mentions = self._facts[path].mentions if path in self._facts else ()
        return any(each.name.startswith("ros/") and each.via == "include" and not each.optional for each in mentions)

    def _is_of_tests(self, path: str) -> bool:
        """Whether a file lies in a folder that is built for tests only, and is not installed out of there all the same."""
        of_tests = tuple([f"{folder}/" for folder in self._script.test_subdirectories])
        return path.startswith(of_tests) and path not in self._always_installed

    def _is_of_python_package(self, path: str, *, idle: bool) -> bool:
        """Whether a file is nearly sure to be installed, where it cannot be seen what is: a script may be anybody's."""
        folder, _, name = path.rpartition("/")
        if idle or name == "conf.py" or self._is_beside_script(path) or self._is_left_out(path):
            return False
        return not self._sees_script or f"{folder}/__init__.py" in self._facts

    def _is_beside_script(self, path: str) -> bool:
        """Whether a file lies at the top of a package that CMake builds: what works on the sources does, to release them, say."""
        return "/" not in path and self._script.of_cmake

    def _is_run(self, path: str) -> bool:
        """Whether a file in Python is run as a test, or lies beside one."""
        folder, _, name = path.rpartition("/")
        runs = self._script.interpreted_tests
        if runs is None:
            return _is_test(name) or folder in self._folders_with_tests
        if path in runs or "" in runs or path.startswith(tuple([f"{each}/" for each in runs])):
            return True
        return (not _is_test(name) or name.endswith(".in")) and any(each.rpartition("/")[0] == folder for each in runs)

    @cached_property
    def _started_by_tests(self) -> frozenset[str]:
        """Python files that those which are run as tests call by their names, each the only one of its name."""
        run = [facts for path, facts in self._facts.items() if facts.programs and self._is_run(path)]
        named = {name for facts in run for name in facts.programs}
        return frozenset([files[0] for files in map(self._own.by_name.get, named) if files is not None and len(files) == 1])

    def _is_left_out(self, path: str) -> bool:
        """Whether others in the folder of a file are built or installed by name, and this one is not."""
        folder, _, name = path.rpartition("/")
        return f"{folder}/*{name[name.rfind('.') :]}" in self._named and (name.endswith(".py") or self._sees_sources)

    @cached_property
    def _sees_sources(self) -> bool:
        """Whether it is known of every target what it is made of."""
        return all(target.sources_known for target in self._script.targets)

    @cached_property
    def _named(self) -> frozenset[str]:
        """Folders out of which the script takes files, each with what the names of these end with."""
        files = {source for target in self._script.targets for source in target.sources}
        files.update(self._installed)
        split = [file.rpartition("/") for file in files]
        return frozenset([f"{folder}/*{name[name.rfind('.') :]}" for folder, _, name in split])

    def _is_idle(self, path: str) -> bool:
        """Whether a file lies in a project of its own that is no sure part of the build, and nothing takes it out of there."""
        if path in self._production or path in self._tests or path in self._always_installed:
            return False
        return any(folder in self._idle for folder in folders_of(path))

    @cached_property
    def _idle(self) -> frozenset[str]:
        """Folders with projects of their own that are no sure part of the build of this one."""
        split = (file.rpartition("/") for file in self._files)
        return frozenset([folder for folder, _, name in split if folder and name in _PROJECTS]).difference(
            self._script.subdirectories
        )

    @cached_property
    def _runs_python_tests(self) -> bool:
        """Whether anything runs tests written in Python: always in a Python package, and in others where CMake says so."""
        return self._script.runs_tests or not self._script.of_cmake

    @cached_property
    def _tests_nothing(self) -> bool:
        """Whether CMake builds no tests, and runs none: what lies among them is started by nobody else either."""
        return not self._runs_python_tests and not any(target.test for target in self._script.targets)

    @cached_property
    def _folders_with_tests(self) -> frozenset[str]:
        split = (file.rpartition("/") for file in self._files if file.endswith(".py"))
        return frozenset(folder for folder, _, name in split if _is_test(name))

    @cached_property
    def _offered(self) -> frozenset[str]:
        """Headers that are installed, or lie where installed ones do."""
        headers = (file for file in self._files if file.endswith(HEADERS))
        return frozenset([file for file in headers if file in self._installed_headers or file.startswith("include/")])

    @cached_property
    def _installed_headers(self) -> frozenset[str]:
        return frozenset([p.source for p in self._script.installs if p.path.startswith("include/")])

    @cached_property
    def _public(self) -> frozenset[str]:
        """Headers that are installed, and those that they include."""
        return self._own.reached(self._offered)

    @cached_property
    def _left_over(self) -> frozenset[str]:
        """Headers that only sources include which nothing compiles."""
        if not self._sees_targets or not self._sees_sources:
            return frozenset()
        compiled = self._production | self._tests | self._optional
        idle = _TEST_FOLDERS | _IDLE_FOLDERS
        dead = {file for file in self._files if file.endswith(SOURCES) and idle.isdisjoint(file.split("/"))} - compiled
        left = self._own.reached(dead) - compiled if dead and self._production else frozenset()
        return left - self._own.reached(self._offered - left) if left else left

    @cached_property
    def _kept(self) -> frozenset[str]:
        """Headers that neither what is compiled nor another package includes: it builds programs only, and exports nothing."""
        script = self._script
        if not self._sees_targets or not self._sees_sources or not self._production:
            return frozenset()
        if any(target.kind != "executable" for target in script.targets if not target.test) or _OFFERS.intersection(
            script.command_names
        ):
            return frozenset()
        return self._public - self._own.reached(self._installed_headers) - self._production - self._tests - self._optional

    @cached_property
    def _installed_for_tests(self) -> frozenset[str]:
        """Files that are installed only where tests are wanted."""
        provides = self._script.installs
        always = {p.source for p in provides if not p.test}
        return frozenset([p.source for p in provides if p.test and p.source not in always])

    @cached_property
    def _generates(self) -> frozenset[str] | None:
        """Interface files that code is generated from, None where nobody knows."""
        if not self._sees_script or self._script.hides(Facet.INTERFACES):
            return None
        files = (file for file in self._files if file.endswith(INTERFACES))
        return frozenset([file for file in files if _interface(file) in self._script.interfaces])

    @cached_property
    def _production(self) -> frozenset[str]:
        return self._own.reached(self._compiled(test=False))

    @cached_property
    def _tests(self) -> frozenset[str]:
        return self._own.reached(self._compiled(test=True))

    @cached_property
    def _optional(self) -> frozenset[str]:
        """Files that are compiled, or included by what is, in some builds only."""
        sources = {source for target in self._script.targets for source in target.optional_sources}
        return self._own.reached(sources) - self._production - self._tests if sources else frozenset()

    @cached_property
    def _optional_stems(self) -> frozenset[str]:
        """Names of headers, without suffix and below any folder, that have a source which only some builds compile."""
        return frozenset([_stem(file) for file in self._optional if file.endswith(SOURCES)])

    def _compiled(self, *, test: bool) -> set[str]:
        """Return the sources of targets that are compiled in every build: also by one of two targets of a name."""
        found: set[str] = set()
        sometimes: dict[str, list[set[str]]] = {}
        for target in self._script.targets:
            if target.test is test:
                found.update(
                    target.sources if not target.optional_sources else set(target.sources).difference(target.optional_sources)
                )
                sometimes.setdefault(target.name, []).append(set(target.optional_sources))
        for alternatives in sometimes.values():
            if len(alternatives) > 1:
                found |= set.intersection(*alternatives)
        # Where everything hangs on a condition, the package is there for those for whom it holds.
        return found or {source for alternatives in sometimes.values() for one in alternatives for source in one}

    @cached_property
    def _installed(self) -> frozenset[str]:
        return self._script.installed

    @cached_property
    def _started(self) -> frozenset[str]:
        """What people start, whatever its name: launch files and programs that are always installed, and entry points."""
        always = [(p.source, p.path) for p in self._script.installs if p.source and not p.conditional]
        found = {source for source, path in always if source in self._launched or path.startswith(_PROGRAMS)}
        commands = [entry for entry in self._script.entry_points if entry.group in ("console_scripts", "gui_scripts")]
        modules = [entry.module.replace(".", "/") for entry in commands]
        return frozenset([*found, *(f"{folder}{module}.py" for module in modules for folder in ("", "src/"))])

    @cached_property
    def _always_installed(self) -> frozenset[str]:
        always = [p.source for p in self._script.installs if p.source and not p.conditional]
        return self._in_python_packages.union(always)

    @cached_property
    def _beside_launch_files(self) -> frozenset[str]:
        """What launch files may import from their own folder, having put it on the path."""
        found = set()
        for path in self._launched:
            folder = path[: path.rfind("/") + 1]
            for mention in self._facts[path].mentions if path in self._facts else ():
                if mention.via == "import":
                    found.add(f"{folder}{mention.name.partition('.')[0]}.py")
        return frozenset(found)

    @cached_property
    def _installed_python(self) -> frozenset[str]:
        found = {p.source for p in self._script.installs if p.source and p.path.startswith(_PROGRAMS)}
        return self._in_python_packages | found

    @cached_property
    def _in_python_packages(self) -> frozenset[str]:
        """Files of packages that are installed with all that is in them, as far as Python can find it."""
        if not self._script.python_packages:
            return frozenset()
        packages = [name.replace(".", "/") for name in self._script.python_packages]
        moved = self._script.relocated_modules
        inside = (*(f"{package}/" for package in packages), *(each for each in moved if each.endswith("/")))
        modules = frozenset([*moved, *(f"{package}{suffix}" for package in packages for suffix in (".py", ".py.in"))])
        below = [file for file in self._files if file.startswith(inside)]
        if projects := self._idle.difference(packages):  # what lies there is installed by another setup.py, if at all
            below = [file for file in below if projects.isdisjoint(folders_of(file))]
        unseen = self._unseen_folders([file for file in below if file.endswith(".py")], inside)
        kept = [file for file in below if not file.endswith(".py") or _is_of_modules(file, unseen)]
        return modules.intersection(self._files).union(kept)

    def _unseen_folders(self, modules: Iterable[str], packages: Iterable[str]) -> set[str]:
        """Return the folders of modules that are no packages, neither declared nor by a file, and that nothing imports from."""
        folders = {module.rpartition("/")[0] for module in modules}.difference([package.rstrip("/") for package in packages])
        found = {folder for folder in folders if f"{folder}/__init__.py" not in self._facts}
        return found - self._imported_folders if found else found

    @cached_property
    def _imported_folders(self) -> frozenset[str]:
        """Folders that a file of the package imports from, or that an entry point is in: those of other packages, too."""
        names = {mention.name for facts in self._facts.values() for mention in facts.mentions if mention.via == "import"}
        names.update([entry.module for entry in self._script.entry_points])
        paths = {path for name in names for path in accumulate(name.split("."), "{}/{}".format)}
        return frozenset([*paths, *(f"src/{path}" for path in paths)])


def _interface(path: str) -> str:
    """Return what a build script calls the interface that a file is for."""
    folder, _, name = path.rpartition("/")
    stem, _, suffix = name.rpartition(".")
    return f"{folder.rpartition('/')[2] if suffix == 'idl' else suffix}/{stem}"


def _is_of_modules(path: str, unseen: Collection[str]) -> bool:
    """Whether a file in Python can be imported: one called ``node copy.py`` was put aside by an editor or a file manager."""
    folder, _, name = path.rpartition("/")
    return folder not in unseen and " " not in name


def _stem(path: str) -> str:
    return path.rpartition("/")[2].rpartition(".")[0]


def _is_test(name: str) -> bool:
    return name.startswith("test_") or name.endswith("_test.py") or name == "conftest.py"
