"""Run the command line as ``python -m ros_lint``."""

from ros_lint.cli.start import run

run()
