"""
## What it finds

A dependency that only ROS 1 or a ROS 2 distribution at its end of life has released: `roscpp`, `message_generation`,
`tf`, `move_base` ...

## Why it matters

The package was not ported to the end. `rosdep install` stops at the name, and so does everybody who installs the package.

## How to fix it

Depend on what took its place in ROS 2, which the message names where there is one, or drop the dependency: where that is
declared already, where nothing uses either of the two, or nothing is generated that would need it. In a package for ROS 1
and ROS 2 write `condition="$ROS_VERSION == 1"` into the tag. Where a module in Python of that name is imported, such as
`serial`, the rosdep key of the module is meant, and the message names it.

## Limitations

For packages whose build type is catkin: they belong to ROS 1. For tags under a condition such as
`condition="$ROS_VERSION == 1"`. Without a successor that is known the confidence is medium: others may have ported the
package without releasing it.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from ros_lint.api import (
    Confidence,
    Facet,
    Finding,
    Package,
    Role,
    Rule,
    Severity,
    Stranger,
    Workspace,
    declared_names,
    is_seen_whole,
    strangers,
)


def check(workspace: Workspace) -> Iterator[Finding]:
    world = workspace.world
    for name, packages in declared_names(workspace).items():
        if world.standing(name) != "end-of-life":
            continue
        ported = world.successor(name)
        last = world.knowledge.names.end_of_life(name)[0]
        for stranger in strangers(name, packages):
            successor = ported or _imported(stranger, workspace)
            idle = not stranger.called_so and _is_idle(stranger.package, name, successor)
            way_out = _way_out(stranger.package, successor, idle=idle)
            yield Finding(
                f"{name} was last released for {last} (as of {world.knowledge.date}): {way_out}",
                stranger.declared.depend.name_span,
                name,
                confidence=Confidence.HIGH if successor else Confidence.MEDIUM,
                package=stranger.package.name,
            )


def _imported(stranger: Stranger, workspace: Workspace) -> str:
    """Return the rosdep key of the module that is called as what is declared, and which the package imports, or ""."""
    uses = [use for use in stranger.called_so if use.package != stranger.name]
    if not stranger.runs_python or not uses or any(use.via != "import" for use in uses):
        return ""
    return uses[0].package if workspace.world.is_key(uses[0].package) else ""


def _is_idle(package: Package, name: str, successor: str) -> bool:
    """Whether it is seen that nothing in a package uses a name, which it declares to build with, or what took its place."""
    if not package.declares(name) & Role.BUILD or not is_seen_whole(package) or name in package.traces:
        return False
    return not any(successor in use.providers for use in package.uses)


def _way_out(package: Package, successor: str, *, idle: bool) -> str:
    if package.manifest is not None and any(_OF_ROS_1.search(depend.condition) for depend in package.manifest.depends):
        return 'write condition="$ROS_VERSION == 1" into the tag, as in others here'
    if idle and not (successor and package.declares(successor)) and not successor.startswith(_FOR_INTERFACES):
        return "remove it, nothing here uses it"
    if not successor:
        return "replace it, or add its sources to the workspace"
    if package.declares(successor):
        return f"remove it, {successor} is declared, too"
    if successor.startswith(_FOR_INTERFACES) and not _has_interfaces(package):
        return "remove it, no interfaces are generated here"
    python = successor.startswith("rclcpp") and package.builds_with == "ament_python"
    return f"use {'rclpy' if python else successor}"


_OF_ROS_1 = re.compile(r"\$ROS_VERSION\s*==\s*[\"']?1\b")
"""The condition of what a package for ROS 1 and ROS 2 needs in ROS 1."""
_FOR_INTERFACES = "rosidl_default_"


def _has_interfaces(package: Package) -> bool:
    """Whether code is generated from messages, services or actions, or may be one day."""
    script = package.script
    if script is None or script.interfaces or package.hidden(Facet.INTERFACES):
        return True
    return any(file.endswith((".msg", ".srv", ".action", ".idl")) for file in package.files)


RULE = Rule(
    name="end-of-life-dependency",
    code="ROS116",
    summary="a dependency must exist in a distribution that is alive",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    workspace=check,
)
