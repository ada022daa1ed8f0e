"""``python -m ros_lint``. Before anything else, Python is kept from finding modules in the folder that it is called in.

That folder is mostly the workspace: a ``json.py`` in it would run. What Python itself loads to get here is out of reach;
the command ``ros-lint`` loads nothing from there to begin with.
"""

import os
import sys

_HERE = os.path.realpath(os.curdir)
_HOME = os.path.dirname(os.path.dirname(os.path.realpath(__file__)))
sys.path[:] = [entry for entry in sys.path if entry and os.path.realpath(entry) != _HERE]
if _HERE == _HOME:
    sys.path.append(_HOME)  # last, for processes that start afresh
os.environ["PYTHONSAFEPATH"] = "1"  # they look there, too

from ros_lint.cli import run  # noqa: E402

run()
