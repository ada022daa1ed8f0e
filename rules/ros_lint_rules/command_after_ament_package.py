"""
## What it finds

Commands after `ament_package()` that have to stand before it: `ament_export_*()`, `ament_environment_hooks()`,
`rosidl_generate_interfaces()`, `ament_vendor()`, `pluginlib_export_plugin_description_file()`,
`rclcpp_components_register_node()`, `rclcpp_components_register_nodes()`, and `find_package(ament_lint_auto)`.

## Why it matters

`ament_package()` writes down what the package exports. Most of these commands stop CMake with an error when they come later;
components and plugins are silently left out of the index.

## How to fix it

Move `ament_package()` to the end of the file. Plain `install()` rules may follow it.

## Limitations

Where either command stands in a condition, a loop or a function: then the order in the file is not the order in which
they run. For `find_package(ament_lint_auto)` where a macro of another package may have found it before.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import ENDS, EXPORTING_PLUGINS, REGISTERING, Call, Finding, Package, Related, Rule, Severity, Workspace, called

_STOP = (
    "ament_environment_hooks",
    "ament_export_definitions",
    "ament_export_dependencies",
    "ament_export_include_directories",
    "ament_export_interfaces",
    "ament_export_libraries",
    "ament_export_link_flags",
    "ament_export_targets",
    "ament_vendor",
    "rosidl_generate_interfaces",
)
_LOST = (EXPORTING_PLUGINS, *REGISTERING)


def check(package: Package, _: Workspace) -> Iterator[Finding]:
    if package.builds_with != "ament_cmake":
        return
    end: Call | None = None
    # Elsewhere a macro may have found ament_lint_auto before, and a second search does nothing.
    plain = any(call.texts[:1] in (("ament_cmake",), ("ament_cmake_auto",)) for call in called(package, "find_package"))
    ends = [call for call in called(package, *ENDS) if not call.blocks]
    for call in called(package, *ENDS, *_STOP, *_LOST, "find_package"):
        if call.blocks and (set(call.blocks) != {"if"} or not call.test):
            continue
        if call.name == "find_package" and (end is None or not plain):
            plain = plain and call.texts[:1] != ("ament_lint_auto",)
            continue
        if call.name in ENDS:
            if ends[-1:] == [call]:  # of those before, duplicate-ament-package speaks
                end = call
        elif end is not None and (effect := _effect(call)):
            related = Related("this ends the package", end.place)
            yield Finding(f"{_quoted(call)} after {end.name}() {effect}; move it before", call.place, call.name, (related,))


def _effect(call: Call) -> str:
    if call.name in _LOST:
        return "is lost"
    if call.name != "find_package" or call.texts[:1] == ("ament_lint_auto",):
        return "stops CMake"
    return ""


def _quoted(call: Call) -> str:
    return "find_package(ament_lint_auto)" if call.name == "find_package" else f"{call.name}()"


RULE = Rule(
    name="command-after-ament-package",
    code="ROS302",
    summary="what a package exports must be said before ament_package()",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    package=check,
)
