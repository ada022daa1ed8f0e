"""Files of a package for its setup.py: existence, and the results of glob, os.walk and pathlib.

setup.py runs in the folder of the package. The analysis is independent of the place of that folder on the disk, so
:data:`ROOT`, a path that exists on no file system, is used as its absolute path.
"""

from __future__ import annotations

import posixpath
import re
from collections.abc import Iterable, Iterator, Sequence
from fnmatch import translate

ROOT = "/\ue020"
"""The absolute path that represents the folder of the package."""


class Files:
    """The names of all files below the folder of a package. Paths are relative to the folder, or begin with :data:`ROOT`."""

    def __init__(self, files: Sequence[str]) -> None:
        self._files = frozenset(files)
        self._entries: dict[str, set[str]] = {"": set()}
        for path in files:
            while path:
                folder, _, name = path.rpartition("/")
                known = folder in self._entries
                entries = self._entries.setdefault(folder, set())
                if name in entries:
                    break
                entries.add(name)
                if known:
                    break
                path = folder  # noqa: PLW2901  (up to a folder that is already known)

    def inside(self, path: str) -> str | None:
        """Return a path relative to the folder of the package, "" for the folder itself.

        The result is None for a path outside of the folder.
        """
        if path in self._files or path in self._entries:
            return path
        path = posixpath.normpath(posixpath.join(ROOT, path))
        if path == ROOT:
            return ""
        return path[len(ROOT) + 1 :] if path.startswith(ROOT + "/") else None

    def is_file(self, path: str) -> bool:
        return not path.endswith("/") and self.inside(path) in self._files

    def is_folder(self, path: str) -> bool:
        return self.inside(path) in self._entries

    def exists(self, path: str) -> bool:
        return self.is_file(path) or self.is_folder(path)

    def names(self, path: str) -> list[str] | None:
        """Return the sorted names of the files and folders in a folder, None if ``path`` is not a folder."""
        inside = self.inside(path)
        return None if inside is None or inside not in self._entries else sorted(self._entries[inside])

    def walk(self, top: str) -> Iterator[tuple[str, list[str], list[str]]]:
        """Yield the results of ``os.walk(top)``: each folder with the names of its folders and of its files.

        The caller may remove names from the list of folders, which are then skipped.
        """
        names = self.names(top)
        if names is None:
            return
        folders = [name for name in names if self.is_folder(posixpath.join(top, name))]
        yield top, folders, [name for name in names if name not in folders]
        for name in folders:
            yield from self.walk(posixpath.join(top, name))

    def glob(self, pattern: str, *, recursive: bool = False, hidden: bool = False) -> list[str]:
        """Return the sorted result of ``glob.glob(pattern)``, each path once. ``hidden`` includes names that begin with a dot."""
        if recursive:
            pattern = _REPEATED.sub(r"\1", pattern)
        return sorted(set(filter(None, self._glob(pattern, recursive, hidden, False))))

    def _glob(self, pattern: str, recursive: bool, hidden: bool, folders: bool) -> Iterator[str]:
        folder, name = posixpath.split(pattern)
        if not _MAGIC.search(pattern):
            if self.exists(pattern) if name else self.is_folder(folder):
                yield pattern
            return
        for top in dict.fromkeys(self._glob(folder, recursive, hidden, True)) if _MAGIC.search(folder) else [folder]:
            if recursive and name == "**":
                found: Iterable[str] = ["", *self._below(top, "", hidden)] if self.is_folder(top) else []
            elif _MAGIC.search(name):
                matches = re.compile(translate(name)).match
                shown = hidden or name.startswith(".")
                found = [entry for entry in self.names(top) or () if matches(entry) and (shown or entry[0] != ".")]
            else:
                yield from [posixpath.join(top, name)] if self.exists(posixpath.join(top, name)) else []
                continue
            for inner in found:
                path = posixpath.join(top, inner)
                if not folders or self.is_folder(path):
                    yield path

    def _below(self, top: str, before: str, hidden: bool) -> Iterator[str]:
        for name in self.names(top) or ():
            if hidden or not name.startswith("."):
                yield before + name
                yield from self._below(posixpath.join(top, name), f"{before}{name}/", hidden)

    def find(self, where: str, *, namespaces: bool, include: Sequence[str] = ("*",), exclude: Sequence[str] = ()) -> list[str]:
        """Return the dotted names of the Python packages below a folder, as find_packages() of setuptools does.

        ``namespaces`` includes folders without ``__init__.py``, as find_namespace_packages() does.
        """
        included, excluded = (_any_of(patterns) for patterns in (include, exclude))
        names = self._packages(where, "", namespaces)
        return [name for name in names if included.match(name) and not excluded.match(name)]

    def _packages(self, folder: str, parent: str, namespaces: bool) -> Iterator[str]:
        for name in self.names(folder) or ():
            path = posixpath.join(folder, name)
            if "." in name or not self.is_folder(path):
                continue
            if namespaces or self.is_file(posixpath.join(path, "__init__.py")):
                yield parent + name
                yield from self._packages(path, f"{parent}{name}.", namespaces)

    def modules(self, folder: str) -> list[str]:
        """Return the sorted names of the Python modules directly in a folder, without ``.py``."""
        inside = self.inside(folder)
        start = f"{inside}/" if inside else ""
        stems = (name[:-3] for name in self._entries.get(inside or "", ()) if name.endswith(".py"))
        return sorted(stem for stem in stems if stem.isidentifier() and f"{start}{stem}.py" in self._files)


def _any_of(patterns: Sequence[str]) -> re.Pattern[str]:
    return re.compile("|".join(map(translate, patterns)) or r"(?!)")


_MAGIC = re.compile(r"[*?\[]")
_REPEATED = re.compile(r"(\A|/)(?:\*\*/+)+(?=\*\*(?:/|\Z))")
"""Components ``**`` before another one. They match nothing else, but each of them multiplies the results."""
