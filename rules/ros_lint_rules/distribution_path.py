"""
## What it finds

A path below the install folder of one distribution, written out in a launch file, program, model or parameter file. It names a
file of a package, a program or a library: `/opt/ros/humble/share/nav2_bt_navigator/behavior_trees/navigate.xml`.

## Why it matters

The file exists only if this distribution is installed from the Ubuntu packages. It is missing in the next distribution, in a
build from source and in a conda environment. If the workspace overrides the package, the path still names the installed one.

## How to fix it

- File of a package: use `get_package_share_directory('nav2_bt_navigator')` or `FindPackageShare` in Python,
  `$(find-pkg-share nav2_bt_navigator)` in XML and YAML launch files, `package://` or `$(find ...)` in models.
- Parameter: pass the path from the launch file, because parameter files cannot look up packages. Remove the parameter if its
  default is that file.
- Program: start it with `ros2 run` or as a node.
- Library: use the bare file name, because `setup.bash` sets the library path.

## Limitations

Not reported:

- Comments, docstrings, tests, examples, documentation, build scripts, and launch files of ROS 1.
- Other paths below `/opt/ros`, such as `/opt/ros/humble/setup.bash`.
- Paths that are composed at run time.

The confidence is high if the path names another distribution than the target distribution (`--distro`, settings or
environment), and the file with the path is installed, built or launched. Otherwise the confidence is medium, because the path
is right on machines with the distribution that it names.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from ros_lint.api import (
    Confidence,
    Finding,
    MachinePath,
    Package,
    Related,
    Rule,
    Severity,
    Workspace,
    files,
    first_related,
    launch,
)

_LEADS_TO = re.compile(
    r"/opt/ros/[a-z]+/(?:share/(?P<package>[a-z]\w*)/(?P<file>.+)|lib/(?P<library>lib[\w.+-]+\.so[.\d]*)"
    r"|lib/(?!python)(?P<owner>[a-z]\w*)/(?P<program>[\w.-]+))"
)
_BUILDING = ("CMakeLists.txt", ".cmake", "setup.py", "package.xml")

_SOMEWHERE = "does not exist in every installation"


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    by_path: dict[str, list[MachinePath]] = {}
    for machine in package.machine_paths:
        file = package.relative(machine.span.path)
        if machine.distribution and not (files.is_auxiliary(file) or file.endswith(_BUILDING) or _is_of_ros_1(machine, package)):
            by_path.setdefault(machine.path, []).append(machine)
    if not by_path:
        return
    target, used = workspace.target, launch.used_files(package)
    for path, (first, *others) in by_path.items():
        leads = _LEADS_TO.fullmatch(path)
        if leads is None:
            continue
        differs = target.explicit and first.distribution != target.distro
        where = (
            f"exists only where {first.distribution} is installed, but the workspace is checked for {target.distro}"
            if differs
            else _SOMEWHERE
        )
        sure = differs and any(package.relative(place.span.path) in used for place in (first, *others))
        yield Finding(
            f"'{path}' {where}; {_remedy(leads, first, package)}",
            first.span,
            path,
            first_related(Related(f"'{path}' is also named here", place.span) for place in others),
            confidence=Confidence.HIGH if sure else Confidence.MEDIUM,
        )


def _remedy(leads: re.Match[str], machine: MachinePath, package: Package) -> str:
    if leads["library"]:
        return f"write {leads['library']}, which is found by name"
    if leads["program"]:
        return f"start it with ros2 run {leads['owner']} {leads['program']}, or as a node"
    name, rest, file = leads["package"], leads["file"], machine.span.path
    if launch.is_launch_file(package, machine.span.path) and not file.endswith(".py"):
        return f"write $(find-pkg-share {name})/{rest}"
    if file.endswith(".xacro"):
        return f"write $(find {name})/{rest}"
    if file.endswith((".urdf", ".srdf", ".rviz")):
        return f"write package://{name}/{rest}"
    if file.endswith((".sdf", ".world")):
        return f"write model://{name}/{rest}"
    if file.endswith((".yaml", ".yml")):
        return f"pass the path from the launch file, which can look up the share directory of '{name}'"
    return f"look it up in the share directory of '{name}'"


def _is_of_ros_1(machine: MachinePath, package: Package) -> bool:
    return machine.span.path.endswith(".launch") and not launch.is_launch_file(package, machine.span.path)


RULE = Rule(
    name="distribution-path",
    code="ROS419",
    summary="paths do not point into the install folder of one distribution",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    package=check,
)
