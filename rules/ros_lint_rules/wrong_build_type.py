"""
## What it finds

A `<build_type>` that colcon cannot use:

- an unknown type, such as `ament_cmake_auto` or `python`;
- an empty type;
- two types that apply at the same time;
- a type whose script does not exist, such as `ament_cmake` without a `CMakeLists.txt` and `ament_python` without a `setup.py`.

## Why it matters

For an unknown type `colcon build` prints "No task extension to 'build' a package", builds nothing and returns 0. With two types
it does not recognize the folder as a ROS package. Without the script the build fails.

## How to fix it

Write one of `ament_cmake`, `ament_python`, `cmake`, `ament_cargo` or `ament_gradle`. The fix does this if only one of them is
possible. Keep one of two types, or give each a condition.

## Limitations

- Types under a condition that is false or has an unknown variable are not reported.
- Extensions of colcon can add types. The confidence is medium unless the name is a known mistake or similar to a known type.
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
    dependencies,
    names,
)

_TYPES = ("ament_cmake", "ament_python", "cmake", "catkin", "ament_cargo", "ament_gradle")
_KNOWN = ", ".join(f"'{name}'" for name in _TYPES[:3])
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
        export
        for export in manifest.exports
        if export.tag == "build_type" and dependencies.conditions.truth(dependencies.conditions.of(export), context)
    ]
    if len(active) > 1:
        all_names = " and ".join(f"'{export.text}'" if export.text else "an empty one" for export in active)
        message = f"{len(active)} build types apply to {workspace.target.distro}: {all_names}; keep one, or give each a condition"
        related = tuple(Related("this build type also applies", export.span) for export in active[:-1])
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
    close = [_MISTAKES[name]] if name in _MISTAKES else names.similar_names(name, _TYPES, 1, 0.8)
    if not close:
        message = f"colcon itself has no build type '{name}'; write {_KNOWN}, or another type that it supports"
        return Finding(message, export.text_span, name, confidence=Confidence.MEDIUM)
    fix = Fix(f"write '{close[0]}'", (Edit(export.text_span, close[0]),))
    return Finding(f"there is no build type '{name}'; write '{close[0]}'", export.text_span, name, fix=fix)


def _without_script(package: Package, export: Element) -> Iterator[Finding]:
    script = _SCRIPTS.get(export.text)
    if script is None or script in package.files:
        return
    other = "ament_python" if script == "CMakeLists.txt" else "ament_cmake"
    if _SCRIPTS[other] in package.files:
        message = f"'{export.text}' needs a {script}, but the package has a {_SCRIPTS[other]}; write '{other}'"
        fix = Fix(f"write '{other}'", (Edit(export.text_span, other),), safe=False)
        yield Finding(message, export.text_span, export.text, fix=fix)
    else:
        near = names.similar_names(script.lower(), [file.lower() for file in package.files if "/" not in file], 1, 0.85)
        meant = next((file for file in package.files if near and file.lower() == near[0]), "")
        remedy = f"but the package has a '{meant}'; rename it to {script}" if meant else "which does not exist; add it"
        related = (Related("this file", package.start_of(meant)),) if meant else ()
        yield Finding(f"'{export.text}' needs a {script}, {remedy}", export.text_span, export.text, related)


RULE = Rule(
    name="wrong-build-type",
    code="ROS108",
    summary="build types are known to colcon and match the build script",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    fixable=True,
    workspace=check,
)
