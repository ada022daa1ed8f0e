"""Remappings of names that the remapped node does not use."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import TYPE_CHECKING, NamedTuple

from ros_lint.analysis.launch.node_programs import started_program, topics_of
from ros_lint.base.suggestions import similar_names
from ros_lint.facts.launch import walk_actions

if TYPE_CHECKING:
    from ros_lint.facts.launch import LaunchFile, LaunchValue
    from ros_lint.workspace.model import Workspace

_NAME = re.compile(r"(?:~/|/)?(?:\w+/)*\w+", re.ASCII)
_OF_EVERY_NODE = frozenset({
    "change_state", "clock", "describe_parameters", "get_available_states", "get_available_transitions", "get_parameter_types",
    "get_parameters", "get_state", "get_transition_graph", "list_parameters", "parameter_events", "rosout", "set_parameters",
    "set_parameters_atomically", "tf", "tf_static", "transition_event",
})  # fmt: skip
"""The last parts of the names of topics and services that rclcpp, rclpy, rclcpp_lifecycle and tf2_ros create."""


class UnusedRemapping(NamedTuple):
    """A remapping of a name that the code of the node does not contain."""

    value: LaunchValue
    """The old name."""
    target: str
    """The executable or class of the node."""
    meant: str
    """A topic or service of a similar name, "" if there is none."""


def unused_remappings(file: LaunchFile, workspace: Workspace) -> Iterator[UnusedRemapping]:
    """Yield the remappings of a launch file whose old name is no topic, service or action of the node.

    Nothing is yielded for a node whose code is not completely known. Only the last parts of names are compared.
    """
    for action in walk_actions(file.actions):
        program = started_program(action, workspace) if action.remappings and not action.children else None
        topics = topics_of(program.package, workspace) if program is not None else None
        if topics is None or action.target is None:
            continue
        known = {topic.rpartition("/")[2] for topic in topics} | _OF_EVERY_NODE
        for before, _ in action.remappings:
            name = before.texts[0]
            last = name.rpartition("/")[2]
            if len(before.texts) != 1 or not _NAME.fullmatch(name) or last in known or name.startswith("__"):
                continue
            near = similar_names(last, sorted({topic.rpartition("/")[2] for topic in topics}), 1, 0.75)
            yield UnusedRemapping(before, action.target.texts[0], near[0] if near else "")
