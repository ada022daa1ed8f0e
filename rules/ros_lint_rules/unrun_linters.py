"""
## What it finds

Linters that are declared and never run: `ament_lint_auto` in `package.xml` while CMake does not call
`ament_lint_auto_find_test_dependencies()`, or linters in `package.xml` that nothing finds. And the call where `ament_lint_auto`
is the only `<test_depend>`: it runs the linters among those, and none is one.

## Why it matters

Everybody believes that the code is checked, and installs the linters, and nothing is checked.

## How to fix it

Call `ament_lint_auto_find_test_dependencies()` in `if(BUILD_TESTING)` after `find_package(ament_lint_auto REQUIRED)`,
or take the linters out of `package.xml`. Where CMake calls linters by their names, such as `ament_cppcheck()`, take out those
that it does not call.

## Limitations

- The script cannot be followed everywhere, or the package is none of `ament_cmake`.
- Another tag than `<test_depend>` declares the linter: then it is there for others, as in a metapackage.
- `rosidl_generate_interfaces()` is given `ADD_LINTER_TESTS`: it runs the linters that `ament_lint_common` brings.
- An option that is off switches the linters on.
- `ament_lint_auto` is the only `<test_depend>`, and CMake finds something that may bring linters.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from ros_lint.api import (
    FINDS_TESTS,
    LINTERS,
    BuildScript,
    Facet,
    Finding,
    Package,
    Rule,
    Severity,
    Workspace,
    called,
    found_names,
)

_AUTO = "ament_lint_auto"
_ALL = "ament_lint_common"
_RUN = "ament_lint_auto_find_test_dependencies"
_MAY_BRING = re.compile("cmake|common|lint|test|tool")
"""Parts of the names of packages that may bring linters when CMake finds them."""
_BRING_NONE = frozenset({_AUTO, "ament_cmake", "ament_cmake_auto", "ament_cmake_python", "ament_cmake_ros"})


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    script = package.script
    if script is None or script.problems or package.builds_with != "ament_cmake" or script.hides(Facet.USES):
        return
    if _checks_what_it_generates(package):
        return
    if FINDS_TESTS.intersection(script.calls):
        yield from _none_to_run(package, script)
        return
    if any(call.blocks.count("if") > call.test for call in called(package, _RUN, anywhere=True)):
        return  # an option switches them on
    declared = [each.depend for each in package.declared if each.name in (_AUTO, _ALL, *LINTERS)]
    for_others = {depend.name for depend in declared if depend.tag != "test_depend"}
    mine = [depend for depend in declared if depend.name not in for_others]
    called_by_name = _called_by_name(package, script)
    found = _found(package, script)
    idle = [depend for depend in mine if depend.name not in found and LINTERS.get(depend.name) not in called_by_name]
    if called_by_name:
        for depend in idle:
            if depend.name != _ALL:  # it brings those that are called
                message = f"{depend.name} is declared, but CMake calls {_list(called_by_name)} instead: remove it"
                yield Finding(message, depend.span, depend.name)
        return
    first = next((depend for depend in mine if depend.name == _AUTO), idle[0] if idle else None)
    if first is not None:
        yield Finding(
            f"{first.name} is declared, but no linter runs: call {_RUN}() in if(BUILD_TESTING), or remove it",
            first.span,
            first.name,
        )


def _none_to_run(package: Package, script: BuildScript) -> Iterator[Finding]:
    """Speak of linters that are called for where there are none."""
    wanted = [each.depend for each in package.declared if each.depend.tag == "test_depend"]
    if _RUN not in script.calls or {depend.name for depend in wanted} != {_AUTO}:
        return
    found = found_names(package, script).union(_looked_for(package)) - _BRING_NONE
    if not any(map(_MAY_BRING.search, found)):
        yield Finding(
            f"{_AUTO} runs the linters among the test dependencies, and package.xml declares none: add "
            f"<test_depend>{_ALL}</test_depend>",
            wanted[0].span,
            _AUTO,
        )


def _checks_what_it_generates(package: Package) -> bool:
    return any("ADD_LINTER_TESTS" in call.texts for call in called(package, "rosidl_generate_interfaces", anywhere=True))


def _called_by_name(package: Package, script: BuildScript) -> list[str]:
    """Return the commands of linters that the CMake files call, if only under a condition."""
    written = {call.name for call in called(package, *LINTERS.values(), anywhere=True)}
    return sorted(written.union(set(LINTERS.values()).intersection(script.calls)))


def _found(package: Package, script: BuildScript) -> set[str]:
    """Return what the CMake files look for, if only under a condition."""
    return _looked_for(package).union(mention.name for mention in script.mentions)


def _looked_for(package: Package) -> set[str]:
    return {call.texts[0] for call in called(package, "find_package", anywhere=True) if call.args}


def _list(commands: list[str]) -> str:
    first, *others = [f"{command}()" for command in commands]
    return f"{first} and {len(others)} more" if len(others) > 1 else " and ".join((first, *others))


RULE = Rule(
    name="unrun-linters",
    code="ROS209",
    summary="linters that are declared must run",
    severity=Severity.INFO,
    since="0.1",
    doc=__doc__,
    package=check,
)
