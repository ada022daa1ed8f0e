"""
## What it finds

A valid `package.xml` with a build script beside it, in a folder below another package. Where a script makes one plain
package of a folder with several, that is told once.

## Why it matters

colcon looks no further once a folder is a package. The nested package is neither built nor listed nor tested, without a
word. The outer package need not have a `package.xml`: a `CMakeLists.txt` with a `project()`, or a `setup.py`, in the
root of a repository makes colcon take all of it for one plain package.

## How to fix it

Move the nested package beside the outer one. If the outer folder is not meant to be a package, put the packages into
a folder of their own and build from there (`colcon build --base-paths src`, `ros-lint src`), or rename the script. If
the nested one is not meant to be built, put an empty `COLCON_IGNORE` beside its manifest.

## Limitations

- The folder, or one between the two, has `COLCON_IGNORE`, `AMENT_IGNORE` or `CATKIN_IGNORE`.
- A `CMakeLists.txt` of the outer package takes the folder in with `add_subdirectory()`, or with a function of its own that is
  called like it (`add_rosidl_subdirectory()`): it is a part of that package then.
- The nested manifest would be rejected anyway, or has no build script beside it.
- In folders of tests, templates, examples or vendored code the confidence is medium: such manifests are mostly data, as are
  those that the outer package installs; and in folders for what is put aside, such as `legacy`. So it is where a file of the
  outer package cannot be read, and where one of the two is of ROS 1 (catkin), which nobody builds with ROS 2.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from ros_lint.api import Confidence, Finding, Manifest, Package, Related, Rule, Severity, Workspace, few, is_apart, several

_DATA = re.compile(
    r"\..*|tests?|testing|fixtures|data|resources?|templates?|examples?|demos?|docs?|vendor|third_?party|3rdparty|external|contrib",
    re.IGNORECASE,
)
"""Folders in which a manifest is rather data than a package that somebody forgot."""


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    inside = [nested for nested in package.nested if not nested.problems]
    lost = [] if workspace.unread(package) else [nested for nested in inside if _is_lost(package, nested)]
    together = lost if len(lost) > 1 and not package.type.startswith("ros.") else []
    if together:
        yield _all_hidden(package, together)
    for nested in inside:
        if nested not in together:
            yield Finding(
                f"colcon does not see {nested.name}: it lies in {_outer(package)}; {_way_out(package, [nested], 'it')}",
                nested.name_span,
                nested.name,
                confidence=Confidence.HIGH if nested in lost else Confidence.MEDIUM,
            )


def _all_hidden(package: Package, lost: list[Manifest]) -> Finding:
    """Return what to say where a script makes one plain package of a folder with several."""
    names = few(nested.name for nested in lost)
    return Finding(
        f"colcon does not see {names} ({len(lost)} packages): they lie in {_outer(package)}; {_way_out(package, lost, 'them')}",
        package.place,
        package.name,
        several(Related("this package", nested.name_span) for nested in lost),
    )


def _is_lost(package: Package, nested: Manifest) -> bool:
    """Whether a manifest is rather a package that somebody wants to build than data, and was not left behind with ROS 1."""
    data = any(_DATA.fullmatch(folder) or is_apart(f"{folder}/") for folder in _between(package, nested))
    return not (data or _is_installed(package, nested) or package.builds_with == "catkin" or _is_of_ros_1(nested))


def _is_installed(package: Package, nested: Manifest) -> bool:
    """Whether the outer package installs the manifest, with its folder."""
    installed = "/".join(nested.path.split("/")[-2:])
    return any(provided.path.endswith(f"/{installed}") for provided in package.built.provides)


def _between(package: Package, nested: Manifest) -> list[str]:
    """Return the folders from that of a package down to that of a nested manifest."""
    return nested.path.removeprefix(f"{package.path}/").split("/")[:-1]


def _is_of_ros_1(manifest: Manifest) -> bool:
    """Whether a manifest asks for catkin, and names no build type."""
    typed = any(element.tag == "build_type" for element in manifest.exports)
    return not typed and any(depend.name == "catkin" for depend in manifest.depends)


def _outer(package: Package) -> str:
    if package.type.startswith("ros."):
        return f"the package {package.name}"
    script = "CMakeLists.txt" if package.type == "cmake" else "setup.py"
    return f"{package.path or 'a folder'}, which is the plain package {package.name} because of its {script}"


def _way_out(package: Package, inside: list[Manifest], it: str) -> str:
    """Return what to do. A root with a script of its own may be meant: then packages are sought in folders below it."""
    folders = dict.fromkeys(folder for nested in inside for folder in _between(package, nested)[:1])
    ways = f"move {it} out, or mark {it} with COLCON_IGNORE"
    return ways if package.path or not folders else f"build with --base-paths {' '.join(folders)}, {ways}"


RULE = Rule(
    name="nested-package",
    code="ROS115",
    summary="a package must not lie in another one",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    package=check,
)
