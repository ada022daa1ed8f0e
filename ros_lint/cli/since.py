"""The option ``--since``: hide the findings that an earlier commit has, too."""

from __future__ import annotations

import os
import tempfile
from typing import TYPE_CHECKING

from ros_lint.base.tree import repository_of
from ros_lint.cli import git_commits
from ros_lint.cli.checking import check_workspaces
from ros_lint.cli.session import UsageError, open_session
from ros_lint.engine import baseline

if TYPE_CHECKING:
    from collections.abc import Mapping

    from ros_lint.cli.session import Request
    from ros_lint.engine.report import Report
    from ros_lint.workspace.join import Progress


def only_new(report: Report, request: Request, environment: Mapping[str, str], progress: Progress) -> Report:
    """Return a report without the findings that an earlier commit has, too: the merge base of HEAD and ``--since``.

    The files of this commit are written into a temporary folder and checked with the same settings. Findings are compared
    as with a baseline. Raises UsageError and GitError.
    """
    ref = request.settings["since"]
    if repository_of(request.base) != request.base:
        raise UsageError("--since needs paths in a git repository")
    commit = git_commits.merge_base(request.base, ref, environment)
    with tempfile.TemporaryDirectory(prefix="ros-lint-") as temporary:
        folder = os.path.realpath(temporary)
        try:
            git_commits.write_files(request.base, commit, folder, environment)
        except OSError as error:
            raise git_commits.GitError(f"--since: the files of {commit} cannot be written: {error}") from error
        session = open_session(_in_folder(request, folder), progress)
        before = check_workspaces(session, session.loader.load_all(), session.roots)
    return baseline.of(before).hide_known(report, f"the commit {commit[:12]}", request.roots, "also in")


def _in_folder(request: Request, folder: str) -> Request:
    """Return the request for checking a commit whose files are in ``folder``.

    Files that the commit and the workspace share are not analysed again: cached facts are found by the contents of files.
    Nothing is added to the cache, because it would replace the facts of the workspace. Requested folders that
    the commit does not have are left out.
    """

    def existing(paths: tuple[str, ...]) -> tuple[str, ...]:
        return tuple(path for path in paths if os.path.isdir(os.path.join(folder, path)))

    return request._replace(
        base=folder,
        roots=existing(request.roots),
        context=existing(request.context),
        inside=(folder,),
        tracked=None,
        cache=request.cache.for_reading(),
    )
