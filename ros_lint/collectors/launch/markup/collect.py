"""Facts of XML and YAML launch files, which are read as ``launch`` and ``launch_ros`` read them.

The functions follow the ``parse`` methods of ``launch`` and ``launch_ros`` one by one, so that ros-lint rejects a file
exactly if launch rejects it.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Literal

from ros_lint.base.text import Text
from ros_lint.collectors.launch.markup import actions as actions_of_tags
from ros_lint.collectors.launch.markup import nodes as nodes_of_tags
from ros_lint.collectors.launch.markup.attributes import Reader, TagReader
from ros_lint.collectors.launch.markup.entity import Entity, Rejected
from ros_lint.collectors.launch.references import References
from ros_lint.collectors.symbolic_text import UNKNOWN
from ros_lint.facts.launch import LaunchAction, LaunchFile


def launch_file(source: Text, language: Literal["xml", "yaml"], root: Entity) -> LaunchFile:
    """Return the facts of a launch file in XML or YAML. ``root`` is its root element."""
    reader = Reader(source, _TAG_READERS)
    actions: list[LaunchAction] = []
    try:
        if root.tag != "launch":
            raise Rejected("root", "the root must be <launch>", root.span)
        root.get("deprecated")
        children = root.actions()
    except Rejected as error:
        reader.note_rejection(error)
    else:
        actions = reader.actions(children)
    references = References(actions)
    return LaunchFile(
        source.path,
        language,
        references.all(),
        tuple(references.opaque),
        (*reader.problems, *references.problems),
        actions=tuple(actions),
        configurations_read=configurations_read(source.text),
        version_problems=tuple(reader.newer),
    )


_COMMENT = re.compile(r"<!--.*?-->", re.DOTALL)
_VARIABLE = re.compile(r"\$\(var[ ]+[\"']?(\$\(|[^\s()\"']+)")


def configurations_read(text: str) -> tuple[str, ...]:
    """Return the names of the launch configurations that a text reads, sorted: ``$(var a)`` -> ("a",).

    The name UNKNOWN stands for names that are computed at launch.
    """
    if "$(var" not in text:
        return ()
    names = set(_VARIABLE.findall(_COMMENT.sub("", text) if "<!--" in text else text))
    return tuple(sorted(UNKNOWN if name == "$(" else name for name in names))


_TAG_READERS: Mapping[str, TagReader] = {**actions_of_tags.TAG_READERS, **nodes_of_tags.TAG_READERS}
