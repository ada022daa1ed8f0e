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
- An argument that nobody takes is also set for what this file includes later, so the confidence is medium, unless it
  resembles an argument that is not given.
"""

from __future__ import annotations

import difflib
from collections.abc import Iterator, Mapping

from ros_lint.api import (
    Confidence,
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

_MOST_RELATED = 4


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
                name,
                (Related("declared here, without default", declared[name]),) if name in declared else (),
                severity=Severity.ERROR,
            )
    if not takes.complete:
        return
    useless = {name: value for name, value in given.items() if name not in takes.known}
    if useless:
        yield _useless(file, useless, takes.known - given.keys())


def _useless(file: str, given: Mapping[str, LaunchValue], left: frozenset[str]) -> Finding:
    """Return the finding for arguments that nobody takes. What resembles one that is left was renamed."""
    first, *others = given
    near = [found[0] for name in given if (found := difflib.get_close_matches(name, left, 1, 0.85))]
    names = ", ".join(given)
    hint = f"; did you mean {', '.join(near)}?" if near else ""
    return Finding(
        f"{file} takes no argument {names}: it does nothing there{hint}",
        given[first].span,
        first,
        tuple(Related(f"the argument {name}", given[name].span) for name in others[:_MOST_RELATED]),
        confidence=Confidence.HIGH if near else Confidence.MEDIUM,
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
