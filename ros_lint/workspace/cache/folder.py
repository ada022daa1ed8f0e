"""The user's cache folder of ros-lint: where it is, which workspaces have a file in it, and which files are removed."""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from typing import NamedTuple

from ros_lint.base.text import from_bytes
from ros_lint.workspace.cache import layout

SUFFIX = ".cache"
"""Suffix of the cache file of a workspace."""

WORKSPACE = "workspace"
"""Name of the record, in a cache file, with the path of the workspace."""

MOST_BYTES = 1 << 30
"""Maximum size of all cache files in bytes. If it is exceeded, the least recently used files are removed."""

_DAY = 86400.0
"""Seconds of a day."""

_MOST_DAYS = 90
"""Number of days without use after which a cache file is removed."""

_ABANDONED = 3600.0
"""Age in seconds at which a temporary file is removed, because the process that wrote it has ended."""


class CachedWorkspace(NamedTuple):
    """The cache file of a workspace."""

    file: str
    """Path of the file."""
    workspace: str
    """Folder of the workspace; "" if the file cannot be read."""
    size: int
    """Size of the file in bytes."""
    used: float
    """Time of the last use in seconds since the epoch, up to a day too early."""

    @property
    def is_gone(self) -> bool:
        """True if the folder of the workspace does not exist."""
        return not os.path.isdir(self.workspace)


def folder(environment: Mapping[str, str]) -> str:
    """Return the user's cache folder for ros-lint, or "" if the system has none (XDG base directories).

    A home directory that does not exist counts as none, because it must not be created, for example in a container.
    """
    home = environment.get("HOME") or environment.get("USERPROFILE") or ""
    caches = environment.get("XDG_CACHE_HOME") or (os.path.join(home, ".cache") if os.path.isdir(home) else "")
    return os.path.join(caches, "ros-lint") if os.path.isabs(caches) else ""


def cached_workspaces(place: str) -> list[CachedWorkspace]:
    """Return the cache files in the folder ``place``, the most recently used first; [] if the folder does not exist.

    Raises OSError for a folder that cannot be read.
    """
    cached = [
        CachedWorkspace(path, _workspace_of(path), status.st_size, status.st_mtime) for path, status in _files(place, SUFFIX)
    ]
    return sorted(cached, key=lambda workspace: (-workspace.used, workspace.file))


def remove(place: str, unwanted: Callable[[CachedWorkspace], bool]) -> list[CachedWorkspace]:
    """Remove the cache files of a folder for which ``unwanted`` returns True, and return them.

    Abandoned temporary files are removed, too. Raises OSError for a file that cannot be removed.
    """
    removed = [cached for cached in cached_workspaces(place) if unwanted(cached)]
    for cached in removed:
        os.unlink(cached.file)
    _remove_abandoned(place)
    return removed


def note_use(path: str) -> None:
    """Set the modification time of a cache file to now, unless it is less than a day old."""
    with suppress(OSError):
        if time.time() - os.stat(path).st_mtime > _DAY:
            os.utime(path)


def tidy(place: str, written: str, *, with_gone_workspaces: bool) -> None:
    """Remove old cache files from a folder, and the least recently used ones until the folder is small enough.

    ``written`` is a file that is kept, because it was just written. ``with_gone_workspaces`` also removes the cache files of
    workspaces that do not exist any more; this is slow, because it reads all cache files.
    """
    with suppress(OSError):
        if with_gone_workspaces:
            remove(place, lambda cached: cached.is_gone and cached.file != written)
        else:
            _remove_abandoned(place)
        newest_first = sorted(_files(place, SUFFIX), key=lambda entry: (entry[0] == written, entry[1].st_mtime), reverse=True)
        total = 0
        for path, status in newest_first:
            total += status.st_size
            is_old = time.time() - status.st_mtime > _MOST_DAYS * _DAY
            if path != written and (is_old or total > MOST_BYTES):
                total -= status.st_size
                os.unlink(path)


def _remove_abandoned(place: str) -> None:
    for path, status in _files(place, layout.TEMPORARY):
        if abs(time.time() - status.st_mtime) > _ABANDONED:
            os.unlink(path)


def _files(place: str, suffix: str) -> Iterator[tuple[str, os.stat_result]]:
    """Yield the files of a folder with the suffix ``suffix``: the path and the status of each. Links are not followed.

    Raises OSError for a folder that cannot be read.
    """
    try:
        entries = os.scandir(place)
    except FileNotFoundError:
        return
    with entries:
        for entry in entries:
            if entry.name.endswith(suffix):
                with suppress(FileNotFoundError):  # another process has removed the file
                    yield entry.path, entry.stat(follow_symlinks=False)


def _workspace_of(path: str) -> str:
    """Return the path of the workspace to which a cache file belongs, "" if the file cannot be read."""
    try:
        return from_bytes(layout.read(path, lambda name: name == WORKSPACE)[WORKSPACE])
    except (OSError, layout.DamagedError, KeyError):
        return ""
