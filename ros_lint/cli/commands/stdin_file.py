"""``ros-lint --stdin-filename FILE``: check a file whose contents come from standard input, for editors without a server."""

from __future__ import annotations

import os
import sys
from typing import TYPE_CHECKING, Any

from ros_lint.cli.checking import check_workspaces
from ros_lint.cli.session import Request, UsageError, open_session, parse_request

if TYPE_CHECKING:
    from collections.abc import Mapping

    from ros_lint.engine.report import Report
    from ros_lint.workspace.join import Progress

_WRITING = ("fix", "diff", "since", "write-baseline")


def check(options: Mapping[str, Any], progress: Progress) -> tuple[Request, Report, dict[str, bytes]]:
    """Return the request for the package of the file, the report with the findings in the file, and the contents by path.

    The other packages of the workspace are read as context. Raises UserError.
    """
    name = str(options["stdin-filename"])
    request = parse_request({**options, "paths": [name if os.path.exists(name) else os.path.dirname(name) or "."]}, os.environ)
    for option in _WRITING:
        if request.settings[option]:
            raise UsageError(f"--stdin-filename and --{option} cannot be combined, because the file is not saved")
    path = os.path.relpath(os.path.join(os.path.realpath(os.path.dirname(name) or "."), os.path.basename(name)), request.base)
    unsaved = {path.replace(os.sep, "/"): sys.stdin.buffer.read()}
    session = open_session(request, progress)
    report = check_workspaces(session, session.loader.load_all(unsaved), session.roots, changed=unsaved)
    return (
        request,
        report._replace(issues=tuple([issue for issue in report.issues if issue.finding.span.path in unsaved])),
        unsaved,
    )
