"""The cache folder: where it is, which workspaces it has, and which files are removed from it."""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from typing import NamedTuple

from ros_lint.base.text import from_bytes
from ros_lint.workspace.cache import layout

SUFFIX = ".cache"
"""Suffix of the file of a workspace."""

WORKSPACE = "workspace"
"""Name of the record with the path of the workspace."""

MOST_BYTES = 1 << 30
"""Maximum size of all files in bytes. If they are larger, the files that were used least recently are removed."""

_DAY = 86400.0
"""Seconds of a day."""

_MOST_DAYS = 90
"""Number of days after which an unused file is removed."""

_ABANDONED = 3600.0
"""Seconds after which a temporary file is removed, because the process that wrote it has ended."""


class CachedWorkspace(NamedTuple):
    """The file of a workspace in the cache folder."""

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
    """Return the user's cache folder for ros-lint, or "" if the system has none (XDG base directories)."""
    home = environment.get("HOME") or environment.get("USERPROFILE") or ""
    caches = environment.get("XDG_CACHE_HOME") or (os.path.join(home, ".cache") if home else "")
    return os.path.join(caches, "ros-lint") if os.path.isabs(caches) else ""


def cached_workspaces(place: str) -> list[CachedWorkspace]:
    """Return the files in a cache folder, the most recently used first; [] if the folder does not exist.

    Raises OSError for a folder that cannot be read.
    """
    cached = [
        CachedWorkspace(path, _workspace_of(path), status.st_size, status.st_mtime) for path, status in _files(place, SUFFIX)
    ]
    return sorted(cached, key=lambda workspace: (-workspace.used, workspace.file))


def remove(place: str, unwanted: Callable[[CachedWorkspace], bool]) -> list[CachedWorkspace]:
    """Remove unwanted files from a cache folder, and return them. Abandoned temporary files are removed, too.

    Raises OSError for a file that cannot be removed.
    """
    removed = [cached for cached in cached_workspaces(place) if unwanted(cached)]
    for cached in removed:
        os.unlink(cached.file)
    _remove_abandoned(place)
    return removed


def note_use(path: str) -> None:
    """Note that a file is used now, unless that was noted within a day."""
    with suppress(OSError):
        if time.time() - os.stat(path).st_mtime > _DAY:
            os.utime(path)


def tidy(place: str, written: str, *, with_gone_workspaces: bool) -> None:
    """Remove files that are too old and, until the folder is small enough, files that were used least recently.

    ``written`` is a file that is kept, because it was just written. ``with_gone_workspaces`` also removes the files of
    workspaces that do not exist any more, for which all files are read.
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
    """Yield the path and the state of each file with a suffix in a folder. Links are not followed. Raises OSError."""
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
    """Return the path of the workspace of a file, "" if the file cannot be read."""
    try:
        return from_bytes(layout.read(path, lambda name: name == WORKSPACE)[WORKSPACE])
    except (OSError, layout.DamagedError, KeyError):
        return ""
