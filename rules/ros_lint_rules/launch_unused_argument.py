"""
## What it finds

A launch argument that is declared but never used, neither in its file nor in a file that includes it or that it includes.

## Why it matters

The argument has no effect, and no message says so, although `ros2 launch --show-args` lists it.

## How to fix it

Use the argument, or remove it.

## Limitations

Not reported:

- Arguments that launch itself reads when it starts a process or a node, such as `emulate_tty`, `sigterm_timeout`, `launch-prefix`
  and `ros_namespace`.
- Arguments of a file that computes the names of the configurations it reads.
- Arguments of a Python launch file that imports modules which may read them.
- Arguments of a launch file whose tests read `test_args` of launch_testing.
- Launch files of examples, and of tests that the build script does not run.
- Arguments of a file that fills in parameters from launch configurations (`allow_substs`), because users may choose another
  parameter file, which may use any argument.
- All arguments, if a file of the workspace cannot be read, because it may include this file.
- Arguments of a file that only contains arguments, because it sets them for files that include it.
- Arguments with an empty default that another launch file of the same folder requires, because the two files may be
  interchangeable.
- Arguments with nearly the name of an undeclared configuration: `launch-undeclared-configuration` reports the configuration.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import STANDARD_LIBRARY, Finding, LaunchFile, Package, Rule, Severity, Workspace, launch

_QUIET = launch.LAUNCH_RUNTIME | {
    "launch_pytest",
    "launch_testing",
    "launch_testing_ros",
    "nav2_common",
    "pytest",
    "rclpy",
    "xacro",
    "yaml",
}
"""Python modules that read no launch configurations, beside those of the standard library and of interfaces."""


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    for launch_file in launch.run_launch_files(package):
        file = launch_file.file
        arguments = launch.argument_use(file, workspace)
        if arguments is None or _may_be_read_elsewhere(file, workspace):
            continue
        excused = {*_replacing(file, package, workspace), *(read.declared for read in arguments.similar.values())}
        required = launch.include_resolver(workspace).takes(file).required
        for name, span in arguments.declared.items():
            if name in arguments.unused and name not in excused:
                problem = (
                    "has no default, so callers must pass it, but nothing uses it"
                    if name in required
                    else "is declared but never used"
                )
                yield Finding(f"launch argument '{name}' {problem}; use it or remove it", span, name)


def _may_be_read_elsewhere(file: LaunchFile, workspace: Workspace) -> bool:
    """Return whether imported modules, parameter files or including files may read the arguments of a file."""
    if file.language == "python" and not (file.imports and all(_is_of_launch(name) for name, _ in file.imports)):
        return True
    return launch.include_tree(workspace).fill(file) or all(action.kind in ("argument", "set") for action in file.actions)


def _is_of_launch(module: str) -> bool:
    """Return whether a module certainly reads no launch configurations."""
    top, _, inner = module.partition(".")
    return top in _QUIET or top in STANDARD_LIBRARY or inner in ("action", "msg", "srv")


def _replacing(file: LaunchFile, package: Package, workspace: Workspace) -> Iterator[str]:
    """Yield the arguments of ``file`` that have an empty default there, but no default in another launch file of its folder."""
    resolver = launch.include_resolver(workspace)
    required = {name for other in package.launch if _folder(other) == _folder(file) for name in resolver.takes(other).required}
    for action in launch.walk_actions(file.actions):
        if action.kind == "argument" and action.target is not None and action.value is not None and action.value.texts == ("",):
            yield from required.intersection(action.target.texts)


def _folder(file: LaunchFile) -> str:
    return file.path.rpartition("/")[0]


RULE = Rule(
    name="launch-unused-argument",
    code="ROS519",
    summary="declared launch arguments are used",
    severity=Severity.INFO,
    since="0.1",
    doc=__doc__,
    package=check,
)
