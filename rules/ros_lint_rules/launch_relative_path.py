"""
## What it finds

A path relative to the folder of the package (`config/robot.yaml`) in a launch file, as a parameter file of a node, as a
configuration of RViz or as an include.

## Why it matters

The path is not relative to the launch file. It is found only if `ros2 launch` is called in the folder of the package.

## How to fix it

Look up the file in the share directory: with `get_package_share_directory('robot')` or `FindPackageShare` in Python, with
`$(find-pkg-share robot)` in XML and YAML. If the file is not in the share directory yet, install it first; the message says so.

## Limitations

Not reported:

- Paths to files that the package does not have.
- Launch files that set the working directory (`cwd`).
- Paths in arguments whose meaning only the program knows.

The confidence is medium for launch files that are not installed.
"""

from __future__ import annotations

import posixpath
from collections.abc import Iterator
from itertools import pairwise

from ros_lint.api import (
    Confidence,
    Facet,
    Finding,
    LaunchAction,
    LaunchValue,
    Package,
    Related,
    Rule,
    Severity,
    Span,
    Workspace,
    launch,
)


def check(package: Package, _: Workspace) -> Iterator[Finding]:
    if not package.launch:
        return
    paths = frozenset(package.files)
    named: dict[str, list[tuple[bool, Span]]] = {}
    for launch_file in launch.package_launch_files(package):
        defaults = launch.assigned_configurations(launch_file.file)
        for action in launch.walk_actions(launch_file.file.actions):
            for value in _read_by_path(action):
                texts = launch.substitute(value, defaults)
                path = posixpath.normpath(texts[0]) if len(texts) == 1 else ""
                if path in paths and all(name != "cwd" for name, _ in action.arguments):
                    named.setdefault(path, []).append((launch_file.installed, value.span))
    for path, places in named.items():
        install = "install it and " if _is_left_out(package, path) else ""
        # The finding is at an installed launch file, if there is one.
        (installed, first), *others = sorted(places, key=lambda place: not place[0])
        yield Finding(
            f"'{path}' is only found if ros2 launch runs in the folder of '{package.name}'; "
            f"{install}look it up in the share directory of the package",
            first,
            path,
            tuple(Related(f"'{path}' is also named here", span) for _, span in others),
            confidence=Confidence.HIGH if installed else Confidence.MEDIUM,
        )


def _read_by_path(action: LaunchAction) -> Iterator[LaunchValue]:
    """Yield the file names of an action that launch or the node opens relative to the working directory.

    These are names of included launch files, parameter files and configurations of RViz.
    """
    if action.kind == "include" and action.target is not None:
        yield action.target
    if action.kind in ("node", "component"):
        yield from (value for name, value in action.parameters if not name)
    words = [value for name, value in action.arguments if not name] if action.kind == "node" else []
    yield from (file for flag, file in pairwise(words) if _GIVES_FILE.issuperset(flag.texts))


_GIVES_FILE = frozenset({"-d", "--display-config", "--params-file"})
"""Command line options with a file name as value: the options of RViz for its configuration, and one of all nodes."""


def _is_left_out(package: Package, path: str) -> bool:
    """Return whether the package certainly does not install the file ``path`` to its share directory."""
    installed = {file.source for file in package.built.products.installs if file.path.startswith("share/")}
    return bool(package.built.path) and not package.hidden(Facet.SHARE) and path not in installed


RULE = Rule(
    name="launch-relative-path",
    code="ROS520",
    summary="launch files do not name files relative to the folder of the package",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    package=check,
)
