"""Paths of a workspace: POSIX strings relative to a base folder."""

from __future__ import annotations

import os
import posixpath
from collections.abc import Iterable, Iterator


def join(directory: str, name: str) -> str:
    """Return the path of a name in a directory."""
    return f"{directory}/{name}" if directory else name


def resolve(directory: str, path: str) -> str:
    """Return a path that is relative to ``directory`` as a path relative to the base. It may begin with ``..``."""
    return posixpath.normpath(join(directory, path))


def relative(directory: str, path: str) -> str:
    """Return ``path`` relative to ``directory``, with ``..`` if necessary: the inverse of :func:`resolve`."""
    return posixpath.relpath(f"/{path}", f"/{directory}")


def is_outside(path: str) -> bool:
    """Return whether a relative path leads out of the directory that it is relative to."""
    return path == ".." or path.startswith("../")


def strip_folder(directory: str, path: str) -> str:
    """Return ``path`` relative to ``directory`` if that contains it, else unchanged. The inverse of :func:`join`."""
    return path.removeprefix(f"{directory}/") if directory else path


def parent(path: str) -> str:
    """Return the directory that contains a path."""
    return path.rpartition("/")[0]


def is_below(path: str, folder: str) -> bool:
    """Return whether ``path`` is ``folder`` or is inside it. The empty folder contains everything."""
    return path == folder or path.startswith(f"{folder.rstrip('/')}/" if folder else "")


def is_below_any(path: str, folders: Iterable[str]) -> bool:
    """Return whether ``path`` is one of the folders or is inside one."""
    return any(is_below(path, folder) for folder in folders)


def folders_of(path: str) -> Iterator[str]:
    """Yield the directories that contain a path, innermost first. The base is left out."""
    while path := parent(path):
        yield path


def upwards(folder: str) -> Iterator[str]:
    """Yield an absolute folder and the folders that contain it, innermost first."""
    while True:
        yield folder
        above = os.path.dirname(folder)
        if above == folder:
            return
        folder = above
