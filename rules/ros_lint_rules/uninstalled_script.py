"""
## What it finds

- A script with an interpreter line that an `ament_cmake` package does not install. It is in `scripts/`, in the folder of
  scripts that are installed, or in the folder of a Python package that is not installed. In the root of the package, only
  nodes are reported: scripts that import `rclpy`.
- A script or module of an `ament_python` package that is neither in `scripts` nor an entry point, although the documentation or
  a script of the package starts it with `ros2 run`.

## Why it matters

`ros2 run` and launch do not find the script.

## How to fix it

`install(PROGRAMS scripts/a.py DESTINATION lib/${PROJECT_NAME})`. The fix adds this rule. In `setup.py`, add an entry point: `'a
= robot.a:main'`.

## Limitations

Not reported:

- Files without an interpreter line.
- Python files that do nothing when they are started: they have no `__main__` guard, and no statement outside of functions
  and classes calls a function of the file or of `rclpy`. In executable files, the call of any function counts.
- Tests, and files that are kept as copies or backups (`old/`, `node copy.py`).
- Files that the build itself runs.
- Files that import packages which only ROS 1 has.
- A part of the build script that cannot be evaluated may install the files.

Reported with high confidence:

- Files that the documentation or a script of the package starts with `ros2 run`.
- Executable nodes (scripts that import `rclpy`) in a folder with installed nodes, unless the folder has more nodes that are not
  installed than installed ones.

Other scripts have medium confidence, or low confidence if they are not executable, because they may be tools for use in the
sources only.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

from ros_lint.api import Confidence, Facet, Finding, Fix, Package, Related, Rule, Severity, Workspace, build, edits, files


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    script = package.script
    if script is None or build.opaque_except_undefined_targets(package, Facet.EXECUTABLES | Facet.SHARE):
        return
    if package.builds_with == "ament_python":
        yield from _of_setup(package)
    if package.builds_with != "ament_cmake" or not script.files.scripts:
        return
    installed = script.products.installed
    nodes = {package.relative(use.span.path) for use in package.uses if use.via == "import" and use.package == "rclpy"}
    standing = workspace.world.resolution
    excluded = installed.union(script.files.build_inputs)
    excluded |= {package.relative(use.span.path) for use in package.uses if standing(use.package) == "end-of-life"}
    with_nodes = Counter([file.rpartition("/")[0] for file in nodes & installed])
    candidates = [file for file in script.files.scripts if file.path not in excluded and file.shebang and file.main]
    candidates = [file for file in candidates if "/" in file.path or file.path in nodes]
    uninstalled = [file for file in candidates if not files.is_auxiliary(file.path)]
    left_out = Counter([file.path.rpartition("/")[0] for file in uninstalled if file.executable and file.path in nodes])
    for file in uninstalled:
        folder = file.path.rpartition("/")[0]
        forgotten = file.path in nodes and with_nodes[folder] > 0
        sure = file.run is not None or (forgotten and file.executable and left_out[folder] <= with_nodes[folder])
        yield Finding(
            f"the script '{file.path}' is not installed, so ros2 run does not find it; install it to lib/{package.name}",
            package.start_of(file.path),
            file.path,
            (Related(f"'{file.path}' is started here", file.run),) if file.run else (),
            Fix.of(f"install '{file.path}'", edits.cmake.install_program(script, "PROGRAMS", file.path)),
            Confidence.HIGH if sure else Confidence.MEDIUM if forgotten or file.executable else Confidence.LOW,
        )


def _of_setup(package: Package) -> Iterator[Finding]:
    """Yield findings for programs that setup.py does not install, although they are started with ``ros2 run``."""
    for file in package.built.files.scripts:
        if file.run is not None and file.main:
            yield Finding(
                f"setup.py does not install an executable for the program '{file.path}', so ros2 run does not find it; "
                "add an entry point to console_scripts",
                package.start_of(file.path),
                file.path,
                (Related(f"'{file.path}' is started here", file.run),),
            )


RULE = Rule(
    name="uninstalled-script",
    code="ROS417",
    summary="scripts for use at run time are installed",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
