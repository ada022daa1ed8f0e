"""
## What it finds

A Python launch file that imports a module from its own folder, by its name or with a leading dot.

## Why it matters

`ros2 launch` loads the file alone, and adds no folder to the places where Python looks. So the import fails, although it
works when the file is run by hand: `No module named 'x'`, or `attempted relative import with no known parent package`.

## How to fix it

Make the module part of a Python package that is installed (`ament_python_install_package`, or `packages=` in `setup.py`)
and import it from there; or include a launch file instead.

## Limitations

- The launch file changes `sys.path`.
- The import is guarded, or inside a function.
- Somebody offers a module of that name: a package of the workspace, one that is installed or released, a library, or Python
  itself.
- A part of the package's build script that cannot be followed may install Python modules, or a file of the workspace cannot be
  read: it may say that another package has the module.
- Launch files of tests and examples.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import Facet, Finding, Package, Rule, Severity, Workspace, launchable


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    if package.hidden(Facet.PYTHON):
        return
    files = frozenset(package.files)
    for launch in launchable(package):
        folder = launch.path.rpartition("/")[0]
        for name, span in launch.file.imports:
            if name.startswith("."):
                yield Finding(
                    f"{name} is imported relative to the launch file, which ros2 launch loads without a package; "
                    "import it by its name from one that is installed",
                    span,
                    name,
                )
            elif _is_sibling(name, folder, files) and not (workspace.unread() or workspace.world.by_import(name).known):
                yield Finding(
                    f"{name} is imported from the folder of the launch file, where ros2 launch does not look; "
                    "import it from a package that is installed",
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
    summary="a launch file must import only what is installed as a Python module",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    package=check,
)
