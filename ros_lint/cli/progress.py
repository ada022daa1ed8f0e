"""Show the progress of a long run in one line of the terminal."""

from __future__ import annotations

import os
import time
from collections.abc import Callable
from typing import TextIO

_DELAY = 0.5
"""Seconds until the line is first shown, because most runs end earlier."""
_INTERVAL = 0.1
"""Seconds between two updates of the line."""


class Progress:
    """Shows the progress of a long run in one line of a terminal. As a context manager, it clears the line at the end.

    The line is not shown if ``wanted`` is False or ``stream`` is not a terminal. ``clock`` returns the time in seconds.
    """

    def __init__(self, stream: TextIO, wanted: bool = True, clock: Callable[[], float] = time.monotonic) -> None:
        self._stream = stream
        self._clock = clock
        self._shown = False
        on = wanted and stream.isatty() and os.environ.get("TERM") != "dumb"
        self._next = clock() + _DELAY if on else float("inf")

    def __enter__(self) -> Progress:
        return self

    def __exit__(self, *error: object) -> None:
        self.clear()

    def update(self, what: str, done: int, total: int) -> None:
        """Show that ``done`` of ``total`` items of the step ``what``, e.g. reading files, are done; ``total`` is 0 if unknown."""
        if (now := self._clock()) < self._next:
            return
        self._next = now + _INTERVAL
        text = f"{what} {done}/{total}" if total else what
        self._write(f"\r{text[: self._columns() - 1]}\x1b[K")
        self._shown = True

    def clear(self) -> None:
        """Clear the line, so that other output can be written."""
        if self._shown:
            self._write("\r\x1b[K")
            self._shown = False

    def _columns(self) -> int:
        try:
            return os.get_terminal_size(self._stream.fileno()).columns or 80
        except (OSError, ValueError):
            return 80

    def _write(self, text: str) -> None:
        try:
            self._stream.write(text)
            self._stream.flush()
        except OSError:
            self._next = float("inf")  # a closed terminal must not stop the run
