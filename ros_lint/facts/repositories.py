"""Repositories that a workspace lists but need not contain (``.repos`` files, git submodules)."""

from __future__ import annotations

from typing import NamedTuple


class UnclonedRepositories(NamedTuple):
    """Repositories of one list that are not in the workspace."""

    path: str
    """Path of the list, such as ``deps.repos`` or ``.gitmodules``."""
    names: tuple[str, ...]
    """Their folder names, sorted."""


class ExpectedRepositories(NamedTuple):
    """Repositories that may be added to a workspace, by folder name. Mostly a package has the same name."""

    uncloned: frozenset[str] = frozenset()
    """Submodules and listed repositories that are not in the workspace: what they may contain counts as not missing.

    The names of their folders, and those at the end of their URLs.
    """
    listed: frozenset[str] = frozenset()
    """Repositories in ``*.repos`` and ``*.rosinstall`` files, which may or may not have been fetched."""
    lists: tuple[UnclonedRepositories, ...] = ()
    """The uncloned repositories of each list."""
    complete: bool = True
    """Whether all lists could be read. Otherwise a repository of any name may be missing."""


NOTHING_AWAITED = ExpectedRepositories()
