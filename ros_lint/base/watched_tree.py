"""A file tree that keeps its answers, and asks the disk again only about paths that may have changed."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import Any, Final, Literal, cast

from ros_lint.base.paths import folders_of, is_below, join, parent
from ros_lint.base.questions import Cell, Recorder
from ros_lint.base.recorded_tree import content_digest
from ros_lint.base.tree import Entry, OverlayTree, Stamp, Tree

_Query = Literal["list", "read", "stamp", "identity", "untracked"]
_Key = tuple[_Query, str]


class _Failure:
    """The error that a tree raised. Two failures with the same number are equal."""

    def __init__(self, error: OSError) -> None:
        self.error = error

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Failure) and self.error.errno == other.error.errno

    __hash__ = None  # type: ignore[assignment]


_UNSTEADY: Final = b""
"""Value in place of the digest of a file that changed before it was doubted. It equals no digest."""


class WatchedTree:
    """Another tree, whose answers are kept until :meth:`doubt` is called. Answers of the recorder record what they ask.

    The contents of files are not kept, only their digests, by which a changed file is recognized. The tree can have an
    overlay: new contents of some files.
    """

    def __init__(self, below: Tree, recorder: Recorder) -> None:
        self._below = below
        self._tree = below
        self.overlay: Mapping[str, bytes] = {}
        self._recorder = recorder
        self._answers: dict[_Key, object] = {}
        self._cells: dict[_Key, Cell] = {}
        self._links: dict[str, str] = {}
        """The real path of each listed link."""

    def lay(self, below: Tree, changed: Mapping[str, bytes]) -> set[str]:
        """Replace the tree below and the overlay. Return the paths whose contents differ in the overlay.

        The new tree below must give the same answers as the former, except for paths that are doubted.
        """
        before, self.overlay = self.overlay, dict(changed)
        self._below = below
        self._tree = OverlayTree(below, self.overlay) if changed else below
        paths = {path for path in {*before, *changed} if before.get(path) != changed.get(path)}
        self._check({key for path in paths for key in (*_keys(path), ("list", parent(path)))})
        return paths

    def doubt(self, paths: Iterable[str]) -> set[str]:
        """Ask again about files and folders that may have changed, appeared or disappeared. Return all their paths."""
        doubted = set(paths)
        for path in list(doubted):
            real = self._below.identity(path)
            doubted.update([link + real[len(target) :] for link, target in self._links.items() if is_below(real, target)])
        keys = {key for path in doubted for key in _keys(path)}
        keys.update([("list", folder) for path in doubted for folder in (*folders_of(path), "")])
        if folders := tuple([f"{path}/" for path in doubted if ("list", path) in self._answers]):
            keys.update([key for key in self._answers if key[1].startswith(folders)])
        self._check(keys)
        return {*doubted, *(path for _, path in keys)}

    def _check(self, keys: Iterable[_Key]) -> None:
        changed = []
        for key in keys:
            if key not in self._answers:
                continue
            before = self._answers[key]
            now = self._answers[key] = self._ask(key)
            if now != before:
                changed.append(self._cells[key])
        self._recorder.change(changed)

    def _ask(self, key: _Key) -> object:
        query, path = key
        try:
            answer = _QUERIES[query](self._tree, path)
        except OSError as error:
            return _Failure(error)
        if query == "list":
            self._links.update(
                [(child, self._below.identity(child)) for name, _, link in answer if link and (child := join(path, name))]
            )
        return answer

    def _answer(self, key: _Key) -> Any:
        cell = self._cells.get(key)
        if cell is None:
            cell = self._cells[key] = Cell()
            self._answers[key] = self._ask(key)
        self._recorder.note(cell)
        answer = self._answers[key]
        if isinstance(answer, _Failure):
            raise answer.error
        return answer

    def list(self, path: str) -> list[Entry]:
        return cast("list[Entry]", self._answer(("list", path)))

    def read(self, path: str) -> bytes:
        key: _Key = ("read", path)
        try:
            data = self._tree.read(path)
            answer: object = content_digest(data)
        except OSError as error:
            data, answer = b"", _Failure(error)
        cell = self._cells.get(key)
        if cell is None:
            cell = self._cells[key] = Cell()
            self._answers[key] = answer
        elif self._answers[key] != answer:
            self._answers[key] = _UNSTEADY
        self._recorder.note(cell)
        if isinstance(answer, _Failure):
            raise answer.error
        return data

    def stamp(self, path: str) -> Stamp:
        return cast("Stamp", self._answer(("stamp", path)))

    def identity(self, path: str) -> str:
        return cast("str", self._answer(("identity", path)))

    def is_untracked(self, path: str) -> bool:
        return bool(self._answer(("untracked", path)))


def _timeless(tree: Tree, path: str) -> Stamp:
    """Return the stamp of a file without its times, because the times of a file say nothing about its meaning."""
    stamp = tree.stamp(path)
    return Stamp(0, stamp.size, stamp.mode)


_QUERIES: Final[Mapping[_Query, Callable[[Tree, str], Any]]] = {
    "list": lambda tree, path: tree.list(path),
    "read": lambda tree, path: content_digest(tree.read(path)),
    "stamp": _timeless,
    "identity": lambda tree, path: tree.identity(path),
    "untracked": lambda tree, path: tree.is_untracked(path),
}


def _keys(path: str) -> list[_Key]:
    return [(query, path) for query in _QUERIES]
