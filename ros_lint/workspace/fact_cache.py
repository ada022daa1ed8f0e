"""Keep the facts of files and the last reports between runs, in the user's cache folder.

The folder belongs to the user, and reading it creates only facts (:mod:`ros_lint.workspace.cache_files`). A file
counts as unchanged if its :class:`~ros_lint.base.tree.Stamp` is. Facts depend only on the text of the file. A
report depends only on the answers of the tree, the settings, the code and the data about released packages.
"""

from __future__ import annotations

import os
import sys
import zlib
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, TypeVar

from ros_lint import __version__
from ros_lint.base.text import to_bytes
from ros_lint.workspace import cache_files

if TYPE_CHECKING:
    from ros_lint.base.tree import Tree

Facts = TypeVar("Facts")

SOURCES = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
"""Folder of the Python package ``ros_lint``."""

_PARTS = 16
"""Number of files that store the facts of a workspace."""


class FactCache:
    """Facts by path and stamp. An empty ``folder`` stores nothing; errors are treated as an empty cache.

    The facts are stored in several files so that a run after a small change writes little.
    """

    def __init__(self, folder: str, base: str) -> None:
        start = os.path.join(folder, digest(os.path.realpath(base))) if folder else ""
        self._files = [f"{start}.{number:x}.facts" for number in range(_PARTS if folder else 0)]
        self._parts: list[dict[str, tuple[tuple[int, ...], Any]]] = [{} for _ in self._files]
        self._stamps: dict[str, tuple[int, ...]] = {}

    def fetch(self, tree: Tree, paths: Sequence[str], kind: type[Facts]) -> dict[str, Facts]:
        """Return the stored facts of files that have not changed.

        ``kind`` is the class of the facts of a file.
        """
        if not self._files:
            return {}
        state = state_of(_collectors())
        loaded = [cache_files.load(file, state) for file in self._files]
        self._parts = [part if _is_part(part, kind) else {} for part in loaded]
        # The stamps are taken before files are read: a file that changes meanwhile counts as changed.
        self._stamps = {path: stamp for path in paths if (stamp := _stamp(tree, path)) is not None}
        stored = {path: entry for part in self._parts for path, entry in part.items()}
        return {path: stored[path][1] for path, stamp in self._stamps.items() if path in stored and stored[path][0] == stamp}

    def store(self, tree: Tree, fresh: Mapping[str, Any]) -> None:
        """Store the facts of files that were read now (``fresh``), and keep the stored facts of other existing files."""
        if not self._files or not fresh:
            return
        changed = set()
        for number, part in enumerate(self._parts):
            for path in [path for path in part if path not in self._stamps and _stamp(tree, path) is None]:
                del part[path]
                changed.add(number)
        for path, facts in fresh.items():
            if path in self._stamps:
                number = _part(path)
                self._parts[number][path] = (self._stamps[path], facts)
                changed.add(number)
        state = state_of(_collectors())
        for number in sorted(changed):
            cache_files.save(self._files[number], state, self._parts[number])


def folder(environment: Mapping[str, str]) -> str:
    """Return the user's cache folder for ros-lint, or "" if the system has none (XDG base directories)."""
    home = environment.get("HOME") or environment.get("USERPROFILE") or ""
    caches = environment.get("XDG_CACHE_HOME") or (os.path.join(home, ".cache") if home else "")
    return os.path.join(caches, "ros-lint") if os.path.isabs(caches) else ""


def _is_part(loaded: Any, kind: type) -> bool:
    """Return whether a value from a cache file maps paths to pairs of a stamp and facts of the class ``kind``."""
    return isinstance(loaded, dict) and all(
        isinstance(path, str)
        and isinstance(entry, tuple)
        and len(entry) == 2
        and isinstance(entry[0], tuple)
        and isinstance(entry[1], kind)
        for path, entry in loaded.items()
    )


def _part(path: str) -> int:
    """Return the number of the part that stores the facts of a file; the files of a folder share a part."""
    return zlib.crc32(to_bytes(path.rpartition("/")[0])) % _PARTS


def _stamp(tree: Tree, path: str) -> tuple[int, ...] | None:
    try:
        return tuple(tree.stamp(path))
    except (OSError, ValueError):  # a path from the cache contains NUL
        return None


def digest(text: str) -> str:
    """Return a short digest of a text."""
    import hashlib  # noqa: PLC0415

    return hashlib.sha256(to_bytes(text)).hexdigest()[:24]


def state_of(files: Iterable[str]) -> str:
    """Return a text that identifies ros-lint, the Python interpreter and the versions of some files."""
    stamps = []
    for file in sorted(files):
        try:
            status = os.stat(file)
            stamps.append(f"{file} {status.st_mtime_ns} {status.st_size} {status.st_ctime_ns} {status.st_ino}")
        except OSError:
            stamps.append(file)
    return f"ros-lint {__version__} {sys.implementation.cache_tag} {digest(' '.join([sys.version, *stamps]))}"


def _collectors() -> Iterator[str]:
    """Yield the files of ros-lint that determine the facts of a file."""
    for room in ("base", "facts", "collectors"):
        yield from files_below(os.path.join(SOURCES, room))
    yield from (os.path.abspath(__file__), os.path.join(SOURCES, "workspace", "collect.py"))


def files_below(place: str) -> Iterator[str]:
    """Yield all files below a folder, without ``__pycache__``."""
    for folder, folders, files in os.walk(place):
        folders[:] = [name for name in folders if name != "__pycache__"]
        yield from [os.path.join(folder, file) for file in files]
