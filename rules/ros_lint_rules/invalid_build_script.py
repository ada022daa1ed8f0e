"""
## What it finds

Build scripts that their tools reject:

- syntax errors in `CMakeLists.txt`, `*.cmake`, `setup.py` and `setup.cfg`, including markers of a merge conflict;
- Python in `setup.py` that is newer than the Python of the chosen distribution;
- `rosidl_generate_interfaces()` without interface files;
- undefined names in `setup.py`;
- calls of a value that is not a function, such as a module, or a tuple after which a comma is missing: `('a', []) ('b', [])`;
- entries of `data_files` that are not a pair of a folder and a list, and destinations outside the install prefix.

## Why it matters

The build stops there. For malformed entries of `data_files`, colcon stops with an AssertionError or TypeError without a line
number.

## How to fix it

Correct the line. An entry of `data_files` is `('share/' + package_name, ['package.xml'])`: a tuple of a folder below the prefix
and a list of files.

## Limitations

Not reported:

- Templates and Python 2.
- Python that is newer than that of the distribution, if no distribution was chosen.
- More than ten lines of a `setup.cfg` that are neither a section nor an option.
- Undefined names and wrong calls in code that catches the error, or that may not run.
- Missing interface files, if a folder of the package is not available, such as a submodule that is not cloned.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import islice

from ros_lint.api import Finding, Package, Rule, Severity, Workspace, too_new

_KINDS = {
    "cmake-syntax": "CMake stops here: ",
    "no-interfaces": "CMake stops here: ",
    "syntax": "",
    "undefined-name": "",
    "no-function": "",
    "setup-cfg-syntax": "",
    "data-files-form": "",
    "absolute-destination": "",
}


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    script = package.script
    if script is None or package.builds_with not in ("ament_cmake", "ament_python", "cmake"):
        return
    for problem in script.problems:
        if problem.kind in _KINDS and not (problem.kind == "no-interfaces" and package.unvisited_folders):
            path = package.relative(problem.span.path)
            yield Finding(f"{_KINDS[problem.kind]}{problem.message}", problem.span, path)
    for problem in islice(too_new(script.python.newer_syntax, workspace.target.chosen), 1):
        yield Finding(problem.message, problem.span, package.relative(problem.span.path))


RULE = Rule(
    name="invalid-build-script",
    code="ROS312",
    summary="build scripts have no syntax errors or other errors that stop CMake or Python",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    package=check,
)
