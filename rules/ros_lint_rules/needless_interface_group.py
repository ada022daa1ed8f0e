"""
## What it finds

`<member_of_group>rosidl_interface_packages</member_of_group>` in a package that contains and generates no interfaces.

## Why it matters

Packages that depend on the group of all interface packages, such as `ros1_bridge`, wait for each member of the group.

## How to fix it

Remove the tag, as the fix does.

## Limitations

Not reported:

- Packages whose build scripts cannot be fully evaluated.
- Tags with a condition that is false in some ROS 2 environment.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import Facet, Finding, Fix, Package, Rule, Severity, Workspace, build, dependencies, files, names


def check(package: Package, _: Workspace) -> Iterator[Finding]:
    manifest, script = package.manifest, package.script
    if manifest is None or script is None or script.problems or names.interfaces.GROUP not in package.groups:
        return
    if package.builds_with not in ("ament_cmake", "ament_python") or script.hides(Facet.INTERFACES | Facet.USES):
        return
    generated = script.products.interfaces or any(True for _ in package.calls(build.GENERATING, anywhere=True))
    if generated or any(file.endswith(files.INTERFACES) for file in package.files):
        return
    for depend in manifest.depends:
        if (
            depend.tag == "member_of_group"
            and depend.name == names.interfaces.GROUP
            and dependencies.conditions.always(depend.condition)
        ):
            written = f"<{depend.tag}>{names.interfaces.GROUP}</{depend.tag}>"
            fix = Fix(f"remove {written}", tuple(dependencies.remove_dependency(package, depend)))
            yield Finding(
                f"'{package.name}' generates no interfaces; remove {written}", depend.span, names.interfaces.GROUP, fix=fix
            )


RULE = Rule(
    name="needless-interface-group",
    code="ROS214",
    summary="members of rosidl_interface_packages have interfaces",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
