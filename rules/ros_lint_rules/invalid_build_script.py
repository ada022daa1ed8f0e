"""
## What it finds

Build scripts that their tools refuse: syntax errors in `CMakeLists.txt`, `*.cmake`, `setup.py` and `setup.cfg`, marks of a
merge conflict among them; Python in a `setup.py` that came after the Python of the distribution that was asked for;
`rosidl_generate_interfaces()` without any interface file; names in a `setup.py` that nothing defines, and calls of what cannot
be called: a module, or the tuple before a comma that is missing; entries of `data_files` that are no pair of a folder and a
list, and destinations outside the install prefix.

## Why it matters

The build stops there. For entries of the wrong form, colcon stops with an AssertionError or TypeError that names no line.

## How to fix it

Correct the place. An entry of `data_files` is `('share/' + package_name, ['package.xml'])`: a tuple of a folder below the
prefix and a list of files.

## Limitations

For templates and for Python 2. About Python that is newer than that of the distribution, where no distribution was asked for.
About names and calls where an error is caught, or where it is not known whether `setup.py` comes there. About interfaces where
a folder of the package has not been fetched, such as a submodule.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import islice

from ros_lint.api import Finding, Package, Rule, Severity, Workspace, relative, too_new

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
        if problem.kind in _KINDS and not (problem.kind == "no-interfaces" and package.unseen):
            path = relative(package, problem.span.path)
            yield Finding(f"{_KINDS[problem.kind]}{problem.message}", problem.span, path)
    for problem in islice(too_new(script.syntax, workspace.target), 1):
        yield Finding(problem.message, problem.span, relative(package, problem.span.path))


RULE = Rule(
    name="invalid-build-script",
    code="ROS312",
    summary="a build script must be readable for its tool",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    package=check,
)
