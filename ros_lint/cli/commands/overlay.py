"""``ros-lint overlay``: list the packages that exist in several layers (workspace, underlays, release), and the one in use."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from ros_lint.cli.commands.output import document

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from ros_lint.workspace.model import Workspace


class _LayerEntry(NamedTuple):
    """A package in one layer: its folder or distribution, and its version."""

    where: str
    version: str
    layer: str
    colcon_name: str = ""
    """Name under which colcon builds a package of the workspace; "" in other layers."""


def run(workspace: Workspace, form: str = "text") -> tuple[str, str, int]:
    """Return standard output, standard error and the exit code, which is 0. ``form`` is the output format, "text" or "json".

    The package in use is the one in the topmost layer. The layers from the top are the workspace, the underlays in their
    order, and the released packages. Raises KnowledgeError.
    """
    names = {*workspace.by_name, *(name for underlay in workspace.world.underlays for name in underlay.packages)}
    layers = {name: list(_entries(workspace, name)) for name in sorted(names)}
    layers = {name: entries for name, entries in layers.items() if len({entry.layer for entry in entries}) > 1}
    if form == "json":
        return _json(workspace, layers), "", 0
    blocks = ["".join(f"{line}\n" for line in _lines(name, entries)) for name, entries in layers.items()]
    return "\n".join(blocks) or "No package exists in more than one layer.\n", "", 0


def _json(workspace: Workspace, layers: Mapping[str, list[_LayerEntry]]) -> str:
    packages = [
        {
            "name": name,
            "layers": [
                {
                    "layer": entry.layer,
                    "where": entry.where,
                    "version": entry.version,
                    "in_use": entry.layer == entries[0].layer,
                }
                for entry in entries
            ],
        }
        for name, entries in layers.items()
    ]
    return document({"distro": workspace.target.distro, "packages": packages})


def _entries(workspace: Workspace, name: str) -> Iterator[_LayerEntry]:
    for package in workspace.by_name.get(name, ()):
        version = package.manifest.version if package.manifest else ""
        yield _LayerEntry(package.path or ".", version, "workspace", package.colcon_name)
    for number, underlay in enumerate(workspace.world.underlays, 1):
        installed = underlay.packages.get(name)
        if installed is not None:
            version = installed.released.version if installed.released else ""
            yield _LayerEntry(installed.prefix.root, version, f"underlay {number}")
    released = workspace.world.knowledge.index.get(name)
    if released is not None:
        yield _LayerEntry(f"released in {workspace.target.distro}", released.version, "distribution")


def _lines(name: str, entries: list[_LayerEntry]) -> Iterator[str]:
    yield name
    topmost = [entry for entry in entries if entry.layer == entries[0].layer]
    width = max(len(entry.where) for entry in entries)
    version_width = max(len(entry.version or "-") for entry in entries)
    for entry in entries:
        sign = "*" if topmost == [entry] else "?" if entry in topmost else " "
        yield f"  {sign} {entry.where.ljust(width)}  {(entry.version or '-').ljust(version_width)}  {entry.layer}"
    if len(topmost) > len({entry.colcon_name for entry in topmost}):
        yield f"    colcon rejects the workspace, because {len(topmost)} packages are named '{name}'"
