"""
## What it finds

Two nodes that have the same full name when a launch file is launched without arguments, in the file itself or by way of
what it includes.

## Why it matters

ROS 2 starts both, with a warning. Parameters, lifecycle and logging go by the name, so `ros2 param set /driver ...` and a
lifecycle manager reach one of the two, and nobody knows which.

## How to fix it

Give one of them another name, or put it into a namespace of its own.

## Limitations

- A name or a namespace is not given by the launch file, or not known.
- One of the two starts only under a condition that does not hold, or that nobody knows; or later, when a timer or an
  event comes.
- Programs that end once they have done their work, such as those that spawn models and controllers.
- Launch files of tests and examples.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from ros_lint.api import (
    Finding,
    LaunchCondition,
    LaunchFile,
    Related,
    Rule,
    Severity,
    Span,
    Workspace,
    agree,
    defaults_of,
    filled,
    is_plain,
    launchable,
    launched,
    renames,
)

if TYPE_CHECKING:
    from ros_lint.api import Started

_SHORT = frozenset({"spawner", "spawner.py", "unspawner", "spawn_entity.py", "create", "load_controller"})
"""Executables that do one thing and end."""

Conditions = tuple[LaunchCondition, ...]


def check(workspace: Workspace) -> Iterator[Finding]:
    names = _Names(workspace)
    for package in workspace.packages:
        for launch in launchable(package):
            for finding in _of(launch.file, names, workspace):
                yield finding._replace(package=package.name)


def _of(file: LaunchFile, names: _Names, workspace: Workspace) -> Iterator[Finding]:
    repeated = names.repeated(file)
    if repeated:
        yield from _in_file(launched(file, workspace, lambda inner: not repeated.isdisjoint(names.of(inner))).started)


class _Names:
    """What nodes may be called, whatever the conditions: to follow launch files through their includes costs more."""

    def __init__(self, workspace: Workspace) -> None:
        self._links = workspace.links
        self._known: dict[str, frozenset[str]] = {}

    def repeated(self, file: LaunchFile) -> set[str]:
        """Return the names that stand twice: in a file, in two files that it includes, or in the file and an included one.

        What starts later, or under conditions that exclude each other, does not count.
        """
        seen: dict[str, list[Conditions]] = {}
        found: set[str] = set()
        for names, conditions in self._parts(file, (), ()):
            for name in names - found:
                others = seen.setdefault(name, [])
                if any(agree((*conditions, *theirs)) for theirs in others):
                    found.add(name)
                others.append(conditions)
        return found

    def of(self, file: LaunchFile) -> frozenset[str]:
        """Return the names of nodes in a file and all that it includes."""
        return self._all(file, ())

    def _parts(
        self, file: LaunchFile, above: tuple[str, ...], conditions: Conditions
    ) -> Iterator[tuple[frozenset[str], Conditions]]:
        defaults = defaults_of(file)
        waiting = [(action, conditions) for action in file.actions]
        while waiting:
            action, outer = waiting.pop()
            inner = (*outer, *action.conditions)
            if action.kind in ("node", "component"):
                yield frozenset(filled(action.name, defaults)), inner
            elif action.kind == "include":
                target = self._links.target(action.target, file)
                if target is not None and target.file.path not in above:
                    yield self._all(target.file, (*above, file.path)), inner
            if action.kind != "later":
                waiting += [(child, inner) for child in action.children]

    def _all(self, file: LaunchFile, above: tuple[str, ...]) -> frozenset[str]:
        known = self._known.get(file.path)
        if known is None:
            known = frozenset().union(*(names for names, _ in self._parts(file, above, ())))
            self._known[file.path] = known
        return known


def _in_file(everything: Sequence[Started]) -> Iterator[Finding]:
    first: dict[str, tuple[Started, Started]] = {}
    again: dict[Span, list[tuple[str, Started, Started, Started]]] = {}
    include: Started | None = None
    for started in everything:
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
    what = f"{started.target[0]} of {started.package[0]}" if started.package else started.target[0]
    related = [Related("the other node", other.span)] if other.span != started.span else []
    if here is started:
        return Finding(
            f"{what} is the second node called {name}: give it another name or namespace", here.span, name, tuple(related)
        )
    others = f"; {more} more {'is' if more == 1 else 'are'} there twice, too" if more else ""
    return Finding(
        f"what is included here starts {what}, the second node called {name}{others}",
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
    if any(renames(text) for texts in started.words for text in texts):
        return ""
    return f"/{namespace.strip('/')}/{name}".replace("//", "/")


RULE = Rule(
    name="launch-duplicate-node",
    code="ROS508",
    summary="nodes that are launched together must have different names",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    workspace=check,
)
