"""
## What it finds

A `package.xml` without a `<build_type>` that applies, in a folder that is built with ament: its `CMakeLists.txt` calls
`ament_package()`, or there is a `setup.py` and no `CMakeLists.txt`.

## Why it matters

Without a build type colcon assumes a ROS 1 package and builds it as `catkin`. CMake stops because catkin is missing, or the
package is built without its environment hooks.

## How to fix it

Write the build type in `<export>`. The fix does this.

    <export>
      <build_type>ament_cmake</build_type>
    </export>

## Limitations

Not reported:

- Packages that depend on catkin.
- Folders whose files do not show the build type.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import Finding, Fix, Package, Rule, Severity, Workspace, build, dependencies, edits


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    manifest = package.manifest
    if manifest is None or manifest.problems or not package.type.startswith("ros."):
        return
    if dependencies.conditions.build_types(manifest, workspace.target.context) or any(
        d.name == "catkin" for d in manifest.depends
    ):
        return
    needed = _needed(package)
    if not needed:
        return
    present = [export for export in manifest.exports if export.tag == "build_type"]
    what = f"no <build_type> applies to {workspace.target.distro}" if present else "<build_type> is missing"
    fix = None if present else Fix(f"write <build_type>{needed}</build_type>", (edits.manifest.set_build_type(manifest, needed),))
    yield Finding(
        f"{what}, so colcon builds the package with catkin; write <build_type>{needed}</build_type> in <export>",
        present[0].span if present else manifest.name_span,
        "build_type",
        fix=fix,
    )


def _needed(package: Package) -> str:
    """Return the build type that the build scripts of the package need, or "" if that is unclear."""
    if "CMakeLists.txt" in package.files:
        return "ament_cmake" if not set(build.ENDS).isdisjoint(package.built.commands.names) else ""
    return "ament_python" if "setup.py" in package.files else ""


RULE = Rule(
    name="missing-build-type",
    code="ROS107",
    summary="the manifests of ament packages have a build type",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
