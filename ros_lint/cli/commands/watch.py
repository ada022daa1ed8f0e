"""``ros-lint --watch``: check a workspace again whenever a file changes."""

from __future__ import annotations

import gc
import os
import sys
import time
from collections.abc import Callable, Iterator, Mapping
from typing import TYPE_CHECKING, Any

from ros_lint.cli.session import UsageError
from ros_lint.workspace.discovery.discover import SKIPPED_FOLDERS

if TYPE_CHECKING:
    from ros_lint.cli.session import Request

_PAUSE = 0.5
"""Seconds between two searches for changes."""
_SHARE = 10
"""A pause is at least this many times as long as the search before it, so that watching a large workspace costs little."""
_CLEAR = "\x1b[2J\x1b[H"
_WRITING = ("fix", "write-baseline", "stdin-filename")


def run(options: Mapping[str, Any], request: Request, check: Callable[[Mapping[str, Any]], int]) -> int:
    """Call ``check`` with the options, and again after each change of a file. Return the last exit code after Ctrl+C.

    Raises UsageError for options that change files.
    """
    for option in _WRITING:
        if request.settings[option]:
            raise UsageError(f"--watch and --{option} cannot be combined")
    folders = [os.path.join(request.base, folder) for folder in (*request.roots, *request.context)]
    gc.enable()  # each run builds a model
    code = 0
    try:
        while True:
            before = state_of(folders)
            if sys.stdout.isatty():
                print(_CLEAR, end="")
            code = check({**options, "watch": False})
            sys.stdout.flush()
            print("ros-lint: waiting for changes; stop with Ctrl+C", file=sys.stderr, flush=True)
            gc.collect()
            _wait(folders, before)
    except KeyboardInterrupt:
        return code


def _wait(folders: list[str], before: Mapping[str, tuple[int, int]]) -> None:
    """Return once files have changed since the state ``before`` and then not any more between two searches."""
    current = before
    while True:
        start = time.monotonic()
        earlier, current = current, state_of(folders)
        if current != before and current == earlier:
            return
        time.sleep(max(_PAUSE, _SHARE * (time.monotonic() - start)))


def state_of(folders: list[str]) -> dict[str, tuple[int, int]]:
    """Return the time of change and the size of each file below the folders, by path.

    Folders that ros-lint never reads are left out: those of git, and folders with ``COLCON_IGNORE`` such as ``build``.
    """
    return dict(entry for folder in folders for entry in _files(folder))


def _files(folder: str) -> Iterator[tuple[str, tuple[int, int]]]:
    pending = [folder]
    while pending:
        place = pending.pop()
        try:
            with os.scandir(place) as entries:
                listed = list(entries)
        except OSError:
            continue  # it was removed, or cannot be read
        if place != folder and any(entry.name == "COLCON_IGNORE" for entry in listed):
            continue
        for entry in listed:
            try:
                if entry.is_dir(follow_symlinks=False):
                    if entry.name not in SKIPPED_FOLDERS:
                        pending.append(entry.path)
                else:
                    stat = entry.stat()
                    yield entry.path, (stat.st_mtime_ns, stat.st_size)
            except OSError:
                continue
