"""The verb ``colcon ros-lint``."""

import asyncio
import os
import shutil

from colcon_core.event.command import Command
from colcon_core.event_handler import add_event_handler_arguments
from colcon_core.event_reactor import create_event_reactor
from colcon_core.executor import Job
from colcon_core.package_descriptor import PackageDescriptor
from colcon_core.package_selection import add_arguments as add_packages_arguments
from colcon_core.package_selection import get_packages
from colcon_core.plugin_system import satisfies_version
from colcon_core.task import TaskContext
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
        """Add the options that discover and select packages, ``--event-handlers`` and ``--ros-lint-args``."""
        add_packages_arguments(parser)
        add_event_handler_arguments(parser)
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
        job = _job([program, *paths, *context.args.ros_lint_args], context.args)
        with create_event_reactor(context) as reactor:
            job.set_event_queue(reactor.get_queue())
            return asyncio.run(job())


def _job(command, args):
    """Return the job that runs a command. Event handlers report it under the name ros-lint."""
    package = PackageDescriptor(os.getcwd())
    package.name = PROGRAM
    context = TaskContext(pkg=package, args=args, dependencies={})
    return Job(identifier=PROGRAM, dependencies=set(), task=_Check(command), task_context=context)


class _Check:
    """A task that runs a command, which writes to the terminal itself."""

    def __init__(self, command):
        self._command = command
        self._context = None

    def set_context(self, *, context):
        """Keep the context of the job, which takes its events."""
        self._context = context

    async def __call__(self):
        """Run the command and return its exit code."""
        self._context.put_event_into_queue(Command(self._command, cwd=os.getcwd()))
        process = await asyncio.create_subprocess_exec(*self._command)
        return await process.wait()
