"""Which names mean files of the package itself: headers that its files include, and modules that they import."""

from __future__ import annotations

from collections.abc import Container, Iterable, Iterator, Mapping, Sequence
from functools import cached_property

from ros_lint.base.paths import join, resolve
from ros_lint.base.text import Span
from ros_lint.facts.build import NOTHING_BUILT, BuildScript, InstalledFile, UninstalledImport
from ros_lint.facts.sources import FileFacts

_SHADOWED = frozenset({"launch"})
"""Folders of packages that are called like a module everybody imports: without __init__.py they do not hide it (PEP 420)."""


class OwnFiles:
    """Answers for one package. Paths are relative to it."""

    def __init__(self, name: str, files: Sequence[str], script: BuildScript | None, facts: Mapping[str, FileFacts]) -> None:
        self._name = name
        self.files = files
        self.script = script
        self.facts = facts
        self._included: dict[str, tuple[set[str], list[str]]] = {}

    def included(self, path: str) -> Container[str]:
        """Return the headers that a file includes and that are of the package, generated ones included."""
        return self._includes(path)[0]

    @cached_property
    def include_folders(self) -> frozenset[str]:
        """The folders that the package has in its include directories: a header in one of them is its own, if it is generated."""
        inner = (f"/{file}".partition("/include/")[2] for file in self.files)
        return frozenset([folder.partition("/")[0] for folder in inner if "/" in folder])

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

    def forgone(self, importers: Iterable[str]) -> frozenset[str]:
        """Return the files in Python that some of the package's import from beside them and go on without, as far as is known.

        Those that a file imports by their whole names, and not so, are none of them.
        """
        found: set[str] = set()
        for path in importers:
            for name in self.facts[path].optional_modules:
                module = name.lstrip(".")
                if module != name:
                    folders = path.split("/")[: len(module) - len(name)]
                    file = "/".join([*folders, module.replace(".", "/")])
                    found.update([f"{file}.py", f"{file}/__init__.py"])
        if not found:
            return frozenset()
        needed = {m.name for facts in self.facts.values() for m in facts.mentions if m.via == "import" and not m.optional}
        return frozenset([file for file in found if _module(file) not in needed])

    def reached(self, roots: Iterable[str]) -> frozenset[str]:
        """Return those of some files that are of the package, and all that they include of it, by way of others or not."""
        reached: set[str] = set()
        waiting = [root for root in roots if root in self.facts]
        while waiting:
            path = waiting.pop()
            if path not in reached:
                reached.add(path)
                waiting += self._includes(path)[1]
        return frozenset(reached)

    def compiled_along(self) -> Mapping[str, frozenset[str]]:
        """Return the headers of the package that come with each source of its targets, where only one file can be meant.

        Left out are tests, sources that some builds leave out, and targets that get headers from nobody knows where.
        """
        targets = [each for each in (self.script or NOTHING_BUILT).targets if each.headers is not None and not each.test]
        sources = dict.fromkeys([source for each in targets for source in each.sources if source not in each.optional_sources])
        return {source: self._along(source) for source in sources if source in self.facts}

    def _along(self, source: str) -> frozenset[str]:
        along: set[str] = set()
        waiting = [source]
        while waiting:
            for path in self._includes(waiting.pop())[1]:
                if path not in along and len(self.by_name[path.rpartition("/")[2]]) == 1:
                    along.add(path)
                    waiting.append(path)
        return frozenset(along)

    def _includes(self, path: str) -> tuple[set[str], list[str]]:
        """Return what a file includes of the package: headers as it names them, and the files that these can be."""
        found = self._included.get(path)
        if found is not None:
            return found
        folder, by_name, templates = path.rpartition("/")[0], self.by_name, self._templates
        own = (self._name, ".", "..")
        headers: set[str] = set()
        files: list[str] = []
        for mention in self.facts[path].mentions if path in self.facts else ():
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

    def _own_headers(self, header: str, folder: str) -> tuple[str, ...]:
        """Return the files of the package that an include in a file of a folder can mean."""
        candidates = self.by_name.get(header.rpartition("/")[2])
        if candidates is None:
            return ()
        end = f"/{header}"
        if len(candidates) == 1 and f"/{candidates[0]}".endswith(end):
            return candidates
        beside = resolve(folder, header) if "." in header[:2] else join(folder, header)
        if beside in candidates:
            return (beside,)
        return tuple([file for file in candidates if file == header or file.endswith(end)])

    @cached_property
    def by_name(self) -> Mapping[str, tuple[str, ...]]:
        """The files by their names without folders."""
        found: dict[str, tuple[str, ...]] = {}
        for file in self.files:
            name = file.rpartition("/")[2]
            found[name] = (*found[name], file) if name in found else (file,)
        return found

    def _is_made(self, header: str, folder: str) -> bool:
        return any(self._own_headers(f"{header}{suffix}", folder) for suffix in (".in", ".em"))

    @cached_property
    def _templates(self) -> frozenset[str]:
        """Names of files that are made of others."""
        return frozenset([name[:-3] for name in self.by_name if name.endswith((".in", ".em"))])

    @cached_property
    def _modules(self) -> Mapping[str, set[str]]:
        """Files and folders with Python code, by the name that an import would have, with the folders that they lie in."""
        found: dict[str, set[str]] = {}
        for file in self.files:
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
        found = {file.rpartition("/")[0] for file in self.files if file.endswith("__init__.py")}
        return frozenset(found - {"", "src"})

    @cached_property
    def _installed_modules(self) -> frozenset[str]:
        names = self.script.python_packages if self.script else ()
        return frozenset([name.partition(".")[0] for name in names])


def _module(path: str) -> str:
    """Return the name by which others import a file in Python."""
    return path.removeprefix("src/").removesuffix(".py").removesuffix("/__init__").replace("/", ".")


def uninstalled_imports(files: Sequence[str], script: BuildScript, facts: Mapping[str, FileFacts]) -> Iterator[UninstalledImport]:
    """Yield the imports of programs in Python that work among the sources, and not where the program is installed.

    Python looks for modules beside the program that it starts, beside what a link to it points to (reference, section D4.4).
    That of an entry point is made by pip, so what lies beside its module is only found as a part of the Python package; and
    setuptools installs no folder that is not among the packages.
    """
    yield from _unlisted(files, script, facts)
    provides = script.installs
    programs = [(p.path, p.source) for p in provides if p.source.endswith(".py") and p.source in facts and _is_program(p)]
    modules = [(each.name, each.path) for each in script.entry_point_modules if each.path in facts and "." in each.name]
    if not (programs or modules):
        return
    known = frozenset(files)
    folders = {file.rpartition("/")[0] for file in files if file.endswith(".py")}
    installed = {p.path for p in provides}
    installed.update([path[: path.rfind("/") + 1] for path in installed])
    for program, source in programs:
        for module, beside, span in _beside(source, facts[source], known, folders):
            there = f"{program[: program.rfind('/') + 1]}{module}"
            if f"{there}.py" not in installed and f"{there}/" not in installed:
                yield UninstalledImport(program, module, beside, span, not facts[source].sets_path)
    names = {path.rpartition("/")[2] for path in installed}
    setting = [path for path, each in facts.items() if each.sets_path] if modules else []
    for name, source in modules:
        top = source.removesuffix(f"{name.replace('.', '/')}.py") + name.partition(".")[0]
        if any(path.startswith(f"{top}/") for path in setting):
            continue  # mostly to find these
        for module, beside, span in _beside(source, facts[source], known, folders):
            if f"{module}.py" not in names:
                yield UninstalledImport(name, module, beside, span, sure=True)


def _unlisted(files: Sequence[str], script: BuildScript, facts: Mapping[str, FileFacts]) -> Iterator[UninstalledImport]:
    """Yield the imports, in Python packages that a setup.py installs, of what lies in a folder that is not among them.

    What an entry point names is sure to be started.
    """
    if not script.python_packages or script.of_cmake:
        return
    packages = frozenset(script.python_packages)
    started = {module.path for module in script.entry_point_modules}
    folders = {file.rpartition("/")[0] for file in files if file.endswith(".py")}
    known = frozenset(files)
    for path, each in facts.items():
        folder = path.rpartition("/")[0]
        top = "src/" if folder.startswith("src/") else ""
        if not path.endswith(".py") or folder.removeprefix(top).replace("/", ".") not in packages:
            continue
        for mention in each.mentions:
            name = mention.name
            if mention.via != "import" or mention.optional or name.partition(".")[0] in each.optional_modules:
                continue
            if f"{top}{name.replace('.', '/')}.py" in known:
                name = name.rpartition(".")[0]
            source = f"{top}{name.replace('.', '/')}"
            if name not in packages and name.partition(".")[0] in packages and source in folders:
                yield UninstalledImport(path, name, f"{source}/", mention.span, path in started)


def _beside(source: str, facts: FileFacts, files: Container[str], folders: Container[str]) -> Iterator[tuple[str, str, Span]]:
    """Yield the modules that a file imports and that lie beside it: their name, the file or folder, the place."""
    here = source[: source.rfind("/") + 1]
    for name, via, span, _, optional, _, _ in facts.mentions:
        module = name.partition(".")[0]
        if via != "import" or optional or not module or module in facts.optional_modules:
            continue
        beside = f"{here}{module}.py" if f"{here}{module}.py" in files else f"{here}{module}/"
        if beside in files or beside[:-1] in folders:
            yield module, beside, span


def _is_program(provided: InstalledFile) -> bool:
    """Whether an installed file in Python is one that is started, in every build."""
    return provided.path.startswith("lib/") and not (provided.test or provided.importable)
