"""The values of an action that can contain a path, and the parts of them that name a file to read."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator

from ros_lint.facts.launch import LaunchAction, LaunchValue

Reads = Callable[[str], str]
"""A function that returns the part of a text that names a file which is read."""
_DISPLAY = re.compile(r"(?:^|\s)(?:-d|--display-config)(?:[\s=]+(\S+)|$)")
"""The option of rviz2 for its display configuration file."""


def _whole(text: str) -> str:
    return text


def _display(text: str) -> str:
    match = _DISPLAY.search(text)
    return (match[1] or "") if match is not None else ""


def values_of(action: LaunchAction) -> Iterable[tuple[LaunchValue, Reads | None]]:
    """Return the values of an action, except its target, that can contain a path, each with its ``Reads``."""
    values: list[tuple[LaunchValue, Reads | None]] = []
    if action.value is not None:
        values.append((action.value, None))
    if action.name is not None:
        values.append((action.name, None))
    if action.namespace is not None:
        values.append((action.namespace, None))
    if action.arguments:
        shows = action.kind == "node" and action.package is not None and action.package.texts == ("rviz2",)
        values += _shown(action.arguments) if shows else [(value, None) for _, value in action.arguments]
    if action.parameters:
        values += [(value, None if name else _whole) for name, value in action.parameters]
    return values


def _shown(arguments: Iterable[tuple[str, LaunchValue]]) -> Iterator[tuple[LaunchValue, Reads | None]]:
    """Yield the arguments of rviz2. The display file is in the argument of its option, or in the next."""
    follows = False
    for name, value in arguments:
        if not name:
            yield value, _whole if follows else _display
            follows = any((match := _DISPLAY.search(text)) and not match[1] for text in value.texts)
        else:
            yield value, None
