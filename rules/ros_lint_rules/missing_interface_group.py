"""
## What it finds

A package that generates messages, services or actions but is no member of the group `rosidl_interface_packages`.

## Why it matters

CMake stops, because packages that install interfaces must include
`<member_of_group>rosidl_interface_packages</member_of_group>` in their package.xml.

## How to fix it

Add the tag to `package.xml`, as the fix does. It raises the format to 3 if necessary.

## Limitations

Not reported:

- Interfaces that are not installed, because only the package itself uses them.
- Packages whose CMakeLists.txt is in a subfolder with its own `package.xml`: CMake reads that one.
- Calls with `SKIP_GROUP_MEMBERSHIP_CHECK`.

The confidence is medium for interfaces that are generated under a condition.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import Confidence, Edit, Finding, Fix, Manifest, Package, Rule, Severity, Span, Workspace, build, edits, names


def check(package: Package, _: Workspace) -> Iterator[Finding]:
    generation, manifest = build.interface_generation(package), package.manifest
    if generation is None or manifest is None or not generation.reads_manifest:
        return
    group = names.interfaces.GROUP
    if group not in package.groups and not _skips_check(package, generation.span):
        yield Finding(
            f"{build.GENERATING}() fails without <member_of_group>{group}</member_of_group> in package.xml; add this tag",
            generation.span,
            group,
            (),
            Fix(f"add <member_of_group>{group}</member_of_group>", _join(manifest)),
            Confidence.HIGH if generation.certain else Confidence.MEDIUM,
        )


def _skips_check(package: Package, place: Span) -> bool:
    calls = package.calls(build.GENERATING, anywhere=True)
    return any(call.name_span == place and "SKIP_GROUP_MEMBERSHIP_CHECK" in call.texts for call in calls)


def _join(manifest: Manifest) -> tuple[Edit, ...]:
    changes = (edits.manifest.add(manifest, "member_of_group", names.interfaces.GROUP),)
    return changes if manifest.format >= 3 else (edits.manifest.raise_format(manifest, 3), *changes)


RULE = Rule(
    name="missing-interface-group",
    code="ROS212",
    summary="packages with interfaces are members of rosidl_interface_packages",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
