"""Repositories that a workspace lists but need not contain (``.repos`` files, git submodules)."""

from __future__ import annotations

from typing import NamedTuple


class ExpectedRepositories(NamedTuple):
    """Repositories that may still come to a workspace, by the names of their folders: mostly those of the packages in them."""

    uncloned: frozenset[str] = frozenset()
    """Submodules whose folders are empty. What they have is missing by no mistake: packages, Python modules, libraries."""
    listed: frozenset[str] = frozenset()
    """Those that ``*.repos`` and ``*.rosinstall`` have fetched, which whoever builds the workspace may have done or not."""


NOTHING_AWAITED = ExpectedRepositories()
