"""
## What it finds

An executable that is built and neither installed nor a test.

## Why it matters

It costs time in every build, and nobody can run it after the installation. Often its install rule was forgotten.

## How to fix it

Install it to `lib/${PROJECT_NAME}`, or build it only when tests or examples are wanted. The fix installs it.

## Limitations

Where something that cannot be followed may install it; where it is not part of every build, or an example; where a custom
command runs it during the build; where `uninstalled-executable` speaks: a launch file starts it, or it is a node of a package
that installs nothing, or other nodes. It is off unless it is asked for.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import (
    Facet,
    Finding,
    Fix,
    Package,
    Rule,
    Severity,
    Workspace,
    cmake_edits,
    forgotten_nodes,
    hidden,
    is_on_request,
    left_out_nodes,
    listed_to_install,
    may_run_built,
)


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    script = package.script
    if script is None or package.builds_with != "ament_cmake" or hidden(package, Facet.EXECUTABLES) or may_run_built(script):
        return
    left = {provided.target for provided in script.provides} | listed_to_install(package)
    left |= forgotten_nodes(package) | left_out_nodes(package)  # another rule says so
    left.update(workspace.started.get(package.name, {}))
    for target in script.targets:
        if target.kind != "executable" or target.test or target.name in left:
            continue
        if is_on_request(package, target):
            continue
        fix = Fix.of(f"install {target.name}", cmake_edits.install_program(script, "TARGETS", target.name), safe=False)
        message = f"{target.name} is built, but neither installed nor a test; install it, or build it only if it is wanted"
        yield Finding(message, target.span, target.name, fix=fix)


RULE = Rule(
    name="unused-executable-target",
    code="ROS404",
    summary="an executable should be installed or be a test",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    default=False,
    fixable=True,
    package=check,
)
