"""The input for the evaluation of CMake scripts: the files of a package, and files outside of it that its scripts name."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from functools import partial
from typing import Final, NamedTuple

from ros_lint.base.paths import is_below, join, strip_folder
from ros_lint.base.questions import Memo, Questions
from ros_lint.base.tree import Entry, Tree, text_of
from ros_lint.collectors.cmake.evaluator.sources import OutsideTree, Sources
from ros_lint.collectors.cmake.syntax import ParsedScript, parse
from ros_lint.workspace.build_scripts.files import Executables, text_in
from ros_lint.workspace.discovery.discover import SKIPPED_FOLDERS, DiscoveredPackage

_MOST_ENTRIES: Final = 10_000
"""Maximum number of files and folders below a folder outside the package; a larger folder counts as empty.

Scripts rarely install more, but ``install(DIRECTORY ../..)`` may name a huge folder.
"""


class Parts(NamedTuple):
    """A package with its parsed CMake files and its declared dependencies: the input for the evaluation of its build script."""

    package: DiscoveredPackage
    commands: Mapping[str, ParsedScript]
    """Parsed CMake files, by path relative to the package."""
    depends: Mapping[str, tuple[str, ...]]
    """Names of declared dependencies, by the letter of the tag: "b" for <build_depend>, "t" for <buildtool_depend> ...

    :data:`ros_lint.knowledge.index.KINDS` has the letters.
    """
    helps: bool
    """True if the package has CMake code that runs in its dependents: ament_package(CONFIG_EXTRAS ...)."""

    @classmethod
    def of(
        cls, package: DiscoveredPackage, commands: Mapping[str, ParsedScript], depends: Mapping[str, tuple[str, ...]]
    ) -> Parts:
        """Return the parts of a package. The arguments are the fields of the result."""
        helps = any(
            argument[0].startswith("CONFIG_EXTRAS")
            for parsed in commands.values()
            for command in parsed.commands
            if command.name in ("ament_package", "ament_auto_package")
            for argument in command.args
        )
        return cls(package, commands, depends, helps)

    @property
    def of_cmake(self) -> bool:
        """True if the build script of the package is a CMakeLists.txt."""
        return "CMakeLists.txt" in self.commands and self.package.type != "ros.ament_python"


class Surroundings:
    """The files outside of a package that its CMake scripts can read; :class:`OutsideTree` documents the methods.

    Targets of symbolic links that lead out of the workspace are left out. If a symbolic link leads to the package, all files
    outside of the package are left out, because the meaning of ``..`` then depends on the path.
    """

    def __init__(self, tree: Tree, questions: Questions | None = None) -> None:
        self._tree = tree
        self._base = tree.identity("")
        self._questions = questions or Memo()

    def of(self, package: str) -> OutsideTree:
        """Return the files outside of a package that its scripts can read. ``package`` is the path of the package."""
        plain = not package or self._tree.identity(package) == join(self._base, package)
        return OutsideTree(self.kind, self.below, self.script) if plain else OutsideTree()

    def kind(self, path: str) -> str:
        folder, _, name = path.rpartition("/")
        entry = self._entries_of(folder).get(name)
        if not path or (entry is not None and entry.kind == "directory" and self._entries_of(path)):
            return "directory"
        return "file" if entry is not None and entry.kind == "file" else ""

    def below(self, folder: str) -> Sequence[str]:
        return self._questions.ask(("files below", folder), lambda: sorted(self._gathered(folder)))

    def script(self, path: str) -> ParsedScript | None:
        return self._questions.ask(("parsed outside", path), lambda: self._parsed_outside(path))

    def parsed_in(self, package: DiscoveredPackage, file: str) -> ParsedScript | None:
        """Return the parsed CMake code in a file of a package, None if the package has no such file or it cannot be read."""
        path = join(package.path, file)
        return self._questions.ask(("parsed", path), lambda: self._parsed(path)) if file in package.files else None

    def _parsed_outside(self, path: str) -> ParsedScript | None:
        inside = self.kind(path) == "file" and is_below(self._tree.identity(path), self._base)
        return self._parsed(path) if inside else None

    def _parsed(self, path: str) -> ParsedScript | None:
        text = text_of(self._tree, path)
        return parse(text) if text is not None else None

    def _entries_of(self, folder: str) -> Mapping[str, Entry]:
        """Return the entries of a folder by name; {} if the folder is unreadable or outside the tree."""
        return self._questions.ask(("entries", folder), lambda: self._list(folder))

    def _list(self, folder: str) -> Mapping[str, Entry]:
        if SKIPPED_FOLDERS.isdisjoint(folder.split("/")) and is_below(self._tree.identity(folder), self._base):
            with suppress(OSError):
                return {entry.name: entry for entry in self._tree.list(folder)}
        return {}

    def _gathered(self, folder: str) -> list[str]:
        """Return the files below a folder; [] if the folder has more than ``_MOST_ENTRIES`` entries.

        Files behind links to folders are left out, because CMake neither copies nor globs them.
        """
        files: list[str] = []
        pending = [folder]
        count = 0
        while pending:
            place = pending.pop()
            entries = self._entries_of(place).values()
            count += len(entries)
            if count > _MOST_ENTRIES:
                return []
            files += [join(place, entry.name) for entry in entries if entry.kind == "file"]
            pending += [join(place, entry.name) for entry in entries if entry.kind == "directory" and not entry.link]
        return files


def sources(tree: Tree, parts: Parts, surroundings: Surroundings) -> Sources:
    """Return the inputs for the evaluation of the scripts of a package. All packages share one ``surroundings``."""
    package, depends = parts.package, parts.depends
    build_depends = tuple(dict.fromkeys((*depends.get("b", ()), *depends.get("t", ()))))
    version = package.manifest.version if package.manifest else ""
    executables = Executables(tree, package)
    unlisted_folders = tuple(skipped.path for skipped in package.unvisited)
    config = text_in(tree, package, "setup.cfg")
    texts = {"setup.cfg": config.text} if config else {}
    return Sources(
        package.name,
        package.path,
        package.files,
        _Scripts(package, parts.commands, surroundings),
        executables,
        version,
        build_depends,
        depends.get("s", ()),
        unlisted_folders,
        texts,
        partial(_list_unlisted, package, surroundings),
        surroundings.of(package.path),
    )


class _Scripts(Mapping[str, ParsedScript]):
    """The parsed CMake files of a package, by path. A file with another name, e.g. ``flags.txt``, is parsed on request."""

    def __init__(self, package: DiscoveredPackage, parsed: Mapping[str, ParsedScript], surroundings: Surroundings) -> None:
        self._package = package
        self._parsed = parsed
        self._surroundings = surroundings

    def __contains__(self, path: object) -> bool:
        return path in self._parsed or path in self._package.files

    def __getitem__(self, path: str) -> ParsedScript:
        parsed = self._parsed.get(path)
        if parsed is None:
            parsed = self._surroundings.parsed_in(self._package, path)
            if parsed is None:
                raise KeyError(path)
        return parsed

    def __iter__(self) -> Iterator[str]:
        return iter(self._parsed)

    def __len__(self) -> int:
        return len(self._parsed)


def _list_unlisted(package: DiscoveredPackage, surroundings: Surroundings, folder: str) -> list[str]:
    """Return the files below a subfolder that discovery skipped, relative to the package.

    The result is [] if the subfolder is a link or cannot be read completely.
    """
    if any(skipped.path == folder and skipped.link for skipped in package.unvisited):
        return []
    return [strip_folder(package.path, file) for file in surroundings.below(join(package.path, folder))]
