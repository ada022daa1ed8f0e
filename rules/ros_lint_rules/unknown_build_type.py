"""
## What it finds

A `<build_type>` that colcon does not know, such as `ament_cmake_auto` or `python`, or that is empty.

## Why it matters

`colcon build` prints "No task extension to 'build' a package", builds nothing and returns 0.

## How to fix it

Write one of `ament_cmake`, `ament_python`, `cmake`, `ament_cargo` or `ament_gradle`. The fix does this if only one of them is
possible.

## Limitations

- Types under a condition that is false or has an unknown variable are not reported.
- Extensions of colcon can add types. The confidence is medium unless the name is a known mistake or similar to a known type.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import Confidence, Edit, Element, Finding, Fix, Rule, Severity, Workspace, build, names

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


def check(workspace: Workspace) -> Iterator[Finding]:
    for package, exports in build.build_types(workspace):
        for export in exports:
            if not export.text:
                message = "<build_type> is empty; write 'ament_cmake' or 'ament_python'"
                yield Finding(message, export.span, "build_type", package=package.name)
            elif export.text not in _TYPES:
                yield _unknown(export)._replace(package=package.name)


def _unknown(export: Element) -> Finding:
    name = export.text
    close = [_MISTAKES[name]] if name in _MISTAKES else names.similar_names(name, _TYPES, 1, 0.8)
    if not close:
        message = f"colcon itself has no build type '{name}'; write {_KNOWN}, or the type of a colcon extension"
        return Finding(message, export.text_span, name, confidence=Confidence.MEDIUM)
    fix = Fix(f"write '{close[0]}'", (Edit(export.text_span, close[0]),))
    return Finding(f"there is no build type '{name}'; write '{close[0]}'", export.text_span, name, fix=fix)


RULE = Rule(
    name="unknown-build-type",
    code="ROS119",
    summary="build types are known to colcon",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    fixable=True,
    workspace=check,
)
