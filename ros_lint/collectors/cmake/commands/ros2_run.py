"""Programs of other packages that the build of a package runs: ``COMMAND ros2 run p program``."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ros_lint.collectors.cmake.evaluator.values import is_known

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ros_lint.collectors.cmake.evaluator.run import Run


def started(run: Run, args: Sequence[str], *, optional: bool = False) -> None:
    """Note the packages whose programs or launch files the commands among some arguments start.

    With ``optional``, the command is there for whoever asks for it.
    """
    for command, verb, package in zip(args, args[1:], args[2:], strict=False):
        if command == "ros2" and verb in ("run", "launch") and is_known(package):
            run.mention(package, "package", run.where(package), f"ros2 {verb} {package}", optional=optional, purpose="tool")
