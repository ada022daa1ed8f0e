"""Caches for values that rules compute once for each package or workspace."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import TypeVar

from ros_lint.workspace.model import Package, Workspace

T = TypeVar("T")

CACHED: dict[str, Callable[..., object]] = {}
"""The decorated functions of the imported modules, by module and name."""

NAMES: dict[object, str] = {}
"""The module and name of each decorated function, by the function without the decorator, which is in the questions."""


def _register(function: Callable[..., object], cached: Callable[..., object]) -> None:
    """Add a decorated function to :data:`CACHED`. A second function with the same name, such as an inner one, has no name."""
    name = f"{function.__module__}:{function.__qualname__}"
    if CACHED.setdefault(name, cached) is cached:
        NAMES[function] = name


def cached_by_workspace(function: Callable[[Workspace], T]) -> Callable[[Workspace], T]:
    """Cache the results of a function with a workspace as argument: a decorator for pure functions that several rules call."""

    @wraps(function)
    def cached_function(workspace: Workspace) -> T:
        return workspace.memo.ask(function, lambda: function(workspace))

    _register(function, cached_function)
    return cached_function


def cached_by_package(function: Callable[[Package, Workspace], T]) -> Callable[[Package, Workspace], T]:
    """Cache the results of a function with a package and its workspace as arguments: a decorator for pure functions."""

    @wraps(function)
    def cached_function(package: Package, workspace: Workspace) -> T:
        # The package is stored, too, so that its id stays unique.
        return workspace.memo.ask((function, id(package)), lambda: (package, function(package, workspace)))[1]

    _register(function, cached_function)
    return cached_function


def cached_by_name(function: Callable[[Workspace, str], T]) -> Callable[[Workspace, str], T]:
    """Cache the results of a function with a workspace and a name as arguments: a decorator for pure functions."""

    @wraps(function)
    def cached_function(workspace: Workspace, name: str) -> T:
        return workspace.memo.ask((function, name), lambda: function(workspace, name))

    _register(function, cached_function)
    return cached_function
