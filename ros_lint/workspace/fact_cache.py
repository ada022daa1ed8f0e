"""Keep the facts of files and the last reports between runs, in the user's cache folder and never in the workspace.

The folder is the user's own, and what is read from it makes no object but facts (:mod:`ros_lint.workspace.cache_files`).
A file counts as unchanged when its :class:`~ros_lint.base.tree.Stamp` is; facts depend on nothing but its text, and a report on
nothing but what the tree said to everything that it was asked, the settings, the code, and the data of the released world.
"""

from __future__ import annotations

import os
import sys
import zlib
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, TypeVar

from ros_lint import __version__
from ros_lint.base.text import to_bytes
from ros_lint.workspace import cache_files as kept_files

if TYPE_CHECKING:
    from ros_lint.base.tree import RecordedTree, Tree
    from ros_lint.engine.report import Report

Facts = TypeVar("Facts")

_SOURCES = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
"""The folder of the package ``ros_lint``."""

_PARTS = 16
"""How many files keep the facts of a workspace."""

_MOST_REPORTS = 8
"""Of one workspace: somebody may check it in different ways by turns."""


class Cache:
    """Facts by path and stamp. An empty ``folder`` keeps nothing. Nothing here raises: a cache that fails is empty.

    They are kept in several files, so that a run after a small change writes little.
    """

    def __init__(self, folder: str, base: str) -> None:
        start = os.path.join(folder, _digest(os.path.realpath(base))) if folder else ""
        self._files = [f"{start}.{number:x}.facts" for number in range(_PARTS if folder else 0)]
        self._parts: list[dict[str, tuple[tuple[int, ...], Any]]] = [{} for _ in self._files]
        self._stamps: dict[str, tuple[int, ...]] = {}

    def fetch(self, tree: Tree, paths: Sequence[str], kind: type[Facts]) -> dict[str, Facts]:
        """Return what is kept of those files that have not changed. ``kind`` is the class of what is kept of a file."""
        if not self._files:
            return {}
        state = _state(_collectors())
        loaded = [kept_files.load(file, state) for file in self._files]
        self._parts = [found if _is_part(found, kind) else {} for found in loaded]
        # Before anything is read, so that what changes meanwhile counts as changed.
        self._stamps = {path: stamp for path in paths if (stamp := _stamp(tree, path)) is not None}
        kept = {path: known for part in self._parts for path, known in part.items()}
        return {path: kept[path][1] for path, stamp in self._stamps.items() if path in kept and kept[path][0] == stamp}

    def store(self, tree: Tree, fresh: Mapping[str, Any]) -> None:
        """Keep what was read now, besides what was kept of files that are still there."""
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
        state = _state(_collectors())
        for number in sorted(changed):
            kept_files.save(self._files[number], state, self._parts[number])


class Reports:
    """The last reports about a workspace.

    ``asked`` and the state of the files in ``data`` are all that a report depends on besides our code and the trees.
    """

    def __init__(self, folder: str, base: str, asked: str, data: Iterable[str]) -> None:
        self._start = f"{_digest(os.path.realpath(base))}-" if folder else ""
        self._folder = folder
        self._file = os.path.join(folder, f"{self._start}{_digest(asked)}.report") if folder else ""
        own = files_below(_SOURCES)
        self._state = _state([*own, *data]) if folder else ""

    def __bool__(self) -> bool:
        """Whether any report is kept at all."""
        return bool(self._file)

    def fetch(self, trees: Sequence[RecordedTree]) -> Report | None:
        """Return the report that a run would make now, or None when only the run can tell."""
        from ros_lint.engine.report import Report  # noqa: PLC0415  (a module that the command needs anyway)

        kept = kept_files.load(self._file, self._state) if self._file else None
        if not isinstance(kept, tuple) or len(kept) != 1 + len(trees) or not isinstance(kept[0], Report):
            return None
        report, *said = kept
        try:
            return report if all(tree.still_says(of_tree) for tree, of_tree in zip(trees, said, strict=True)) else None
        except (TypeError, ValueError):  # no list of questions, answers and paths
            return None

    def store(self, trees: Sequence[RecordedTree], report: Report) -> None:
        """Keep a report that was made from what some trees said. It loses the functions of its rules."""
        if not self._file or report.crashes or not all(tree.steady for tree in trees):
            return
        bare = {rule.name: rule._replace(package=None, workspace=None, suppressions=None) for rule in report.rules}
        issues = tuple([issue._replace(rule=bare[issue.rule.name]) for issue in report.issues])
        said = ([(question, _bare(told)) for question, told in tree.said.items()] for tree in trees)
        if kept_files.save(self._file, self._state, (report._replace(issues=issues, rules=tuple(bare.values())), *said)):
            self._clear()

    def _clear(self) -> None:
        """Remove the oldest reports of the workspace."""
        try:
            with os.scandir(self._folder) as entries:
                mine = [(entry.stat().st_mtime_ns, entry.path) for entry in entries if entry.name.startswith(self._start)]
            for _, path in sorted(mine)[:-_MOST_REPORTS]:
                os.unlink(path)
        except OSError:
            return


def folder(environment: Mapping[str, str]) -> str:
    """Return the user's cache folder for ros-lint, or "" when the system has none (XDG base directories)."""
    home = environment.get("HOME") or environment.get("USERPROFILE") or ""
    above = environment.get("XDG_CACHE_HOME") or (os.path.join(home, ".cache") if home else "")
    return os.path.join(above, "ros-lint") if os.path.isabs(above) else ""


def _is_part(loaded: Any, kind: type) -> bool:
    """Return whether a value that was loaded maps paths to stamps and facts."""
    return isinstance(loaded, dict) and all(
        isinstance(path, str)
        and isinstance(entry, tuple)
        and len(entry) == 2
        and isinstance(entry[0], tuple)
        and isinstance(entry[1], kind)
        for path, entry in loaded.items()
    )


def _bare(told: Any) -> Any:
    """Return stamps and the entries of a directory as plain tuples, which are equal to them and read faster."""
    return [tuple(entry) for entry in told] if isinstance(told, list) else tuple(told) if isinstance(told, tuple) else told


def _part(path: str) -> int:
    """Return which part keeps the facts of a file: that of its folder."""
    return zlib.crc32(to_bytes(path.rpartition("/")[0])) % _PARTS


def _stamp(tree: Tree, path: str) -> tuple[int, ...] | None:
    try:
        return tuple(tree.stamp(path))
    except (OSError, ValueError):  # a NUL in a path that was loaded
        return None


def _digest(text: str) -> str:
    import hashlib  # noqa: PLC0415

    return hashlib.sha256(to_bytes(text)).hexdigest()[:24]


def _state(files: Iterable[str]) -> str:
    """Return what tells one interpreter and one state of some files from another."""
    stamps = []
    for file in sorted(files):
        try:
            found = os.stat(file)
            stamps.append(f"{file} {found.st_mtime_ns} {found.st_size} {found.st_ctime_ns} {found.st_ino}")
        except OSError:
            stamps.append(file)
    return f"ros-lint {__version__} {sys.implementation.cache_tag} {_digest(' '.join([sys.version, *stamps]))}"


def _collectors() -> Iterator[str]:
    """Yield the files that the facts of a file depend on."""
    for room in ("base", "facts", "collectors"):
        yield from files_below(os.path.join(_SOURCES, room))
    yield from (os.path.abspath(__file__), os.path.join(_SOURCES, "workspace", "collect.py"))


def files_below(place: str) -> Iterator[str]:
    """Yield all files below a folder, those left out that Python makes of others."""
    for folder, folders, files in os.walk(place):
        folders[:] = [name for name in folders if name != "__pycache__"]
        yield from [os.path.join(folder, file) for file in files]
