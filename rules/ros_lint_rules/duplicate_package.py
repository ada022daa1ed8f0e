"""
## What it finds

Several packages with the same name in the workspace, with their folders. The name is the one that colcon uses: that of
`package.xml`, or of `colcon.pkg` or `colcon.meta` if these set one. Plain CMake and Python packages have the name in `project()`
or `setup()`.

## Why it matters

`colcon build` rejects the whole workspace: "Duplicate package names not supported". It checks names after the selection of
packages, so `--packages-select` cannot build one of the two.

## How to fix it

Rename or remove one of the packages, or put an empty file `COLCON_IGNORE` into the folder of a package that should not be
built.

## Limitations

Not reported:

- Packages in ignored folders.
- Packages with the same name in an underlay: see `shadowed-package`.

Reported with medium confidence, because such packages are built separately: each package is in

- a workspace of its own, such as `arm_ws/src` and `car_ws`;
- the `extra_packages` of a micro-ROS build;
- a step of a course, such as `03-service` and `04-action`.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from ros_lint.api import Confidence, Finding, Package, Related, Rule, Severity, Workspace, graph


def check(workspace: Workspace) -> Iterator[Finding]:
    for name, places in graph.dependency_graph(workspace).places.items():
        same = [package for package in places if not package.is_ros1]  # they are built in another workspace
        if len(same) < 2:
            continue
        first, *others = same
        *earlier, last = [f"'{package.path or '.'}'" for package in same]
        paths = f"{', '.join(earlier)} and {last}"
        yield Finding(
            f"{len(same)} packages have the name '{name}': {paths}; colcon rejects the workspace; rename one, or put "
            "an empty file COLCON_IGNORE into its folder",
            first.span,
            name,
            tuple(Related(f"another package '{name}'", package.span) for package in others),
            confidence=Confidence.MEDIUM if _are_built_separately(same) else Confidence.HIGH,
            package=first.name,
        )


def _are_built_separately(packages: Iterable[Package]) -> bool:
    """Return whether each package is in a workspace of its own (``arm_ws``, ``lesson_2``), so that no build has two of them."""
    places = [graph.workspace_of(package.path) for package in packages]
    return "" not in places and len(set(places)) == len(places)


RULE = Rule(
    name="duplicate-package",
    code="ROS102",
    summary="package names are unique in the workspace",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    workspace=check,
)
