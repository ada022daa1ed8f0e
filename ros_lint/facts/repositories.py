"""Repositories that a workspace lists but may not contain, in ``.repos`` files or as git submodules."""

from __future__ import annotations

from typing import NamedTuple


class UnclonedRepositories(NamedTuple):
    """The repositories of one list, such as a ``.repos`` file, that are not in the workspace."""

    path: str
    """Path of the file with the list, such as ``deps.repos`` or ``.gitmodules``."""
    names: tuple[str, ...]
    """Folder names of the missing repositories, sorted."""


class ExpectedRepositories(NamedTuple):
    """Repositories that a workspace lists, by folder name. Mostly a repository has a package of the same name."""

    uncloned: frozenset[str] = frozenset()
    """Names of the submodules and listed repositories that are not in the workspace. Their packages do not count as missing.

    For each repository, these are the name of its folder and the name at the end of its URL.
    """
    listed: frozenset[str] = frozenset()
    """Names of the repositories in ``*.repos`` and ``*.rosinstall`` files, fetched or not."""
    lists: tuple[UnclonedRepositories, ...] = ()
    """For each list, the repositories that are not in the workspace."""
    complete: bool = True
    """True if all lists could be read. Otherwise a repository of any name may be missing."""


NOTHING_AWAITED = ExpectedRepositories()
