"""
## What it finds

A `<group_depend>` on a group that no package is a member of: not in the workspace, not in an underlay, not in the
distribution.

## Why it matters

A group without members gives no dependency at all, so the packages that were to be built before this one are not. Mostly
the name of the group is misspelt.

## How to fix it

Correct the name, or add `<member_of_group>` to the packages that belong to it.

## Limitations

It is off by default, since members may be in other repositories. For tags under a condition that cannot be evaluated, and
when there is no index of the distribution.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import Finding, Package, Rule, Severity, Workspace


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    if not workspace.world.knowledge.covered:
        return
    for declared in package.group_depends:
        if declared.certain and not workspace.world.group_members(declared.name):
            yield Finding(
                f"no package is a member of group {declared.name}, so nothing is built first for it: correct the name, or add "
                f"<member_of_group>{declared.name}</member_of_group> to its members",
                declared.depend.name_span,
                declared.name,
            )


RULE = Rule(
    name="dead-group",
    code="ROS118",
    summary="a group that a package depends on must have members",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    default=False,
    package=check,
)
