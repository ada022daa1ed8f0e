"""The layout of a cache file: named records of bytes, each with a checksum.

A cache file is replaced as a whole. A process that is killed leaves either the old file or the complete new file.
"""

from __future__ import annotations

import os
import time
import zlib
from collections.abc import Callable, Mapping

from ros_lint.base import files

TEMPORARY = ".tmp"
"""Suffix of a temporary file that is being written."""

MOST_BYTES = 256 << 20
"""Maximum size of a cache file in bytes. The file of a workspace with 500 packages has 2 MB."""

_MAGIC = b"ros-lint cache 1"
"""First bytes of each cache file; the number changes with the layout."""


class DamagedError(ValueError):
    """A file is not a cache file, or some of its bytes have changed."""


def read(path: str, wanted: Callable[[str], bool]) -> dict[str, bytes]:
    """Return the records of a cache file by name, in the order of the file: those whose names ``wanted`` accepts.

    Raises DamagedError, and OSError for a file that is missing, not a regular file, linked, or writable by another user.
    """
    return _unpack(files.read(path, MOST_BYTES, links=False, private=True), wanted)


def replace(path: str, records: Mapping[str, bytes]) -> None:
    """Write ``records`` to a cache file in place of its contents. Names of records are ASCII words.

    Raises OSError, and then leaves the file unchanged.
    """
    contents = _pack(records)
    if len(contents) > MOST_BYTES:
        raise files.too_large(len(contents), MOST_BYTES, path)
    temporary = f"{path}.{os.getpid()}-{time.time_ns():x}{TEMPORARY}"
    handle = os.open(temporary, os.O_WRONLY | os.O_CREAT | os.O_EXCL | getattr(os, "O_BINARY", 0), 0o600)
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(contents)
        os.replace(temporary, path)
    except OSError as error:
        os.unlink(temporary)
        raise OSError(error.errno, error.strerror, path) from error


def _pack(records: Mapping[str, bytes]) -> bytes:
    """Return the contents of a cache file: a header line, an index and the records.

    The index has the name, the size and the checksum of each record.
    """
    index = "".join(f"{name} {len(data)} {zlib.crc32(data):08x}\n" for name, data in records.items()).encode("ascii")
    return b"".join([b"%s %d %08x\n" % (_MAGIC, len(index), zlib.crc32(index)), index, *records.values()])


def _unpack(contents: bytes, wanted: Callable[[str], bool]) -> dict[str, bytes]:
    try:
        head = contents[:100].partition(b"\n")[0]
        magic, size, checksum = head.rsplit(b" ", 2)
        start = len(head) + 1
        end = start + int(size)
        index = contents[start:end]
        if magic != _MAGIC or end > len(contents) or zlib.crc32(index) != int(checksum, 16):
            raise DamagedError("not a cache file, or damaged")
        result = {}
        for line in index.decode("ascii").splitlines():
            name, length, checksum_of_record = line.split(" ")
            start, end = end, end + int(length)
            if wanted(name):
                record = contents[start:end]
                if end > len(contents) or zlib.crc32(record) != int(checksum_of_record, 16):
                    raise DamagedError("damaged")
                result[name] = record
    except ValueError as error:  # also DamagedError
        raise DamagedError(str(error) if isinstance(error, DamagedError) else "not a cache file, or damaged") from error
    return result
