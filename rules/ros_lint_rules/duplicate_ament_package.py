"""
## What it finds

A second `ament_package()` or `ament_auto_package()` in one CMakeLists.txt. `ament_auto_package()` calls `ament_package()` itself.

## Why it matters

CMake stops at the second call, or the exports between the two calls are lost.

## How to fix it

Keep the last call. The fix removes the others.

## Limitations

Calls in a condition, a loop or a function are not reported.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import Edit, Finding, Fix, Package, Related, Rule, Severity, Workspace, build


def check(package: Package, _: Workspace) -> Iterator[Finding]:
    if package.builds_with != "ament_cmake":
        return
    calls = [call for call in package.calls(*build.ENDS) if not call.blocks]
    for call in calls[1:]:
        earlier = calls[0]
        fix = None
        if earlier.name == call.name and not earlier.args:
            fix = Fix(f"remove the first {earlier.name}()", (Edit(earlier.extent, ""),), safe=False)
        again = "again" if earlier.name == call.name else f"after {earlier.name}()"
        yield Finding(
            f"{call.name}() is called {again}, but only one call is allowed; keep only the last one",
            call.name_span,
            call.name,
            (Related(f"the first call of {earlier.name}()", earlier.name_span),),
            fix,
        )


RULE = Rule(
    name="duplicate-ament-package",
    code="ROS303",
    summary="each package calls ament_package() only once",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
