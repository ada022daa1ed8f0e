"""
## What it finds

Risky habits in a CMakeLists.txt:

- `cmake_minimum_required()` with a version that CMake 4 does not support (below 3.5), and for Lyrical and later with one that
  CMake 4 has deprecated (below 3.10);
- `find_package()` without `REQUIRED` or `QUIET`, if no condition checks whether the package was found;
- the same `find_package()` call twice;
- an unconditional `set()` of `CMAKE_BUILD_TYPE`, `CMAKE_INSTALL_PREFIX` or `CMAKE_PREFIX_PATH`;
- `include(FindX)` instead of `find_package(X)`;
- `link_directories()`.

## Why it matters

The platforms of Lyrical and later have CMake 4, which stops at versions below 3.5. Without `REQUIRED`, a missing package is
noticed only when the compiler fails. An unconditional `set()` overrides the command line:
`colcon build --cmake-args -DCMAKE_BUILD_TYPE=Debug` has no effect.

## How to fix it

Require CMake 3.8 or newer. Write `REQUIRED`. Remove the second call. Set a variable only if it is not set:
`if(NOT CMAKE_BUILD_TYPE) ... endif()`. Link targets by name.

## Limitations

- Calls in conditions, loops and functions are not reported.
- The rule is off by default.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from ros_lint.api import Call, Finding, Package, Related, Rule, Severity, Workspace

_OVERWRITTEN = ("CMAKE_BUILD_TYPE", "CMAKE_INSTALL_PREFIX", "CMAKE_PREFIX_PATH")
_CMAKE_4 = ("lyrical", "rolling")


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    script = package.script
    if script is None or package.builds_with != "ament_cmake":
        return
    first: dict[tuple[str, ...], Call] = {}
    for call in package.calls("cmake_minimum_required", "find_package", "include", "link_directories", "set"):
        if call.blocks or call.test or not call.args:
            continue
        name = call.texts[0]
        match call.name:
            case "cmake_minimum_required":
                yield from _version(call, workspace)
            case "find_package":
                earlier = first.setdefault(call.texts, call)
                if earlier is not call:
                    message = f"'{name}' is already found with the same arguments; remove one of the two calls"
                    yield Finding(message, call.name_span, name, (Related("the first call", earlier.name_span),))
                elif not {"REQUIRED", "QUIET"}.intersection(call.texts) and _is_firm(package, call):
                    message = f"find_package({name}) without REQUIRED: CMake goes on if it is missing; add REQUIRED or QUIET"
                    yield Finding(message, call.name_span, name, severity=Severity.INFO)
            case "set" if name in _OVERWRITTEN and not any(name in text for text in call.texts[1:]):
                yield Finding(f"set({name}) overrides the command line; set it only if it is not set", call.name_span, name)
            case "include" if re.fullmatch(r"Find\w+", name) and name[4:] != "PkgConfig":
                yield Finding(f"use find_package({name[4:]}) instead of include({name})", call.name_span, name[4:])
            case "link_directories":
                message = "link_directories() affects every later target; link targets by name instead"
                yield Finding(message, call.name_span, package.relative(call.path))
            case _:
                pass


def _is_firm(package: Package, call: Call) -> bool:
    """Return whether find_package() must succeed: no condition checks whether the package was found."""
    script = package.script
    assert script is not None
    span = call.span(0)
    return any(mention.span == span and not mention.optional for mention in script.mentions)


def _version(call: Call, workspace: Workspace) -> Iterator[Finding]:
    match = next((number for text in call.texts if (number := re.match(r"([0-9]{1,9})\.([0-9]{1,9})", text))), None)
    if match is None or "..." in " ".join(call.texts):
        return
    version = (int(match[1]), int(match[2]))
    if version < (3, 5):
        unsupported = workspace.target.distro in _CMAKE_4
        message = f"CMake 4 does not support cmake_minimum_required(VERSION {match[0]}); require 3.8 or newer"
        yield Finding(message, call.name_span, match[0], severity=Severity.ERROR if unsupported else None)
    elif version < (3, 10) and workspace.target.distro in _CMAKE_4:
        message = f"cmake_minimum_required(VERSION {match[0]}) is deprecated in CMake 4; require 3.10 or newer"
        yield Finding(message, call.name_span, match[0], severity=Severity.INFO)


RULE = Rule(
    name="cmake-hygiene",
    code="ROS310",
    summary="a CMakeLists.txt leaves build settings to the user and avoids risky habits",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    default=False,
    package=check,
)
