"""``python -m ros_lint``."""

from ros_lint.start import run

run()
