"""
## What it finds

Habits in a CMakeLists.txt that bite later:

- `cmake_minimum_required()` with a version that CMake 4 has no support for (below 3.5) or will drop (below 3.10);
- `find_package()` without `REQUIRED` or `QUIET`, when nothing asks whether the package was found;
- a package that is found twice in the same way;
- `CMAKE_BUILD_TYPE`, `CMAKE_INSTALL_PREFIX` or `CMAKE_PREFIX_PATH` overwritten without condition;
- `include(FindX)` where `find_package(X)` is meant;
- `link_directories()`.

## Why it matters

CMake 4 is in the platforms of Lyrical and later, and stops at versions below 3.5. A package that is not found is noticed
only when the compiler stops. A variable that is overwritten takes away what the user asked for on the command line:
`colcon build --cmake-args -DCMAKE_BUILD_TYPE=Debug` does nothing.

## How to fix it

Ask for 3.8 or more, write `REQUIRED`, remove the second search, set a variable only if it is not set:
`if(NOT CMAKE_BUILD_TYPE) ... endif()`, and link targets by their names.

## Limitations

In conditions, loops and functions. It is off unless it is asked for.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from ros_lint.api import Call, Finding, Package, Related, Rule, Severity, Workspace, called, relative

_OVERWRITTEN = ("CMAKE_BUILD_TYPE", "CMAKE_INSTALL_PREFIX", "CMAKE_PREFIX_PATH")
_CMAKE_4 = ("lyrical", "rolling")


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    script = package.script
    if script is None or package.builds_with != "ament_cmake":
        return
    first: dict[tuple[str, ...], Call] = {}
    for call in called(package, "cmake_minimum_required", "find_package", "include", "link_directories", "set"):
        if call.blocks or call.test or not call.args:
            continue
        name = call.texts[0]
        match call.name:
            case "cmake_minimum_required":
                yield from _version(call, workspace)
            case "find_package":
                earlier = first.setdefault(call.texts, call)
                if earlier is not call:
                    message = f"{name} is found already; remove one of the two"
                    yield Finding(message, call.place, name, (Related("here", earlier.place),))
                elif not {"REQUIRED", "QUIET"}.intersection(call.texts) and _is_firm(package, call):
                    message = f"find_package({name}) without REQUIRED: CMake goes on when it is not found; write it, or QUIET"
                    yield Finding(message, call.place, name, severity=Severity.INFO)
            case "set" if name in _OVERWRITTEN and not any(name in text for text in call.texts[1:]):
                yield Finding(f"{name} is overwritten; set it only if it is not set", call.place, name)
            case "include" if re.fullmatch(r"Find\w+", name) and name[4:] != "PkgConfig":
                yield Finding(f"include({name}): use find_package({name[4:]})", call.place, name[4:])
            case "link_directories":
                message = "link_directories() reaches every target; link targets by name"
                yield Finding(message, call.place, relative(package, call.path))
            case _:
                pass


def _is_firm(package: Package, call: Call) -> bool:
    """Whether the package is taken for needed: no condition made the search optional."""
    script = package.script
    assert script is not None
    span = call.span(0)
    return any(mention.span == span and not mention.optional for mention in script.mentions)


def _version(call: Call, workspace: Workspace) -> Iterator[Finding]:
    match = next((found for text in call.texts if (found := re.match(r"(\d+)\.(\d+)", text))), None)
    if match is None or "..." in " ".join(call.texts):
        return
    version = (int(match[1]), int(match[2]))
    if version < (3, 5):
        gone = workspace.target.distro in _CMAKE_4
        message = f"CMake 4 has no support for policies of {match[0]}; ask for 3.8 or more"
        yield Finding(message, call.place, match[0], severity=Severity.ERROR if gone else None)
    elif version < (3, 10) and workspace.target.distro in _CMAKE_4:
        message = f"support for policies of {match[0]} is deprecated in CMake 4; ask for 3.10 or more"
        yield Finding(message, call.place, match[0], severity=Severity.INFO)


RULE = Rule(
    name="cmake-hygiene",
    code="ROS310",
    summary="a CMakeLists.txt should leave the build to its user",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    default=False,
    package=check,
)
