"""
## What it finds

An executable that is built, but neither installed nor a test.

## Why it matters

It costs time in every build, and cannot be run after installation. Often its install rule was forgotten.

## How to fix it

Install it to `lib/${PROJECT_NAME}`, or build it only together with tests or examples. The fix installs it.

## Limitations

This rule is off by default. Not reported:

- A part of the build script that cannot be evaluated may install the executable.
- The executable is an example, or not part of every build.
- A custom command runs the executable during the build.
- `uninstalled-executable` reports it: a launch file starts it, or it is a node, and the package installs nothing or other
  nodes.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import Facet, Finding, Fix, Package, Rule, Severity, Workspace, build, edits, launch


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    script = package.script
    if (
        script is None
        or package.builds_with != "ament_cmake"
        or build.opaque_except_undefined_targets(package, Facet.EXECUTABLES)
        or build.may_run_built(script)
    ):
        return
    excluded = {provided.target for provided in script.products.installs} | build.install_arguments(package)
    excluded |= build.never_installed_nodes(package) | build.partly_installed_nodes(
        package
    )  # uninstalled-executable reports them
    excluded.update(launch.nodes_started(workspace, package.name))
    for target in script.products.targets:
        if target.kind != "executable" or target.test or target.name in excluded:
            continue
        if build.is_optional_target(package, target):
            continue
        fix = Fix.of(f"install '{target.name}'", edits.cmake.install_program(script, "TARGETS", target.name), safe=False)
        message = f"'{target.name}' is built, but neither installed nor a test; install it, or add EXCLUDE_FROM_ALL"
        yield Finding(message, target.span, target.name, fix=fix)


RULE = Rule(
    name="unused-executable-target",
    code="ROS404",
    summary="executables are installed or are tests",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    default=False,
    fixable=True,
    package=check,
)
