"""Tags that packages of a workspace add to the XML and YAML formats of launch."""

from __future__ import annotations

from ros_lint.analysis.memo import cached_by_workspace
from ros_lint.facts.launch import LaunchAction, LaunchFile, LaunchValue
from ros_lint.workspace.model import Workspace

_GROUP = "launch.frontend.launch_extension"
"""The group of the entry points of packages with further tags (launch/frontend/parser.py)."""


@cached_by_workspace
def adds_tags(workspace: Workspace) -> bool:
    """Return whether a package of the workspace adds tags to the formats. Which tags these are is unknown."""
    return any(entry.group == _GROUP for package in workspace.packages for entry in package.built.products.entry_points)


def with_added_tags(file: LaunchFile, workspace: Workspace) -> LaunchFile:
    """Return a launch file in which unknown tags are actions of unknown effect if a package of the workspace may add them."""
    unknown = [problem for problem in file.problems if problem.kind == "unknown-tag"]
    if not unknown or not adds_tags(workspace):
        return file
    others = [
        LaunchAction("other", problem.span, name=LaunchValue((problem.message.rpartition(" ")[2],), problem.span))
        for problem in unknown
    ]
    problems = tuple([problem for problem in file.problems if problem.kind != "unknown-tag"])
    return file._replace(actions=(*file.actions, *others), problems=problems)
