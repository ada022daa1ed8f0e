"""Paths of a workspace: POSIX strings relative to a base folder."""

from __future__ import annotations

import os
import posixpath
from collections.abc import Iterator


def join(directory: str, name: str) -> str:
    """Return the path of a name in a directory."""
    return f"{directory}/{name}" if directory else name


def resolve(directory: str, path: str) -> str:
    """Return the path that a relative one, which may lead upwards, means from a directory."""
    return posixpath.normpath(join(directory, path))


def relative(directory: str, path: str) -> str:
    """Return the relative path, which may lead upwards, by which a directory means a path: the reverse of :func:`resolve`."""
    return posixpath.relpath(f"/{path}", f"/{directory}")


def is_outside(path: str) -> bool:
    """Return whether a relative path leads out of the directory that it is relative to."""
    return path == ".." or path.startswith("../")


def strip_folder(directory: str, path: str) -> str:
    """Return a path as it is in a directory that it lies in: the reverse of :func:`join`. Others stay as they are."""
    return path.removeprefix(f"{directory}/") if directory else path


def parent(path: str) -> str:
    """Return the directory that a path lies in."""
    return path.rpartition("/")[0]


def is_below(path: str, folder: str) -> bool:
    """Return whether a path is that of a directory, or of something that lies in it. The empty one holds everything."""
    return path == folder or path.startswith(f"{folder.rstrip('/')}/" if folder else "")


def folders_of(path: str) -> Iterator[str]:
    """Yield the directories that a path lies in, innermost first; not the base, in which everything lies."""
    while path := parent(path):
        yield path


def upwards(folder: str) -> Iterator[str]:
    """Yield a folder of the machine and those that it lies in, innermost first."""
    while True:
        yield folder
        above = os.path.dirname(folder)
        if above == folder:
            return
        folder = above
