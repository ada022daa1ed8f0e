"""Several workspaces in one repository, such as ``arm_ws/src`` and ``car_ws/src``. colcon builds each of them separately."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from typing import Protocol, TypeVar

_STEP = r"\d+[-_. ]|(?:chapter|day|exercise|lab|lesson|part|step|tutorial|week)[-_ ]?\d"
_BUILT_SEPARATELY = re.compile(rf"{_STEP}|\w+_ws\Z|extra_packages\Z")
"""Matches the beginnings of the names of folders that are built separately, e.g. ``lesson_2`` and ``arm_ws``.

micro-ROS builds ``extra_packages`` separately for a microcontroller.
"""


class _Located(Protocol):
    @property
    def path(self) -> str: ...


L = TypeVar("L", bound=_Located)


def workspace_of(path: str) -> str:
    """Return the folder of the workspace that contains a package. ``path`` is the path of the package in the repository.

    The workspace is the folder above the first ``src`` (``arm_ws/src/arm`` -> ``arm_ws``), else a folder that is built
    separately, such as ``lesson_2`` of a course, else "".
    """
    top, inside, _ = f"/{path}/".partition("/src/")
    if inside:
        return top.removeprefix("/")
    parts = path.split("/")
    alone = next((at for at, part in enumerate(parts) if _BUILT_SEPARATELY.match(part.lower())), len(parts))
    return "/".join(parts[: alone + 1]) if alone < len(parts) else ""


def hidden_namesakes(packages: Iterable[tuple[str, str]]) -> Mapping[str, frozenset[str]]:
    """Return, for each workspace, the paths of packages in other workspaces that have the name of one of its packages.

    ``packages`` are pairs of a package name and a path. Example: if ``arm_ws/src/driver`` and ``car_ws/src/driver`` exist, the
    result for ``arm_ws`` is ``car_ws/src/driver``. A workspace without such packages is left out.
    """
    places: dict[str, dict[str, list[str]]] = {}
    for name, path in packages:
        places.setdefault(name, {}).setdefault(workspace_of(path), []).append(path)
    hidden: dict[str, set[str]] = {}
    for by_workspace in places.values():
        for workspace in by_workspace if len(by_workspace) > 1 else ():
            others = [path for other, paths in by_workspace.items() if other != workspace for path in paths]
            hidden.setdefault(workspace, set()).update(others)
    return {workspace: frozenset(paths) for workspace, paths in hidden.items()}


def own_first(candidates: Sequence[L], path: str) -> Sequence[L]:
    """Return the candidates in the workspace of the package at ``path``, or all candidates if that workspace contains none."""
    if len(candidates) < 2:
        return candidates
    workspace = workspace_of(path)
    return [candidate for candidate in candidates if workspace_of(candidate.path) == workspace] or candidates
