"""Read a file whose size and kind nobody has checked: a configuration file, a list of known findings, a file of the cache."""

from __future__ import annotations

import errno
import os
import stat

_MASK = 0o022
"""The permission to write for the group and for all others."""

_NOT_OWN = "another user owns it or can write it"


def read(path: str, most: int) -> bytes:
    """Return the bytes of a regular file of at most ``most`` bytes. Links are followed.

    Raises OSError, also for another kind of file and for a larger one; ``strerror`` has the reason. A FIFO does not block.
    """
    return _read(path, most, 0)


def read_own(path: str, most: int) -> bytes:
    """Return the bytes of a regular file as :func:`read` does, but only if it belongs to the user. Links are not followed."""
    return _read(path, most, getattr(os, "O_NOFOLLOW", 0), own=True)


def is_private(folder: str) -> bool:
    """Return whether a folder, and the link that leads to it, belongs to the user, and no other user can write into it.

    A system without user ids (Windows) gives no answer, and every folder counts as private.
    """
    try:
        link, target = os.lstat(folder), os.stat(folder)
    except OSError:
        return False
    return stat.S_ISDIR(target.st_mode) and _is_private(target) and _is_of_user(link)


def _read(path: str, most: int, flags: int, *, own: bool = False) -> bytes:
    flags |= getattr(os, "O_NONBLOCK", 0)
    with open(path, "rb", opener=lambda name, usual: os.open(name, usual | flags)) as file:
        found = os.fstat(file.fileno())
        if not stat.S_ISREG(found.st_mode):
            raise OSError(errno.EINVAL, "not a regular file", path)
        if own and not _is_private(found):
            raise PermissionError(errno.EPERM, _NOT_OWN, path)
        data = file.read(most + 1)
    if len(data) > most:
        raise OSError(errno.EFBIG, f"larger than {most >> 10} KB", path)
    return data


def _is_private(found: os.stat_result) -> bool:
    return _is_of_user(found) and not (hasattr(os, "geteuid") and found.st_mode & _MASK)


def _is_of_user(found: os.stat_result) -> bool:
    return not hasattr(os, "geteuid") or found.st_uid == os.geteuid()
