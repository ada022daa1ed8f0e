"""
## What it finds

Linters that are declared and never run: `ament_lint_auto` in `package.xml` while CMake does not call
`ament_lint_auto_find_test_dependencies()`, or linters in `package.xml` that nothing finds.

## Why it matters

Everybody believes that the code is checked, and installs the linters, and nothing is checked.

## How to fix it

Call `ament_lint_auto_find_test_dependencies()` in `if(BUILD_TESTING)` after `find_package(ament_lint_auto REQUIRED)`,
or take the linters out of `package.xml`.

## When it keeps silent

The script cannot be followed everywhere, or the package is none of `ament_cmake`.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import Facet, Finding, Package, Rule, Severity, Workspace

_AUTO = "ament_lint_auto"
_RUN = "ament_lint_auto_find_test_dependencies"
_FIND = frozenset({_RUN, "ament_auto_find_test_dependencies", "autoware_package"})
_LINTERS = ("ament_lint_common", "ament_cmake_copyright", "ament_cmake_cppcheck", "ament_cmake_cpplint",
            "ament_cmake_flake8", "ament_cmake_lint_cmake", "ament_cmake_pep257", "ament_cmake_uncrustify",
            "ament_cmake_xmllint", "ament_cmake_clang_format", "ament_cmake_clang_tidy", "ament_cmake_mypy",
            "ament_cmake_pycodestyle", "ament_cmake_pyflakes", "ament_cmake_pclint")  # fmt: skip


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    script = package.script
    if script is None or script.problems or package.builds_with != "ament_cmake" or package.hidden(Facet.USES):
        return
    if _FIND.intersection(script.calls):
        return
    named = {mention.name for mention in script.mentions}
    declared = [each.depend for each in package.declared if each.depend.name in (_AUTO, *_LINTERS)]
    idle = [depend for depend in declared if depend.name == _AUTO or depend.name not in named]
    if not idle:
        return
    first = next((depend for depend in idle if depend.name == _AUTO), idle[0])
    yield Finding(
        f"{first.name} is declared, but no linter runs: call {_RUN}() in if(BUILD_TESTING), or remove it",
        first.span,
        first.name,
    )


RULE = Rule(
    name="unrun-linters",
    code="ROS209",
    summary="linters that are declared must run",
    severity=Severity.INFO,
    since="0.1",
    doc=__doc__,
    package=check,
)
