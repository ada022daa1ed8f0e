"""Standard output and standard error of the process: in any encoding, on a full disk, or closed."""

from __future__ import annotations

import io
import os
import sys
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from _typeshed import ReadableBuffer


class OutputError(Exception):
    """Standard output cannot be written. The message says why."""


class _Output(io.RawIOBase):
    """Standard output with errors of its own: an OSError does not say which file it is about."""

    def __init__(self, raw: io.RawIOBase) -> None:
        self._raw = raw

    def writable(self) -> bool:
        return True

    def fileno(self) -> int:
        return self._raw.fileno()

    def isatty(self) -> bool:
        return self._raw.isatty()

    def write(self, data: ReadableBuffer, /) -> int | None:
        try:
            return self._raw.write(data)
        except BrokenPipeError:
            raise  # the reader has ended, as in `ros-lint | head`
        except OSError as error:
            raise OutputError(f"standard output: {error.strerror or error}") from error


def prepare() -> None:
    """Replace the standard streams of the process by streams that can always be written to, or fail with OutputError.

    A character that the encoding of standard output lacks is written as an escape. Text for a closed standard error is lost.
    """
    if sys.stderr is None:
        sys.stderr = open(os.devnull, "w", encoding="utf-8")  # noqa: SIM115  (until the process ends)
    if sys.stdout is None:
        # Takes the number, else the next file that is opened would be standard output; and fails when written to.
        os.dup2(os.open(os.devnull, os.O_RDONLY), _NUMBER)
        raw: Any = io.FileIO(_NUMBER, "w", closefd=False)
        encoding = "utf-8"
    else:
        buffer = sys.stdout.buffer
        raw, encoding = getattr(buffer, "raw", buffer), sys.stdout.encoding  # without a buffer where Python runs with -u
    output = io.BufferedWriter(_Output(raw))
    sys.stdout = io.TextIOWrapper(output, encoding, "backslashreplace", line_buffering=raw.isatty())


_NUMBER = 1
"""The file descriptor of standard output."""
