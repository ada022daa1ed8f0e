"""
## What it finds

A `package.xml` in which no `<build_type>` counts, although the folder is built with ament: its `CMakeLists.txt` calls
`ament_package()`, or there is a `setup.py` and no `CMakeLists.txt`.

## Why it matters

Without a build type colcon takes the package for one of ROS 1 and builds it as `catkin`: CMake stops because it has no
catkin, or the package is built without its environment hooks.

## How to fix it

Write the build type into `<export>`, as the fix does:

    <export>
      <build_type>ament_cmake</build_type>
    </export>

## Limitations

For packages that depend on catkin, and for folders that do not show how they are meant to be built.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import ENDS, Finding, Fix, Package, Rule, Severity, Workspace, conditions, manifest_edits


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    manifest = package.manifest
    if manifest is None or manifest.problems or not package.type.startswith("ros."):
        return
    if conditions.build_types(manifest, workspace.target.context) or any(d.name == "catkin" for d in manifest.depends):
        return
    meant = _meant(package)
    if not meant:
        return
    given = [export for export in manifest.exports if export.tag == "build_type"]
    what = f"no <build_type> counts for {workspace.target.distro}" if given else "there is no <build_type>"
    fix = None if given else Fix(f"write <build_type>{meant}</build_type>", (manifest_edits.set_build_type(manifest, meant),))
    yield Finding(
        f"{what}, which means catkin; write <build_type>{meant}</build_type> into <export>",
        given[0].span if given else manifest.name_span,
        "build_type",
        fix=fix,
    )


def _meant(package: Package) -> str:
    """Return the build type that the scripts of a package need, or "" if that is not clear."""
    if "CMakeLists.txt" in package.files:
        return "ament_cmake" if not set(ENDS).isdisjoint(package.built.calls) else ""
    return "ament_python" if "setup.py" in package.files else ""


RULE = Rule(
    name="missing-build-type",
    code="ROS107",
    summary="a package that is built with ament must say so in its manifest",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
