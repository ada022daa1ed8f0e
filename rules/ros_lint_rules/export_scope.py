"""
## What it finds

Calls of `ament_export_dependencies()`, `ament_export_targets()` and the other `ament_export_*()` commands in a function, or in
the `CMakeLists.txt` of a subfolder that `add_subdirectory()` reads.

## Why it matters

These commands set variables, which `ament_package()` writes to the CMake configuration of the package. Variables that are set
in a function or subfolder are lost when CMake leaves the function or subfolder. Packages that find this one get none of these
exports: "fatal error: robot/robot.hpp: No such file or directory", or an unknown target.

## How to fix it

Call the command in the `CMakeLists.txt` of the package, before `ament_package()`. A set of targets can be exported there,
although `install(TARGETS ... EXPORT ...)` is in the subfolder. If no other package uses what the subfolder builds, such as
plugins, remove the call.

If nothing else is exported, findings of `unexported-dependency` and `unexported-headers` for the package are probably
consequences. They are hidden as long as this finding is shown.

## Limitations

Not reported:

- Calls in conditions and for tests only.
- Packages that pass the variables of ament to the scope of `ament_package()` themselves.
- Calls in macros, which run in the scope of their caller, and in files of `include()`.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import Consequence, Finding, Package, Related, Rule, Severity, Workspace, first_related


def check(package: Package, _: Workspace) -> Iterator[Finding]:
    if package.builds_with != "ament_cmake" or not package.built.cmake.lost_exports:
        return
    first, *others = package.built.cmake.lost_exports
    yield Finding(
        f"{first.name}() has no effect here, because ament_package() does not read variables of a function or subfolder; "
        "call it in the top CMakeLists.txt, outside functions",
        first.span,
        first.name,
        first_related(Related(f"{call.name}() has no effect here either", call.span) for call in others),
        explains=() if _exports_elsewhere(package) else (Consequence("unexported-dependency"), Consequence("unexported-headers")),
    )


def _exports_elsewhere(package: Package) -> bool:
    """Return whether the CMakeLists.txt in the package folder has an ament_export_*() call that takes effect."""
    lost = {call.span for call in package.built.cmake.lost_exports}
    calls = (call for call in package.built.commands.calls if call.path == package.cmake_lists)
    return any(call.name.startswith("ament_export_") and call.name_span not in lost for call in calls)


RULE = Rule(
    name="export-scope",
    code="ROS323",
    summary="exports are written in the scope of ament_package()",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    package=check,
)
