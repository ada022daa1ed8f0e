"""
## What it finds

A dependency that was released only for ROS 1 or for ROS 2 distributions that reached their end of life: `roscpp`,
`message_generation`, `tf`, `move_base` ...

## Why it matters

The package is not completely ported. `rosdep install` fails at the name, for everybody who installs the package.

## How to fix it

- Depend on the successor in ROS 2, which the message names if it is known. The fix writes the successor if the package already
  uses it.
- Remove the dependency if the message says so, because the successor is declared already, nothing uses the dependency or its
  successor, or no interfaces are generated.
- If a Python module of that name is imported, such as `serial`, declare the rosdep key of the module, which the message names.
- In a package for ROS 1 and ROS 2, write `condition="$ROS_VERSION == 1"` into the tag.

## Limitations

Not reported:

- Packages with the build type catkin, because they belong to ROS 1.
- Tags under a condition such as `condition="$ROS_VERSION == 1"`.

Without a known successor the confidence is medium, because others may have ported the package without a release.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from ros_lint.api import Confidence, Edit, Facet, Finding, Fix, Package, Role, Rule, Severity, Workspace, dependencies


def check(workspace: Workspace) -> Iterator[Finding]:
    world = workspace.world
    for name, packages in dependencies.declared_names(workspace).items():
        if world.resolution(name) != "end-of-life":
            continue
        known_successor = world.successor(name)
        last = world.knowledge.names.end_of_life(name)[0]
        for unresolved_dependency in dependencies.unresolved(name, packages):
            successor = known_successor or _imported(unresolved_dependency, workspace)
            unused = not unresolved_dependency.matching_uses and _is_unused(unresolved_dependency.package, name, successor)
            remedy = _remedy(unresolved_dependency.package, successor, unused=unused)
            yield Finding(
                f"'{name}' was last released for {last} (as of {world.knowledge.date}); {remedy}",
                unresolved_dependency.declared.depend.name_span,
                name,
                fix=_fix(unresolved_dependency, successor, workspace),
                confidence=Confidence.HIGH if successor else Confidence.MEDIUM,
                package=unresolved_dependency.package.name,
                explains=dependencies.wrong_name_explains(name, successor),
            )


def _fix(dependency: dependencies.UnresolvedDependency, successor: str, workspace: Workspace) -> Fix | None:
    """Return the fix that declares the successor in place of a dependency.

    None if the package declares the successor already, or does not use it.
    """
    package = dependency.package
    if package.declares(successor) or not any(successor in use.providers for use in package.uses):
        return None
    edits = [Edit(tag.name_span, successor) for tag in dependency.tags]
    return dependencies.naming_fix(workspace, successor, f"write '{successor}' instead of '{dependency.name}'", *edits)


def _imported(unresolved_dependency: dependencies.UnresolvedDependency, workspace: Workspace) -> str:
    """Return the rosdep key of an imported Python module with the name of the dependency: ``python3-serial`` for ``serial``.

    The result is "" if no such module is imported, or the dependency is used in other ways, too.
    """
    uses = [use for use in unresolved_dependency.matching_uses if use.package != unresolved_dependency.name]
    if not unresolved_dependency.runs_python or not uses or any(use.via != "import" for use in uses):
        return ""
    return uses[0].package if workspace.world.is_key(uses[0].package) else ""


def _is_unused(package: Package, name: str, successor: str) -> bool:
    """Return whether a fully analysed package uses neither the package ``name`` nor its ``successor``."""
    if not package.declares(name) & Role.BUILD or not dependencies.is_fully_visible(package) or name in package.textual_mentions:
        return False
    return not any(successor in use.providers for use in package.uses)


def _remedy(package: Package, successor: str, *, unused: bool) -> str:
    if package.manifest is not None and any(_OF_ROS_1.search(depend.condition) for depend in package.manifest.depends):
        return 'write condition="$ROS_VERSION == 1" into the tag, as other tags here have'
    if unused and not (successor and package.declares(successor)) and not successor.startswith(_FOR_INTERFACES):
        return "remove it, because nothing here uses it"
    if not successor:
        return "replace it, or add its sources to the workspace"
    if package.declares(successor):
        return f"remove it, because '{successor}' is declared, too"
    if successor.startswith(_FOR_INTERFACES) and not _has_interfaces(package):
        return "remove it, because no interfaces are generated here"
    python = successor.startswith("rclcpp") and package.builds_with == "ament_python"
    return f"use '{'rclpy' if python else successor}'"


_OF_ROS_1 = re.compile(r"\$ROS_VERSION\s*==\s*[\"']?1\b")
"""Pattern of a condition that holds only in ROS 1, as a package for ROS 1 and ROS 2 has it: ``$ROS_VERSION == 1``."""
_FOR_INTERFACES = "rosidl_default_"


def _has_interfaces(package: Package) -> bool:
    """Return whether the package generates interfaces, may generate interfaces, or has interface files."""
    script = package.script
    if script is None or script.products.interfaces or package.hidden(Facet.INTERFACES):
        return True
    return any(file.endswith((".msg", ".srv", ".action", ".idl")) for file in package.files)


RULE = Rule(
    name="end-of-life-dependency",
    code="ROS116",
    summary="dependencies exist in a supported distribution",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    fixable=True,
    workspace=check,
)
