"""The files that setup() installs according to its options: data files, scripts, entry points, and Python modules."""

from __future__ import annotations

import posixpath
import re
from collections.abc import Callable, Iterator, Mapping
from collections.abc import Set as AbstractSet
from typing import NamedTuple

from ros_lint.base.text import Span
from ros_lint.collectors.python.interpreter.alternatives import plain
from ros_lint.collectors.python.interpreter.values import (
    Class,
    Globbed,
    Guarded,
    Unknown,
    Value,
)
from ros_lint.collectors.setup_py.interpreter.files import Files
from ros_lint.collectors.setup_py.interpreter.values import REST
from ros_lint.facts.build import InstalledFile
from ros_lint.facts.setup_py import EntryPoint
from ros_lint.facts.visibility import Facet, Opaque, Problem

INSTALLED = Facet.SHARE | Facet.EXECUTABLES | Facet.PYTHON
"""The parts of a package whose content setup.py determines."""
_HARMLESS_COMMANDS = frozenset({"sdist", "test", "clean", "pytest", "lint", "upload", "docs", "build_sphinx"})
_ENTRY = re.compile(r"\s*([^=\s][^=]*?)\s*=\s*(.*?)\s*\Z", re.DOTALL)
_RESERVED_FOLDERS = frozenset(
    {
        "ci", "bin", "debian", "doc", "docs", "documentation", "manpages", "news", "newsfragments", "changelog", "test",
        "tests", "unit_test", "unit_tests", "example", "examples", "scripts", "tools", "util", "utils", "python",
        "build", "dist", "venv", "env", "requirements", "tasks", "fabfile", "site_scons", "benchmark", "benchmarks",
        "exercise", "exercises", "htmlcov",
    }
)  # fmt: skip
"""Folders that the automatic discovery of setuptools does not treat as packages."""


class SetupContext(NamedTuple):
    """The inputs, besides the options of setup(), from which the installed files of a package are computed."""

    files: Files
    executables: AbstractSet[str]
    scripts: str | None
    """The folder of programs relative to the prefix, None if it is unknown."""
    call: Span
    """The span of the call of setup(), which is used for values without a span."""
    conditional: bool


class Distribution:
    """The files that one call of setup() installs. :meth:`read` computes them.

    ``place(value, default)`` returns the span of a value, and ``default`` for a value without a span.
    """

    def __init__(self, context: SetupContext, place: Callable[[Value, Span], Span]) -> None:
        self._context = context
        self._place = place
        self.provides: list[InstalledFile] = []
        self.entry_points: list[EntryPoint] = []
        self.python_packages: list[str] = []
        self.moved: list[str] = []
        self.opaque: list[Opaque] = []
        self.problems: list[Problem] = []

    def read(self, options: Mapping[str, Value]) -> None:
        """Compute from the options of setup() which files the call installs, and store them in the attributes."""
        if REST in options:
            self._hide(INSTALLED, options[REST])
        self._python(options)
        self._data_files(options.get("data_files"))
        self._scripts(options.get("scripts"))
        self._entry_points(options.get("entry_points"))
        if options.get("ext_modules"):
            self.opaque.append(Opaque(Facet.PYTHON, "the names of the modules of an extension are unknown", self._context.call))
        commands = options.get("cmdclass")
        if isinstance(commands, Unknown):
            self._hide(INSTALLED, commands)
        elif isinstance(commands, dict):
            for name, command in commands.items():
                if name not in _HARMLESS_COMMANDS:
                    what = command.name if isinstance(command, Class) else "another class"
                    reason = f"the command {name} is replaced by {what}, which may install anything"
                    self.opaque.append(Opaque(INSTALLED, reason, self._context.call))

    def _hide(self, facet: Facet, value: Value) -> None:
        reason = value.reason if isinstance(value, Unknown) else "its form is not supported"
        self.opaque.append(Opaque(facet, reason, self._place(value, self._context.call)))

    def _items(self, value: Value, facet: Facet) -> Iterator[tuple[Value, bool]]:
        """Yield the known elements of a list, each with a boolean: True if the element may be missing.

        If ``value`` or an element is unknown, record that the part ``facet`` of the package may contain more than is known.
        """
        if value is None:
            return
        if not isinstance(value, (list, tuple)):
            self._hide(facet, value)
            return
        for item in value:
            inner = plain(item)
            if isinstance(inner, Unknown):
                self._hide(facet, inner)
            else:
                yield inner, isinstance(item, Guarded)

    # --- Python

    def _python(self, options: Mapping[str, Value]) -> None:
        packages, modules = options.get("packages"), options.get("py_modules")
        folders = options.get("package_dir")
        if folders is not None and (not isinstance(folders, dict) or REST in folders):
            self._hide(Facet.PYTHON, folders[REST] if isinstance(folders, dict) else folders)
            folders = None
        known = {str(name): str(folder) for name, folder in (folders or {}).items() if not isinstance(folder, Unknown)}
        if packages is None and modules is None and REST not in options:
            packages, known = self._discovered(known)
        for name, _ in self._items(packages, Facet.PYTHON):
            if isinstance(name, str):
                self._package(name, known)
        for name, _ in self._items(modules, Facet.PYTHON):
            if isinstance(name, str):
                path = posixpath.join(known.get("", ""), name.replace(".", "/") + ".py")
                self.python_packages.append(str(name))
                if known.get(""):
                    self.moved.append(posixpath.normpath(path))
                if not self._context.files.is_file(path):
                    self._problem("missing-file", f"'{path}' does not exist", name, path)

    def _package(self, given: str, folders: Mapping[str, str]) -> None:
        files = self._context.files
        name = given.strip("/").replace("/", ".")  # setuptools warns about a path, but installs that package
        folder = folder_of(name, folders)
        self.python_packages.append(name)
        if not files.is_folder(folder or "."):
            self._problem("missing-file", f"folder '{folder}' of package '{name}' does not exist", given, folder)
        modules = files.modules(folder)
        self.python_packages += [f"{name}.{module}" for module in modules if module != "__init__"]
        lies = posixpath.normpath(folder)
        if lies != name.replace(".", "/"):
            self.moved += [f"{lies}/"] if lies != "." else [f"{module}.py" for module in modules]

    def _discovered(self, folders: dict[str, str]) -> tuple[list[str], dict[str, str]]:
        """Return the packages that setuptools (since 61) discovers without the option ``packages``, and their folders.

        These are the packages in the root folder that ``package_dir`` names, else in src/. If neither folder exists, they are the
        only top-level package next to setup.py and its subpackages, none if there are several top-level packages. The folders
        have the form of the option ``package_dir``.
        """
        files = self._context.files
        if "" in folders or files.is_folder("src"):
            top = folders.get("", "src")
            return files.find(top, namespaces=True), {"": top}
        roots = [name for name in files.find(".", namespaces=False) if "." not in name]
        roots = [name for name in roots if name not in _RESERVED_FOLDERS and not name.startswith("_")]
        if len(roots) != 1:
            return [], folders
        return [name for name in files.find(".", namespaces=True) if name.partition(".")[0] == roots[0]], folders

    # --- files

    def _data_files(self, value: Value) -> None:
        for entry, maybe in self._items(value, Facet.SHARE | Facet.EXECUTABLES):
            if isinstance(entry, str):
                self._data_file("", entry, maybe)
                continue
            if not isinstance(entry, (tuple, list)) or len(entry) != 2:
                self._problem(
                    "data-files-form",
                    "an entry of data_files must be a tuple of a folder and a list of files; write ('folder', ['file'])",
                    entry,
                )
                continue
            folder, sources = entry
            if isinstance(folder, Unknown):
                self._hide(Facet.SHARE | Facet.EXECUTABLES, folder)
                continue
            folder = posixpath.normpath(str(folder)) if str(folder) else ""
            if folder.startswith("/"):
                self._problem(
                    "absolute-destination",
                    f"data_files cannot install to '{folder}', which is outside the install prefix; write a relative folder",
                    entry[0],
                )
                continue
            if not isinstance(sources, (list, Unknown)) or not isinstance(entry, tuple):
                self._problem(
                    "data-files-form",
                    "an entry of data_files must be a tuple of a folder and a list of files; write ('folder', ['file'])",
                    entry[0],
                )
            if isinstance(sources, Globbed) and not sources:
                message = (
                    f"no file matches '{sources.pattern}', so nothing is installed to {folder}; correct or remove the pattern"
                )
                self._problem("empty-glob", message, entry[0], sources.pattern)
            for source, maybe_source in self._items(sources, _facet(folder)):
                self._data_file(folder, source, maybe or maybe_source)

    def _data_file(self, folder: str, source: Value, maybe: bool) -> None:
        context = self._context
        path = context.files.inside(str(source))
        if path is not None and context.files.is_folder(path):
            message = f"'{path}' is a folder, but data_files can only copy files, so the build fails; list only files"
            self._problem("directory-in-data-files", message, source, path)
            return
        if path is not None and not context.files.is_file(path):
            self._problem("missing-file", f"'{path}' does not exist", source, path)
            return
        # It is unknown whether a file outside of the package exists.
        self._provide(posixpath.join(folder, posixpath.basename(str(source))), path or "", maybe or not path, source)

    def _scripts(self, value: Value) -> None:
        for source, maybe in self._items(value, Facet.EXECUTABLES):
            path = self._context.files.inside(str(source))
            if path is not None and not self._context.files.is_file(path):
                self._problem("missing-file", f"'{path}' does not exist", source, path)
            elif self._context.scripts is not None:
                installed = posixpath.join(self._context.scripts, posixpath.basename(str(source)))
                self._provide(installed, path or "", maybe, source, program=True)

    def _provide(self, path: str, source: str, maybe: bool, value: Value, program: bool | None = None) -> None:
        runs = source in self._context.executables if program is None else program
        conditional = maybe or self._context.conditional
        span = self._place(value, self._context.call)
        self.provides.append(InstalledFile(posixpath.normpath(path), source, runs, conditional, span))

    # --- entry points

    def _entry_points(self, value: Value) -> None:
        if isinstance(value, str):
            self._sections(value)
        elif isinstance(value, dict):
            for group, entries in value.items():
                self._entry_lines(str(group), entries, maybe=False)
        elif value is not None:
            self._hide(Facet.EXECUTABLES, value)

    def _entry_lines(self, group: str, value: Value, maybe: bool) -> None:
        """Record the entry points of a group: the lines of a text, or of the texts in nested lists, as in setuptools.

        ``maybe`` is True if the entry points may be missing.
        """
        if isinstance(value, str):
            for line in value.splitlines():
                self._entry_point(group, line, value, maybe)
        else:
            for inner, inner_maybe in self._items(value, Facet.EXECUTABLES):
                self._entry_lines(group, inner, maybe or inner_maybe)

    def _sections(self, text: str) -> None:
        group = ""
        for line in text.splitlines():
            bare = line.strip()
            if bare.startswith("[") and bare.endswith("]"):
                group = bare[1:-1].strip()
            else:
                self._entry_point(group, bare, text, False)

    def _entry_point(self, group: str, line: str, value: Value, maybe: bool) -> None:
        if not line.strip() or line.lstrip().startswith("#"):
            return
        match = _ENTRY.match(line)
        if match is None:
            entry = line.strip()
            self._problem(
                "entry-point-form",
                f"'{entry}' is not of the form 'name = module:function'; write it in this form",
                value,
                entry.split()[0],
            )
            return
        name, target = match[1], match[2]
        self.entry_points.append(EntryPoint(group, name, target, self._place(value, self._context.call)))
        if group in ("console_scripts", "gui_scripts") and self._context.scripts is not None:
            self._provide(posixpath.join(self._context.scripts, name), "", maybe, value, program=True)

    def _problem(self, kind: str, message: str, value: Value, subject: str = "") -> None:
        self.problems.append(Problem(kind, message, self._place(value, self._context.call), subject=subject))


def _facet(folder: str) -> Facet:
    """Return the part of the package that may contain more than is known if an unknown file is installed to ``folder``.

    ``folder`` is relative to the install prefix: ``share/a`` -> ``Facet.SHARE``.
    """
    top = folder.partition("/")[0]
    return {"share": Facet.SHARE, "lib": Facet.EXECUTABLES, "bin": Facet.EXECUTABLES}.get(top, INSTALLED)


def folder_of(package: str, folders: Mapping[str, str]) -> str:
    """Return the folder of a Python package; ``folders`` is the value of the option ``package_dir``.

    ``a.b`` -> ``src/a/b`` for ``{"": "src"}``
    """
    head, tail = package.split("."), list[str]()
    while head:
        name = ".".join(head)
        if name in folders:
            return posixpath.join(folders[name], *tail)
        tail.insert(0, head.pop())
    return posixpath.join(folders.get("", ""), *tail)
