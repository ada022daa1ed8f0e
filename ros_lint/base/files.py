"""Read regular files with a size limit.

Files are opened without blocking, so that a FIFO, a socket or a device is rejected at once.
"""

from __future__ import annotations

import errno
import os
import stat

MOST_BYTES = 4 << 20
"""Size limit of a source file in bytes. A larger file is generated data, not source code."""

_FLAGS: int = os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_NOCTTY", 0) | getattr(os, "O_BINARY", 0)
_WRITABLE_BY_OTHERS = 0o022
"""Permission bits with which the group or other users can write a file."""
_NO_LINK: int = getattr(os, "O_NOFOLLOW", 0)


def read(place: str, most: int = MOST_BYTES, *, links: bool = True, private: bool = False) -> bytes:
    """Return the bytes of the regular file at the path ``place``. Bytes that another process appends meanwhile are left out.

    Raises OSError, in particular with these error numbers:

    * EFBIG for a file of more than ``most`` bytes,
    * EISDIR for a folder, EINVAL for a FIFO, socket or device,
    * ELOOP for a symbolic link, if ``links`` is False,
    * EPERM if ``private`` is True and another user owns or can write the file, or the file has further hard links.
    """
    # os.open and one read of the right size are twice as fast as open() on the many small files of a workspace.
    handle = os.open(place, _FLAGS if links else _FLAGS | _NO_LINK)
    try:
        status = os.fstat(handle)
        if not stat.S_ISREG(status.st_mode):
            raise _irregular(place, status.st_mode)
        if private and not _is_private(status):
            raise PermissionError(errno.EPERM, "another user owns the file or can write to it", place)
        if private and status.st_nlink > 1:
            raise PermissionError(errno.EPERM, "the file has further hard links", place)
        size = status.st_size
        if size > most:
            raise too_large(size, most, place)
        data = os.read(handle, size)
        while len(data) < size and (chunk := os.read(handle, size - len(data))):
            data += chunk
        return data
    finally:
        os.close(handle)


def too_large(size: int, most: int, place: str) -> OSError:
    """Return the error for a file of ``size`` bytes at the path ``place``, if the limit is ``most`` bytes."""
    return OSError(errno.EFBIG, f"{_amount(size)} is more than the limit of {_amount(most)}", place)


def is_private(folder: str) -> bool:
    """Return whether a folder belongs to the current user and no other user can write into it.

    If ``folder`` is a symbolic link, the link must belong to the user, too. On a system without user ids (Windows), every
    folder counts as private.
    """
    try:
        link, target = os.lstat(folder), os.stat(folder)
    except OSError:
        return False
    return stat.S_ISDIR(target.st_mode) and _is_private(target) and _is_of_user(link)


def _is_private(status: os.stat_result) -> bool:
    return _is_of_user(status) and not (hasattr(os, "geteuid") and status.st_mode & _WRITABLE_BY_OTHERS)


def _is_of_user(status: os.stat_result) -> bool:
    return not hasattr(os, "geteuid") or status.st_uid == os.geteuid()


def _amount(size: int) -> str:
    """Return a number of bytes as text in MB or KB, rounded up: "4 MB"."""
    return f"{-(-size >> 20)} MB" if size >= 1 << 20 else f"{-(-size >> 10)} KB"


def _irregular(place: str, mode: int) -> OSError:
    if stat.S_ISDIR(mode):
        return OSError(errno.EISDIR, os.strerror(errno.EISDIR), place)
    return OSError(errno.EINVAL, "not a regular file", place)
