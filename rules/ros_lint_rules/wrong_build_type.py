"""
## What it finds

A `<build_type>` whose build script does not exist: `ament_cmake` or `cmake` without a `CMakeLists.txt`, `ament_python` without
a `setup.py`.

## Why it matters

The build fails.

## How to fix it

Write the build type of the existing build script, or add the missing script. The fix writes the build type if the script of the
other type exists.

## Limitations

- Types under a condition that is false or has an unknown variable are not reported.
- Unknown types and several types are reported by `unknown-build-type` and `multiple-build-types`.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import Edit, Element, Finding, Fix, Package, Related, Rule, Severity, Workspace, build, names

_SCRIPTS = {"ament_cmake": "CMakeLists.txt", "cmake": "CMakeLists.txt", "ament_python": "setup.py"}


def check(workspace: Workspace) -> Iterator[Finding]:
    for package, exports in build.build_types(workspace):
        if package.files and len(exports) == 1:
            script = _SCRIPTS.get(exports[0].text)
            if script is not None and script not in package.files:
                yield _finding(package, exports[0], script)._replace(package=package.name)


def _finding(package: Package, export: Element, script: str) -> Finding:
    other = "ament_python" if script == "CMakeLists.txt" else "ament_cmake"
    if _SCRIPTS[other] in package.files:
        message = f"'{export.text}' needs a {script}, but the package has a {_SCRIPTS[other]}; write '{other}'"
        fix = Fix(f"write '{other}'", (Edit(export.text_span, other),), safe=False)
        return Finding(message, export.text_span, export.text, fix=fix)
    near = names.similar_names(script.lower(), [file.lower() for file in package.files if "/" not in file], 1, 0.85)
    meant = next((file for file in package.files if near and file.lower() == near[0]), "")
    remedy = f"but the package has a '{meant}'; rename it to {script}" if meant else "which does not exist; add it"
    related = (Related(f"the file '{meant}'", package.start_of(meant)),) if meant else ()
    return Finding(f"'{export.text}' needs a {script}, {remedy}", export.text_span, export.text, related)


RULE = Rule(
    name="wrong-build-type",
    code="ROS108",
    summary="the build script of the build type exists",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    fixable=True,
    workspace=check,
)
