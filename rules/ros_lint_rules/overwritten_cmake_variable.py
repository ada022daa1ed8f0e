"""
## What it finds

An unconditional `set()` of `CMAKE_BUILD_TYPE`, `CMAKE_INSTALL_PREFIX` or `CMAKE_PREFIX_PATH`.

## Why it matters

It overrides the command line: `colcon build --cmake-args -DCMAKE_BUILD_TYPE=Debug` has no effect.

## How to fix it

Set the variable only if it is not set: `if(NOT CMAKE_BUILD_TYPE) ... endif()`.

## Limitations

A `set()` that contains the old value of the variable is not reported.
The rule is off by default. Calls in conditions, loops and functions are not reported.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import Finding, Package, Rule, Severity, Workspace, build

_VARIABLES = ("CMAKE_BUILD_TYPE", "CMAKE_INSTALL_PREFIX", "CMAKE_PREFIX_PATH")


def check(package: Package, _: Workspace) -> Iterator[Finding]:
    for call in build.unconditional_calls(package, "set"):
        name, *values = call.texts
        if name in _VARIABLES and not any(name in text for text in values):
            yield Finding(
                f"set({name}) overrides -D{name} of the command line; set it only in if(NOT {name})", call.name_span, name
            )


RULE = Rule(
    name="overwritten-cmake-variable",
    code="ROS318",
    summary="a CMakeLists.txt does not overwrite variables of the command line",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    default=False,
    package=check,
)
