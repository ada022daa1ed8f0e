"""
## What it finds

Parts of ROS 1 in a package that is built by ament: `find_package(catkin)` and `catkin_package()` that always run, and
`<nodelet>` or `<rviz>` in the exports of `package.xml`.

## Why it matters

There is no catkin in ROS 2, so CMake stops at `find_package(catkin REQUIRED)`. The exports do nothing: ROS 2 finds plugins
by what CMake enters into the index, so that the plugin seems to be exported and is not.

## How to fix it

Remove them. Export plugins with `pluginlib_export_plugin_description_file(rviz_common plugins.xml)`; nodelets become
components.

## Limitations

In a condition, as packages for both ROS versions have them, and for `find_package(catkin)` without `REQUIRED`. For the exports
of a package that a build type under a condition has built with catkin: they serve ROS 1.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import EXPORTING_PLUGINS, Finding, Package, Rule, Severity, Workspace, called

_EXPORTS = {
    "nodelet": "nodelets are components in ROS 2",
    "rviz": "pluginlib_export_plugin_description_file(rviz_common ...) exports displays in ROS 2",
}


def check(package: Package, _: Workspace) -> Iterator[Finding]:
    if package.builds_with not in ("ament_cmake", "ament_python") or package.manifest is None:
        return
    for call in called(package, "find_package", "catkin_package"):
        if call.blocks or call.test:
            continue
        if call.name == "catkin_package":
            yield Finding("catkin_package() is of ROS 1; ament_package() takes its place", call.place, call.name)
        elif call.texts[:1] == ("catkin",) and "REQUIRED" in call.texts:
            message = "find_package(catkin) stops CMake, for there is no catkin in ROS 2; find each package by its name"
            yield Finding(message, call.span(0), "catkin")
    exports = package.manifest.exports
    if any(element.tag == "build_type" and element.text == "catkin" for element in exports):
        return
    for element in exports:
        if element.tag in _EXPORTS and not element.get("condition"):
            done = EXPORTING_PLUGINS in package.built.calls
            way = "remove it" if done else _EXPORTS[element.tag]
            yield Finding(
                f"<{element.tag}> in the exports does nothing in ROS 2; {way}",
                element.span,
                element.tag,
                severity=Severity.INFO,
            )


RULE = Rule(
    name="catkin-leftover",
    code="ROS309",
    summary="an ament package should have no parts of catkin",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    package=check,
)
