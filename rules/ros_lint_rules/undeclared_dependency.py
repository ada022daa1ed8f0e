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
- A declared dependency is itself not known, so that the package might come with it: then the confidence is medium.
- All evidence is in files that are perhaps not built or installed: then, too, the confidence is medium.
- The package needs this one itself, so that declaring it would close a cycle: then, too, the confidence is medium.
- Modules of launch itself that only launch files import come with `ros2 launch`: then the severity is info.
- Only launch files that are no tests name it, for what they start, include or look up: that is the business of
  `launch-outside-closure`.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import (
    Confidence,
    Finding,
    Fix,
    Package,
    Related,
    Rule,
    Severity,
    Workspace,
    add_dependency,
    comes_with_launching,
    tag_for,
    undeclared,
)

_MOST_RELATED = 4


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    if package.manifest is None or package.manifest.problems:
        return
    found = undeclared(package, workspace)
    with_launch = {need.name for need, _ in found if comes_with_launching(package, need.uses)}
    for need, sure in found:
        if need.name == "launch" and "launch_ros" in with_launch:
            continue  # which brings it
        best, *others = need.uses
        name = need.name
        tag = tag_for(package, workspace, name, need.role)
        circular = package.name in workspace.world.closure((name,))
        yield Finding(
            _message(name, tag, circular),
            best.span,
            name,
            tuple(Related(f"also used here: {use.what}", use.span) for use in others[:_MOST_RELATED]),
            None if circular else Fix(f"declare {name} as <{tag}>", add_dependency(package, tag, name)),
            Confidence.HIGH if sure and not circular else Confidence.MEDIUM,
            Severity.INFO if need.name in with_launch else None,
        )


def _message(name: str, tag: str, circular: bool) -> str:
    if circular:
        return f"{name} is used here, but cannot be declared: it needs this package itself"
    return f"{name} is used here, but package.xml does not declare it: add <{tag}>{name}</{tag}>"


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
