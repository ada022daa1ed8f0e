"""
## What it finds

A Python launch file that imports a module from its own folder, by name or with a leading dot.

## Why it matters

`ros2 launch` loads only the file itself and adds no folder to `sys.path`. The import fails, although it works if the file is
run by hand: `No module named 'x'`, or `attempted relative import with no known parent package`.

## How to fix it

Make the module part of an installed Python package (`ament_python_install_package`, or `packages=` in `setup.py`) and import it
from there. Or include a launch file instead.

## Limitations

Not reported:

- Launch files that change `sys.path`.
- Imports in `try` or in a function.
- Modules with a name that a workspace, installed or released package, a library or Python itself provides.
- Packages whose build script cannot be fully analysed: it may install Python modules.
- Imports by name, if a file of the workspace cannot be read: it may show that another package has the module.
- Launch files of tests and examples.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import Facet, Finding, Package, Rule, Severity, Workspace, launch


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    if package.hidden(Facet.PYTHON):
        return
    files = frozenset(package.files)
    for launch_file in launch.package_launch_files(package):
        folder = launch_file.path.rpartition("/")[0]
        for name, span in launch_file.file.imports:
            if name.startswith("."):
                yield Finding(
                    f"'{name}' is imported relative to the launch file, which ros2 launch loads without a package; "
                    "import it by name from an installed package",
                    span,
                    name,
                )
            elif _is_sibling(name, folder, files) and not (workspace.unread() or workspace.world.by_import(name).known):
                yield Finding(
                    f"'{name}' is imported from the folder of the launch file, where Python does not look for it; "
                    "import it from an installed package",
                    span,
                    name,
                )


def _is_sibling(name: str, folder: str, files: frozenset[str]) -> bool:
    path = f"{folder}/" if folder else ""
    path += name.replace(".", "/")
    return f"{path}.py" in files or f"{path}/__init__.py" in files


RULE = Rule(
    name="launch-sibling-import",
    code="ROS510",
    summary="launch files import only installed Python modules",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    package=check,
)
