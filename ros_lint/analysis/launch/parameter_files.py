"""Parameter files that launch files of the workspace pass to nodes if launch arguments have their defaults."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from posixpath import normpath
from typing import TYPE_CHECKING, NamedTuple

from ros_lint.analysis.launch.includes import assigned_configurations, include_resolver, installed_below_share, substitute
from ros_lint.analysis.memo import cached_by_workspace
from ros_lint.collectors.symbolic_text import installed_place
from ros_lint.facts.launch import walk_actions

if TYPE_CHECKING:
    from ros_lint.facts.launch import LaunchAction, LaunchFile, LaunchValue
    from ros_lint.facts.sources import ParameterFile
    from ros_lint.workspace.model import Workspace


class NodeParameterFile(NamedTuple):
    """A parameter file of the workspace that a launch file passes to a node or component."""

    action: LaunchAction
    """The action that starts the node or component."""
    value: LaunchValue
    """The value in the launch file that is the path of the parameter file."""
    file: ParameterFile
    """The parameter file."""
    names: tuple[str, ...]
    """The possible names of the node; () if the launch file does not set a name."""
    namespaces: tuple[str, ...]
    """The possible namespaces that the action itself sets; ("",) if it sets none."""


class ParameterContents:
    """Finds the parameter files of the workspace by the paths in launch files."""

    def __init__(self, workspace: Workspace) -> None:
        self._by_source: dict[str, ParameterFile] = {}
        self._by_place: dict[tuple[str, str], ParameterFile | None] = {}
        for package in workspace.packages:
            self._by_source.update({file.path: file for file in package.parameter_files})
            for file, path in installed_below_share(package, package.parameter_files):
                key = (package.name, path)
                # If two files are installed to one path, it is unknown which of them is used.
                self._by_place[key] = None if self._by_place.get(key, file) is not file else file

    def __call__(self, path: str) -> ParameterFile | None:
        """Return the parameter file at a path in an install space or relative to the base folder; None if it is not known."""
        place = installed_place(path)
        if place is None:
            return self._by_source.get(normpath(path))
        return self.installed(place.package, place.share or "")

    def installed(self, package: str, path: str) -> ParameterFile | None:
        """Return the parameter file at a path below the share folder of a package; None if it is not known."""
        return self._by_place.get((package, path))


@cached_by_workspace
def parameter_contents(workspace: Workspace) -> ParameterContents:
    """Return the :class:`ParameterContents` of a workspace."""
    return ParameterContents(workspace)


class ParameterFiles:
    """Finds the parameter files of the workspace that launch files pass to nodes."""

    def __init__(self, workspace: Workspace) -> None:
        self._links = include_resolver(workspace)
        self._contents = parameter_contents(workspace)

    def given(self, file: LaunchFile) -> Iterator[NodeParameterFile]:
        """Yield the parameter files of the workspace that a launch file passes to nodes.

        Parameter files with an unknown path are left out.
        """
        defaults: Mapping[str, tuple[str, ...]] | None = None
        for action in walk_actions(file.actions):
            for name, value in action.parameters if action.kind in ("node", "component") else ():
                if name:
                    continue
                if defaults is None:
                    defaults = assigned_configurations(file)
                texts = substitute(value, defaults)
                place = self._links.installed_at(texts[0], file) if len(texts) == 1 else None
                parameters = self._contents.installed(*place) if place is not None else None
                if parameters is not None:
                    names, namespaces = substitute(action.name, defaults), substitute(action.namespace, defaults)
                    yield NodeParameterFile(action, value, parameters, names, namespaces or ("",))
