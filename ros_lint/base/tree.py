"""File trees: interfaces to the files on a disk, in memory, or on a disk with some contents replaced.

All other modules read files through a tree, so that the same code reads a real workspace, a workspace with fixes in
memory and a test case. Paths are relative to the base of the tree, with forward slashes; the base itself is ``""``.
"""

from __future__ import annotations

import errno
import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from operator import itemgetter
from typing import Literal, NamedTuple, Protocol

from ros_lint.base import files
from ros_lint.base.paths import is_below_any, join, parent, upwards
from ros_lint.base.text import Text, read, to_bytes

Kind = Literal["file", "directory", "other"]


class Entry(NamedTuple):
    """An entry of a directory. For a link, ``kind`` is the kind of its target, "other" for a broken link.

    A device is "other", too.
    """

    name: str
    kind: Kind
    link: bool = False


class Stamp(NamedTuple):
    """The metadata of a file by which changes are detected.

    The fields are the modification time in nanoseconds, the size in bytes, the permission bits, the inode's change time
    (st_ctime, in nanoseconds) and the inode number. Tools can restore the first three (``cp -p``, ``rsync -t``,
    git-restore-mtime). No tool sets the change time, and the inode number changes when a link leads to another file.
    """

    time: int
    size: int
    mode: int
    changed: int = 0
    inode: int = 0

    @property
    def executable(self) -> bool:
        """True if the owner, the group or others may execute the file."""
        return bool(self.mode & 0o111)

    def is_settled(self, time: int) -> bool:
        """Return whether any change of the file after ``time`` must change the stamp. ``time`` is in nanoseconds since the epoch.

        A file system counts time in ticks, so two changes within one tick have equal times. The coarsest tick is that of
        FAT, two seconds.
        """
        return max(self.time, self.changed) + _COARSEST_TICK < time


_COARSEST_TICK = 2_000_000_000
"""Longest tick of a file system's clock, in nanoseconds."""


class Tree(Protocol):
    """A tree of files to read. Each method raises OSError if the path does not exist or cannot be read."""

    def list(self, path: str) -> list[Entry]:
        """Return the entries of a directory, sorted by name."""

    def read(self, path: str) -> bytes:
        """Return the bytes of a file."""

    def stamp(self, path: str) -> Stamp:
        """Return the metadata of a file by which changes are detected."""

    def identity(self, path: str) -> str:
        """Return the real path of a file or directory.

        Links are resolved, so two paths of the same directory have equal identities. The identity of an entry that is not
        a link is the identity of its directory joined with its name.
        """

    def is_untracked(self, path: str) -> bool:
        """Return whether a path exists on the disk, but is not in this tree because git does not track it."""


def text_of(tree: Tree, path: str) -> Text | None:
    """Return the text of a file, None if it cannot be read."""
    try:
        return read(path, tree.read(path))
    except OSError:
        return None


def contents(tree: Tree, folder: str, files: Iterable[str]) -> Iterator[tuple[str, bytes]]:
    """Yield pairs of the path and contents of ``files``, which are relative to ``folder``. Unreadable files are left out."""
    for path in (join(folder, file) for file in files):
        try:
            yield path, tree.read(path)
        except OSError:
            continue


_NAME = itemgetter(0)
_make = tuple.__new__


def repository_of(folder: str) -> str:
    """Return the root of the git repository that contains an absolute folder, "" if there is none."""
    return next((above for above in upwards(folder) if os.path.exists(os.path.join(above, ".git"))), "")


def _followed(entry: os.DirEntry[str]) -> Entry:
    try:
        kind: Kind = "directory" if entry.is_dir() else "file" if entry.is_file() else "other"
    except OSError:
        kind = "other"  # e.g. a link to itself
    return Entry(entry.name, kind, entry.is_symlink())


LEADS_OUT = "links to a place outside the workspace"


class DiskTree:
    """The files below a directory of the disk, read-only.

    A symbolic link to a file is followed only if its target is

    * in one of the folders ``inside`` (real paths; by default only the directory itself),
    * or, if the folder of the file is reached by a link, in the target of that link or in the git repository of that
      target.
    """

    __slots__ = ("_base", "_inside")

    def __init__(self, base: str, inside: Sequence[str] = ()) -> None:
        self._base = base
        self._inside = tuple(inside)

    def place(self, path: str) -> str:
        """Return the path for the operating system: the base of the tree joined with ``path``.

        Raises FileNotFoundError if no file can have the path.
        """
        return _possible(f"{self._base}/{path}" if path else self._base)

    def list(self, path: str) -> list[Entry]:
        result = []
        with os.scandir(self.place(path)) as entries:
            for entry in entries:
                # The two common cases need no system call and little Python code.
                if entry.is_file(follow_symlinks=False):
                    result.append(_make(Entry, (entry.name, "file", False)))
                elif entry.is_dir(follow_symlinks=False):
                    result.append(_make(Entry, (entry.name, "directory", False)))
                else:
                    result.append(_followed(entry))
        result.sort(key=_NAME)
        return result

    def read(self, path: str) -> bytes:
        """Return the bytes of a file. Raises OSError; the errno is EXDEV for a link that leads out of the workspace."""
        try:
            return files.read(self.place(path), links=False)
        except OSError as error:
            if error.errno not in _IS_LINK:
                raise
        target = self.identity(path)
        if not self._may_lead_to(target, parent(path)):
            raise OSError(errno.EXDEV, LEADS_OUT, self.place(path))
        return files.read(target)

    def _may_lead_to(self, target: str, folder: str) -> bool:
        """Return whether this tree follows a link in ``folder`` to a file with the real path ``target``."""
        inside = self._inside or (self.identity(""),)
        if is_below_any(target, inside):
            return True
        linked = ""  # the real path of the outermost folder that is reached by a link to elsewhere
        while folder and not is_below_any(real := self.identity(folder), inside):
            linked, folder = real, parent(folder)
        return bool(linked) and is_below_any(target, (linked, repository_of(linked) or linked))

    def stamp(self, path: str) -> Stamp:
        status = os.stat(self.place(path))
        inode = status.st_ino & _INODE_BITS
        return Stamp(status.st_mtime_ns, status.st_size, status.st_mode & 0o777, status.st_ctime_ns, inode)

    def identity(self, path: str) -> str:
        return os.path.realpath(_possible(os.path.join(self._base, path)))

    def is_untracked(self, path: str) -> bool:  # noqa: ARG002  (of a Tree)
        return False


def _possible(path: str) -> str:
    """Return ``path``. Raises FileNotFoundError if it contains NUL, or a character that the file system cannot represent."""
    try:
        if path.isascii() or os.fsencode(path):
            possible = "\0" not in path
    except UnicodeEncodeError:
        possible = False
    if not possible:
        raise FileNotFoundError(errno.ENOENT, os.strerror(errno.ENOENT), path)
    return path


_INODE_BITS = (1 << 63) - 1
"""Mask for the part of an inode number that a stamp stores, because some file systems have numbers of 64 and 128 bits."""

_IS_LINK = (errno.ELOOP, errno.EMLINK)
"""Error numbers of os.open() with O_NOFOLLOW for a symbolic link: ELOOP on Linux and macOS, EMLINK on FreeBSD."""


class MachineTree(DiskTree):
    """All files of the machine, by absolute path. All links are followed."""

    __slots__ = ()

    def __init__(self) -> None:
        super().__init__("")

    def place(self, path: str) -> str:
        return _possible(path)

    def read(self, path: str) -> bytes:
        return files.read(self.place(path))


class MemoryTree:
    """Files in memory, given as a mapping from path to contents. ``executable`` has the paths of the executable files."""

    __slots__ = ("_directories", "_executable", "_files")

    def __init__(self, files: Mapping[str, str | bytes], executable: frozenset[str] = frozenset()) -> None:
        self._files = {path: _bytes(content) for path, content in files.items()}
        self._executable = executable
        self._directories: dict[str, dict[str, Entry]] = {"": {}}
        for path in self._files:
            self._enter(path, "file")

    def _enter(self, path: str, kind: Kind) -> None:
        directory, _, name = path.rpartition("/")
        if directory not in self._directories:
            self._directories[directory] = {}
            self._enter(directory, "directory")
        self._directories[directory][name] = Entry(name, kind)

    def list(self, path: str) -> list[Entry]:
        if path not in self._directories:
            raise NotADirectoryError(20, os.strerror(20), path)
        return sorted(self._directories[path].values())

    def read(self, path: str) -> bytes:
        if path not in self._files:
            raise FileNotFoundError(2, os.strerror(2), path)
        return self._files[path]

    def stamp(self, path: str) -> Stamp:
        return Stamp(0, len(self.read(path)), 0o755 if path in self._executable else 0o644)

    def identity(self, path: str) -> str:
        return path

    def is_untracked(self, path: str) -> bool:  # noqa: ARG002  (of a Tree)
        return False


class OverlayTree:
    """Another tree in which the contents of some files are replaced or added. Added files must be in existing directories."""

    __slots__ = ("_below", "_changed", "_names")

    def __init__(self, below: Tree, changed: Mapping[str, bytes]) -> None:
        self._below = below
        self._changed = changed
        self._names: dict[str, list[str]] = {}
        for file in changed:
            directory, _, name = file.rpartition("/")
            self._names.setdefault(directory, []).append(name)

    def list(self, path: str) -> list[Entry]:
        entries = self._below.list(path)
        if path not in self._names:
            return entries
        new = set(self._names[path]).difference(entry.name for entry in entries)
        return sorted([*entries, *(Entry(name, "file") for name in new)], key=_NAME)

    def read(self, path: str) -> bytes:
        return self._changed[path] if path in self._changed else self._below.read(path)

    def stamp(self, path: str) -> Stamp:
        try:
            return self._below.stamp(path)
        except FileNotFoundError:
            if path not in self._changed:
                raise
            return Stamp(0, len(self._changed[path]), 0o644)

    def identity(self, path: str) -> str:
        return self._below.identity(path)

    def is_untracked(self, path: str) -> bool:
        return path not in self._changed and self._below.is_untracked(path)


def _bytes(content: str | bytes) -> bytes:
    return content if isinstance(content, bytes) else to_bytes(content)
