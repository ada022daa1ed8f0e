"""
## What it finds

A dependency that is known, but not for the target distribution: a rosdep key without a rule for the distribution's platform, or
a package that is only released for other distributions.

## Why it matters

`rosdep install` stops there, and the build farm rejects the release. On the author's machine the library may be installed by
chance, or from an older Ubuntu.

## How to fix it

- Use the key that replaced it, often `python3-…` for `python-…`.
- Put a condition on the tag if only one distribution needs it.
- Add a rule to rosdistro.
- Add the sources of unreleased packages to the workspace, and name them in a `.repos` file.

## Limitations

- If no distribution was chosen, only keys that resolve on no platform of any supported distribution are reported.
- The platforms are those of the distribution (REP 2000), not the machine on which ros-lint runs.
- The confidence is medium for packages that a `.repos` file or `.gitmodules` may provide.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import Confidence, Finding, Rule, Severity, Workspace, dependencies


def check(workspace: Workspace) -> Iterator[Finding]:
    world = workspace.world
    for name, packages in dependencies.declared_names(workspace).items():
        if world.is_package(name):
            continue
        if world.is_key(name):
            if dependencies.is_unresolvable_key(workspace, name):
                yield from (_key(unresolved, workspace) for unresolved in dependencies.unresolved(name, packages))
        elif workspace.target.explicit and world.resolution(name) == "elsewhere":
            yield from (_package(unresolved, workspace) for unresolved in dependencies.unresolved(name, packages))


def _key(unresolved: dependencies.UnresolvedDependency, workspace: Workspace) -> Finding:
    name, knowledge, distro = unresolved.name, workspace.world.knowledge, workspace.target.distro
    anywhere = knowledge.distros_resolving(name)
    meant = workspace.world.meant(name, python=unresolved.runs_python)
    place = f"{knowledge.platform}, the platform of {distro}" if anywhere else "any Ubuntu that ROS 2 supports"
    remedy = f"use '{meant.name}'" if meant else "use another key, or add a rule to rosdistro"
    if condition := dependencies.condition_for(workspace, name):
        needs = dependencies.condition_format(unresolved.package)
        remedy = f'write <{unresolved.declared.depend.tag} condition="{condition}">{needs}, or use another key'
    return Finding(
        f"rosdep key '{name}' has no rule for {place}; {remedy}",
        unresolved.declared.depend.name_span,
        name,
        package=unresolved.package.name,
        explains=dependencies.wrong_name_explains(name, meant.name if meant else ""),
    )


def _package(unresolved: dependencies.UnresolvedDependency, workspace: Workspace) -> Finding:
    name, world, distro = unresolved.name, workspace.world, workspace.target.distro
    others = ", ".join(world.where_else(name))
    remedy = "add its sources to the workspace, or remove the dependency"
    if condition := dependencies.condition_for(workspace, name):
        needs = dependencies.condition_format(unresolved.package)
        remedy = f'write <{unresolved.declared.depend.tag} condition="{condition}">{needs}, or add its sources to the workspace'
    return Finding(
        f"'{name}' is not released for {distro}, only for {others} (as of {world.knowledge.date}); {remedy}",
        unresolved.declared.depend.name_span,
        name,
        confidence=Confidence.MEDIUM if workspace.source_lists else Confidence.HIGH,
        package=unresolved.package.name,
    )


RULE = Rule(
    name="unresolvable-key",
    code="ROS105",
    summary="declared dependencies resolve for the distribution",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    workspace=check,
)
