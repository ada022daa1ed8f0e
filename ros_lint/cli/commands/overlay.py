"""``ros-lint overlay``: which layer provides a package that several layers have."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ros_lint.workspace.model import Workspace


class _Place(NamedTuple):
    where: str
    version: str
    layer: str
    colcon_name: str = ""
    """The name by which colcon orders it, for a package of the workspace."""


def run(workspace: Workspace) -> tuple[str, str, int]:
    """Return standard output, standard error and the exit code, which is 0.

    The topmost layer wins: the workspace, then the underlays in their order, then the released packages. Raises
    KnowledgeError.
    """
    lines: list[str] = []
    names = {*workspace.by_name, *(name for underlay in workspace.world.underlays for name in underlay.packages)}
    for name in sorted(names):
        places = list(_places(workspace, name))
        if len({place.layer for place in places}) > 1:
            lines += ["", *_tell(name, places)] if lines else _tell(name, places)
    return "".join(f"{line}\n" for line in lines) or "No package exists in more than one layer.\n", "", 0


def _places(workspace: Workspace, name: str) -> Iterator[_Place]:
    for package in workspace.by_name.get(name, ()):
        version = package.manifest.version if package.manifest else ""
        yield _Place(package.path or ".", version, "workspace", package.colcon_name)
    for number, underlay in enumerate(workspace.world.underlays, 1):
        installed = underlay.packages.get(name)
        if installed is not None:
            version = installed.released.version if installed.released else ""
            yield _Place(installed.prefix.root, version, f"underlay {number}")
    released = workspace.world.knowledge.index.get(name)
    if released is not None:
        yield _Place(f"released in {workspace.target.distro}", released.version, "distribution")


def _tell(name: str, places: list[_Place]) -> Iterator[str]:
    yield name
    same = [place for place in places if place.layer == places[0].layer]
    width = max(len(place.where) for place in places)
    version_width = max(len(place.version or "-") for place in places)
    for place in places:
        sign = "*" if same == [place] else "?" if place in same else " "
        yield f"  {sign} {place.where.ljust(width)}  {(place.version or '-').ljust(version_width)}  {place.layer}"
    if len(same) > len({place.colcon_name for place in same}):
        yield f"    colcon rejects the workspace, because {len(same)} packages are named '{name}'"
