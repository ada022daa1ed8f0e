"""Determine the role of each file of a package and whether it is in use.

The order of evidence is: membership in targets, inclusion by files in use, names of folders.
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
"""Folders whose files serve tests, unless something else determines their role."""

_IDLE_FOLDERS = frozenset({"doc", "docs", "example", "examples", "tutorial", "tutorials", "tools", "sphinx"})
"""Folders whose files are often not part of the build and the installation."""

_OF_OTHERS = frozenset({"3rd_party", "3rdparty", "extern", "external", "externals", "third_party", "thirdparty"})
"""Folders for third-party code, whose tests this package does not build."""

_RESOURCES = (".urdf", ".xacro", ".sdf", ".world", ".rviz", ".yaml", ".yml", ".xml")

_RECIPES = frozenset({"conanfile.py", "noxfile.py"})
"""Files of tools that are not part of a colcon build."""

_OF_PAGES = frozenset({"doc", "docs", "sphinx"})
"""Folders with documentation: programs in them generate it."""

_STAND_INS = (".jinja.", ".j2.", ".tmpl.", ".template.")
"""Parts of the names of templates, whose products belong to other packages."""

_PROJECTS = frozenset({"CMakeLists.txt", "setup.py", "pyproject.toml", "package.xml"})
"""Files that make a folder a separate project."""

_PROGRAMS = ("lib/", "bin/")

_OFFERS = frozenset({"ament_export_include_directories", "ament_export_interfaces", "ament_export_targets", "export"})
"""Commands that export headers to other packages: these headers are intended to be installed."""

PRODUCTION = Role.BUILD | Role.EXEC
PUBLIC = Role.BUILD | Role.EXPORT | Role.EXEC


class FileRoles:
    """The roles of the files of one package. Paths are relative to it; ``launched`` are its launch files."""

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
        # A build in a folder that is missing, such as a submodule, uses no sources and installs no modules from
        # outside of it. An undefined target installs no modules. An unknown installation compiles nothing.
        self._sees_compiled = known and not around & (Facet.LIBRARIES | Facet.EXECUTABLES)
        self._sees_python = known and not beside & (Facet.PYTHON | Facet.EXECUTABLES)

    def place(self, path: str) -> tuple[Role, bool]:
        """Return the role of a file, and whether the file is certainly in use."""
        role, sure = self._place(path)
        return role, sure and not (self._idle and self._is_idle(path))

    def is_foreign(self, path: str) -> bool:
        """Return whether a file is not part of the package.

        It is a template for others, a recipe of another tool, a generator of documentation or a backup copy.
        """
        folder, _, name = path.rpartition("/")
        folders = folder.split("/")
        if not apart.EDITORS_COPIES.isdisjoint(folders):
            return True
        looks_so = any(part in name for part in _STAND_INS) or (name.startswith("setup.py.") and folder)
        if not looks_so and name.endswith(".py"):
            # The configuration of Sphinx is next to the first page, in a folder of any name.
            of_sphinx = name == "conf.py" and not {f"{folder}/index.rst", f"{folder}/index.md"}.isdisjoint(self._files)
            looks_so = of_sphinx or name in _RECIPES or not _OF_PAGES.isdisjoint(folders)
        return bool(looks_so) and path not in self._installed_python and path not in self._production

    def is_optional(self, path: str) -> bool:
        """Return whether only some builds compile a file, depending on a condition that may be false."""
        return path in self._optional and (path not in self._public or _stem(path) in self._optional_stems)

    def is_started(self, path: str) -> bool:
        """Return whether users start a file: a launch file or program that is always installed."""
        return path in self._started

    def serves_tests(self, path: str) -> bool:
        """Return whether no production target compiles or includes a header."""
        return path not in self._production

    def _place(self, path: str) -> tuple[Role, bool]:
        name = path.rpartition("/")[2]
        if path in self._public:
            if path in self._installed_for_tests and path not in self._production:
                return Role.TEST, True
            unused = path in self._left_over or path in self._kept or self._is_of_ros_1(path)
            return PUBLIC, path in self._production or not unused
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
            # pytest collects files named like tests; their neighbours are helpers. Elsewhere a file may be anything.
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
        """Return whether a file among the tests is a launch file that may be run.

        If all tests that are run are known, only an installed file may be run.
        """
        sees_all = self._script.cmake.interpreted_tests is not None or self._tests_nothing
        return path in self._launched and (not sees_all or path in self._installed)

    def _is_of_ros_1(self, path: str) -> bool:
        """Return whether a header always includes headers of roscpp, so that it cannot be compiled in ROS 2."""
        mentions = self._facts[path].mentions if path in self._facts else ()
        return any(mention.name.startswith("ros/") and mention.via == "include" and not mention.optional for mention in mentions)

    def _is_of_tests(self, path: str) -> bool:
        """Return whether a file is in a folder that is built only for tests, and is not always installed."""
        of_tests = tuple([f"{folder}/" for folder in self._script.cmake.test_subdirectories])
        return path.startswith(of_tests) and path not in self._always_installed

    def _is_of_python_package(self, path: str, *, idle: bool) -> bool:
        """Return whether a file is almost certainly installed, although the installation is not visible.

        A standalone script is not, because it may be unrelated to the build.
        """
        folder, _, name = path.rpartition("/")
        if idle or name == "conf.py" or self._is_beside_script(path) or self._is_left_out(path):
            return False
        return not self._sees_script or f"{folder}/__init__.py" in self._facts

    def _is_beside_script(self, path: str) -> bool:
        """Return whether a file is in the root folder of a CMake package.

        Such scripts usually work on the sources, for example to release them.
        """
        return "/" not in path and self._script.of_cmake

    def _is_run(self, path: str) -> bool:
        """Return whether a Python file is run as a test, or is next to such a file."""
        folder, _, name = path.rpartition("/")
        runs = self._script.cmake.interpreted_tests
        if runs is None:
            return _is_test(name) or folder in self._folders_with_tests
        if path in runs or "" in runs or path.startswith(tuple([f"{run}/" for run in runs])):
            return True
        return (not _is_test(name) or name.endswith(".in")) and any(run.rpartition("/")[0] == folder for run in runs)

    @cached_property
    def _started_by_tests(self) -> frozenset[str]:
        """Python files that tests start by name, if only one file has the name."""
        run = [facts for path, facts in self._facts.items() if facts.programs and self._is_run(path)]
        named = {name for facts in run for name in facts.programs}
        return frozenset([files[0] for files in map(self._own.by_name.get, named) if files is not None and len(files) == 1])

    def _is_left_out(self, path: str) -> bool:
        """Return whether other files of the same folder and suffix are built or installed, but not this one."""
        folder, _, name = path.rpartition("/")
        return f"{folder}/*{name[name.rfind('.') :]}" in self._named and (name.endswith(".py") or self._sees_sources)

    @cached_property
    def _sees_sources(self) -> bool:
        """True if the sources of each target are known."""
        return all(target.sources_known for target in self._script.products.targets)

    @cached_property
    def _named(self) -> frozenset[str]:
        """Folders with built or installed files, each with the suffix of such a file."""
        files = {source for target in self._script.products.targets for source in target.sources}
        files.update(self._installed)
        split = [file.rpartition("/") for file in files]
        return frozenset([f"{folder}/*{name[name.rfind('.') :]}" for folder, _, name in split])

    def _is_idle(self, path: str) -> bool:
        """Return whether a file is in a separate project that may not be built, and nothing else uses it."""
        if path in self._production or path in self._tests or path in self._always_installed:
            return False
        return any(folder in self._idle for folder in folders_of(path))

    @cached_property
    def _idle(self) -> frozenset[str]:
        """Folders with separate projects that are not certainly part of the build of this package."""
        split = (file.rpartition("/") for file in self._files)
        return frozenset([folder for folder, _, name in split if folder and name in _PROJECTS]).difference(
            self._script.cmake.subdirectories
        )

    @cached_property
    def _runs_python_tests(self) -> bool:
        """True if Python tests are run: always in a Python package, in CMake packages if the script says so."""
        return self._script.cmake.runs_tests or not self._script.of_cmake

    @cached_property
    def _tests_nothing(self) -> bool:
        """True if CMake builds and runs no tests: then nothing starts the files among them."""
        return not self._runs_python_tests and not any(target.test for target in self._script.products.targets)

    @cached_property
    def _folders_with_tests(self) -> frozenset[str]:
        split = (file.rpartition("/") for file in self._files if file.endswith(".py"))
        return frozenset(folder for folder, _, name in split if _is_test(name))

    @cached_property
    def _offered(self) -> frozenset[str]:
        """Headers that are installed or in the folder ``include``."""
        headers = (file for file in self._files if file.endswith(HEADERS))
        return frozenset([file for file in headers if file in self._installed_headers or file.startswith("include/")])

    @cached_property
    def _installed_headers(self) -> frozenset[str]:
        return frozenset([p.source for p in self._script.products.installs if p.path.startswith("include/")])

    @cached_property
    def _public(self) -> frozenset[str]:
        """Headers that are installed, and headers that these include."""
        return self._own.reached(self._offered)

    @cached_property
    def _left_over(self) -> frozenset[str]:
        """Headers that only uncompiled sources include."""
        if not self._sees_targets or not self._sees_sources:
            return frozenset()
        compiled = self._production | self._tests | self._optional
        idle = _TEST_FOLDERS | _IDLE_FOLDERS
        dead = {file for file in self._files if file.endswith(SOURCES) and idle.isdisjoint(file.split("/"))} - compiled
        left = self._own.reached(dead) - compiled if dead and self._production else frozenset()
        return left - self._own.reached(self._offered - left) if left else left

    @cached_property
    def _kept(self) -> frozenset[str]:
        """Headers that neither compiled files nor other packages include.

        The package builds only programs and exports nothing.
        """
        script = self._script
        if not self._sees_targets or not self._sees_sources or not self._production:
            return frozenset()
        if any(target.kind != "executable" for target in script.products.targets if not target.test) or _OFFERS.intersection(
            script.commands.names
        ):
            return frozenset()
        return self._public - self._own.reached(self._installed_headers) - self._production - self._tests - self._optional

    @cached_property
    def _installed_for_tests(self) -> frozenset[str]:
        """Files that are installed only when tests are built."""
        provides = self._script.products.installs
        always = {p.source for p in provides if not p.test}
        return frozenset([p.source for p in provides if p.test and p.source not in always])

    @cached_property
    def _generates(self) -> frozenset[str] | None:
        """Interface files from which code is generated, None if unknown."""
        if not self._sees_script or self._script.hides(Facet.INTERFACES):
            return None
        files = (file for file in self._files if file.endswith(INTERFACES))
        return frozenset([file for file in files if _interface(file) in self._script.products.interfaces])

    @cached_property
    def _production(self) -> frozenset[str]:
        return self._own.reached(self._compiled(test=False))

    @cached_property
    def _tests(self) -> frozenset[str]:
        return self._own.reached(self._compiled(test=True))

    @cached_property
    def _optional(self) -> frozenset[str]:
        """Files that are compiled, or included by compiled files, in some builds only."""
        sources = {source for target in self._script.products.targets for source in target.optional_sources}
        return self._own.reached(sources) - self._production - self._tests if sources else frozenset()

    @cached_property
    def _optional_stems(self) -> frozenset[str]:
        """Names, without folder and suffix, of sources that only some builds compile."""
        return frozenset([_stem(file) for file in self._optional if file.endswith(SOURCES)])

    def _compiled(self, *, test: bool) -> set[str]:
        """Return the sources compiled in every build, also by one of two alternative targets of one name."""
        found: set[str] = set()
        sometimes: dict[str, list[set[str]]] = {}
        for target in self._script.products.targets:
            if target.test is test:
                found.update(
                    target.sources if not target.optional_sources else set(target.sources).difference(target.optional_sources)
                )
                sometimes.setdefault(target.name, []).append(set(target.optional_sources))
        for alternatives in sometimes.values():
            if len(alternatives) > 1:
                found |= set.intersection(*alternatives)
        # If everything is conditional, the package is relevant only where the condition holds.
        return found or {source for alternatives in sometimes.values() for sources in alternatives for source in sources}

    @cached_property
    def _installed(self) -> frozenset[str]:
        return self._script.products.installed

    @cached_property
    def _started(self) -> frozenset[str]:
        """Files that users start: launch files and programs that are always installed, and entry points."""
        always = [(p.source, p.path) for p in self._script.products.installs if p.source and not p.conditional]
        found = {source for source, path in always if source in self._launched or path.startswith(_PROGRAMS)}
        commands = [entry for entry in self._script.products.entry_points if entry.group in ("console_scripts", "gui_scripts")]
        modules = [entry.module.replace(".", "/") for entry in commands]
        return frozenset([*found, *(f"{folder}{module}.py" for module in modules for folder in ("", "src/"))])

    @cached_property
    def _always_installed(self) -> frozenset[str]:
        always = [p.source for p in self._script.products.installs if p.source and not p.conditional]
        return self._in_python_packages.union(always)

    @cached_property
    def _beside_launch_files(self) -> frozenset[str]:
        """Modules that launch files may import from their own folder, after adding it to ``sys.path``."""
        found = set()
        for path in self._launched:
            folder = path[: path.rfind("/") + 1]
            for mention in self._facts[path].mentions if path in self._facts else ():
                if mention.via == "import":
                    found.add(f"{folder}{mention.name.partition('.')[0]}.py")
        return frozenset(found)

    @cached_property
    def _installed_python(self) -> frozenset[str]:
        found = {p.source for p in self._script.products.installs if p.source and p.path.startswith(_PROGRAMS)}
        return self._in_python_packages | found

    @cached_property
    def _in_python_packages(self) -> frozenset[str]:
        """Files of installed Python packages, as far as Python can import them."""
        if not self._script.products.python_packages:
            return frozenset()
        packages = [name.replace(".", "/") for name in self._script.products.python_packages]
        moved = self._script.python.relocated_modules
        inside = (*(f"{package}/" for package in packages), *(path for path in moved if path.endswith("/")))
        modules = frozenset([*moved, *(f"{package}{suffix}" for package in packages for suffix in (".py", ".py.in"))])
        below = [file for file in self._files if file.startswith(inside)]
        if projects := self._idle.difference(packages):  # its files are installed by another setup.py, if at all
            below = [file for file in below if projects.isdisjoint(folders_of(file))]
        unseen = self._unseen_folders([file for file in below if file.endswith(".py")], inside)
        kept = [file for file in below if not file.endswith(".py") or _is_of_modules(file, unseen)]
        return modules.intersection(self._files).union(kept)

    def _unseen_folders(self, modules: Iterable[str], packages: Iterable[str]) -> set[str]:
        """Return folders of modules that are not Python packages and from which nothing is imported."""
        folders = {module.rpartition("/")[0] for module in modules}.difference([package.rstrip("/") for package in packages])
        found = {folder for folder in folders if f"{folder}/__init__.py" not in self._facts}
        return found - self._imported_folders if found else found

    @cached_property
    def _imported_folders(self) -> frozenset[str]:
        """Folders from which a file imports or that contain an entry point, including those of other packages."""
        names = {mention.name for facts in self._facts.values() for mention in facts.mentions if mention.via == "import"}
        names.update([entry.module for entry in self._script.products.entry_points])
        paths = {path for name in names for path in accumulate(name.split("."), "{}/{}".format)}
        return frozenset([*paths, *(f"src/{path}" for path in paths)])


def _interface(path: str) -> str:
    """Return the name of an interface file in a build script, as ``msg/Name``."""
    folder, _, name = path.rpartition("/")
    stem, _, suffix = name.rpartition(".")
    return f"{folder.rpartition('/')[2] if suffix == 'idl' else suffix}/{stem}"


def _is_of_modules(path: str, unseen: Collection[str]) -> bool:
    """Return whether a Python file can be imported: ``node copy.py`` is a copy made by a file manager."""
    folder, _, name = path.rpartition("/")
    return folder not in unseen and " " not in name


def _stem(path: str) -> str:
    return path.rpartition("/")[2].rpartition(".")[0]


def _is_test(name: str) -> bool:
    return name.startswith("test_") or name.endswith("_test.py") or name == "conftest.py"
