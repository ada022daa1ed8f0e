"""Repositories that a workspace lists but need not contain (``.repos`` files, git submodules)."""

from __future__ import annotations

from typing import NamedTuple


class ExpectedRepositories(NamedTuple):
    """Repositories that may be added to a workspace, by folder name, which is mostly also a package name."""

    uncloned: frozenset[str] = frozenset()
    """Submodules whose folders are empty: packages, modules and libraries in them count as not missing."""
    listed: frozenset[str] = frozenset()
    """Repositories in ``*.repos`` and ``*.rosinstall`` files, which may or may not have been fetched."""


NOTHING_AWAITED = ExpectedRepositories()
