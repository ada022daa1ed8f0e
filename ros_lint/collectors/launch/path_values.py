"""The values of a launch action that can contain a path, and the part of each value that is a file to be read."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator

from ros_lint.facts.launch import LaunchAction, LaunchValue

FilePart = Callable[[str], str]
"""A function that returns the part of a text that is the path of a file to read, "" if there is none."""
_DISPLAY = re.compile(r"(?:^|\s)(?:-d|--display-config)(?:[\s=]+(\S+)|$)")
"""Pattern of the option of rviz2 with its display configuration file, such as ``-d a.rviz``."""


def _entire_text(text: str) -> str:
    return text


def _display_file(text: str) -> str:
    match = _DISPLAY.search(text)
    return (match[1] or "") if match is not None else ""


def values_of(action: LaunchAction) -> Iterable[tuple[LaunchValue, FilePart | None]]:
    """Return the values of an action that can contain a path, except ``action.target`` (such as the executable of a node).

    Each value is paired with a function that extracts a file path from a text of the value: ``-d a.rviz`` -> ``a.rviz``. It is
    the path of a file that the started program reads. The function is None if the program reads no file in the value.
    """
    values: list[tuple[LaunchValue, FilePart | None]] = []
    if action.value is not None:
        values.append((action.value, None))
    if action.name is not None:
        values.append((action.name, None))
    if action.namespace is not None:
        values.append((action.namespace, None))
    if action.arguments:
        is_rviz = action.kind == "node" and action.package is not None and action.package.texts == ("rviz2",)
        values += _rviz_arguments(action.arguments) if is_rviz else [(value, None) for _, value in action.arguments]
    if action.parameters:
        values += [(value, None if name else _entire_text) for name, value in action.parameters]
    return values


def _rviz_arguments(arguments: Iterable[tuple[str, LaunchValue]]) -> Iterator[tuple[LaunchValue, FilePart | None]]:
    """Yield the arguments of rviz2, each with a function that extracts the display file: ``-d a.rviz`` -> ``a.rviz``.

    If the option ``-d`` is an argument of its own, the file is the next argument. The function is None for values that are
    not arguments of the command line.
    """
    is_display_next = False
    for name, value in arguments:
        if not name:
            yield value, _entire_text if is_display_next else _display_file
            is_display_next = any((match := _DISPLAY.search(text)) and not match[1] for text in value.texts)
        else:
            yield value, None
