"""
## What it finds

Commands that create tests, and `find_package()` of packages for tests, outside of `if(BUILD_TESTING)`. The package that
provides the command is declared only as `<test_depend>`, or not at all. In the second case, `undeclared-dependency` proposes
`<test_depend>`.

## Why it matters

Release builds do not build tests: the build farm does not install test dependencies and sets `BUILD_TESTING` to off. Then CMake
stops at `find_package()` or at an unknown command.

## How to fix it

Move the command between `if(BUILD_TESTING)` and `endif()`.

## Limitations

Not reported:

- Packages that are also declared for the build, or that come with a dependency declared for the build.
- Commands under a condition, and commands in functions.
- `find_package()` without `REQUIRED`.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import Finding, Package, Rule, Severity, Workspace, build, dependencies


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    unguarded = build.unguarded_tests(package)
    undeclared_names = {need.name for need, _ in dependencies.undeclared(package, workspace)} if unguarded else set()
    for provider, call in unguarded.items():
        if not package.declares(provider) and provider not in undeclared_names:
            continue  # a dependency that is declared for every build provides it
        command = f"find_package({provider})" if call.name == "find_package" else f"{call.name}()"
        yield Finding(
            f"{command} is outside of if(BUILD_TESTING), but '{provider}' is installed for tests only; move it inside",
            call.name_span,
            provider,
        )


RULE = Rule(
    name="unguarded-test",
    code="ROS306",
    summary="tests are built only if BUILD_TESTING is on",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    package=check,
)
