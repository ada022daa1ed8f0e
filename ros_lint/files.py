"""Read files of the machine: regular files only, and never more bytes than a limit.

Opening a file does not block, so a FIFO, a socket or a device is refused at once.
"""

from __future__ import annotations

import errno
import os
import stat

MOST_BYTES = 4 << 20
"""Size limit of a source file in bytes. A larger file is generated data, and no source."""

_FLAGS: int = os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_NOCTTY", 0) | getattr(os, "O_BINARY", 0)
_NO_LINK: int = getattr(os, "O_NOFOLLOW", 0)


def read(place: str, most: int = MOST_BYTES, *, links: bool = True) -> bytes:
    """Return the bytes of a regular file. A file that grows meanwhile is cut at the size that it had when it was opened.

    Raises OSError, with EFBIG for a file of more than ``most`` bytes, EINVAL for a FIFO, socket or device, and without
    ``links`` ELOOP for a path that is a link.
    """
    # os.open and one read of the right size are twice as fast as open() on the many small files of a workspace.
    handle = os.open(place, _FLAGS if links else _FLAGS | _NO_LINK)
    try:
        status = os.fstat(handle)
        if not stat.S_ISREG(status.st_mode):
            raise _irregular(place, status.st_mode)
        size = status.st_size
        if size > most:
            raise OSError(errno.EFBIG, f"{-(-size >> 20)} MB is more than the limit of {most >> 20} MB", place)
        data = os.read(handle, size)
        while len(data) < size and (more := os.read(handle, size - len(data))):
            data += more
        return data
    finally:
        os.close(handle)


def _irregular(place: str, mode: int) -> OSError:
    if stat.S_ISDIR(mode):
        return OSError(errno.EISDIR, os.strerror(errno.EISDIR), place)
    return OSError(errno.EINVAL, "not a regular file", place)
