"""Cache the facts of files. Facts are the data that collectors extract from the contents of one file.

A file is assumed to be unchanged if its :class:`~ros_lint.base.tree.Stamp` (times, size, inode) is unchanged and settled.
Settled means that each later change would result in another stamp. Otherwise the file is read, and the digest of its
contents decides. So the facts are found again after ``git checkout`` or in a new clone.
"""

from __future__ import annotations

import os
import time
from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from itertools import count
from typing import TYPE_CHECKING, NamedTuple

from ros_lint.base.columns import Codec
from ros_lint.base.recorded_tree import NOT_READ, has_contents
from ros_lint.base.tree import Stamp
from ros_lint.workspace.cache.file import SOURCES, CacheFile, digest, files_below, state_of
from ros_lint.workspace.collected import Collected, ReadFile

if TYPE_CHECKING:
    from ros_lint.base.tree import Tree


class CachedFacts(NamedTuple):
    """The facts (data that collectors extract) of a file, and the stamp and digest that the file had when it was read."""

    path: str
    stamp: Stamp
    settled: bool
    """True if an equal stamp means equal contents; see :meth:`Stamp.is_settled`."""
    digest: bytes
    collected: Collected


_Segment = tuple[CachedFacts, ...]


class FactCache:
    """The cached facts of the files of a workspace. Facts are the data that collectors extract from a file.

    ``folders`` are folders outside the workspace that links may lead into.
    The facts are stored in segments, so that a run after a small change encodes little. A new segment absorbs older
    segments that are not much larger, so the number of segments grows with the logarithm of the number of files.
    """

    def __init__(self, file: CacheFile, folders: Sequence[str] = ()) -> None:
        self._file = file
        self._folders = folders
        self._segments: dict[str, _Segment] = {}
        self._cached: dict[str, CachedFacts] = {}
        self._renewed: dict[str, CachedFacts] = {}
        self._stamps: dict[str, Stamp] = {}
        self._start = 0

    def fetch(self, tree: Tree, disk: Tree, paths: Sequence[str]) -> dict[str, ReadFile]:
        """Return the cached facts (extracted data) of those files among ``paths`` that have not changed.

        The stamps (times, size, inode) of files are read from ``tree``. If an equal stamp does not prove that a file is
        unchanged, its contents are read from ``disk`` and compared.
        """
        if not self._file:
            return {}
        self._start = time.time_ns()
        # The stamps are taken before files are read: a file that changes meanwhile counts as changed.
        self._stamps = {path: stamp for path in paths if (stamp := _stamp(tree, path)) is not None}
        self._segments = self._file.read(lambda name: name.startswith(self._prefix), _codec())
        self._cached = {facts.path: facts for segment in self._segments.values() for facts in segment}
        found = {}
        for path, stamp in self._stamps.items():
            facts = self._cached.get(path)
            if facts is not None and self._is_unchanged(disk, facts, stamp):
                found[path] = ReadFile(facts.digest, facts.collected)
        return found

    def _is_unchanged(self, disk: Tree, facts: CachedFacts, stamp: Stamp) -> bool:
        if facts.settled and facts.stamp == stamp:
            return True
        if not has_contents(disk, facts.path, stamp, facts.stamp, facts.digest):
            return False
        settled = stamp.is_settled(self._start)
        if settled or facts.stamp != stamp:
            self._renewed[facts.path] = facts._replace(stamp=stamp, settled=settled)
        return True

    def store(self, disk: Tree, fresh: Mapping[str, ReadFile]) -> None:
        """Store the facts (extracted data) of files that were read in this run. Files that could not be read are left out."""
        if not self._file:
            return
        new = dict(self._renewed)
        for path, file in fresh.items():
            if file.digest != NOT_READ and (stamp := self._stamps.get(path)):
                new[path] = CachedFacts(path, stamp, stamp.is_settled(self._start), file.digest, file.collected)
        if not new:
            return
        kept = dict(self._segments)
        for name in self._absorbed(len(new)):
            for facts in kept.pop(name):
                is_newest = facts is self._cached[facts.path]
                if facts.path not in new and is_newest and (facts.path in self._stamps or _stamp(disk, facts.path)):
                    new[facts.path] = facts
        name = next(name for number in count() if (name := f"{self._prefix}{number}") not in kept)
        self._file.write(
            {name: tuple(new.values())},
            _codec(),
            lambda names: [name for name in names if name.startswith("facts-") and self._is_obsolete(name, kept)],
        )

    def _absorbed(self, size: int) -> Iterator[str]:
        """Yield the names of the segments to merge with a new segment of ``size`` files, the newest first."""
        superseded = sum(map(len, self._segments.values())) - len(self._cached)
        for name in reversed(self._segments):
            amount = len(self._segments[name])
            if amount > 2 * size and superseded < len(self._cached):
                return
            size += amount
            yield name

    def _is_obsolete(self, name: str, kept: Mapping[str, object]) -> bool:
        """Return whether to remove a record from the cache.

        Removed are the records of other versions of ros-lint, and the records of this workspace that are not in ``kept``.
        """
        return not name.startswith(f"facts-{_state()}-") or (name.startswith(self._prefix) and name not in kept)

    @property
    def _prefix(self) -> str:
        return f"facts-{_state()}-{digest(os.pathsep.join(self._folders))}-"


@cache
def _codec() -> Codec[_Segment]:
    return Codec(tuple[CachedFacts, ...])


@cache
def _state() -> str:
    """Return a digest of the code of ros-lint that determines which facts are extracted from a file."""
    rooms = [os.path.join(SOURCES, room) for room in ("base", "facts", "collectors", os.path.join("workspace", "cache"))]
    modules = [os.path.join(SOURCES, "workspace", name) for name in ("collect.py", "collected.py")]
    return state_of([*(path for room in rooms for path in files_below(room)), *modules], _codec().schema)


def _stamp(tree: Tree, path: str) -> Stamp | None:
    try:
        return tree.stamp(path)
    except OSError:
        return None
