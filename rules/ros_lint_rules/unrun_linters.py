"""
## What it finds

Linters that are declared but never run:

- `ament_lint_auto` is in `package.xml`, but CMake does not call `ament_lint_auto_find_test_dependencies()`;
- linters are in `package.xml`, but no `find_package()` finds them;
- `ament_lint_auto_find_test_dependencies()` is called, but `ament_lint_auto` is the only `<test_depend>`. The call runs the
  linters among the test dependencies, and there are none.

One rule reports all of them, because the declared linters check nothing in each case.

## Why it matters

The linters are installed, and everyone believes that they check the code, but nothing is checked.

## How to fix it

Call `ament_lint_auto_find_test_dependencies()` in `if(BUILD_TESTING)` after `find_package(ament_lint_auto REQUIRED)`, or remove
the linters from `package.xml`. If CMake calls linters by name, such as `ament_cppcheck()`, remove those that it does not call.

## Limitations

Not reported:

- The script cannot be fully evaluated, or the build type is not `ament_cmake`.
- Linters declared with a tag other than `<test_depend>`, because they are for other packages, as in a metapackage.
- `rosidl_generate_interfaces()` is called with `ADD_LINTER_TESTS`, which runs the linters of `ament_lint_common`.
- An option that is off by default runs the linters.
- `ament_lint_auto` is the only `<test_depend>`, but CMake finds a package that may provide linters.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from ros_lint.api import BuildScript, Facet, Finding, Package, Rule, Severity, Workspace, build, dependencies

_AUTO = "ament_lint_auto"
_ALL = "ament_lint_common"
_RUN = "ament_lint_auto_find_test_dependencies"
_MAY_BRING = re.compile("cmake|common|lint|test|tool")
"""Pattern of the names of packages that may make linters available when CMake finds them."""
_BRING_NONE = frozenset({_AUTO, "ament_cmake", "ament_cmake_auto", "ament_cmake_python", "ament_cmake_ros"})


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    script = package.script
    if script is None or script.problems or package.builds_with != "ament_cmake" or script.hides(Facet.USES):
        return
    if _checks_what_it_generates(package):
        return
    if build.FINDS_TESTS.intersection(script.commands.names):
        yield from _none_to_run(package, script)
        return
    if any(call.blocks.count("if") > call.test for call in package.calls(_RUN, anywhere=True)):
        return  # an option enables them
    declared = [declared.depend for declared in package.declared if declared.name in (_AUTO, _ALL, *build.LINTERS)]
    for_others = {depend.name for depend in declared if depend.tag != "test_depend"}
    own = [depend for depend in declared if depend.name not in for_others]
    called_by_name = _called_by_name(package, script)
    mentioned = _mentioned(package, script)
    idle = [depend for depend in own if depend.name not in mentioned and build.LINTERS.get(depend.name) not in called_by_name]
    if called_by_name:
        for depend in idle:
            if depend.name != _ALL:  # it provides the called linters
                message = (
                    f"'{depend.name}' is declared, but CMake calls {_list(called_by_name)} instead; remove this <{depend.tag}>"
                )
                yield Finding(message, depend.span, depend.name)
        return
    first = next((depend for depend in own if depend.name == _AUTO), idle[0] if idle else None)
    if first is not None:
        yield Finding(
            f"'{first.name}' is declared, but no linter runs; call {_RUN}() in if(BUILD_TESTING), or remove this <{first.tag}>",
            first.span,
            first.name,
        )


def _none_to_run(package: Package, script: BuildScript) -> Iterator[Finding]:
    """Yield a finding if the script runs the linters among the test dependencies, but package.xml declares no linter.

    Then ament_lint_auto, which runs the linters, is the only test dependency.
    """
    for_tests = [declared.depend for declared in package.declared if declared.depend.tag == "test_depend"]
    if _RUN not in script.commands.names or {depend.name for depend in for_tests} != {_AUTO}:
        return
    packages = dependencies.names_searched(package, script).union(_looked_for(package)) - _BRING_NONE
    if not any(map(_MAY_BRING.search, packages)):
        yield Finding(
            f"'{_AUTO}' runs the linters among the test dependencies, but package.xml declares none; add "
            f"<test_depend>{_ALL}</test_depend>",
            for_tests[0].span,
            _AUTO,
        )


def _checks_what_it_generates(package: Package) -> bool:
    return any("ADD_LINTER_TESTS" in call.texts for call in package.calls("rosidl_generate_interfaces", anywhere=True))


def _called_by_name(package: Package, script: BuildScript) -> list[str]:
    """Return the linter commands that the CMake files call, also under a condition."""
    written = {call.name for call in package.calls(*build.LINTERS.values(), anywhere=True)}
    return sorted(written.union(set(build.LINTERS.values()).intersection(script.commands.names)))


def _mentioned(package: Package, script: BuildScript) -> set[str]:
    """Return the packages that the CMake files find or name, also under a condition."""
    return _looked_for(package).union(mention.name for mention in script.mentions)


def _looked_for(package: Package) -> set[str]:
    return {call.texts[0] for call in package.calls("find_package", anywhere=True) if call.args}


def _list(commands: list[str]) -> str:
    first, *others = [f"{command}()" for command in commands]
    return f"{first} and {len(others)} more" if len(others) > 1 else " and ".join((first, *others))


RULE = Rule(
    name="unrun-linters",
    code="ROS209",
    summary="declared linters run",
    severity=Severity.INFO,
    since="0.1",
    doc=__doc__,
    package=check,
)
