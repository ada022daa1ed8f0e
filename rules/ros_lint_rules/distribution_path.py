"""
## What it finds

A path into the folder of one distribution, `/opt/ros/humble/share/nav2_bt_navigator/behavior_trees/navigate.xml`, that is written
out in a launch file, a program, a model or parameters: a file of a package, one of its programs, or a library.

## Why it matters

It is there with this distribution alone, and only where that was installed from the packages of Ubuntu. With the next one the
file is missing, as it is where ROS was built from source or comes from conda; and a package of that name in the workspace,
which lies over the installed one, is passed by.

## How to fix it

A file of a package is found by the package: `get_package_share_directory('nav2_bt_navigator')` and `FindPackageShare` in
Python, `$(find-pkg-share nav2_bt_navigator)` in XML and YAML launch files, `package://` and `$(find ...)` in models. Parameters
cannot look up anything: the launch file gives such ones, or they are left out where the default is that file. A program is
started by `ros2 run`, or as a node. A library is found by its name alone, since `setup.bash` says where libraries lie.

## Limitations

- In comments and docstrings, in tests, examples and documentation, in build scripts, and in launch files of ROS 1.
- Of other paths in there, such as `/opt/ros/humble/setup.bash`, and of paths that are put together.

The confidence is high where another distribution is asked for, by `--distro`, the settings or the environment, and the file
that names the path is used: installed, built or launched. Else it is medium: the path is right on machines that have that one.
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
    is_apart,
    is_launched,
    relative,
    several,
    used_files,
)

_LEADS_TO = re.compile(
    r"/opt/ros/[a-z]+/(?:share/(?P<package>[a-z]\w*)/(?P<file>.+)|lib/(?P<library>lib[\w.+-]+\.so[.\d]*)"
    r"|lib/(?!python)(?P<owner>[a-z]\w*)/(?P<program>[\w.-]+))"
)
_BUILDING = ("CMakeLists.txt", ".cmake", "setup.py", "package.xml")

_SOMEWHERE = "not there in every installation"


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    found: dict[str, list[MachinePath]] = {}
    for each in package.machine_paths:
        file = relative(package, each.span.path)
        if each.distribution and not (is_apart(file) or file.endswith(_BUILDING) or _is_of_ros_1(each, package)):
            found.setdefault(each.path, []).append(each)
    if not found:
        return
    target, used = workspace.target, used_files(package)
    for path, (first, *others) in found.items():
        leads = _LEADS_TO.fullmatch(path)
        if leads is None:
            continue
        other = target.told and first.distribution != target.distro
        where = f"there with {first.distribution} only, and this is for {target.distro}" if other else _SOMEWHERE
        sure = other and any(relative(package, each.span.path) in used for each in (first, *others))
        yield Finding(
            f"{path} is {where}: {_way_out(leads, first, package)}",
            first.span,
            path,
            several(Related("and here", each.span) for each in others),
            confidence=Confidence.HIGH if sure else Confidence.MEDIUM,
        )


def _way_out(leads: re.Match[str], machine: MachinePath, package: Package) -> str:
    if leads["library"]:
        return f"say {leads['library']}, which is found by its name"
    if leads["program"]:
        return f"start it with ros2 run {leads['owner']} {leads['program']}, or as a node"
    name, rest, file = leads["package"], leads["file"], machine.span.path
    if is_launched(package, machine.span.path) and not file.endswith(".py"):
        return f"say $(find-pkg-share {name})/{rest}"
    if file.endswith(".xacro"):
        return f"say $(find {name})/{rest}"
    if file.endswith((".urdf", ".srdf", ".rviz")):
        return f"say package://{name}/{rest}"
    if file.endswith((".sdf", ".world")):
        return f"say model://{name}/{rest}"
    if file.endswith((".yaml", ".yml")):
        return f"let the launch file give it, from the share directory of {name}"
    return f"look it up in the share directory of {name}"


def _is_of_ros_1(machine: MachinePath, package: Package) -> bool:
    return machine.span.path.endswith(".launch") and not is_launched(package, machine.span.path)


RULE = Rule(
    name="distribution-path",
    code="ROS419",
    summary="a path must not lead into the folder of one distribution",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    package=check,
)
