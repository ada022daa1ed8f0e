"""The cache file of a workspace with the results of earlier runs.

The file is not used if it is damaged, if it is a symbolic link or has several hard links, or if another user can write the
file or its folder. Records are decoded by :mod:`ros_lint.base.columns`, which creates only plain data objects. So a
manipulated file can make a run slow, but it cannot run code.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from typing import TypeVar

from ros_lint import __version__
from ros_lint.base import files
from ros_lint.base.columns import Codec, DecodeError
from ros_lint.base.text import to_bytes
from ros_lint.workspace.cache import layout
from ros_lint.workspace.cache.folder import SUFFIX, WORKSPACE, note_use, tidy

T = TypeVar("T")

SOURCES = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
"""Folder of the Python package ``ros_lint``."""


class CacheFile:
    """The cached results of a workspace. With an empty ``folder``, nothing is cached. Nothing is written unless ``writable``.

    ``notes`` has the reasons why cached results were not used or not written, to be shown to the user.
    """

    def __init__(self, folder: str, workspace: str, *, writable: bool = True) -> None:
        self._folder = folder
        self._writable = writable
        self._workspace = os.path.realpath(workspace) if folder else ""
        # Each installation has its own file, so that two versions do not replace each other's results.
        key = "\0".join((self._workspace, __version__, sys.version, SOURCES))
        self._path = os.path.join(folder, f"{digest(key)}{SUFFIX}") if folder else ""
        self._notes: dict[str, None] = {}

    def __bool__(self) -> bool:
        """Return whether results are kept between runs: False if ``folder`` is empty."""
        return bool(self._path)

    def for_reading(self) -> CacheFile:
        """Return the same cache file, to which nothing is written."""
        return CacheFile(self._folder, self._workspace, writable=False)

    @property
    def notes(self) -> tuple[str, ...]:
        """Reasons why cached results were not used or not written."""
        return tuple(self._notes)

    def read(self, wanted: Callable[[str], bool], codec: Codec[T]) -> dict[str, T]:
        """Return the decoded records for whose names ``wanted`` returns True, the oldest first; {} if the file cannot be used."""
        if not os.path.lexists(self._path):
            return {}
        try:
            _require_private(self._folder)
            records = layout.read(self._path, wanted)
            note_use(self._path)
            return {name: codec.decode(data) for name, data in records.items()}
        except (OSError, layout.DamagedError, DecodeError) as error:
            self._note("the cached results are not used, so this run is slower", error)
            return {}

    def write(self, records: Mapping[str, T], codec: Codec[T], obsolete: Callable[[Sequence[str]], Collection[str]]) -> None:
        """Add or replace records of the cache file.

        ``obsolete`` is called with the names of the records in the file, and returns the names of the records to remove.
        """
        if not self._path or not self._writable:
            return
        try:
            os.makedirs(self._folder, mode=0o700, exist_ok=True)
            _require_private(self._folder)
            encoded = {name: codec.encode(value) for name, value in records.items()}
            old = self._usable_records()
            removed = {*obsolete(list(old)), *records, WORKSPACE}
            kept = {name: data for name, data in old.items() if name not in removed}
            layout.replace(self._path, {WORKSPACE: to_bytes(self._workspace), **kept, **encoded})
            tidy(self._folder, self._path, with_gone_workspaces=not old)
        except Exception as error:  # the disk may be full, or a fact nested too deeply: the run goes on without a cache
            self._note("the results are not cached, so the next run is slower", error)

    def _usable_records(self) -> dict[str, bytes]:
        try:
            return layout.read(self._path, lambda name: True)
        except (OSError, layout.DamagedError):
            return {}

    def _note(self, effect: str, error: Exception) -> None:
        if isinstance(error, OSError):
            place, reason = error.filename or self._path, error.strerror or str(error)
        elif isinstance(error, layout.DamagedError):
            place, reason = self._path, str(error)
        elif isinstance(error, DecodeError):
            place, reason = self._path, "damaged"
        else:
            place, reason = self._path, f"{type(error).__name__}: {error}"
        self._notes[f"{effect}: '{os.fspath(place)}': {reason}"] = None


NO_CACHE = CacheFile("", "")
"""A cache that stores nothing."""


def digest(text: str) -> str:
    """Return the SHA-256 digest of a text, shortened to 24 hexadecimal digits."""
    import hashlib  # noqa: PLC0415

    return hashlib.sha256(to_bytes(text)).hexdigest()[:24]


def state_of(paths: Iterable[str], schema: str) -> str:
    """Return a digest that changes with the versions of ros-lint and Python, with the files ``paths``, and with ``schema``.

    A file counts as changed if its time stamps, size or inode are different. ``schema`` describes the format of the records.
    """
    stamps = []
    for path in sorted(paths):
        try:
            status = os.stat(path)
            stamps.append(f"{path} {status.st_mtime_ns} {status.st_size} {status.st_ctime_ns} {status.st_ino}")
        except OSError:
            stamps.append(path)
    return digest(" ".join([__version__, sys.version, schema, *stamps]))


def files_below(place: str) -> Iterator[str]:
    """Yield all files below a folder, without ``__pycache__``."""
    for folder, folders, names in os.walk(place):
        folders[:] = [name for name in folders if name != "__pycache__"]
        yield from [os.path.join(folder, name) for name in names]


def _require_private(folder: str) -> None:
    """Raise PermissionError if another user owns a folder or can write into it."""
    if not files.is_private(folder):
        raise PermissionError(0, "another user owns the folder or can write to it", folder)
