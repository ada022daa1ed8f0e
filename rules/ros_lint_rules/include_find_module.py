"""
## What it finds

`include(FindX)` instead of `find_package(X)`.

## Why it matters

A find module expects the variables that `find_package()` sets, such as `X_FIND_REQUIRED`. Without them a missing package is not
an error, and a package configuration file of X is ignored.

## How to fix it

Write `find_package(X REQUIRED)`.

## Limitations

`include(FindPkgConfig)` is not reported, because it is only used for its commands.
The rule is off by default. Calls in conditions, loops and functions are not reported.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from ros_lint.api import Finding, Package, Rule, Severity, Workspace, build


def check(package: Package, _: Workspace) -> Iterator[Finding]:
    for call in build.unconditional_calls(package, "include"):
        name = call.texts[0]
        if re.fullmatch(r"Find\w+", name) and name[4:] != "PkgConfig":
            yield Finding(
                f"include({name}) does not stop if '{name[4:]}' is missing; use find_package({name[4:]} REQUIRED)",
                call.name_span,
                name[4:],
            )


RULE = Rule(
    name="include-find-module",
    code="ROS319",
    summary="find modules are used by find_package(), not by include()",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    default=False,
    package=check,
)
