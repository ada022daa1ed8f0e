"""Make standard output and standard error usable: in any encoding, on a full disk, or closed."""

from __future__ import annotations

import io
import os
import sys

TYPE_CHECKING = False  # as in typing, whose import would take a third of the time of ``--version``
if TYPE_CHECKING:
    from typing import Any

    from _typeshed import ReadableBuffer


class OutputError(Exception):
    """Standard output cannot be written. The message contains the reason."""


class _Output(io.RawIOBase):
    """A stream for standard output that raises OutputError, because an OSError does not show which file failed."""

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
            raise  # the reader has exited, as in `ros-lint | head`
        except OSError as error:
            raise OutputError(f"standard output: {error.strerror or error}") from error


def prepare() -> None:
    """Replace the standard streams by streams that accept every text, or raise OutputError if standard output fails.

    Characters that standard output cannot encode are written as escapes. Text for a closed standard error is dropped.
    """
    if sys.stderr is None:
        sys.stderr = open(os.devnull, "w", encoding="utf-8")  # noqa: SIM115  (until the process ends)
    if sys.stdout is None:
        # Reserve the file descriptor, or else the next opened file would become standard output. Writing to it fails.
        os.dup2(os.open(os.devnull, os.O_RDONLY), _DESCRIPTOR)
        raw: Any = io.FileIO(_DESCRIPTOR, "w", closefd=False)
        encoding = "utf-8"
    else:
        buffer = sys.stdout.buffer
        raw, encoding = getattr(buffer, "raw", buffer), sys.stdout.encoding  # there is no buffer if Python runs with -u
    output = io.BufferedWriter(_Output(raw))
    sys.stdout = io.TextIOWrapper(output, encoding, "backslashreplace", line_buffering=raw.isatty())


_DESCRIPTOR = 1
"""File descriptor of standard output."""
