"""
## What it finds

A `cmake_minimum_required()` with a version that CMake 4 does not support (below 3.5), and for Lyrical and later with one that
CMake 4 has deprecated (below 3.10).

## Why it matters

The platforms of Lyrical and later have CMake 4, which stops at versions below 3.5.

## How to fix it

Require CMake 3.8 or newer, for Lyrical and later CMake 3.10 or newer.

## Limitations

Ranges of versions are not reported.
The rule is off by default. Calls in conditions, loops and functions are not reported.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from ros_lint.api import Finding, Package, Rule, Severity, Workspace, build

_CMAKE_4 = ("lyrical", "rolling")


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    cmake_4 = workspace.target.distro in _CMAKE_4
    for call in build.unconditional_calls(package, "cmake_minimum_required"):
        match = next((number for text in call.texts if (number := re.match(r"([0-9]{1,9})\.([0-9]{1,9})", text))), None)
        if match is None or "..." in " ".join(call.texts):
            continue
        version = (int(match[1]), int(match[2]))
        if version < (3, 5):
            message = f"CMake 4 does not support cmake_minimum_required(VERSION {match[0]}); require 3.8 or newer"
            yield Finding(message, call.name_span, match[0], severity=Severity.ERROR if cmake_4 else None)
        elif version < (3, 10) and cmake_4:
            message = f"cmake_minimum_required(VERSION {match[0]}) is deprecated in CMake 4; require 3.10 or newer"
            yield Finding(message, call.name_span, match[0], severity=Severity.INFO)


RULE = Rule(
    name="old-cmake-version",
    code="ROS315",
    summary="the required version of CMake is one that CMake 4 supports",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    default=False,
    package=check,
)
