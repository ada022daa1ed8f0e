"""
## What it finds

Launch files with the same name that a package installs to different folders, or one launch file that is installed twice.

## Why it matters

`ros2 launch package file` searches all folders of the package and stops if it finds two files: `file 'x' was found more than
once in the share directory of package`.

## How to fix it

Rename one of the files, or install the file only once. Includes are not affected, because they name the folder.

## Limitations

Not reported:

- Files that are installed under unknown conditions, and files without the name of a launch file.
- Different files of the same name, if other launch files of the workspace include all of them, because included files need not
  be launched by name. If a file of the workspace cannot be read, different files are never reported.
- Launch files of tests and examples.

If neighbouring folders have several names in common, as with one set of files for each robot, the confidence is medium: such
files may be launched by path.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence

from ros_lint.api import (
    Confidence,
    Finding,
    InstalledFile,
    Package,
    Related,
    Rule,
    Severity,
    Workspace,
    cached_by_workspace,
    files,
    launch,
)


def check(workspace: Workspace) -> Iterator[Finding]:
    for package in workspace.packages:
        repeated = _installed_repeatedly(package)
        for name, places in repeated.items():
            sources = [package.base_path(place.source) for place in places]
            if len(set(sources)) > 1 and (workspace.unread() or _included(workspace).issuperset(sources)):
                continue
            share = f"share/{package.name}/"
            paths = ", ".join(f"'{place.path.removeprefix(share)}'" for place in places)
            yield Finding(
                f"'{package.name}' installs '{name}' more than once ({paths}), so ros2 launch {package.name} {name} fails; "
                "rename one file, or install it only once",
                files.file_start(sources[0]),
                name,
                tuple(
                    Related(f"'{name}' is installed again here", place.span)
                    if source == sources[0]
                    else Related(f"this file is also installed as '{name}'", files.file_start(source))
                    for place, source in zip(places[1:], sources[1:], strict=True)
                ),
                confidence=Confidence.MEDIUM if _is_set(repeated, places) else Confidence.HIGH,
                package=package.name,
            )


def _is_set(repeated: Mapping[str, Sequence[InstalledFile]], places: Sequence[InstalledFile]) -> bool:
    """Return whether the launch files ``places`` are parts of similar sets of files, e.g. of one set for each robot.

    Their folders are then next to each other and have several file names in common. ``repeated``: the launch files that are
    installed more than once, by name.
    """
    folders = _folders(places)
    return len({folder.rpartition("/")[0] for folder in folders}) == 1 and any(
        len(folders & _folders(others)) > 1 for others in repeated.values() if others is not places
    )


def _folders(places: Iterable[InstalledFile]) -> set[str]:
    return {place.path.rpartition("/")[0] for place in places}


def _installed_repeatedly(package: Package) -> dict[str, list[InstalledFile]]:
    """Return the launch files that a package installs more than once, by name."""
    file_paths = {launch_file.path for launch_file in launch.package_launch_files(package)}
    names: dict[str, dict[str, InstalledFile]] = {}
    for provided in package.built.products.installs if file_paths else ():
        name = provided.path.rpartition("/")[2]
        if provided.source not in file_paths or provided.conditional or not name.endswith(launch.LAUNCH_FILE_NAMES):
            continue
        if provided.path.startswith(f"share/{package.name}/"):
            names.setdefault(name, {}).setdefault(provided.path, provided)
    return {name: list(places.values()) for name, places in names.items() if len(places) > 1}


@cached_by_workspace
def _included(workspace: Workspace) -> frozenset[str]:
    """Return the paths of the launch files that other launch files include."""
    file_paths = (file for package in workspace.packages for file in package.launch)
    return frozenset([inner.path for file in file_paths for inner in launch.include_resolver(workspace).includes(file)])


RULE = Rule(
    name="launch-duplicate-file",
    code="ROS509",
    summary="the launch files of a package have different names",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    workspace=check,
)
