"""
## What it finds

Calls of `link_directories()`.

## Why it matters

The command affects every later target. A target may then link a library of the same name from the wrong folder.

## How to fix it

Link targets by name, or libraries by their full path.

## Limitations

The rule is off by default. Calls in conditions, loops and functions are not reported.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import Finding, Package, Rule, Severity, Workspace, build


def check(package: Package, _: Workspace) -> Iterator[Finding]:
    for call in build.unconditional_calls(package, "link_directories"):
        message = "link_directories() affects every later target; link targets by name instead"
        yield Finding(message, call.name_span, package.relative(call.path))


RULE = Rule(
    name="link-directories",
    code="ROS320",
    summary="libraries are linked as targets, not found by link_directories()",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    default=False,
    package=check,
)
