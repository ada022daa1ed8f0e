"""Caches for values that rules compute once for each package or workspace."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import TypeVar

from ros_lint.workspace.model import Package, Workspace

T = TypeVar("T")


def cached_by_workspace(function: Callable[[Workspace], T]) -> Callable[[Workspace], T]:
    """Cache the results of a function with a workspace as argument: a decorator for pure functions that several rules call."""

    @wraps(function)
    def cached_function(workspace: Workspace) -> T:
        if function not in workspace.memo:
            workspace.memo[function] = function(workspace)
        memo: T = workspace.memo[function]
        return memo

    return cached_function


def cached_by_package(function: Callable[[Package, Workspace], T]) -> Callable[[Package, Workspace], T]:
    """Cache the results of a function with a package and its workspace as arguments: a decorator for pure functions."""

    @wraps(function)
    def cached_function(package: Package, workspace: Workspace) -> T:
        key = (function, id(package))
        cached = workspace.memo.get(key)
        if cached is None:
            # The package is stored, too, so that its id stays unique.
            cached = workspace.memo[key] = (package, function(package, workspace))
        memo: T = cached[1]
        return memo

    return cached_function
