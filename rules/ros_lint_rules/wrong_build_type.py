"""
## What it finds

A `<build_type>` that colcon cannot use: one that no part of colcon builds, such as `ament_cmake_auto` or `python`; one
that is empty; two that count at the same time; or one whose script is not there, such as `ament_cmake` without a
`CMakeLists.txt` and `ament_python` without a `setup.py`.

## Why it matters

For an unknown type `colcon build` prints "No task extension to 'build' a package", builds nothing and returns 0. With two
types it takes the folder for no ROS package. Without the script the build fails.

## How to fix it

Write one of `ament_cmake`, `ament_python`, `cmake`, `ament_cargo` or `ament_gradle`. Where it is clear which one is meant,
the fix does this. Keep one of two types, or give each a condition.

## Limitations

For types under a condition that is false or has an unknown variable. Extensions of colcon can bring more types: the
confidence is medium unless the name is a known mistake or close to a known type.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import (
    Confidence,
    Edit,
    Element,
    Finding,
    Fix,
    Manifest,
    Package,
    Related,
    Rule,
    Severity,
    Workspace,
    conditions,
    place_of,
    similar,
)

_TYPES = ("ament_cmake", "ament_python", "cmake", "catkin", "ament_cargo", "ament_gradle")
_MISTAKES = {
    "ament_cmake_auto": "ament_cmake",
    "ament_cmake_python": "ament_cmake",
    "ament_cmake_ros": "ament_cmake",
    "ament": "ament_cmake",
    "ament_auto": "ament_cmake",
    "autoware_cmake": "ament_cmake",
    "python": "ament_python",
    "python3": "ament_python",
    "setup_py": "ament_python",
    "setuptools": "ament_python",
    "cargo": "ament_cargo",
    "gradle": "ament_gradle",
}
_SCRIPTS = {"ament_cmake": "CMakeLists.txt", "cmake": "CMakeLists.txt", "ament_python": "setup.py"}


def check(workspace: Workspace) -> Iterator[Finding]:
    for package in (*workspace.packages, *workspace.unusable):
        if package.manifest and not package.manifest.problems:
            for finding in _of_package(package, package.manifest, workspace):
                yield finding._replace(package=package.name)


def _of_package(package: Package, manifest: Manifest, workspace: Workspace) -> Iterator[Finding]:
    context = workspace.target.context
    active = [
        export for export in manifest.exports if export.tag == "build_type" and conditions.truth(conditions.of(export), context)
    ]
    if len(active) > 1:
        names = " and ".join(export.text or "an empty one" for export in active)
        message = f"{len(active)} build types count for {workspace.target.distro}: {names}; keep one, or give each a condition"
        related = tuple(Related("this one counts, too", export.span) for export in active[:-1])
        yield Finding(message, active[-1].span, "build_type", related)
    for export in active:
        if not export.text:
            yield Finding("<build_type> is empty; write ament_cmake or ament_python", export.span, "build_type")
        elif export.text not in _TYPES:
            yield _unknown(export)
        elif package.files and len(active) == 1:
            yield from _without_script(package, export)


def _unknown(export: Element) -> Finding:
    name = export.text
    close = [_MISTAKES[name]] if name in _MISTAKES else similar(name, _TYPES, 1, 0.8)
    if not close:
        message = f"colcon has no build type {name} of its own; write {', '.join(_TYPES[:3])} or another that it has"
        return Finding(message, export.text_span, name, confidence=Confidence.MEDIUM)
    fix = Fix(f"write {close[0]}", (Edit(export.text_span, close[0]),))
    return Finding(f"there is no build type {name}; write {close[0]}", export.text_span, name, fix=fix)


def _without_script(package: Package, export: Element) -> Iterator[Finding]:
    script = _SCRIPTS.get(export.text)
    if script is None or script in package.files:
        return
    other = "ament_python" if script == "CMakeLists.txt" else "ament_cmake"
    if _SCRIPTS[other] in package.files:
        message = f"{export.text} needs a {script}, and here is a {_SCRIPTS[other]}; write {other}"
        fix = Fix(f"write {other}", (Edit(export.text_span, other),), safe=False)
        yield Finding(message, export.text_span, export.text, fix=fix)
    else:
        near = similar(script.lower(), [file.lower() for file in package.files if "/" not in file], 1, 0.85)
        meant = next((file for file in package.files if near and file.lower() == near[0]), "")
        way_out = f"and here is {meant}: call it {script}" if meant else "which is not there; add it"
        related = (Related("this file", place_of(package, meant)),) if meant else ()
        yield Finding(f"{export.text} needs a {script}, {way_out}", export.text_span, export.text, related)


RULE = Rule(
    name="wrong-build-type",
    code="ROS108",
    summary="the build type must be one that colcon can build from what the folder holds",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    fixable=True,
    workspace=check,
)
