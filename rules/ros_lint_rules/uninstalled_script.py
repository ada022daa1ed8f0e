"""
## What it finds

A script with an interpreter line, in `scripts/`, beside scripts that are installed, or in the folder of a Python package that is
not installed, that an `ament_cmake` package does not install. The confidence is high where a page or a script of the package
starts it with `ros2 run`, and for an executable node beside nodes that are installed (both import `rclpy`), unless those are
fewer than the ones that are not. Else it is medium or low: it may be a tool for the sources only.

Also a script or a module of an `ament_python` package that a page or a script of the package starts with `ros2 run`, and that
is neither among the `scripts` nor the entry points.

## Why it matters

`ros2 run` and launch do not find it.

## How to fix it

`install(PROGRAMS scripts/a.py DESTINATION lib/${PROJECT_NAME})`. The fix adds this rule. In `setup.py`: an entry point,
`'a = robot.a:main'`.

## Limitations

For files without interpreter line or executable bit, for tests, for what is put aside (`old/`, `node copy.py`), for those that
the build itself runs, for those that import what only ROS 1 has, and where something that cannot be followed may install them.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

from ros_lint.api import (
    Confidence,
    Facet,
    Finding,
    Fix,
    Package,
    Related,
    Rule,
    Severity,
    Workspace,
    cmake_edits,
    hidden,
    is_apart,
    place_of,
    relative,
)


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    script = package.script
    if script is None or hidden(package, Facet.EXECUTABLES | Facet.SHARE):
        return
    if package.builds_with == "ament_python":
        yield from _of_setup(package)
    if package.builds_with != "ament_cmake":
        return
    installed = script.installed
    nodes = {relative(package, use.span.path) for use in package.uses if use.via == "import" and use.package == "rclpy"}
    standing = workspace.world.standing
    left = installed.union(script.inputs)
    left |= {relative(package, use.span.path) for use in package.uses if standing(use.package) == "end-of-life"}
    with_nodes = Counter([file.rpartition("/")[0] for file in nodes & installed])
    lost = [file for file in script.files if file.path not in left and file.shebang and file.main and not is_apart(file.path)]
    alike = Counter([file.path.rpartition("/")[0] for file in lost if file.executable and file.path in nodes])
    for file in lost:
        folder = file.path.rpartition("/")[0]
        forgotten = file.path in nodes and with_nodes[folder] > 0
        sure = file.run is not None or (forgotten and file.executable and alike[folder] <= with_nodes[folder])
        yield Finding(
            f"{file.path} is a script, and is not installed, so ros2 run does not find it; install it to lib/{package.name}",
            place_of(package, file.path),
            file.path,
            (Related("it is started here", file.run),) if file.run else (),
            Fix.of(f"install {file.path}", cmake_edits.install_program(script, "PROGRAMS", file.path)),
            Confidence.HIGH if sure else Confidence.MEDIUM if forgotten or file.executable else Confidence.LOW,
        )


def _of_setup(package: Package) -> Iterator[Finding]:
    """Speak of programs that setup.py does not install, and that are said to be started with ``ros2 run``."""
    for file in package.built.files:
        if file.run is not None and file.main:
            yield Finding(
                f"{file.path} is a program, and setup.py makes no executable of it, so ros2 run does not find it; "
                "add an entry point",
                place_of(package, file.path),
                file.path,
                (Related("it is started here", file.run),),
            )


RULE = Rule(
    name="uninstalled-script",
    code="ROS417",
    summary="a script that is meant to be run must be installed",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
