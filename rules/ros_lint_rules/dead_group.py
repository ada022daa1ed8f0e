"""
## What it finds

A `<group_depend>` on a group without members: no package of the workspace, an underlay or the distribution is in it.

## Why it matters

A group without members adds no dependency, so the packages that should be built before this one are not. Usually the name of
the group is misspelt.

## How to fix it

Correct the name, or add `<member_of_group>` to the packages that belong to the group.

## Limitations

The rule is off by default because members may be in other repositories. Not reported:

- Tags under a condition that cannot be evaluated.
- Distributions without a package index.
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
                f"no package is a member of group '{declared.name}', so this tag adds no dependency; correct the name, or add "
                f"<member_of_group>{declared.name}</member_of_group> to its members",
                declared.depend.name_span,
                declared.name,
            )


RULE = Rule(
    name="dead-group",
    code="ROS118",
    summary="groups that packages depend on have members",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    default=False,
    package=check,
)
