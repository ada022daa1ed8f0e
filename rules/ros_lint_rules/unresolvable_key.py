"""
## What it finds

A dependency that is known, but not to the distribution that the workspace is checked for: a rosdep key without a rule for
the distribution's platform, or a package that only other distributions have released.

## Why it matters

`rosdep install` stops there, and the build farm rejects the release. On the machine where the package was written the
library may have been there by chance, or under an older Ubuntu.

## How to fix it

Use the key that took its place, often `python3-…` for `python-…`; put a condition on the tag if it is needed for one
distribution only; or add a rule to rosdistro. What is not released has to come as sources, named in a `.repos` file.

## Limitations

When nobody said which distribution is meant: then only keys that resolve on no platform of any supported distribution are
reported. The platforms are those of the distribution (REP 2000), whatever machine ros-lint runs on. A package that a
`.repos` file or `.gitmodules` may bring has medium confidence.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import Confidence, Finding, Rule, Severity, Stranger, Workspace, declared_names, lacks_rule, strangers


def check(workspace: Workspace) -> Iterator[Finding]:
    world = workspace.world
    for name, packages in declared_names(workspace).items():
        if world.is_package(name):
            continue
        if world.is_key(name):
            if lacks_rule(workspace, name):
                yield from (_key(stranger, workspace) for stranger in strangers(name, packages))
        elif workspace.target.told and world.standing(name) == "elsewhere":
            yield from (_package(stranger, workspace) for stranger in strangers(name, packages))


def _key(stranger: Stranger, workspace: Workspace) -> Finding:
    name, knowledge, distro = stranger.name, workspace.world.knowledge, workspace.target.distro
    anywhere = knowledge.resolving(name)
    meant = workspace.world.meant(name, python=stranger.runs_python)
    place = f"{knowledge.platform}, where {distro} runs" if anywhere else "any Ubuntu that ROS 2 runs on"
    better = f"use {meant.name}" if meant else "use another key, or add a rule to rosdistro"
    return Finding(
        f"rosdep key {name} has no rule for {place}: {better}",
        stranger.declared.depend.name_span,
        name,
        package=stranger.package.name,
    )


def _package(stranger: Stranger, workspace: Workspace) -> Finding:
    name, world, distro = stranger.name, workspace.world, workspace.target.distro
    others = ", ".join(world.where_else(name))
    return Finding(
        f"{name} is not released for {distro}, only for {others} (as of {world.knowledge.date}): "
        "add its sources to the workspace, or do without it",
        stranger.declared.depend.name_span,
        name,
        confidence=Confidence.MEDIUM if workspace.source_lists else Confidence.HIGH,
        package=stranger.package.name,
    )


RULE = Rule(
    name="unresolvable-key",
    code="ROS105",
    summary="a declared name must resolve for the distribution",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    workspace=check,
)
