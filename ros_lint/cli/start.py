"""The start of the process, for the command ``ros-lint`` and for ``python -m ros_lint``.

The current folder is mostly the workspace, and a ``json.py`` in it would run. So it leaves the path of modules before anything
but ``os`` and ``sys`` is imported. What Python itself loads to get here is out of reach: at the start if ``PYTHONPATH`` has
an empty entry, and for ``python -m``.
"""

import os
import sys


def run() -> None:
    """Run the command of this process and end it."""
    leave_current_folder()
    from ros_lint.cli import main as cli  # noqa: PLC0415  (imports more, which the current folder must not have)

    cli.run()


def leave_current_folder() -> None:
    """Take the current folder off the path of modules, also of the processes that this one starts.

    If this package lies in the current folder, the folder becomes the last entry.
    """
    try:
        here = os.path.realpath(os.curdir)
    except OSError:
        return  # the folder is gone, and no module is in it
    sys.path[:] = _without(here, sys.path)
    home = os.path.dirname(os.path.dirname(os.path.realpath(__file__)))
    if here == home:
        sys.path.append(home)
    os.environ["PYTHONSAFEPATH"] = "1"
    if path := os.environ.get("PYTHONPATH"):
        os.environ["PYTHONPATH"] = os.pathsep.join(_without(here, path.split(os.pathsep)))


def _without(folder: str, path: list[str]) -> list[str]:
    """Return the entries of a path that lead elsewhere. An empty entry means the current folder."""
    return [entry for entry in path if entry and os.path.realpath(entry) != folder]
