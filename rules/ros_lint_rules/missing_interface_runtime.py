"""
## What it finds

A package that generates messages, services or actions but lacks the dependency `rosidl_default_runtime` in `package.xml`.

## Why it matters

The generated code cannot be loaded unless another package provides the run-time package.

## How to fix it

Add the tag that the message names, as the fix does.

## Limitations

Not reported:

- Interfaces that are not installed, because only the package itself uses them.
- Packages whose script names the run-time package, as in `ament_export_dependencies(rosidl_default_runtime)`:
  `undeclared-dependency` reports it.
- Packages whose CMakeLists.txt is in a subfolder with its own `package.xml`: CMake reads that one.

If another declared dependency provides the run-time package, may do so, or provides all its dependencies, nothing fails: the
severity is info and the confidence medium. The severity is warning if the name of the package shows that it serves tests.

The confidence is also medium for interfaces that are generated under a condition.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import Confidence, Finding, Package, Role, Rule, Severity, Workspace, build, dependencies, files

_RUNTIME = "rosidl_default_runtime"
_CORE = "rosidl_core_runtime"
"""The package to declare in place of rosidl_default_runtime, in interface packages on which rosidl_default_runtime depends."""


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    generation = build.interface_generation(package)
    if generation is None or not generation.reads_manifest:
        return
    starts = [declared.name for declared in package.declared if declared.role & (Role.EXEC | Role.EXPORT)]
    reported = {need.name for need, certain in dependencies.undeclared(package, workspace) if certain}
    if not {_RUNTIME, _CORE}.isdisjoint(starts) or _RUNTIME in reported:
        return
    closure = workspace.world.closure(starts)
    needed = workspace.world.closure([_RUNTIME])
    only_itself = len(needed) > 1 and set(needed.difference(closure)) == {_RUNTIME}
    provided = _RUNTIME in closure or bool(closure.unknown) or only_itself
    tag = "run_depend" if package.manifest and package.manifest.format == 1 else "exec_depend"
    yield Finding(
        f"the generated interfaces need '{_RUNTIME}' at run time; add <{tag}>{_RUNTIME}</{tag}>",
        generation.span,
        _RUNTIME,
        (),
        dependencies.naming_fix(
            workspace, _RUNTIME, f"declare '{_RUNTIME}' as <{tag}>", *dependencies.add_dependency(package, tag, _RUNTIME)
        ),
        Confidence.MEDIUM if provided else Confidence.HIGH if generation.certain else Confidence.MEDIUM,
        Severity.INFO if provided else Severity.WARNING if files.is_for_tests(package.name) else None,
    )


RULE = Rule(
    name="missing-interface-runtime",
    code="ROS208",
    summary="packages with interfaces depend on rosidl_default_runtime",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
