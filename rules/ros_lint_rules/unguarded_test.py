"""
## What it finds

Commands that make tests, and `find_package()` of packages that serve tests only, outside `if(BUILD_TESTING)`, where the
package that brings them is declared as `<test_depend>` only, or not at all: then `undeclared-dependency` names that tag.

## Why it matters

Release builds go without tests: the build farm does not install what is declared for tests, sets `BUILD_TESTING` to off,
and then CMake stops at `find_package()` or at an unknown command.

## How to fix it

Put it between `if(BUILD_TESTING)` and `endif()`.

## Limitations

Where the package is declared for the build as well, or comes along with what is; under any condition that asks for tests; in
functions; where `find_package()` is not `REQUIRED`.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import Finding, Package, Rule, Severity, Workspace, undeclared, unguarded_tests


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    found = unguarded_tests(package)
    lacking = {need.name for need, _ in undeclared(package, workspace)} if found else set()
    for provider, call in found.items():
        if not package.declares(provider) and provider not in lacking:
            continue  # it comes along with what is declared for every build
        what = f"find_package({provider})" if call.name == "find_package" else f"{call.name}()"
        yield Finding(
            f"{what} outside if(BUILD_TESTING), but {provider} is there for tests only; put it inside",
            call.place,
            provider,
        )


RULE = Rule(
    name="unguarded-test",
    code="ROS306",
    summary="tests must be built only when tests are wanted",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    package=check,
)
