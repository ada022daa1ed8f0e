"""
## What it finds

A package that is used, but that nothing in `package.xml` brings along: a header that is included, a Python module that
is imported, a `find_package`, a message type, a package whose files are looked up.

## Why it matters

It works as long as somebody else happens to install or build the package first. On a clean machine, in a container or
on the build farm it does not: colcon may build the packages in the wrong order, `rosdep install` leaves the package
out, and the released binary lacks it.

## How to fix it

Declare the package in `package.xml`, in the tag that the message names: `<depend>` for what is compiled against and
needed at run time, `<exec_depend>` for what is needed at run time only, `<test_depend>` for tests. The fix does this.

## When it keeps silent

- The package comes with a declared one: see `transitive-dependency` for uses that hang on such a chain.
- The use is optional: `find_package(QUIET)` behind `if(X_FOUND)`, `try: import`, `__has_include`.
- The name belongs to no package or rosdep key that is known, or to the system.
- A declared dependency is itself not known, so that anything might come with it: then the confidence is medium.
- The package needs this one itself, so that declaring it would close a cycle: then, too, the confidence is medium.
- Modules of launch itself that only launch files import come with `ros2 launch`: then the severity is info.
- What a launch file starts, includes or looks up is the business of `launch-outside-closure`.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from ros_lint.api import (
    Confidence,
    Finding,
    Fix,
    Package,
    Related,
    Role,
    Rule,
    Severity,
    Use,
    Workspace,
    add_dependency,
    tag_for,
)

_MOST_RELATED = 4
_LAUNCH = frozenset({"launch", "launch_ros", "ament_index_python"})
"""What `ros2 launch` brings along."""


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    manifest = package.manifest
    if manifest is None or manifest.problems:
        return
    declared = tuple(dict.fromkeys(declared.name for declared in package.declared))
    closure = workspace.world.closure(declared)
    for name, uses in _missing(package, frozenset(declared) | closure.names).items():
        best, *others = sorted(uses, key=_rank)
        role = _union(uses)
        tag = tag_for(package, workspace, name, role)
        circular = package.name in workspace.world.closure((name,)).names
        sure = best.sure and closure.complete and not circular
        yield Finding(
            _message(name, tag, circular),
            best.span,
            name,
            tuple(Related(f"also used here: {use.what}", use.span) for use in others[:_MOST_RELATED]),
            Fix(f"declare {name} as <{tag}>", add_dependency(package, tag, name)),
            Confidence.HIGH if sure else Confidence.MEDIUM,
            Severity.INFO if _comes_with_launching(package, uses) else None,
        )


def _comes_with_launching(package: Package, uses: Sequence[Use]) -> bool:
    """Whether only launch files import it, and it is part of whatever can launch them (reference, section E2, row 15)."""
    launched = {launch.path for launch in package.launch}
    return all(use.via == "import" and use.package in _LAUNCH and use.span.path in launched for use in uses)


def _message(name: str, tag: str, circular: bool) -> str:
    if circular:
        return f"{name} is used here, but cannot be declared: it needs this package itself"
    return f"{name} is used here, but package.xml does not declare it: add <{tag}>{name}</{tag}>"


def _missing(package: Package, covered: frozenset[str]) -> dict[str, list[Use]]:
    found: dict[str, list[Use]] = {}
    for use in package.uses:
        if use.optional or use.via == "launch" or not covered.isdisjoint(use.providers):
            continue
        found.setdefault(use.package, []).append(use)
    return found


def _rank(use: Use) -> tuple[object, ...]:
    """The surest and most telling evidence first."""
    telling = ("include", "import", "cmake", "interface", "target", "macro", "package", "key", "launch")
    return (not use.sure, use.role == Role.TEST, telling.index(use.via), use.span)


def _union(uses: Sequence[Use]) -> Role:
    role = Role(0)
    for use in uses:
        role |= use.role
    return role


RULE = Rule(
    name="undeclared-dependency",
    code="ROS201",
    summary="a package that is used must be declared",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
