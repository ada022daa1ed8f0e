"""
## What it finds

Parts of ROS 1 in an ament package:

- `find_package(catkin REQUIRED)` and `catkin_package()` outside of conditions;
- `<nodelet>` and `<rviz>` in the exports of `package.xml`.

## Why it matters

ROS 2 has no catkin, so CMake stops at `find_package(catkin REQUIRED)`. The exports have no effect, because ROS 2 finds plugins
in the ament index, which CMake writes: the plugin looks exported but is not.

## How to fix it

Remove these parts. Export plugins with `pluginlib_export_plugin_description_file(rviz_common plugins.xml)`. Rewrite nodelets as
components.

## Limitations

Not reported:

- Commands under a condition, as in packages for both ROS versions.
- `find_package(catkin)` without `REQUIRED`.
- Exports under a condition.
- Exports of a package that has the build type catkin under a condition, because the exports serve ROS 1.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import Finding, Package, Rule, Severity, Workspace, build

_EXPORTS = {
    "nodelet": "convert the nodelet to a component",
    "rviz": "export displays with pluginlib_export_plugin_description_file(rviz_common ...)",
}


def check(package: Package, _: Workspace) -> Iterator[Finding]:
    if package.builds_with not in ("ament_cmake", "ament_python") or package.manifest is None:
        return
    for call in package.calls("find_package", "catkin_package"):
        if call.blocks or call.test:
            continue
        if call.name == "catkin_package":
            yield Finding("catkin_package() belongs to ROS 1; use ament_package()", call.name_span, call.name)
        elif call.texts[:1] == ("catkin",) and "REQUIRED" in call.texts:
            message = (
                "find_package(catkin) stops CMake, because ROS 2 has no catkin; call find_package() for each package that you use"
            )
            yield Finding(message, call.span(0), "catkin")
    exports = package.manifest.exports
    if any(element.tag == "build_type" and element.text == "catkin" for element in exports):
        return
    for element in exports:
        if element.tag in _EXPORTS and not element.get("condition"):
            exported = build.EXPORTING_PLUGINS in package.built.commands.names
            remedy = "remove it" if exported else _EXPORTS[element.tag]
            yield Finding(
                f"<{element.tag}> in <export> has no effect in ROS 2; {remedy}",
                element.span,
                element.tag,
                severity=Severity.INFO,
            )


RULE = Rule(
    name="catkin-leftover",
    code="ROS309",
    summary="ament packages contain no parts of catkin",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    package=check,
)
