"""
## What it finds

Launch files that the package does not install: no `install(DIRECTORY launch ...)`, `install(FILES ...)`,
`ament_auto_package(INSTALL_TO_SHARE ...)` or `data_files` covers them.

## Why it matters

`ros2 launch` and includes look into `share/<package>` of the install space, so they do not find these files. With a
sourced workspace of yesterday they may still find an old copy, and the change of today does nothing.

## How to fix it

In `CMakeLists.txt` add `install(DIRECTORY launch DESTINATION share/${PROJECT_NAME})` before `ament_package()`, or the folder
to a rule that installs others so; the fix does this. In `setup.py` add to `data_files`:
`(os.path.join('share', package_name, 'launch'), glob('launch/*.launch.py'))`; the fix does this, too, where `data_files` is
written out.

## Limitations

- A part of the build script that cannot be followed may install the files, or a file of the package cannot be read.
- A `CMakeLists.txt` has no command at all: that is a matter of `missing-ament-package`.
- Launch files of tests, examples and templates, those of ROS 1, and modules that only build actions for launch files;
  packages for tests, going by their names.
- Files that are installed under a condition, and those that a rule leaves out which installs others of their kind
  (`PATTERN x EXCLUDE`).
- A file of the same name is installed from another folder: these are variants, of which one is chosen.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence

from ros_lint.api import (
    Facet,
    Finding,
    Fix,
    Package,
    Related,
    Rule,
    Severity,
    Workspace,
    cmake_edits,
    few,
    folders_of,
    is_for_tests,
    is_kept_back,
    launch_suffix,
    launchable,
    place_of,
    setup_edits,
    several,
)


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    script = package.script
    if script is None or script.is_empty or package.builds_with not in ("ament_cmake", "ament_python"):
        return
    if package.hidden(Facet.SHARE) or workspace.unread(package) or is_for_tests(package.name):
        return
    missing: dict[str, list[str]] = {}
    kept: set[str] = set()
    names = {provided.path.rpartition("/")[2] for provided in script.provides}
    for launch in launchable(package):
        folder, _, name = launch.path.rpartition("/")
        if launch.installed:
            kept.update(folders_of(launch.path))
        elif name not in names:
            missing.setdefault(folder, []).append(launch.path)
    for folder, paths in _together(missing, kept).items():
        whole = folder not in kept and folder != ""
        forgotten = paths if whole else [path for path in paths if launch_suffix(path) and not is_kept_back(package, path)]
        if forgotten:
            yield _finding(package, folder, forgotten, whole=whole)


def _together(missing: Mapping[str, list[str]], kept: set[str]) -> dict[str, list[str]]:
    """Count the files of a folder to an outer one that lacks files too, if nothing of that one is installed."""
    found: dict[str, list[str]] = {}
    for folder in sorted(missing):
        outer = next((above for above in folders_of(f"{folder}/") if above in found and above not in kept), folder)
        found.setdefault(outer, []).extend(missing[folder])
    return found


def _finding(package: Package, folder: str, paths: Iterable[str], whole: bool) -> Finding:
    script = package.script
    assert script is not None
    paths = sorted(paths)
    named = few(path.rpartition("/")[2] for path in paths)
    it = "it" if len(paths) == 1 else "them"
    if whole:
        what = f"{folder}/ has launch files ({named}), but is not installed"
    else:
        what = f"{named} {'is' if len(paths) == 1 else 'are'} not installed"
    return Finding(
        f"{what}: ros2 launch will not find {it}; install {'it' if whole else it} to share/{package.name}",
        setup_edits.place(script),
        folder or paths[0],
        several(Related("this launch file", place_of(package, path)) for path in paths),
        _fix(package, folder, paths, whole),
    )


def _fix(package: Package, folder: str, paths: Sequence[str], whole: bool) -> Fix | None:
    script = package.script
    if script is not None and script.path.endswith("setup.py"):
        return _fix_of_setup(package, folder, paths, whole)
    if script is None:
        return None
    if whole:
        return Fix.of(f"install {folder}/", cmake_edits.install_folder(package, folder))
    # Beside the files of that folder which are installed, if it has some.
    inner = folder.rpartition("/")[2] or "launch"
    return Fix.of(f"install {' '.join(paths)}", cmake_edits.install_files(script, paths, inner))


def _fix_of_setup(package: Package, folder: str, paths: Iterable[str], whole: bool) -> Fix | None:
    slot = setup_edits.slot(package.built, "data_files")
    if slot is None or not all("/" in path for path in paths):  # one beside setup.py itself
        return None
    edit = setup_edits.add_files(slot, package.name, paths, package.files)
    return Fix(f"install {f'{folder}/' if whole else ' '.join(sorted(paths))}", (edit,))


RULE = Rule(
    name="uninstalled-launch",
    code="ROS401",
    summary="launch files must be installed",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
