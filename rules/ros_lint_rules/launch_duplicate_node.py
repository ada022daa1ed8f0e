"""
## What it finds

Two nodes with the same full name that start when a launch file is launched without arguments. Included launch files count.

## Why it matters

ROS 2 starts both with a warning. Parameters, lifecycle and logging use the node name, so `ros2 param set /driver ...` and
lifecycle managers reach an arbitrary one of the two.

## How to fix it

Rename one of them, or put it into another namespace.

## Limitations

Not reported:

- Nodes whose name or namespace is unknown or not set by the launch file.
- Nodes under a condition that is false or unknown, and nodes that a timer or an event starts later.
- Programs that exit after their work, such as those that spawn models and controllers.
- Launch files of tests and examples.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, NamedTuple

from ros_lint.api import (
    Finding,
    LaunchAction,
    LaunchCondition,
    LaunchFile,
    Package,
    Related,
    Rule,
    Severity,
    Span,
    Workspace,
    cached_by_name,
    launch,
)

if TYPE_CHECKING:
    from ros_lint.api import launch

_SHORT = frozenset({"spawner", "spawner.py", "unspawner", "spawn_entity.py", "create", "load_controller"})
"""Executables that exit after their work, such as spawning a model. Two nodes of the same name then do no harm."""

Conditions = tuple[LaunchCondition, ...]


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    for launch_file in launch.package_launch_files(package):
        yield from _of(launch_file.file, workspace)


def _of(file: LaunchFile, workspace: Workspace) -> Iterator[Finding]:
    repeated = _repeated(file, workspace)
    if repeated:
        yield from _in_file(
            launch.expand_defaults(file, workspace, lambda inner: not repeated.isdisjoint(_all_names(inner, workspace))).started
        )


class _Part(NamedTuple):
    """A part of a launch file that starts nodes: a node with its possible names, or an include."""

    names: frozenset[str]
    included: str
    """Path of the included launch file, "" for a node."""
    conditions: Conditions


def _repeated(file: LaunchFile, workspace: Workspace) -> set[str]:
    """Return the names that two nodes of a launch file and the files it includes may have.

    This is a cheap test before the includes of the file are evaluated. Nodes that a timer or an event starts later do not count,
    and neither do nodes under conditions that exclude each other.
    """
    seen: dict[str, list[Conditions]] = {}
    repeated: set[str] = set()
    for part in _parts(workspace, file.path):
        names = _names_below(workspace, part.included) if part.included else part.names
        for name in names - repeated:
            earlier = seen.setdefault(name, [])
            if any(launch.are_consistent((*part.conditions, *others)) for others in earlier):
                repeated.add(name)
            earlier.append(part.conditions)
    return repeated


def _all_names(file: LaunchFile, workspace: Workspace) -> frozenset[str]:
    """Return the possible names of all nodes in a launch file and the files it includes."""
    return _names_below(workspace, file.path)


@cached_by_name
def _parts(workspace: Workspace, path: str) -> tuple[_Part, ...]:
    file, links = launch.launch_file(workspace, path), launch.include_resolver(workspace)
    result: list[_Part] = []
    defaults = launch.assigned_configurations(file) if file is not None else {}
    waiting: list[tuple[LaunchAction, Conditions]] = [(action, ()) for action in file.actions] if file is not None else []
    while waiting and file is not None:
        action, outer = waiting.pop()
        inner = (*outer, *action.conditions)
        if action.kind in ("node", "component"):
            result.append(_Part(frozenset(launch.substitute(action.name, defaults)), "", inner))
        elif action.kind == "include":
            target = links.target(action.target, file)
            if target is not None and target.file.path != path:
                result.append(_Part(frozenset(), target.file.path, inner))
        if action.kind != "later":
            waiting += [(child, inner) for child in action.children]
    return tuple(result)


@cached_by_name
def _names_below(workspace: Workspace, path: str) -> frozenset[str]:
    """Return the possible names of all nodes in the launch file at ``path`` and the files it includes, at most MOST_RELATED."""
    seen, waiting = {path}, [path]
    names: set[str] = set()
    while waiting and len(seen) <= launch.MOST_RELATED:
        for part in _parts(workspace, waiting.pop()):
            names |= part.names
            if part.included and part.included not in seen:
                seen.add(part.included)
                waiting.append(part.included)
    return frozenset(names)


def _in_file(everything: Sequence[launch.Started]) -> Iterator[Finding]:
    first: dict[str, tuple[launch.Started, launch.Started]] = {}
    again: dict[Span, list[tuple[str, launch.Started, launch.Started, launch.Started]]] = {}
    include: launch.Started | None = None
    for started in everything:
        if started.kind == "include" and started.depth == 0:
            include = started
        here = started if started.depth == 0 else include
        name = _full_name(started)
        if not name or here is None:
            continue
        earlier, origin = first.setdefault(name, (started, here))
        # Two nodes of one include are reported for the included file itself.
        if earlier is not started and not (origin is here and started.depth):
            again.setdefault(here.span, []).append((name, started, earlier, here))
    for (name, started, earlier, here), *more in again.values():
        yield _finding(name, started, earlier, here, len(more))


def _finding(name: str, started: launch.Started, earlier: launch.Started, here: launch.Started, more: int) -> Finding:
    what = f"'{started.target[0]}' of '{started.package[0]}'" if started.package else f"'{started.target[0]}'"
    related = [Related(f"the first node named '{name}'", earlier.span)] if earlier.span != started.span else []
    if here is started:
        return Finding(
            f"{what} is the second node named '{name}', but node names must be unique; give it another name or namespace",
            here.span,
            name,
            tuple(related),
        )
    others = f" ({more} more {'name is' if more == 1 else 'names are'} also used twice)" if more else ""
    return Finding(
        f"the included file starts {what}, the second node named '{name}', but node names must be unique; "
        f"give one of the nodes another name or namespace{others}",
        here.span,
        name,
        (Related(f"the second node named '{name}'", started.span), *related),
    )


def _full_name(started: launch.Started) -> str:
    """Return the full name of a node that certainly starts at once and keeps running; "" for other nodes and unknown names."""
    if started.kind not in ("node", "component") or not started.certain or started.later:
        return ""
    if len(started.name) != 1 or len(started.namespace) != 1 or len(started.target) != 1:
        return ""
    name, namespace = started.name[0], started.namespace[0]
    if not name or not launch.is_plain(name) or not launch.is_plain(namespace) or started.target[0] in _SHORT:
        return ""
    if any(launch.is_node_renaming(text) for texts in started.words for text in texts):
        return ""
    return f"/{namespace.strip('/')}/{name}".replace("//", "/")


RULE = Rule(
    name="launch-duplicate-node",
    code="ROS508",
    summary="nodes that are launched together have different names",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    package=check,
)
