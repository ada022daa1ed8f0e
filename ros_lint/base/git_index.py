"""Read the index of a git repository: the list of the files that git tracks.

git itself is not called, because it may be missing, and because its configuration can make it run programs. The format is
described in ``Documentation/gitformat-index.txt`` of git.
"""

from __future__ import annotations

import hashlib
import os
from collections.abc import Mapping
from typing import Final, NamedTuple

from ros_lint.base import files

_MOST_BYTES: Final = 64 << 20
"""Size limit of an index file in bytes, enough for about half a million files."""
_HASHES: Final = (("sha1", 20), ("sha256", 32))
_SIGNATURE: Final = b"DIRC"
_VERSIONS: Final = (2, 3, 4)
_HEADER: Final = 12
"""Length of the header of an index in bytes: signature, version and number of entries."""
_MODE: Final = 24
"""Offset of the mode (kind of file and permissions) in an entry, after the times, the device and the inode."""
_HASH: Final = 40
"""Offset of the hash of the contents in an entry."""
_EXTENDED: Final = 0x4000
"""Bit in the flags of an entry that has two more bytes of flags."""
_LINK: Final = 0o120000
_SUBMODULE: Final = 0o160000


class Tracked(NamedTuple):
    """The paths that git tracks, relative to the root of the repository."""

    files: frozenset[str]
    """Paths of all entries: files, symbolic links and submodules."""
    links: frozenset[str]
    """Paths of symbolic links and submodules. The index has no entries for files below these paths."""


def read_index(repository: str, environment: Mapping[str, str]) -> Tracked | None:
    """Return the tracked paths of the repository at an absolute folder, None if its index is missing, damaged or incomplete.

    The variable ``GIT_INDEX_FILE`` in ``environment`` names another index file. git sets it in the hooks of ``git commit
    FILE``.
    """
    try:
        place = environment.get("GIT_INDEX_FILE", "") or os.path.join(_git_folder(repository), "index")
        return parse_index(files.read(os.path.join(repository, place), _MOST_BYTES))
    except OSError:
        return None


def _git_folder(repository: str) -> str:
    """Return the git folder of a work tree: ``.git``, or the folder whose path the file ``.git`` contains. Raises OSError."""
    place = os.path.join(repository, ".git")
    if os.path.isdir(place):
        return place
    text = os.fsdecode(files.read(place))
    return os.path.join(repository, text.removeprefix("gitdir:").strip())


def parse_index(data: bytes) -> Tracked | None:
    """Return the tracked paths in the bytes of an index of version 2, 3 or 4; None if it is damaged, split or sparse."""
    for name, size in _HASHES:
        content, checksum = data[:-size], data[-size:]
        # With index.skipHash, git writes zeros in place of the checksum.
        if checksum == bytes(size) or hashlib.new(name, content, usedforsecurity=False).digest() == checksum:
            try:
                if (tracked := _parse(content, size)) is not None:
                    return tracked
            except (IndexError, ValueError):
                continue
    return None


def _parse(data: bytes, hash_size: int) -> Tracked | None:
    """Return the tracked paths in the bytes of an index without its checksum; None for other formats and incomplete indexes.

    ``hash_size`` is the length of a hash in bytes. Raises IndexError or ValueError if the bytes end too early.
    """
    version, count = _number(data, 4, 4), _number(data, 8, 4)
    if data[:4] != _SIGNATURE or version not in _VERSIONS:
        return None
    at, name = _HEADER, b""
    names: set[str] = set()
    links: set[str] = set()
    for _ in range(count):
        mode, flags = _number(data, at + _MODE, 4), _number(data, at + _HASH + hash_size, 2)
        start = at + _HASH + hash_size + (4 if flags & _EXTENDED else 2)
        if version == 4:
            removed, start = _variable_number(data, start)
            stop = data.index(b"\0", start)
            name = name[: max(len(name) - removed, 0)] + data[start:stop]
            at = stop + 1
        else:
            stop = data.index(b"\0", start)
            name = data[start:stop]
            at += ((stop - at) // 8 + 1) * 8  # an entry is padded with 1 to 8 bytes
        path = os.fsdecode(name)
        names.add(path)
        if mode in (_LINK, _SUBMODULE):
            links.add(path)
    return Tracked(frozenset(names), frozenset(links)) if _is_complete(data, at) else None


def _is_complete(data: bytes, at: int) -> bool:
    """Return whether an index lists all files: only optional extensions follow its last entry, which ends at the offset ``at``.

    The name of a required extension begins with a lower-case letter. It means that the index is split or sparse, so
    entries are missing.
    """
    while at < len(data):
        if not data[at : at + 1].isupper():
            return False
        at += 8 + _number(data, at + 4, 4)
    return at == len(data)


def _number(data: bytes, at: int, size: int) -> int:
    """Return the big-endian number of ``size`` bytes at the offset ``at``. Raises IndexError if the data ends before it."""
    part = data[at : at + size]
    if len(part) < size:
        raise IndexError
    return int.from_bytes(part, "big")


def _variable_number(data: bytes, at: int) -> tuple[int, int]:
    """Return the number of variable length at the offset ``at``, in git's encoding of offsets, and the offset after it."""
    byte = data[at]
    value = byte & 0x7F
    while byte & 0x80:
        at += 1
        byte = data[at]
        value = ((value + 1) << 7) | (byte & 0x7F)
    return value, at + 1
