"""``ros-lint --watch``: check a workspace again whenever a file changes."""

from __future__ import annotations

import gc
import os
import sys
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from typing import TYPE_CHECKING, Any

from ros_lint.cli.checking import check_session
from ros_lint.cli.session import UsageError, open_session
from ros_lint.cli.settings import CONFIGURATION_FILES
from ros_lint.workspace.discovery.discover import SKIPPED_FOLDERS

if TYPE_CHECKING:
    from ros_lint.cli.progress import Progress
    from ros_lint.cli.session import Request, Session
    from ros_lint.engine.report import Report

    Check = Callable[[Mapping[str, Any], Callable[[Request, Progress], Report]], int]
    State = dict[str, tuple[int, int]]

_PAUSE = 0.5
"""Seconds between two searches for changes."""
_SHARE = 10
"""A pause is at least this many times as long as the search before it, so that watching a large workspace costs little."""
_CLEAR = "\x1b[2J\x1b[H"
_WRITING = ("fix", "write-baseline", "stdin-filename")


def run(options: Mapping[str, Any], request: Request, check: Check) -> int:
    """Call ``check`` with the options, and again after each change of a file. Return the last exit code after Ctrl+C.

    Only what depends on a changed file is checked again. Raises UsageError for options that change files.
    """
    for option in _WRITING:
        if request.settings[option]:
            raise UsageError(f"--watch and --{option} cannot be combined")
    folders = [os.path.join(request.base, folder) for folder in (*request.roots, *request.context)]
    index = os.path.join(request.base, ".git", "index")
    gc.enable()  # each run builds a model
    checker = _Checker()
    code = 0
    try:
        while True:
            before = state_of(folders, index)
            if sys.stdout.isatty():
                print(_CLEAR, end="")
            code = check({**options, "watch": False}, checker.report)
            sys.stdout.flush()
            print("ros-lint: waiting for changes; stop with Ctrl+C", file=sys.stderr, flush=True)
            gc.collect()
            checker.changed.update(_wait(folders, index, before))
    except KeyboardInterrupt:
        return code


class _Checker:
    """Checks a workspace again and again."""

    def __init__(self) -> None:
        self.changed: set[str] = set()
        """Absolute paths of the files that have changed since the last check."""
        self._session: Session | None = None
        self._progress: Progress | None = None

    def report(self, request: Request, progress: Progress) -> Report:
        """Return the report of a check. A change of a configuration file or of the files that git tracks starts from scratch."""
        self._progress = progress
        changed, self.changed = self.changed, set()
        names = {os.path.basename(path) for path in changed}
        session, self._session = self._session, None  # after an error, the next check starts from scratch, too
        if session is None or not names.isdisjoint((*CONFIGURATION_FILES, "index")):
            session = open_session(request, self._update, again=True)
        session.loader.forget([os.path.relpath(path, request.base).replace(os.sep, "/") for path in changed])
        report = check_session(session)
        self._session = session
        return report

    def _update(self, step: str, finished: int, total: int) -> None:
        if self._progress:
            self._progress.update(step, finished, total)


def _wait(folders: list[str], index: str, before: State) -> set[str]:
    """Return the paths of changed files once files have changed since ``before`` and then not any more between two searches."""
    current = before
    while True:
        start = time.monotonic()
        earlier, current = current, state_of(folders, index)
        if current != before and current == earlier:
            return {path for path in {*before, *current} if before.get(path) != current.get(path)}
        time.sleep(max(_PAUSE, _SHARE * (time.monotonic() - start)))


def state_of(folders: list[str], index: str) -> State:
    """Return the time of change and the size of each file below the folders, by path, and of the ``index`` of git.

    Folders that ros-lint never reads are left out: those of git, and folders with ``COLCON_IGNORE`` such as ``build``.
    """
    state = dict(entry for folder in folders for entry in _files(folder))
    with suppress(OSError):  # there is no repository
        stat = os.stat(index)
        state[index] = (stat.st_mtime_ns, stat.st_size)
    return state


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
