"""The start of the process, for the command ``ros-lint`` and for ``python -m ros_lint``.

The current folder is usually the workspace, and Python would import a ``json.py`` from it. So the folder is removed
from the module path before anything but ``os`` and ``sys`` is imported. Python itself may import modules from the folder
before this module runs: always for ``python -m``, and at start-up if ``PYTHONPATH`` has an empty entry.
"""

import os
import sys


def run() -> None:
    """Remove the current folder from the module path, run the command of this process, and exit."""
    leave_current_folder()
    from ros_lint.cli import main as cli  # noqa: PLC0415  (its imports must not come from the current folder)

    cli.run()


def leave_current_folder() -> None:
    """Remove the current folder from the module path (``sys.path``) of this process and its child processes.

    If ros-lint itself is in the current folder, the folder becomes the last entry instead.
    """
    try:
        current = os.path.realpath(os.curdir)
    except OSError:
        return  # the folder does not exist any more and contains no module
    sys.path[:] = _without(current, sys.path)
    home = os.path.dirname(os.path.dirname(os.path.realpath(__file__)))
    if current == home:
        sys.path.append(home)
    os.environ["PYTHONSAFEPATH"] = "1"
    if path := os.environ.get("PYTHONPATH"):
        os.environ["PYTHONPATH"] = os.pathsep.join(_without(current, path.split(os.pathsep)))


def _without(folder: str, path: list[str]) -> list[str]:
    """Return the entries of a module path without those for ``folder``.

    Empty entries, which mean the current folder, are removed, too.
    """
    return [entry for entry in path if entry and os.path.realpath(entry) != folder]
