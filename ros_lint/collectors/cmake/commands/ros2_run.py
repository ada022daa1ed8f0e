"""Programs of other packages that a build runs, as in ``COMMAND ros2 run package program``."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ros_lint.collectors.cmake.evaluator.values import is_known

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ros_lint.collectors.cmake.evaluator.run import Run


def note_started_programs(run: Run, args: Sequence[str], *, optional: bool = False) -> None:
    """Record the packages after ``ros2 run`` or ``ros2 launch`` in the arguments of a command.

    ``optional`` is True for a custom target that is not built by default.
    """
    for command, verb, package in zip(args, args[1:], args[2:], strict=False):
        if command == "ros2" and verb in ("run", "launch") and is_known(package):
            quotation = f"ros2 {verb} {package}"
            run.add_mention(package, "package", run.place_of(package), quotation, optional=optional, purpose="tool")
