"""
## What it finds

An include that does not give an argument which the included launch file requires, or that gives one which neither this
file nor any that it includes declares or uses.

## Why it matters

Without a required argument the launch file stops: `Included launch description missing required argument`. An argument
that nobody takes does nothing, silently: it was renamed or removed, and what it used to change has its default again.

## How to fix it

Give the argument, or give it a default where it is declared; correct the name, or take the argument out.

## When it keeps silent

- Which file is included, or which arguments it gets, is not known from the launch files alone.
- A file that is included further down is not in the workspace: it may take the argument.
- Arguments that are declared under a condition or in a group.
- A file asks for arguments by names that it computes.

An argument that nobody takes is an info, since it is also set for what is included later; a warning if it resembles an
argument that is not given.
"""

from __future__ import annotations

import difflib
from collections.abc import Iterator

from ros_lint.api import (
    Finding,
    Launchable,
    LaunchAction,
    LaunchValue,
    Links,
    Related,
    Rule,
    Severity,
    Workspace,
    everything,
    is_plain,
    launchable,
)


def check(workspace: Workspace) -> Iterator[Finding]:
    links = workspace.links
    for package in workspace.packages:
        for launch in launchable(package):
            for action in everything(launch.file.actions):
                if action.kind == "include":
                    for finding in _of_include(action, launch, links):
                        yield finding._replace(package=package.name)


def _of_include(action: LaunchAction, launch: Launchable, links: Links) -> Iterator[Finding]:
    target = links.target(action.target, launch.file)
    given = {name: value for name, value in action.arguments if name}
    if target is None or not all(is_plain(name) for name in given):
        return
    takes = links.takes(target.file)
    file = f"{target.package.name}/{target.path}"
    span = action.target.span if action.target is not None else action.span
    declared = {
        name: one.span
        for one in everything(target.file.actions)
        if one.kind == "argument" and one.target is not None
        for name in one.target.texts
    }
    for name in takes.required:
        if name not in given:
            yield Finding(
                f"{file} requires the argument {name}, which is not given here",
                span,
                f"{file}:{name}",
                (Related("declared here, without default", declared[name]),) if name in declared else (),
                severity=Severity.ERROR,
            )
    left = takes.known - given.keys()
    for name, value in given.items() if takes.complete else ():
        if name not in takes.known:
            yield _useless(file, name, value, left)


def _useless(file: str, name: str, value: LaunchValue, left: frozenset[str]) -> Finding:
    """Return the finding for an argument that nobody takes. One that resembles an argument not given was renamed."""
    near = difflib.get_close_matches(name, left, 1, 0.85)
    return Finding(
        f"{file} takes no argument {name}: it does nothing there{f'; did you mean {near[0]}?' if near else ''}",
        value.span,
        f"{file}:{name}",
        severity=None if near else Severity.INFO,
    )


RULE = Rule(
    name="launch-argument",
    code="ROS507",
    summary="an include must give the arguments that the included file takes",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    workspace=check,
)
