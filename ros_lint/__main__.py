"""``python -m ros_lint``."""

from ros_lint.cli import run

run()
