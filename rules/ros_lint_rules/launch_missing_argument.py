"""
## What it finds

An include that does not pass an argument which the included launch file requires, because it declares the argument without a
default.

## Why it matters

The launch file stops: `Included launch description missing required argument`.

## How to fix it

Pass the argument, or declare a default for it in the included file.

## Limitations

Not reported:

- Includes whose file or arguments cannot be determined from the launch files alone.
- Required arguments that are declared under a condition or in a group.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import Finding, LaunchFile, Package, Related, Rule, Severity, Workspace, launch


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    resolver = launch.include_resolver(workspace)
    for launch_file in launch.run_launch_files(package):
        for include in launch.includes(launch_file.file):
            yield from _of_include(include, launch_file.file, resolver)


def _of_include(include: launch.PlacedInclude, source: LaunchFile, resolver: launch.IncludeResolver) -> Iterator[Finding]:
    action = include.action
    target = resolver.target(action.target, source)
    passed = {name for name, _ in action.arguments}
    if target is None or not all(launch.is_plain(name) for name in passed if name):
        return
    file = f"{target.package.name}/{target.path}"
    for name, declared in resolver.takes(target.file).required.items():
        if name not in passed:
            yield Finding(
                f"'{file}' requires the argument '{name}', which is not passed here; pass it",
                action.target.span if action.target is not None else action.span,
                f"{file}:{name}",
                (Related(f"argument '{name}' is declared here without a default", declared),),
            )


RULE = Rule(
    name="launch-missing-argument",
    code="ROS513",
    summary="includes pass the arguments that the included launch file requires",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    package=check,
)
