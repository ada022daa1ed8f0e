"""
## What it finds

A `<depend>` or `<build_depend>` on a ROS package that nothing in the package uses: no include, no import, no
`find_package`, no interface, no launch file, and its name stands in no other file.

## Why it matters

Every dependency is installed and built before this package, and rebuilds it when it changes. A leftover costs time on
every machine, and tells readers something wrong.

## How to fix it

Remove the tag. The fix does this.

## When it keeps silent

Whenever the dependency might be needed in a way that leaves no trace: test, run-time and tool dependencies, rosdep keys
of the system, tags under a condition, packages whose build scripts cannot be followed everywhere, packages that find
what they declare (`ament_auto_find_build_dependencies`), metapackages, vendor
packages and packages without code, and dependencies that give
CMake macros, plugins or components.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import (
    Facet,
    Finding,
    Fix,
    Package,
    Rule,
    Severity,
    Workspace,
    builds_something,
    remove_dependency,
    works_unseen,
)

_TAGS = ("depend", "build_depend")
_FINDS_ALL = "ament_auto_find_build_dependencies"


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    manifest = package.manifest
    if manifest is None or manifest.problems or not _is_seen_whole(package):
        return
    used = {provider for use in package.uses for provider in use.providers}
    for declared in package.declared:
        depend = declared.depend
        if depend.tag not in _TAGS or depend.condition or depend.name in used or depend.name in package.traces:
            continue
        if works_unseen(package, workspace, depend.name):
            continue
        yield Finding(
            f"{depend.name} is declared, but nothing in the package uses it: remove <{depend.tag}>{depend.name}</{depend.tag}>",
            depend.span,
            depend.name,
            fix=Fix(f"remove <{depend.tag}>{depend.name}</{depend.tag}>", remove_dependency(package, depend)),
        )


def _is_seen_whole(package: Package) -> bool:
    """Whether every use would have been seen (reference, section F3, conditions 5 and 6)."""
    script = package.script
    if script is None or script.problems or package.hidden(Facet.USES):
        return False
    if package.builds_with not in ("ament_cmake", "ament_python") or _FINDS_ALL in script.calls:
        return False
    return builds_something(package)


RULE = Rule(
    name="unused-dependency",
    code="ROS204",
    summary="a package that is declared must be used",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
