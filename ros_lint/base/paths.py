"""Functions for paths in a workspace: strings with forward slashes, relative to a base folder."""

from __future__ import annotations

import os
import posixpath
from collections.abc import Iterable, Iterator


def join(directory: str, name: str) -> str:
    """Return the path of ``name`` in ``directory``, e.g. ``a/b/c`` for ``a`` and ``b/c``.

    For ``""``, the base, return ``name``.
    """
    return f"{directory}/{name}" if directory else name


def resolve(directory: str, path: str) -> str:
    """Return the path relative to the base, given ``path`` relative to ``directory``: ``a/b``, ``../c.py`` -> ``a/c.py``.

    The result begins with ``..`` if it is outside the base.
    """
    return posixpath.normpath(join(directory, path))


def relative(directory: str, path: str) -> str:
    """Return ``path`` relative to ``directory``: ``a/b``, ``a/c.py`` -> ``../c.py``. The inverse of :func:`resolve`."""
    return posixpath.relpath(f"/{path}", f"/{directory}")


def is_outside(path: str) -> bool:
    """Return whether a normalized relative path leads out of its base: it is ``..`` or begins with ``../``."""
    return path == ".." or path.startswith("../")


def strip_folder(directory: str, path: str) -> str:
    """Return ``path`` without the leading ``directory``: ``a``, ``a/b/c`` -> ``b/c``. The inverse of :func:`join`.

    A path outside ``directory`` is returned unchanged.
    """
    return path.removeprefix(f"{directory}/") if directory else path


def parent(path: str) -> str:
    """Return the directory that contains a path: ``a/b`` for ``a/b/c``; for ``a``, the base, which is ``""``."""
    return path.rpartition("/")[0]


def is_below(path: str, folder: str) -> bool:
    """Return whether ``path`` is ``folder`` or is inside it. The empty folder contains everything."""
    return path == folder or path.startswith(f"{folder.rstrip('/')}/" if folder else "")


def is_below_any(path: str, folders: Iterable[str]) -> bool:
    """Return whether ``path`` is one of ``folders`` or is inside one of these folders."""
    return any(is_below(path, folder) for folder in folders)


def folders_of(path: str) -> Iterator[str]:
    """Yield the directories that contain a path, without the base, innermost first: ``a/b/c`` -> ``a/b``, ``a``."""
    while path := parent(path):
        yield path


def upwards(folder: str) -> Iterator[str]:
    """Yield an absolute folder and each folder that contains it, innermost first."""
    while True:
        yield folder
        above = os.path.dirname(folder)
        if above == folder:
            return
        folder = above
