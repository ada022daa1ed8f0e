"""
## What it finds

A package of type `ament_cmake` whose CMakeLists.txt never calls `ament_package()` or `ament_auto_package()`, or contains no
command at all.

## Why it matters

The package builds but cannot be found afterwards: it is missing from the ament index, its `package.xml` is not installed, and
no CMake configuration is written. `ros2 run` reports "Package not found", and dependent packages fail to configure.

## How to fix it

Call `ament_package()` once, as the last command of the top-level CMakeLists.txt. The fix appends it.

## Limitations

Not reported:

- A command or included file that cannot be analysed, or another CMakeLists.txt of the package, may call `ament_package()`.
- The package installs its own CMake configuration, so other packages find it as a plain CMake project.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import ALL_FACETS, Edit, Finding, Fix, Package, Rule, Severity, Workspace, build, files


def check(package: Package, _: Workspace) -> Iterator[Finding]:
    script = package.script
    if package.builds_with != "ament_cmake" or script is None or build.stops_early(script):
        return
    if script.is_empty:
        yield Finding(
            "CMakeLists.txt contains no command, so nothing is built or installed and the package will not be found; write "
            "project(), the targets and ament_package()",
            files.file_start(script.path),
            "ament_package()",
        )
    if "project" not in script.commands.names:
        return
    if any(name in script.commands.names for name in build.ENDS) or any(
        call.name in build.ENDS for call in script.commands.calls
    ):
        return
    if any(opaque.span.path.endswith((".txt", ".cmake")) for opaque in package.hidden(ALL_FACETS)):
        return
    if any(provided.path.rpartition("/")[2] in build.config_names(package.name) for provided in script.products.installs):
        return
    yield Finding(
        "ament_package() is never called, so the installed package will not be found; call it at the end",
        next((call.name_span for call in package.calls("project")), files.file_start(script.path)),
        "ament_package()",
        fix=_fix(package),
    )


def _fix(package: Package) -> Fix | None:
    script = package.script
    calls = [call for call in script.commands.calls if call.path == package.cmake_lists] if script else []
    last = calls[-1] if calls else None
    if last is None or last.blocks:
        return None
    return Fix("call ament_package() at the end", (Edit(last.extent.end(), "\n\nament_package()"),), safe=False)


RULE = Rule(
    name="missing-ament-package",
    code="ROS301",
    summary="packages of type ament_cmake call ament_package()",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
