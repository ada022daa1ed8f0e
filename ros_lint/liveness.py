"""What the files of a package serve, and whether they are alive: built, installed, included, tested, or lying around.

By target membership first, by include from what is alive second, by folder names last (reference, section C6.4).
"""

from __future__ import annotations

import posixpath
from collections.abc import Collection, Container, Iterable, Mapping
from functools import cached_property

from ros_lint.facts import BuildScript, Facet, FileFacts, Role

TEST_FOLDERS = frozenset({"test", "tests", "testing", "integration_tests", "benchmark", "benchmarks", "gtest", "unit_tests"})
"""Folders whose files serve tests when nothing else says what they serve."""

_IDLE_FOLDERS = frozenset({"doc", "docs", "example", "examples", "tutorial", "tutorials", "tools", "sphinx"})
"""Folders whose files are often not part of what the package builds and installs."""

HEADERS = (".h", ".hh", ".hpp", ".hxx", ".inl", ".ipp", ".tpp", ".cuh")
_INTERFACES = (".msg", ".srv", ".action", ".idl")
_RESOURCES = (".urdf", ".xacro", ".sdf", ".world", ".rviz", ".yaml", ".yml", ".xml")
_RUNNERS = ("pytest", "launch_test", "ros_test", "add_test", "nose")
"""Parts of the names of CMake commands that run tests in Python."""

_RECIPES = frozenset({"conanfile.py", "noxfile.py", "conf.py"})
"""Files of tools that have no part in a build by colcon."""

_PROGRAMS = ("lib/", "bin/")

_SHADOWED = frozenset({"launch"})
"""Folders of packages that are called like a module everybody imports: without __init__.py they do not hide it (PEP 420)."""

PRODUCTION = Role.BUILD | Role.EXEC
PUBLIC = Role.BUILD | Role.EXPORT | Role.EXEC


class Liveness:
    """Answers for the files of one package. Paths are relative to it; ``launched`` are its launch files."""

    def __init__(
        self,
        name: str,
        files: Iterable[str],
        script: BuildScript | None,
        facts: Mapping[str, FileFacts],
        launched: Collection[str] = (),
    ) -> None:
        self._name = name
        self._files = tuple(files)
        self._script = script
        self._facts = facts
        self._launched = launched
        self._included: dict[str, tuple[set[str], list[str]]] = {}
        hidden = Facet(0)
        for opaque in script.opaque if script else ():
            hidden |= opaque.hides
        self._sees_targets = script is not None and not hidden & (Facet.LIBRARIES | Facet.EXECUTABLES)
        self._sees_share = script is not None and not hidden & Facet.SHARE
        self._sees_python = script is not None and not hidden & (Facet.PYTHON | Facet.EXECUTABLES)

    def place(self, path: str) -> tuple[Role, bool]:
        """Return what a file is needed for, and whether it is sure to be alive."""
        name = path.rpartition("/")[2]
        if path in self._public:
            return PUBLIC, True
        if path in self._production:
            return PRODUCTION, True
        if path in self._tests:
            return Role.TEST, True
        if name.endswith(_INTERFACES):
            return PUBLIC, True
        python = name.endswith((".py", ".py.in")) or "." not in name
        resource = name.endswith(_RESOURCES)
        folders = set(path.split("/")[:-1])
        if TEST_FOLDERS & folders or (python and _is_test(name) and path not in self._started):
            # pytest takes what is called test, and beside it lie its helpers; elsewhere lies anything.
            taken = self._runs_python_tests and (_is_test(name) or path.rpartition("/")[0] in self._folders_with_tests)
            return Role.TEST, (taken or path in self._launched) if python else not (self._sees_targets or resource)
        if path in self._launched and (path in self._installed or path in self._installed_python):
            return Role.EXEC, True
        idle = bool(_IDLE_FOLDERS & folders)
        if path in self._launched:
            return Role.EXEC, not (self._sees_share or idle)
        if path == "setup.py":
            return Role.TOOL, True
        if resource:
            return Role.EXEC, path in self._installed or not (self._sees_share or idle)
        if python:
            alive = path in self._installed_python or (path in self._installed and path in self._beside_launch_files)
            return Role.EXEC, alive or not (self._sees_python or idle or name in _RECIPES)
        return PRODUCTION, not (self._sees_targets or idle)

    def has_module(self, module: str, importer: str) -> bool:
        """Whether an import in a file can mean a file of the package.

        What lies in a Python package is no module of its own, but for scripts beside it that are started where they are.
        """
        folders = self._modules.get(module, set())
        if not folders:
            return False
        here, _, name = importer.rpartition("/")
        beside = here in folders and name != f"{module}.py"
        return beside or module in self._installed_modules or not folders <= self._python_packages

    def own_includes(self, path: str) -> Container[str]:
        """Return the headers that a file includes and that are of the package, generated ones included."""
        return self._includes(path)[0]

    @cached_property
    def include_folders(self) -> frozenset[str]:
        """The folders that the package has in its include directories: a header in one of them is its own, if it is generated."""
        inner = (f"/{file}".partition("/include/")[2] for file in self._files)
        return frozenset([folder.partition("/")[0] for folder in inner if "/" in folder])

    def _own_headers(self, header: str, folder: str) -> tuple[str, ...]:
        """Return the files of the package that an include in a file of a folder can mean."""
        candidates = self._by_name.get(header.rpartition("/")[2])
        if candidates is None:
            return ()
        end = f"/{header}"
        if len(candidates) == 1 and f"/{candidates[0]}".endswith(end):
            return candidates
        beside = f"{folder}/{header}" if folder else header
        if "." in header[:2]:
            beside = posixpath.normpath(beside)
        if beside in candidates:
            return (beside,)
        return tuple([file for file in candidates if file == header or file.endswith(end)])

    @cached_property
    def _runs_python_tests(self) -> bool:
        """Whether anything runs tests written in Python: always in a Python package, and in others where CMake says so."""
        if self._script is None or not self._script.path.endswith("CMakeLists.txt"):
            return True
        return any(word in call for call in self._script.calls for word in _RUNNERS)

    @cached_property
    def _folders_with_tests(self) -> frozenset[str]:
        split = (file.rpartition("/") for file in self._files if file.endswith(".py"))
        return frozenset(folder for folder, _, name in split if _is_test(name))

    @cached_property
    def _by_name(self) -> Mapping[str, tuple[str, ...]]:
        found: dict[str, tuple[str, ...]] = {}
        for file in self._files:
            name = file.rpartition("/")[2]
            found[name] = (*found[name], file) if name in found else (file,)
        return found

    def _is_made(self, header: str, folder: str) -> bool:
        return any(self._own_headers(f"{header}{suffix}", folder) for suffix in (".in", ".em"))

    @cached_property
    def _templates(self) -> frozenset[str]:
        """Names of files that are made of others."""
        return frozenset([name[:-3] for name in self._by_name if name.endswith((".in", ".em"))])

    @cached_property
    def _modules(self) -> Mapping[str, set[str]]:
        """Files and folders with Python code, by the name that an import would have, with the folders that they lie in."""
        found: dict[str, set[str]] = {}
        for file in self._files:
            if file.endswith(".py"):
                path = file[:-3]
                while path:
                    folder, _, name = path.rpartition("/")
                    found.setdefault(name, set()).add(folder)
                    path = folder
        for name in _SHADOWED & found.keys():
            found[name] = {folder for folder in found[name] if f"{folder}/{name}".lstrip("/") in self._python_packages}
        return found

    @cached_property
    def _python_packages(self) -> frozenset[str]:
        """Folders that are Python packages. The top of a package is none, whatever lies there."""
        found = {file.rpartition("/")[0] for file in self._files if file.endswith("__init__.py")}
        return frozenset(found - {"", "src"})

    @cached_property
    def _installed_modules(self) -> frozenset[str]:
        names = self._script.python_packages if self._script else ()
        return frozenset([name.partition(".")[0] for name in names])

    @cached_property
    def _public(self) -> frozenset[str]:
        """Headers that are installed, and those that they include."""
        installed = {p.source for p in self._script.provides if p.path.startswith("include/")} if self._script else set()
        roots = {file for file in self._files if file.endswith(HEADERS) and (file in installed or file.startswith("include/"))}
        return self._reached(roots)

    @cached_property
    def _production(self) -> frozenset[str]:
        targets = self._script.targets if self._script else ()
        return self._reached({source for target in targets if not target.test for source in target.sources})

    @cached_property
    def _tests(self) -> frozenset[str]:
        targets = self._script.targets if self._script else ()
        return self._reached({source for target in targets if target.test for source in target.sources})

    @cached_property
    def _installed(self) -> frozenset[str]:
        return frozenset(p.source for p in self._script.provides if p.source) if self._script else frozenset()

    @cached_property
    def _started(self) -> frozenset[str]:
        """What people start, whatever its name: launch files and programs that are always installed, and entry points."""
        if self._script is None:
            return frozenset()
        always = [(p.source, p.path) for p in self._script.provides if p.source and not p.conditional]
        found = {source for source, path in always if source in self._launched or path.startswith(_PROGRAMS)}
        commands = [entry for entry in self._script.entry_points if entry.group in ("console_scripts", "gui_scripts")]
        modules = [entry.target.partition(":")[0].strip().replace(".", "/") for entry in commands]
        return frozenset([*found, *(f"{folder}{module}.py" for module in modules for folder in ("", "src/"))])

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
        if self._script is None:
            return frozenset()
        found = {p.source for p in self._script.provides if p.source and p.path.startswith(_PROGRAMS)}
        packages = [name.replace(".", "/") for name in self._script.python_packages]
        inside = tuple(f"{package}/" for package in packages)
        modules = {f"{package}{suffix}" for package in packages for suffix in (".py", ".py.in")}
        if packages:
            found.update([file for file in self._files if file in modules or file.startswith(inside)])
        return frozenset(found)

    def _reached(self, roots: Iterable[str]) -> frozenset[str]:
        reached: set[str] = set()
        waiting = [root for root in roots if root in self._facts]
        while waiting:
            path = waiting.pop()
            if path not in reached:
                reached.add(path)
                waiting += self._includes(path)[1]
        return frozenset(reached)

    def _includes(self, path: str) -> tuple[set[str], list[str]]:
        """Return what a file includes of the package: headers as it names them, and the files that these can be."""
        found = self._included.get(path)
        if found is not None:
            return found
        folder, by_name, templates = path.rpartition("/")[0], self._by_name, self._templates
        own = (self._name, ".", "..")
        headers: set[str] = set()
        files: list[str] = []
        for mention in self._facts[path].mentions if path in self._facts else ():
            if mention.via != "include":
                continue
            header = mention.name
            first, slash, _ = header.partition("/")
            name = header.rpartition("/")[2]
            means = self._own_headers(header, folder) if name in by_name else ()
            if means or (slash and first in own) or (name in templates and self._is_made(header, folder)):
                headers.add(header)
                files += means
        self._included[path] = (headers, files)
        return headers, files


def _is_test(name: str) -> bool:
    return name.startswith("test_") or name.endswith("_test.py") or name == "conftest.py"
