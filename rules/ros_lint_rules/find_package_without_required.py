"""
## What it finds

A `find_package()` without `REQUIRED` or `QUIET`, if no condition checks whether the package was found.

## Why it matters

CMake goes on if the package is missing. The mistake is noticed only when the compiler fails.

## How to fix it

Write `REQUIRED`. If the package is optional, write `QUIET` and check `if(<package>_FOUND)`.

## Limitations

The second of two equal calls is not reported, because `duplicate-find-package` reports it.
The rule is off by default. Calls in conditions, loops and functions are not reported.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import Finding, Package, Rule, Severity, Workspace, build


def check(package: Package, _: Workspace) -> Iterator[Finding]:
    required = {mention.span for mention in package.built.mentions if not mention.optional}
    seen: set[tuple[str, ...]] = set()
    for call in build.unconditional_calls(package, "find_package"):
        # A mention is optional if a condition checks whether the package was found.
        if call.texts not in seen and not _WORDS.intersection(call.texts) and call.span(0) in required:
            name = call.texts[0]
            message = f"find_package({name}) has no REQUIRED, so CMake continues if '{name}' is missing; add REQUIRED or QUIET"
            yield Finding(message, call.name_span, name)
        seen.add(call.texts)


_WORDS = frozenset({"REQUIRED", "QUIET"})


RULE = Rule(
    name="find-package-without-required",
    code="ROS316",
    summary="calls of find_package() require the package, or a condition checks the result",
    severity=Severity.INFO,
    since="0.1",
    doc=__doc__,
    default=False,
    package=check,
)
