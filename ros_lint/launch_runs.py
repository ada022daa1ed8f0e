"""What a launch file of the workspace starts when it is launched without arguments."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ros_lint.collectors.launch_text import share

if TYPE_CHECKING:
    from collections.abc import Callable

    from ros_lint.facts.launch import LaunchFile
    from ros_lint.interpret.launch_expand import Expansion
    from ros_lint.workspace import Workspace


def launched(file: LaunchFile, workspace: Workspace, follow: Callable[[LaunchFile], bool]) -> Expansion:
    """Return what a launch file starts by itself, in brief, with those of the files that it includes that are to be followed."""
    from ros_lint.interpret.launch_expand import expand  # noqa: PLC0415  (most runs need nothing of it)

    place = workspace.links.place(file)
    if place is not None:
        file = file._replace(path=f"{share(place.package.name)}/{place.path}")

    def included(path: str) -> LaunchFile | None:
        found = workspace.links.included(path)
        return found if found is not None and follow(found) else None

    return expand(file, {}, included, workspace.target.distro, brief=True)
