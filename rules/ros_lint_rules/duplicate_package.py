"""
## What it finds

Several packages of one name in the workspace, and where they are. The name is the one that colcon uses: that of `package.xml`,
or of `colcon.pkg` or `colcon.meta` where these set one. Plain CMake and Python packages have the name in `project()` or
`setup()`.

## Why it matters

`colcon build` refuses the whole workspace: "Duplicate package names not supported". It looks at the names after it has
chosen packages, so `--packages-select` does not help to build one of the two.

## How to fix it

Rename one, remove one, or put an empty file `COLCON_IGNORE` into the folder of the one that is not to be built.

## Limitations

About folders that are ignored, and about packages of the same name in an underlay: see `shadowed-package`. Where each lies
in a workspace of its own, such as `arm_ws/src` and `car_ws`, among the `extra_packages` of a micro-ROS build, or in a step of
its own, such as `03-service` and `04-action`, the confidence is medium: these are built one by one.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

from ros_lint.api import Confidence, Finding, Package, Related, Rule, Severity, Workspace


def check(workspace: Workspace) -> Iterator[Finding]:
    for name, same in workspace.graph.places.items():
        if len(same) < 2:
            continue
        first, *others = same
        places = " and ".join(package.path or "." for package in same)
        yield Finding(
            f"{len(same)} packages are called {name}: {places}; colcon refuses them: rename one or put COLCON_IGNORE into it",
            first.place,
            name,
            tuple(Related(f"{name} is here, too", package.place) for package in others),
            confidence=Confidence.MEDIUM if _lie_apart(same) else Confidence.HIGH,
            package=first.name,
        )


def _lie_apart(packages: Iterable[Package]) -> bool:
    """Whether each package lies in a workspace of its own: those of one repository, and its steps, are built one by one."""
    places = [_workspace(package.path) for package in packages]
    return "" not in places and len(set(places)) == len(places)


_STEP = r"\d+[-_. ]|(?:chapter|day|exercise|lab|lesson|part|step|tutorial|week)[-_ ]?\d"
_BUILT_ALONE = re.compile(rf"{_STEP}|\w+_ws\Z|extra_packages\Z")
"""How folders begin that are built one by one. ``extra_packages`` are those of a library for a microcontroller (micro-ROS)."""


def _workspace(path: str) -> str:
    """Return the folder above the ``src`` that a package is in, or another that is built alone, "" where it lies in neither."""
    top, inside, _ = f"/{path}/".partition("/src/")
    if inside:
        return top.removeprefix("/")
    parts = path.split("/")
    alone = next((at for at, part in enumerate(parts) if _BUILT_ALONE.match(part.lower())), len(parts))
    return "/".join(parts[: alone + 1]) if alone < len(parts) else ""


RULE = Rule(
    name="duplicate-package",
    code="ROS102",
    summary="a name must belong to one package of the workspace",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    workspace=check,
)
