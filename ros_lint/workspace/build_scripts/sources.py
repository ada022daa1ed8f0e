"""What the evaluation of CMake scripts is given of a tree: the files of a package, and those around it that a script names."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from functools import partial
from typing import Final, NamedTuple

from ros_lint.base.paths import is_below, join, strip_folder
from ros_lint.base.tree import Entry, Tree, text_of
from ros_lint.collectors.cmake.evaluator.sources import Around, Sources
from ros_lint.collectors.cmake.syntax import Parsed, parse
from ros_lint.workspace.build_scripts.files import Executables, text_in
from ros_lint.workspace.discovery.discover import NEVER, DiscoveredPackage

_MOST_ENTRIES: Final = 10_000
"""Below a folder outside of the files of a package. Nobody installs more, but he may install all that is there."""


class Parts(NamedTuple):
    """What the scripts of a package can see of it."""

    found: DiscoveredPackage
    commands: Mapping[str, Parsed]
    """Its CMake files, by path relative to the package."""
    depends: Mapping[str, tuple[str, ...]]
    """What it declares, by kind letters as in the index."""


class Surroundings:
    """A tree as the scripts of its packages see it; the methods are described where :class:`Around` is.

    What lies behind a link that leads out of the tree is not in sight, nor what lies around a package that is reached by a
    link: what ``..`` means there depends on who asks.
    """

    def __init__(self, tree: Tree) -> None:
        self._tree = tree
        self._base = tree.identity("")
        self._entries: dict[str, Mapping[str, Entry]] = {}
        self._files: dict[str, Sequence[str]] = {}
        self._scripts: dict[str, Parsed | None] = {}

    def of(self, package: str) -> Around:
        """Return what the scripts of a package see, given its path."""
        plain = not package or self._tree.identity(package) == join(self._base, package)
        return Around(self.kind, self.below, self.script) if plain else Around()

    def kind(self, path: str) -> str:
        folder, _, name = path.rpartition("/")
        entry = self._listed(folder).get(name)
        if not path or (entry is not None and entry.kind == "directory" and self._listed(path)):
            return "directory"
        return "file" if entry is not None and entry.kind == "file" else ""

    def below(self, folder: str) -> Sequence[str]:
        if folder not in self._files:
            self._files[folder] = sorted(self._gathered(folder))
        return self._files[folder]

    def script(self, path: str) -> Parsed | None:
        if path not in self._scripts:
            inside = self.kind(path) == "file" and is_below(self._tree.identity(path), self._base)
            text = text_of(self._tree, path) if inside else None
            self._scripts[path] = parse(text) if text is not None else None
        return self._scripts[path]

    def _listed(self, folder: str) -> Mapping[str, Entry]:
        """Return the entries of a folder by name, none where it cannot be read or is no part of the tree."""
        if folder not in self._entries:
            self._entries[folder] = {}
            if NEVER.isdisjoint(folder.split("/")) and is_below(self._tree.identity(folder), self._base):
                with suppress(OSError):
                    self._entries[folder] = {entry.name: entry for entry in self._tree.list(folder)}
        return self._entries[folder]

    def _gathered(self, folder: str) -> list[str]:
        """Return the files below a folder as CMake copies and globs them: it follows no link to a folder."""
        found: list[str] = []
        todo = [folder]
        seen = 0
        while todo:
            place = todo.pop()
            entries = self._listed(place).values()
            seen += len(entries)
            if seen > _MOST_ENTRIES:
                return []
            found += [join(place, entry.name) for entry in entries if entry.kind == "file"]
            todo += [join(place, entry.name) for entry in entries if entry.kind == "directory" and not entry.link]
        return found


def sources(tree: Tree, parts: Parts, around: Surroundings) -> Sources:
    """Return what the scripts of a package can see, given the tree that it lies in, which is the same for all packages."""
    found, depends = parts.found, parts.depends
    built = tuple(dict.fromkeys((*depends.get("b", ()), *depends.get("t", ()))))
    version = found.manifest.version if found.manifest else ""
    executables = Executables(tree, found)
    unseen = tuple(skipped.path for skipped in found.unseen)
    config = text_in(tree, found, "setup.cfg")
    texts = {"setup.cfg": config.text} if config else {}
    return Sources(
        found.name,
        found.path,
        found.files,
        _Scripts(tree, found, parts.commands),
        executables,
        version,
        built,
        depends.get("s", ()),
        unseen,
        texts,
        partial(_look, found, around),
        around.of(found.path),
    )


class _Scripts(Mapping[str, Parsed]):
    """The CMake files of a package. Others are read when they are asked for: a script may have any name."""

    def __init__(self, tree: Tree, found: DiscoveredPackage, parsed: Mapping[str, Parsed]) -> None:
        self._tree = tree
        self._found = found
        self._parsed = dict(parsed)

    def __contains__(self, path: object) -> bool:
        return path in self._parsed or path in self._found.files

    def __getitem__(self, path: str) -> Parsed:
        if path not in self._parsed:
            text = text_in(self._tree, self._found, path)
            if text is None:
                raise KeyError(path)
            self._parsed[path] = parse(text)
        return self._parsed[path]

    def __iter__(self) -> Iterator[str]:
        return iter(self._parsed)

    def __len__(self) -> int:
        return len(self._parsed)


def _look(found: DiscoveredPackage, around: Surroundings, folder: str) -> list[str]:
    """Return the files below a folder of a package that was not looked into, nothing where not all are in sight."""
    if any(skipped.path == folder and skipped.link for skipped in found.unseen):
        return []
    return [strip_folder(found.path, file) for file in around.below(join(found.path, folder))]
