"""
## What it finds

The same `find_package()` call twice.

## Why it matters

The second call has no effect. If one of the calls is changed or removed, the other one remains.

## How to fix it

Remove one of the calls.

## Limitations

Calls with different arguments, such as other components, are not reported.
The rule is off by default. Calls in conditions, loops and functions are not reported.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import Call, Finding, Package, Related, Rule, Severity, Workspace, build


def check(package: Package, _: Workspace) -> Iterator[Finding]:
    first: dict[tuple[str, ...], Call] = {}
    for call in build.unconditional_calls(package, "find_package"):
        earlier = first.setdefault(call.texts, call)
        if earlier is not call:
            message = f"find_package({call.texts[0]}) was already called with the same arguments; remove one of the two calls"
            related = Related(f"the first call of find_package({call.texts[0]})", earlier.name_span)
            yield Finding(message, call.name_span, call.texts[0], (related,))


RULE = Rule(
    name="duplicate-find-package",
    code="ROS317",
    summary="no call of find_package() is repeated",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    default=False,
    package=check,
)
