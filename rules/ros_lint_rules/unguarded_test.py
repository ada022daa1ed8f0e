"""
## What it finds

Commands that make tests, and `find_package()` of packages that serve tests only, outside `if(BUILD_TESTING)`, where the
package that brings them is declared as `<test_depend>` only.

## Why it matters

Release builds go without tests: the build farm does not install what is declared for tests, sets `BUILD_TESTING` to off,
and then CMake stops at `find_package()` or at an unknown command.

## How to fix it

Put it between `if(BUILD_TESTING)` and `endif()`.

## When it keeps silent

Where the package is declared for the build as well; under any condition that asks for tests; in functions; where
`find_package()` is not `REQUIRED`.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import Call, Finding, Package, Role, Rule, Severity, Workspace, called

_PROVIDERS = {
    "ament_add_gtest": "ament_cmake_gtest",
    "ament_add_gmock": "ament_cmake_gmock",
    "ament_add_pytest_test": "ament_cmake_pytest",
    "ament_add_google_benchmark": "ament_cmake_google_benchmark",
    "add_launch_test": "launch_testing_ament_cmake",
    "add_ros_test": "ros_testing",
}
_FOR_TESTS = frozenset({*_PROVIDERS.values(), "ament_lint_auto", "ament_lint_common", "ament_cmake_ros_isolated"})


def check(package: Package, _: Workspace) -> Iterator[Finding]:
    if package.builds_with != "ament_cmake":
        return
    told: set[str] = set()
    for call in called(package, "find_package", *_PROVIDERS):
        provider = _PROVIDERS.get(call.name) or (call.texts[0] if call.args else "")
        if call.test or call.blocks or provider not in _FOR_TESTS or provider in told or not _stops(call):
            continue
        if package.declares(provider) == Role.TEST:
            told.add(provider)
            what = f"find_package({provider})" if call.name == "find_package" else f"{call.name}()"
            yield Finding(
                f"{what} outside if(BUILD_TESTING), but {provider} is there for tests only; put it inside",
                call.place,
                provider,
            )


def _stops(call: Call) -> bool:
    return call.name != "find_package" or "REQUIRED" in call.texts


RULE = Rule(
    name="unguarded-test",
    code="ROS306",
    summary="tests must be built only when tests are wanted",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    package=check,
)
