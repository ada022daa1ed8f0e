"""
## What it finds

Two launch files of one name that a package installs into different folders, or one that it installs twice.

## Why it matters

`ros2 launch package file` looks for the name in every folder of the package, and refuses when it finds two: `file 'x' was
found more than once in the share directory of package`.

## How to fix it

Rename one, or install it once. Including works all the same, since an include names the folder.

## Limitations

- The files are installed under conditions that are not known, or are not called like launch files.
- Each of them is included by another launch file of the workspace: then they are parts, which nobody launches by name. So
  they may be where a file of the workspace cannot be read.
- Launch files of tests and examples.

Where folders side by side have several names in common, as with one set of files for each robot, the confidence is medium:
they may be launched by their paths.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence

from ros_lint.api import (
    LAUNCH_NAMES,
    Confidence,
    Finding,
    Package,
    Provided,
    Related,
    Rule,
    Severity,
    Workspace,
    beginning,
    from_base,
    launchable,
    per_workspace,
)


def check(workspace: Workspace) -> Iterator[Finding]:
    for package in workspace.packages:
        twice = _twice(package)
        for name, places in twice.items():
            sources = [from_base(package, place.source) for place in places]
            if len(set(sources)) > 1 and (workspace.unread() or _included(workspace).issuperset(sources)):
                continue
            paths = ", ".join(place.path.partition(f"share/{package.name}/")[2] for place in places)
            yield Finding(
                f"{package.name} installs {name} more than once ({paths}), so ros2 launch {package.name} {name} refuses; "
                "rename one, or install it once",
                beginning(sources[0]),
                name,
                tuple(
                    Related("installed by this", place.span)
                    if source == sources[0]
                    else Related("the other file", beginning(source))
                    for place, source in zip(places[1:], sources[1:], strict=True)
                ),
                confidence=Confidence.MEDIUM if _is_set(twice, places) else Confidence.HIGH,
                package=package.name,
            )


def _is_set(twice: Mapping[str, Sequence[Provided]], places: Sequence[Provided]) -> bool:
    """Whether files of one name lie in folders side by side that have more names in common: one set of files for each robot."""
    folders = _folders(places)
    return len({folder.rpartition("/")[0] for folder in folders}) == 1 and any(
        len(folders & _folders(others)) > 1 for others in twice.values() if others is not places
    )


def _folders(places: Iterable[Provided]) -> set[str]:
    return {place.path.rpartition("/")[0] for place in places}


def _twice(package: Package) -> dict[str, list[Provided]]:
    """Return the launch files that a package installs at several places, by their names."""
    files = {launch.path for launch in launchable(package)}
    names: dict[str, dict[str, Provided]] = {}
    for provided in package.built.provides if files else ():
        name = provided.path.rpartition("/")[2]
        if provided.source not in files or provided.conditional or not name.endswith(LAUNCH_NAMES):
            continue
        if provided.path.startswith(f"share/{package.name}/"):
            names.setdefault(name, {}).setdefault(provided.path, provided)
    return {name: list(places.values()) for name, places in names.items() if len(places) > 1}


@per_workspace
def _included(workspace: Workspace) -> frozenset[str]:
    """Return the paths of the launch files that others include."""
    files = (file for package in workspace.packages for file in package.launch)
    return frozenset([inner.path for file in files for inner in workspace.links.includes(file)])


RULE = Rule(
    name="launch-duplicate-file",
    code="ROS509",
    summary="the launch files of a package must have different names",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    workspace=check,
)
