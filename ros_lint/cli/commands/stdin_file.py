"""``ros-lint --stdin-filename FILE``: check a file whose contents come from standard input, for editors without a server."""

from __future__ import annotations

import os
import sys
from typing import TYPE_CHECKING

from ros_lint.cli.checking import check_workspaces
from ros_lint.cli.session import UsageError, open_session

if TYPE_CHECKING:
    from ros_lint.cli.session import Request
    from ros_lint.engine.report import Report
    from ros_lint.workspace.join import Progress

_WRITING = ("fix", "diff", "since", "write-baseline")


def check(request: Request, progress: Progress) -> tuple[Report, dict[str, bytes]]:
    """Return the report with the findings in the file of ``--stdin-filename``, and its contents by path.

    The other packages of the workspace are read as context. Raises UserError.
    """
    for option in _WRITING:
        if request.settings[option]:
            raise UsageError(f"--stdin-filename and --{option} cannot be combined, because the file is not saved")
    folder, name = os.path.split(request.settings["stdin-filename"])
    path = os.path.relpath(os.path.join(os.path.realpath(folder or "."), name), request.base).replace(os.sep, "/")
    unsaved = {path: sys.stdin.buffer.read()}
    session = open_session(request, progress)
    report = check_workspaces(session, session.loader.load_all(unsaved), session.roots)
    return report._replace(issues=tuple([issue for issue in report.issues if issue.finding.span.path == path])), unsaved
