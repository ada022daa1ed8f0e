"""
## What it finds

Two nodes that have the same full name when a launch file is launched without arguments, in the file itself or by way of
what it includes.

## Why it matters

ROS 2 starts both, with a warning. Parameters, lifecycle and logging go by the name, so `ros2 param set /driver ...` and a
lifecycle manager reach one of the two, and nobody knows which.

## How to fix it

Give one of them another name, or put it into a namespace of its own.

## When it keeps silent

- A name or a namespace is not given by the launch file, or not known.
- One of the two starts only under a condition that does not hold, or that nobody knows; or later, when a timer or an
  event comes.
- Programs that end once they have done their work, such as those that spawn models and controllers.
- Launch files of tests and examples.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from ros_lint.api import (
    Finding,
    LaunchFile,
    Package,
    Related,
    Rule,
    Severity,
    Span,
    Workspace,
    defaults_of,
    everything,
    filled,
    is_plain,
    launchable,
    launched,
)

if TYPE_CHECKING:
    from ros_lint.api import Started

_SHORT = frozenset({"spawner", "spawner.py", "unspawner", "spawn_entity.py", "create", "load_controller"})
"""Executables that do one thing and end."""

_RENAMES = ("__node:=", "__name:=", "__ns:=")
_DEEPEST = 20


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    for launch in launchable(package):
        if _may_repeat(launch.file, workspace):
            yield from _in_file(launch.file, workspace)


def _may_repeat(file: LaunchFile, workspace: Workspace) -> bool:
    """Whether a name stands twice in a file or what it includes, whatever the conditions. To follow it costs more."""
    seen: set[str] = set()
    for name in _names(file, workspace, 0):
        if name in seen:
            return True
        seen.add(name)
    return False


def _names(file: LaunchFile, workspace: Workspace, depth: int) -> Iterator[str]:
    defaults = defaults_of(file)
    for action in everything(file.actions):
        if action.kind in ("node", "component"):
            yield from filled(action.name, defaults)
        elif action.kind == "include" and depth < _DEEPEST:
            inner = workspace.links.target(action.target, file)
            if inner is not None:
                yield from _names(inner.file, workspace, depth + 1)


def _in_file(file: LaunchFile, workspace: Workspace) -> Iterator[Finding]:
    first: dict[str, tuple[Started, Started]] = {}
    again: dict[Span, list[tuple[str, Started, Started, Started]]] = {}
    include: Started | None = None
    for started in launched(file, workspace, follow=True).started:
        if started.kind == "include" and started.depth == 0:
            include = started
        here = started if started.depth == 0 else include
        name = _full_name(started)
        if not name or here is None:
            continue
        other, top = first.setdefault(name, (started, here))
        # Two of one include are told where that is launched by itself.
        if other is not started and not (top is here and started.depth):
            again.setdefault(here.span, []).append((name, started, other, here))
    for (name, started, other, here), *more in again.values():
        yield _finding(name, started, other, here, len(more))


def _finding(name: str, started: Started, other: Started, here: Started, more: int) -> Finding:
    what = f"{started.package[0]} {started.target[0]}" if started.package else started.target[0]
    related = [Related("the other node", other.span)] if other.span != started.span else []
    if here is started:
        return Finding(
            f"{what} is the second node called {name}: give it another name or namespace", here.span, name, tuple(related)
        )
    others = f", and {more} more that are there twice" if more else ""
    return Finding(
        f"what this includes starts {what} as the second node called {name}{others}",
        here.span,
        name,
        (Related("the node", started.span), *related),
    )


def _full_name(started: Started) -> str:
    """Return the full name of a node that surely starts, at once and for long; "" when it is not known."""
    if started.kind not in ("node", "component") or not started.certain or started.later:
        return ""
    if len(started.name) != 1 or len(started.namespace) != 1 or len(started.target) != 1:
        return ""
    name, namespace = started.name[0], started.namespace[0]
    if not name or not is_plain(name) or not is_plain(namespace) or started.target[0] in _SHORT:
        return ""
    if any(mark in text for texts in started.words for text in texts for mark in _RENAMES):
        return ""
    return f"/{namespace.strip('/')}/{name}".replace("//", "/")


RULE = Rule(
    name="launch-duplicate-node",
    code="ROS508",
    summary="nodes that are launched together must have different names",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    package=check,
)
