"""The verb ``colcon ros-lint``."""

import os
import shutil
import subprocess

from colcon_core.package_selection import add_arguments as add_packages_arguments
from colcon_core.package_selection import get_packages
from colcon_core.plugin_system import satisfies_version
from colcon_core.verb import VerbExtensionPoint, logger

PROGRAM = "ros-lint"
FAILED = 2
"""The exit code of ros-lint if the check could not be done."""


class RosLintVerb(VerbExtensionPoint):
    """Check a set of packages with ros-lint."""

    def __init__(self):
        super().__init__()
        satisfies_version(VerbExtensionPoint.EXTENSION_POINT_VERSION, "^1.0")

    def add_arguments(self, *, parser):
        """Add the options that discover and select packages, and ``--ros-lint-args``."""
        add_packages_arguments(parser)
        parser.add_argument(
            "--ros-lint-args",
            nargs="*",
            metavar="*",
            type=str.lstrip,
            default=[],
            help="Pass arguments to ros-lint. Arguments which match other options must be prefixed by a space",
        )

    def main(self, *, context):
        """Run ros-lint once for all selected packages and return its exit code."""
        program = shutil.which(PROGRAM)
        if program is None:
            logger.error("the program '%s' is not installed, or not in PATH", PROGRAM)
            return FAILED
        decorators = get_packages(context.args, recursive_categories=("run",))
        paths = [os.path.abspath(str(decorator.descriptor.path)) for decorator in decorators if decorator.selected]
        if not paths:
            logger.warning("no package is selected")
            return 0
        return subprocess.call([program, *paths, *context.args.ros_lint_args])
