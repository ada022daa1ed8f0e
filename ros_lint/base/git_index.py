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
"""Size limit of an index in bytes: about half a million files."""
_HASHES: Final = (("sha1", 20), ("sha256", 32))
_SIGNATURE: Final = b"DIRC"
_VERSIONS: Final = (2, 3, 4)
_HEADER: Final = 12
"""Bytes of the header: signature, version and number of entries."""
_MODE: Final = 24
"""Offset of the mode in an entry: behind the times, the device and the inode."""
_HASH: Final = 40
"""Offset of the hash in an entry."""
_EXTENDED: Final = 0x4000
"""Flag of an entry with two more bytes of flags."""
_LINK: Final = 0o120000
_SUBMODULE: Final = 0o160000


class Tracked(NamedTuple):
    """The files that git tracks, relative to the root of the repository."""

    files: frozenset[str]
    """Files and links."""
    links: frozenset[str]
    """Links and submodules: what is below them is not in the index."""


def read_index(repository: str, environment: Mapping[str, str]) -> Tracked | None:
    """Return what git tracks in the repository at an absolute folder, None if its index is missing, damaged or incomplete.

    ``GIT_INDEX_FILE`` names another index, as in the hooks of ``git commit FILE``.
    """
    try:
        place = environment.get("GIT_INDEX_FILE", "") or os.path.join(_git_folder(repository), "index")
        return parse_index(files.read(os.path.join(repository, place), _MOST_BYTES))
    except OSError:
        return None


def _git_folder(repository: str) -> str:
    """Return the git folder of a work tree: ``.git``, or the folder that a file ``.git`` names. Raises OSError."""
    place = os.path.join(repository, ".git")
    if os.path.isdir(place):
        return place
    text = os.fsdecode(files.read(place))
    return os.path.join(repository, text.removeprefix("gitdir:").strip())


def parse_index(data: bytes) -> Tracked | None:
    """Return what an index of version 2, 3 or 4 lists, None if it is damaged, split or sparse."""
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
    """Return what an index without its checksum lists. Raises IndexError or ValueError if it ends early."""
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
    """Return whether the optional extensions at an offset fill the rest of an index.

    Required extensions, whose names begin with a lower-case letter, mean that entries are missing: a split or sparse index.
    """
    while at < len(data):
        if not data[at : at + 1].isupper():
            return False
        at += 8 + _number(data, at + 4, 4)
    return at == len(data)


def _number(data: bytes, at: int, size: int) -> int:
    """Return a number in network byte order. Raises IndexError beyond the end."""
    part = data[at : at + size]
    if len(part) < size:
        raise IndexError
    return int.from_bytes(part, "big")


def _variable_number(data: bytes, at: int) -> tuple[int, int]:
    """Return a number of variable length, as git writes offsets in packs, and the offset behind it."""
    byte = data[at]
    value = byte & 0x7F
    while byte & 0x80:
        at += 1
        byte = data[at]
        value = ((value + 1) << 7) | (byte & 0x7F)
    return value, at + 1
