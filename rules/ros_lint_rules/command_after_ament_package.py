"""
## What it finds

Commands after `ament_package()` that must come before it: `ament_export_*()`, `ament_environment_hooks()`,
`rosidl_generate_interfaces()`, `ament_vendor()`, `pluginlib_export_plugin_description_file()`,
`rclcpp_components_register_node()`, `rclcpp_components_register_nodes()`, and `find_package(ament_lint_auto)`.

## Why it matters

`ament_package()` writes the exports of the package to files. Most of these commands stop CMake with an error if they come
later. Components and plugins are missing from the ament index without an error.

## How to fix it

Move `ament_package()` to the end of the file. Plain `install()` commands may follow it.

## Limitations

Not reported:

- Commands, or `ament_package()`, in a condition, a loop or a function, because the order of execution is unknown. Commands in
  `if(BUILD_TESTING)` are reported.
- `find_package(ament_lint_auto)`, if a macro of another package may have found it before.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import Call, Finding, Package, Related, Rule, Severity, Workspace, build

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
_IGNORED = (build.EXPORTING_PLUGINS, *build.REGISTERING)


def check(package: Package, _: Workspace) -> Iterator[Finding]:
    if package.builds_with != "ament_cmake":
        return
    end: Call | None = None
    # A second find_package(ament_lint_auto) has no effect, and macros of other packages may contain the first one.
    plain = any(call.texts[:1] in (("ament_cmake",), ("ament_cmake_auto",)) for call in package.calls("find_package"))
    ends = [call for call in package.calls(*build.ENDS) if not call.blocks]
    for call in package.calls(*build.ENDS, *_STOP, *_IGNORED, "find_package"):
        if call.blocks and (set(call.blocks) != {"if"} or not call.test):
            continue
        if call.name == "find_package" and (end is None or not plain):
            plain = plain and call.texts[:1] != ("ament_lint_auto",)
            continue
        if call.name in build.ENDS:
            if ends[-1:] == [call]:  # duplicate-ament-package reports the earlier ones
                end = call
        elif end is not None and (effect := _effect(call)):
            related = Related(f"{end.name}() is called here", end.name_span)
            yield Finding(
                f"{_quoted(call)} after {end.name}() {effect}; move it before {end.name}()", call.name_span, call.name, (related,)
            )


def _effect(call: Call) -> str:
    if call.name in _IGNORED:
        return "has no effect"
    if call.name != "find_package" or call.texts[:1] == ("ament_lint_auto",):
        return "stops CMake"
    return ""


def _quoted(call: Call) -> str:
    return "find_package(ament_lint_auto)" if call.name == "find_package" else f"{call.name}()"


RULE = Rule(
    name="command-after-ament-package",
    code="ROS302",
    summary="exports come before ament_package()",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    package=check,
)
