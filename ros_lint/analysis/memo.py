"""Caches for what rules compute once for each package or workspace."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import TypeVar

from ros_lint.workspace.model import Package, Workspace

T = TypeVar("T")


def cached_by_workspace(function: Callable[[Workspace], T]) -> Callable[[Workspace], T]:
    """Make a pure function of a workspace remember what it says, for several rules ask the same."""

    @wraps(function)
    def remembering(workspace: Workspace) -> T:
        if function not in workspace.memo:
            workspace.memo[function] = function(workspace)
        said: T = workspace.memo[function]
        return said

    return remembering


def cached_by_package(function: Callable[[Package, Workspace], T]) -> Callable[[Package, Workspace], T]:
    """Make a pure function of a package and its workspace remember what it says, for several rules ask the same."""

    @wraps(function)
    def remembering(package: Package, workspace: Workspace) -> T:
        key = (function, id(package))
        found = workspace.memo.get(key)
        if found is None:
            # The package is kept, so that its id goes on meaning it.
            found = workspace.memo[key] = (package, function(package, workspace))
        said: T = found[1]
        return said

    return remembering
