"""Determine for each file of a package whether it is needed to build, to run or to test, and whether it is in use.

The order of evidence is: membership in targets, inclusion by files in use, names of folders.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable
from functools import cached_property
from itertools import accumulate

from ros_lint.base import auxiliary_files
from ros_lint.base.paths import folders_of
from ros_lint.collectors.suffixes import HEADERS, INTERFACES, SOURCES
from ros_lint.facts.build import NOTHING_BUILT
from ros_lint.facts.manifest import Role
from ros_lint.facts.visibility import Facet
from ros_lint.workspace.usage.own_files import OwnFiles

_TEST_FOLDERS = auxiliary_files.TEST_FOLDERS | {"gtest"}
"""Names of folders whose files serve tests, unless other evidence determines their role."""

_UNBUILT_FOLDERS = frozenset({"doc", "docs", "example", "examples", "tutorial", "tutorials", "tools", "sphinx"})
"""Names of folders whose files are often neither built nor installed."""

_RESOURCES = (".urdf", ".xacro", ".sdf", ".world", ".rviz", ".yaml", ".yml", ".xml")

_RECIPES = frozenset({"conanfile.py", "noxfile.py"})
"""File names of Python scripts for tools that are not part of a colcon build (Conan, nox)."""

_DOCUMENTATION_FOLDERS = frozenset({"doc", "docs", "sphinx"})
"""Names of folders with documentation. Programs in them generate the documentation."""

_TEMPLATE_MARKS = (".jinja.", ".j2.", ".tmpl.", ".template.")
"""Parts of the names of template files. The files generated from them belong to other packages."""

_PROJECTS = frozenset({"CMakeLists.txt", "setup.py", "pyproject.toml", "package.xml"})
"""File names that make a folder a separate project."""

_PROGRAMS = ("lib/", "bin/")

_EXPORTING_COMMANDS = frozenset({"ament_export_include_directories", "ament_export_interfaces", "ament_export_targets", "export"})
"""Commands that export headers to other packages. The exported headers are intended to be installed."""

PRODUCTION = Role.BUILD | Role.EXEC
PUBLIC = Role.BUILD | Role.EXPORT | Role.EXEC


class FileRoles:
    """The roles of the files of one package: what they are needed for, e.g. ``Role.TEST``.

    Paths are relative to the package. ``launched`` has the paths of its launch files.
    """

    def __init__(self, own_files: OwnFiles, launched: Collection[str]) -> None:
        self._own_files = own_files
        self._files = own_files.files
        has_script = own_files.script is not None
        self._script = script = own_files.script or NOTHING_BUILT
        self._script_known = has_script
        self._facts = own_files.facts
        self._launched = launched
        hidden = compiled_hidden = python_hidden = Facet(0)
        for opaque in script.opaque:
            hidden |= opaque.hides
            compiled_hidden |= opaque.hides if not (opaque.inside or opaque.below) else Facet(0)
            python_hidden |= opaque.hides if not (opaque.inside or opaque.undefined) else Facet(0)
        self._targets_known = has_script and not hidden & (Facet.LIBRARIES | Facet.EXECUTABLES)
        self._share_known = has_script and not hidden & Facet.SHARE
        # A build in a folder that is missing, such as a submodule, uses no sources and installs no modules from
        # outside of it. An undefined target installs no modules. An unknown installation compiles nothing.
        self._compiled_known = has_script and not compiled_hidden & (Facet.LIBRARIES | Facet.EXECUTABLES)
        self._python_known = has_script and not python_hidden & (Facet.PYTHON | Facet.EXECUTABLES)

    def role(self, path: str) -> tuple[Role, bool]:
        """Return what a file is needed for (``Role.TEST``), and whether a build, launch file or test certainly uses the file."""
        role, certain = self._role(path)
        return role, certain and not (self._separate_projects and self._is_in_separate_project(path))

    def is_template_or_recipe(self, path: str) -> bool:
        """Return whether a file is a template, a script for another tool, a generator of documentation or a backup copy.

        Such a file is not part of the package.
        """
        folder, _, name = path.rpartition("/")
        folders = folder.split("/")
        if not auxiliary_files.EDITOR_COPY_FOLDERS.isdisjoint(folders):
            return True
        looks_unrelated = any(part in name for part in _TEMPLATE_MARKS) or (name.startswith("setup.py.") and folder)
        if not looks_unrelated and name.endswith(".py"):
            # The configuration of Sphinx is next to the first page, in a folder of any name.
            is_sphinx_configuration = name == "conf.py" and not {f"{folder}/index.rst", f"{folder}/index.md"}.isdisjoint(
                self._files
            )
            looks_unrelated = is_sphinx_configuration or name in _RECIPES or not _DOCUMENTATION_FOLDERS.isdisjoint(folders)
        if not looks_unrelated or path in self._installed_python or path in self._production:
            return False
        return not (path in self._launched and path in self._installed)

    def is_optional(self, path: str) -> bool:
        """Return whether only some builds compile a file, because its target or its inclusion depends on a condition."""
        return path in self._optional and (path not in self._public or _stem(path) in self._optional_stems)

    def is_started(self, path: str) -> bool:
        """Return whether users start a file. It is then a program or launch file that every build installs."""
        return path in self._started

    def serves_tests(self, path: str) -> bool:
        """Return whether only tests of this package can include a file.

        The file is then not installed, and no source outside of the tests includes it.
        """
        return path not in self._production and path not in self._installed_headers

    def _role(self, path: str) -> tuple[Role, bool]:
        name = path.rpartition("/")[2]
        if path in self._public:
            of_tests = path in self._installed_for_tests or (self._builds_only_tests and path not in self._installed_headers)
            if of_tests and path not in self._production:
                return Role.TEST, True
            unused = path in self._headers_of_uncompiled_sources or path in self._unreferenced_headers or self._is_of_ros_1(path)
            return PUBLIC, path in self._production or not (unused or self._may_serve_tests_only(path))
        if path in self._production:
            return PRODUCTION, True
        if path in self._tests:
            return Role.TEST, True
        if name.endswith(INTERFACES):
            return PUBLIC, self._generates is None or path in self._generates
        python = name.endswith((".py", ".py.in")) or "." not in name
        resource = name.endswith(_RESOURCES)
        folders = set(path.split("/")[:-1])
        if (
            _TEST_FOLDERS & folders
            or self._is_in_test_subdirectory(path)
            or (python and _is_test(name) and path not in self._started)
        ):
            # pytest collects files named like tests; their neighbours are helpers. Elsewhere a file may be anything.
            is_run = self._runs_python_tests and (self._is_run(path) or path in self._started_by_tests)
            in_use = not (
                self._compiled_known or resource or self._siblings_are_used(path) or auxiliary_files.THIRD_PARTY_FOLDERS & folders
            )
            return Role.TEST, (is_run or self._may_be_launched(path)) if python else in_use
        if path in self._launched and (path in self._installed or path in self._installed_python):
            return Role.EXEC, not auxiliary_files.is_backup_copy(path)
        in_unbuilt_folder = bool(_UNBUILT_FOLDERS & folders)
        if path in self._launched:
            return Role.EXEC, not (self._share_known or in_unbuilt_folder)
        if path == "setup.py":
            return Role.TOOL, True
        if resource:
            return Role.EXEC, path in self._installed or not (self._share_known or in_unbuilt_folder)
        if python:
            in_use = path in self._installed_python or (path in self._installed and path in self._beside_launch_files)
            return Role.EXEC, in_use or (
                not self._python_known and self._is_of_python_package(path, in_unbuilt_folder=in_unbuilt_folder)
            )
        return PRODUCTION, not (self._compiled_known or in_unbuilt_folder or self._siblings_are_used(path))

    def _may_be_launched(self, path: str) -> bool:
        """Return whether a file in a folder of tests is a launch file that a test or a user may launch.

        If the build script shows all tests that are run, the launch file must be installed, because then only users launch it.
        """
        sees_all = self._script.cmake.interpreted_tests is not None or self._has_no_tests
        return path in self._launched and (not sees_all or path in self._installed)

    def _is_of_ros_1(self, path: str) -> bool:
        """Return whether a header always includes headers of roscpp, so that it cannot be compiled in ROS 2."""
        mentions = self._facts[path].mentions if path in self._facts else ()
        return any(mention.name.startswith("ros/") and mention.via == "include" and not mention.optional for mention in mentions)

    def _is_in_test_subdirectory(self, path: str) -> bool:
        """Return whether a file is in a folder that CMake adds only to build tests, and is not installed in every build."""
        of_tests = tuple([f"{folder}/" for folder in self._script.cmake.test_subdirectories])
        return path.startswith(of_tests) and path not in self._always_installed

    def _is_of_python_package(self, path: str, *, in_unbuilt_folder: bool) -> bool:
        """Return whether a Python file is almost certainly installed, although the installation cannot be evaluated.

        The result is False for a standalone script, which may be unrelated to the build. It is also False if
        ``in_unbuilt_folder``: the file is in a folder that is often not installed, such as ``docs``.
        """
        folder, _, name = path.rpartition("/")
        if in_unbuilt_folder or name == "conf.py" or self._is_beside_script(path) or self._siblings_are_used(path):
            return False
        return not self._script_known or f"{folder}/__init__.py" in self._facts

    def _is_beside_script(self, path: str) -> bool:
        """Return whether a file is next to the CMakeLists.txt, in the root folder of a CMake package.

        A Python file there is usually a development tool, for example to make a release.
        """
        return "/" not in path and self._script.of_cmake

    def _is_run(self, path: str) -> bool:
        """Return whether a Python file is run as a test, or is in the folder of a file that is run as a test."""
        folder, _, name = path.rpartition("/")
        runs = self._script.cmake.interpreted_tests
        if runs is None:
            return _is_test(name) or folder in self._folders_with_tests
        if path in runs or "" in runs or path.startswith(tuple([f"{run}/" for run in runs])):
            return True
        return (not _is_test(name) or name.endswith(".in")) and any(run.rpartition("/")[0] == folder for run in runs)

    @cached_property
    def _started_by_tests(self) -> frozenset[str]:
        """Python files whose name occurs in a string of a test, if only one file of the package has the name."""
        run = [facts for path, facts in self._facts.items() if facts.programs and self._is_run(path)]
        named = {name for facts in run for name in facts.programs}
        return frozenset([files[0] for files in map(self._own_files.by_name.get, named) if files is not None and len(files) == 1])

    def _siblings_are_used(self, path: str) -> bool:
        """Return whether files with the folder and the suffix of ``path`` are built or installed by name."""
        folder, _, name = path.rpartition("/")
        return f"{folder}/*{name[name.rfind('.') :]}" in self._used_patterns and (name.endswith(".py") or self._sources_known)

    @cached_property
    def _sources_known(self) -> bool:
        """True if the sources of every target are known."""
        return all(target.sources_known for target in self._script.products.targets)

    @cached_property
    def _used_patterns(self) -> frozenset[str]:
        """Folders with built or installed files, each with the suffix of such a file: ``src/*.cpp``."""
        files = {source for target in self._script.products.targets for source in target.sources}
        files.update(self._installed)
        split = [file.rpartition("/") for file in files]
        return frozenset([f"{folder}/*{name[name.rfind('.') :]}" for folder, _, name in split])

    def _is_in_separate_project(self, path: str) -> bool:
        """Return whether a file belongs only to a separate project that may not be built.

        A separate project is a subfolder with its own CMakeLists.txt, setup.py, pyproject.toml or package.xml.
        """
        if path in self._production or path in self._tests or path in self._always_installed:
            return False
        return any(folder in self._separate_projects for folder in folders_of(path))

    @cached_property
    def _separate_projects(self) -> frozenset[str]:
        """Folders of separate projects that are not certainly part of the build of this package."""
        split = (file.rpartition("/") for file in self._files)
        return frozenset([folder for folder, _, name in split if folder and name in _PROJECTS]).difference(
            self._script.cmake.subdirectories
        )

    @cached_property
    def _runs_python_tests(self) -> bool:
        """True if Python tests are run: always in a Python package, and in a CMake package whose script runs them."""
        return self._script.cmake.runs_tests or not self._script.of_cmake

    @cached_property
    def _has_no_tests(self) -> bool:
        """True if CMake builds and runs no tests, so that no test starts the files in the folders of tests."""
        return not self._runs_python_tests and not any(target.test for target in self._script.products.targets)

    @cached_property
    def _folders_with_tests(self) -> frozenset[str]:
        split = (file.rpartition("/") for file in self._files if file.endswith(".py"))
        return frozenset(folder for folder, _, name in split if _is_test(name))

    @cached_property
    def _exported_headers(self) -> frozenset[str]:
        """Headers that are installed or in the folder ``include``."""
        headers = (file for file in self._files if file.endswith(HEADERS))
        return frozenset([file for file in headers if file in self._installed_headers or file.startswith("include/")])

    @cached_property
    def _installed_headers(self) -> frozenset[str]:
        return frozenset([p.source for p in self._script.products.installs if p.path.startswith("include/")])

    @cached_property
    def _public(self) -> frozenset[str]:
        """Headers that are installed or in the folder ``include``, and all headers that they include."""
        return self._own_files.include_closure(self._exported_headers)

    @cached_property
    def _headers_of_uncompiled_sources(self) -> frozenset[str]:
        """Headers that only uncompiled sources include."""
        if not self._targets_known or not self._sources_known:
            return frozenset()
        compiled = self._production | self._tests | self._optional
        unbuilt = _TEST_FOLDERS | _UNBUILT_FOLDERS
        uncompiled = {file for file in self._files if file.endswith(SOURCES) and unbuilt.isdisjoint(file.split("/"))} - compiled
        headers = self._own_files.include_closure(uncompiled) - compiled if uncompiled and self._production else frozenset()
        return headers - self._own_files.include_closure(self._exported_headers - headers) if headers else headers

    @cached_property
    def _unreferenced_headers(self) -> frozenset[str]:
        """Headers in the folder ``include`` that no installed header and no compiled file includes.

        Empty unless the package builds only programs and exports nothing.
        """
        script = self._script
        if not self._targets_known or not self._sources_known or not self._production:
            return frozenset()
        if any(
            target.kind != "executable" for target in script.products.targets if not target.test
        ) or _EXPORTING_COMMANDS.intersection(script.commands.names):
            return frozenset()
        return (
            self._public
            - self._own_files.include_closure(self._installed_headers)
            - self._production
            - self._tests
            - self._optional
        )

    @cached_property
    def _installed_for_tests(self) -> frozenset[str]:
        """Files that are installed only when tests are built."""
        provides = self._script.products.installs
        always = {p.source for p in provides if not p.test}
        return frozenset([p.source for p in provides if p.test and p.source not in always])

    @cached_property
    def _builds_only_tests(self) -> bool:
        """True if the package has targets and builds all of them only for tests."""
        targets = self._script.products.targets
        return self._targets_known and bool(targets) and all(target.test for target in targets)

    def _may_serve_tests_only(self, header: str) -> bool:
        """Return whether a header may serve only tests, because no target and no installation of the header is known."""
        return not self._targets_known and not self._script.products.targets and header not in self._installed_headers

    @cached_property
    def _generates(self) -> frozenset[str] | None:
        """Interface files from which code is generated; None if they are unknown."""
        if not self._script_known or self._script.hides(Facet.INTERFACES):
            return None
        files = (file for file in self._files if file.endswith(INTERFACES))
        return frozenset([file for file in files if _interface(file) in self._script.products.interfaces])

    @cached_property
    def _production(self) -> frozenset[str]:
        return self._own_files.include_closure(self._compiled(test=False))

    @cached_property
    def _tests(self) -> frozenset[str]:
        return self._own_files.include_closure(self._compiled(test=True))

    @cached_property
    def _optional(self) -> frozenset[str]:
        """Files that only some builds compile or include."""
        sources = {source for target in self._script.products.targets for source in target.optional_sources}
        return self._own_files.include_closure(sources) - self._production - self._tests if sources else frozenset()

    @cached_property
    def _optional_stems(self) -> frozenset[str]:
        """Names, without folder and suffix, of sources that only some builds compile."""
        return frozenset([_stem(file) for file in self._optional if file.endswith(SOURCES)])

    def _compiled(self, *, test: bool) -> set[str]:
        """Return the sources that every build compiles: for tests if ``test`` is true, else for all other targets.

        If a target has alternative definitions, a source that is in all definitions counts. If every source is conditional, all
        count.
        """
        result: set[str] = set()
        optional_by_target: dict[str, list[set[str]]] = {}
        for target in self._script.products.targets:
            if target.test is test:
                result.update(
                    target.sources if not target.optional_sources else set(target.sources).difference(target.optional_sources)
                )
                optional_by_target.setdefault(target.name, []).append(set(target.optional_sources))
        for alternatives in optional_by_target.values():
            if len(alternatives) > 1:
                result |= set.intersection(*alternatives)
        # If everything is conditional, the package is relevant only where the condition holds.
        return result or {
            source for alternatives in optional_by_target.values() for sources in alternatives for source in sources
        }

    @cached_property
    def _installed(self) -> frozenset[str]:
        return self._script.products.installed

    @cached_property
    def _started(self) -> frozenset[str]:
        """Files that users start: launch files and programs that every build installs, and modules of entry points."""
        always = [(p.source, p.path) for p in self._script.products.installs if p.source and not p.conditional]
        result = {source for source, path in always if source in self._launched or path.startswith(_PROGRAMS)}
        commands = [entry for entry in self._script.products.entry_points if entry.group in ("console_scripts", "gui_scripts")]
        modules = [entry.module.replace(".", "/") for entry in commands]
        return frozenset([*result, *(f"{folder}{module}.py" for module in modules for folder in ("", "src/"))])

    @cached_property
    def _always_installed(self) -> frozenset[str]:
        always = [p.source for p in self._script.products.installs if p.source and not p.conditional]
        return self._in_python_packages.union(always)

    @cached_property
    def _beside_launch_files(self) -> frozenset[str]:
        """Modules that launch files may import from their own folder, after they add the folder to ``sys.path``."""
        result = set()
        for path in self._launched:
            folder = path[: path.rfind("/") + 1]
            for mention in self._facts[path].mentions if path in self._facts else ():
                if mention.via == "import":
                    result.add(f"{folder}{mention.name.partition('.')[0]}.py")
        return frozenset(result)

    @cached_property
    def _installed_python(self) -> frozenset[str]:
        programs = {p.source for p in self._script.products.installs if p.source and p.path.startswith(_PROGRAMS)}
        return self._in_python_packages | programs

    @cached_property
    def _in_python_packages(self) -> frozenset[str]:
        """Files of installed Python packages, without Python files that cannot be imported."""
        if not self._script.products.python_packages:
            return frozenset()
        packages = [name.replace(".", "/") for name in self._script.products.python_packages]
        relocated = self._script.python.relocated_modules
        prefixes = (*(f"{package}/" for package in packages), *(path for path in relocated if path.endswith("/")))
        modules = frozenset([*relocated, *(f"{package}{suffix}" for package in packages for suffix in (".py", ".py.in"))])
        files = [file for file in self._files if file.startswith(prefixes)]
        if separate := self._separate_projects.difference(packages):  # its files are installed by another setup.py, if at all
            files = [file for file in files if separate.isdisjoint(folders_of(file))]
        plain_folders = self._plain_folders([file for file in files if file.endswith(".py")], prefixes)
        importable = [file for file in files if not file.endswith(".py") or _is_importable(file, plain_folders)]
        return modules.intersection(self._files).union(importable)

    def _plain_folders(self, modules: Iterable[str], packages: Iterable[str]) -> set[str]:
        """Return the folders of ``modules`` that have no ``__init__.py``. Folders from which the package imports are left out.

        ``packages`` are the folders of installed Python packages, which are also left out.
        """
        folders = {module.rpartition("/")[0] for module in modules}.difference([package.rstrip("/") for package in packages])
        plain_folders = {folder for folder in folders if f"{folder}/__init__.py" not in self._facts}
        return plain_folders - self._imported_folders if plain_folders else plain_folders

    @cached_property
    def _imported_folders(self) -> frozenset[str]:
        """Paths of modules that the package imports or starts as entry points, with the paths of all parent modules.

        ``import a.b`` gives ``a``, ``a/b``, ``src/a`` and ``src/a/b``. Modules of other packages are included.
        """
        names = {mention.name for facts in self._facts.values() for mention in facts.mentions if mention.via == "import"}
        names.update([entry.module for entry in self._script.products.entry_points])
        paths = {path for name in names for path in accumulate(name.split("."), "{}/{}".format)}
        return frozenset([*paths, *(f"src/{path}" for path in paths)])


def _interface(path: str) -> str:
    """Return the name that a build script uses for the interface file at ``path``: ``a/msg/Pose.msg`` -> ``msg/Pose``."""
    folder, _, name = path.rpartition("/")
    stem, _, suffix = name.rpartition(".")
    return f"{folder.rpartition('/')[2] if suffix == 'idl' else suffix}/{stem}"


def _is_importable(path: str, plain_folders: Collection[str]) -> bool:
    """Return whether Python can import a file. False for files in ``plain_folders`` and copies such as ``node copy.py``."""
    folder, _, name = path.rpartition("/")
    return folder not in plain_folders and " " not in name


def _stem(path: str) -> str:
    return path.rpartition("/")[2].rpartition(".")[0]


def _is_test(name: str) -> bool:
    return name.startswith("test_") or name.endswith("_test.py") or name == "conftest.py"
