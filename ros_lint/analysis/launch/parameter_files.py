"""Parameter files that launch files of the workspace pass to nodes if launch arguments have their defaults."""

from __future__ import annotations

from collections.abc import Mapping
from posixpath import normpath
from typing import TYPE_CHECKING, NamedTuple

from ros_lint.analysis.launch.includes import assigned_configurations, include_resolver, substitute
from ros_lint.analysis.launch.workspace_files import launch_file, parameter_file, parameter_places
from ros_lint.analysis.memo import cached_by_name, cached_by_workspace
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
        self._workspace = workspace

    def __call__(self, path: str) -> ParameterFile | None:
        """Return the parameter file at a path in an install space or relative to the base folder; None if it is not known."""
        place = installed_place(path)
        if place is None:
            return parameter_file(self._workspace, normpath(path))
        return self.installed(place.package, place.share or "")

    def installed(self, package: str, path: str) -> ParameterFile | None:
        """Return the parameter file at a path below the share folder of a package; None if it is not known.

        If two files are installed to one path, it is unknown which of them is used.
        """
        named = self._workspace.by_name.get(package, ())
        found = {source for owner in named for source in parameter_places(owner, self._workspace).sources.get(path, ())}
        return parameter_file(self._workspace, found.pop()) if len(found) == 1 else None


@cached_by_workspace
def parameter_contents(workspace: Workspace) -> ParameterContents:
    """Return the :class:`ParameterContents` of a workspace."""
    return ParameterContents(workspace)


def given_parameter_files(file: LaunchFile, workspace: Workspace) -> tuple[NodeParameterFile, ...]:
    """Return the parameter files of the workspace that a launch file of the workspace passes to nodes.

    Parameter files with an unknown path are left out.
    """
    return _given(workspace, file.path)


@cached_by_name
def _given(workspace: Workspace, path: str) -> tuple[NodeParameterFile, ...]:
    file, links, contents = launch_file(workspace, path), include_resolver(workspace), parameter_contents(workspace)
    defaults: Mapping[str, tuple[str, ...]] | None = None
    result: list[NodeParameterFile] = []
    for action in walk_actions(file.actions) if file is not None else ():
        for name, value in action.parameters if action.kind in ("node", "component") else ():
            if name or file is None:
                continue
            if defaults is None:
                defaults = assigned_configurations(file)
            texts = substitute(value, defaults)
            place = links.installed_at(texts[0], file) if len(texts) == 1 else None
            parameters = contents.installed(*place) if place is not None else None
            if parameters is not None:
                names, namespaces = substitute(action.name, defaults), substitute(action.namespace, defaults)
                result.append(NodeParameterFile(action, value, parameters, names, namespaces or ("",)))
    return tuple(result)


def parameter_files_passed_on(file: LaunchFile, workspace: Workspace) -> frozenset[str]:
    """Return the paths of the parameter files that a launch file of the workspace passes to included launch files."""
    return _passed_on(workspace, file.path)


@cached_by_name
def _passed_on(workspace: Workspace, path: str) -> frozenset[str]:
    file, links, contents = launch_file(workspace, path), include_resolver(workspace), parameter_contents(workspace)
    if file is None:
        return frozenset()
    includes = [action for action in walk_actions(file.actions) if action.kind == "include" and action.arguments]
    defaults = assigned_configurations(file) if includes else {}
    values = (substitute(value, defaults) for action in includes for _, value in action.arguments)
    places = (links.installed_at(texts[0], file) for texts in values if len(texts) == 1)
    files = (contents.installed(*place) for place in places if place is not None)
    return frozenset(parameters.path for parameters in files if parameters is not None)
