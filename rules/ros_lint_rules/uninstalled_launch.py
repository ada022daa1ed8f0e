"""
## What it finds

Launch files that the package does not install: no `install(DIRECTORY launch ...)`, `install(FILES ...)`,
`ament_auto_package(INSTALL_TO_SHARE ...)` or `data_files` covers them.

## Why it matters

`ros2 launch` and includes look in `share/<package>` of the install space, so they do not find these files. An old copy from an
earlier build may still be found there, and changes of the file have no effect.

## How to fix it

In `CMakeLists.txt`, add `install(DIRECTORY launch DESTINATION share/${PROJECT_NAME})` before `ament_package()`, or add the
folder to an existing rule. The fix does this. In `setup.py`, add to `data_files`: `(os.path.join('share', package_name,
'launch'), glob('launch/*.launch.py'))`. The fix does this if `data_files` is a literal list.

## Limitations

Not reported:

- A part of the build script that cannot be evaluated may install the files, or a file of the package cannot be read.
- The `CMakeLists.txt` contains no command: see `missing-ament-package`.
- Launch files of tests, examples and templates, and those of ROS 1.
- Modules that only create actions for launch files.
- Packages whose names show that they are for tests.
- Files that are installed under a condition.
- Files that a rule excludes while it installs others of their kind (`PATTERN x EXCLUDE`).
- A file of the same name is installed from another folder: the files are variants, and one of them is chosen.
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
    edits,
    files,
    first_related,
    launch,
    names,
)


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    script = package.script
    if script is None or script.is_empty or package.builds_with not in ("ament_cmake", "ament_python"):
        return
    if package.hidden(Facet.SHARE) or workspace.unread(package) or files.is_for_tests(package.name):
        return
    missing: dict[str, list[str]] = {}
    kept: set[str] = set()
    all_names = {provided.path.rpartition("/")[2] for provided in script.products.installs}
    for launch_file in launch.package_launch_files(package):
        folder, _, name = launch_file.path.rpartition("/")
        if launch_file.installed:
            kept.update(files.folders_of(launch_file.path))
        elif name not in all_names:
            missing.setdefault(folder, []).append(launch_file.path)
    for folder, paths in _grouped(missing, kept).items():
        whole = folder not in kept and folder != ""
        uninstalled = (
            paths
            if whole
            else [path for path in paths if launch.launch_suffix(path) and not launch.is_excluded_from_install(package, path)]
        )
        if uninstalled:
            yield _finding(package, folder, uninstalled, whole=whole)


def _grouped(missing: Mapping[str, list[str]], kept: set[str]) -> dict[str, list[str]]:
    """Return the uninstalled launch files, grouped by folder. Files of subfolders are in the group of the outermost folder.

    ``kept``: folders with installed files. Files of their subfolders form groups of their own.
    """
    groups: dict[str, list[str]] = {}
    for folder in sorted(missing):
        outer = next((above for above in files.folders_of(f"{folder}/") if above in groups and above not in kept), folder)
        groups.setdefault(outer, []).extend(missing[folder])
    return groups


def _finding(package: Package, folder: str, paths: Iterable[str], whole: bool) -> Finding:
    script = package.script
    assert script is not None
    paths = sorted(paths)
    named = names.shorten_list(path.rpartition("/")[2] for path in paths)
    it = "it" if len(paths) == 1 else "them"
    if whole:
        what = f"'{folder}/' contains launch files ({named}), but is not installed"
    else:
        what = f"{named} {'is' if len(paths) == 1 else 'are'} not installed"
    place = edits.cmake.install_folder_place(package) if whole else None
    remedy = "add it to this install(DIRECTORY)" if place else f"install {'it' if whole else it} to share/{package.name}"
    return Finding(
        f"{what}, so ros2 launch will not find {it}; {remedy}",
        place or edits.setup_py.place(script),
        folder or paths[0],
        first_related(Related(f"the launch file '{path}'", package.start_of(path)) for path in paths),
        _fix(package, folder, paths, whole),
    )


def _fix(package: Package, folder: str, paths: Sequence[str], whole: bool) -> Fix | None:
    script = package.script
    if script is not None and script.path.endswith("setup.py"):
        return _fix_of_setup(package, folder, paths, whole)
    if script is None:
        return None
    if whole:
        return Fix.of(f"install '{folder}/'", edits.cmake.install_folder(package, folder))
    # In the same place as installed files of the folder, if there are any.
    inner = folder.rpartition("/")[2] or "launch"
    return Fix.of(f"install {_list(paths)}", edits.cmake.install_files(script, paths, inner))


def _fix_of_setup(package: Package, folder: str, paths: Iterable[str], whole: bool) -> Fix | None:
    slot = edits.setup_py.slot(package.built, "data_files")
    if slot is None or not all("/" in path for path in paths):  # a launch file next to setup.py
        return None
    edit = edits.setup_py.add_files(slot, package.name, paths, package.files)
    return Fix(f"install {_list([f'{folder}/'] if whole else sorted(paths))}", (edit,))


def _list(paths: Sequence[str]) -> str:
    return " and ".join(f"'{path}'" for path in paths)


RULE = Rule(
    name="uninstalled-launch",
    code="ROS401",
    summary="launch files are installed",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
