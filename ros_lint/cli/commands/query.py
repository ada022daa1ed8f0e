"""Open and load a workspace for the commands that print information about it, such as ``graph``."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Mapping
from typing import Any

from ros_lint.base.paths import is_below, upwards
from ros_lint.cli.context import outermost_package, workspace_around
from ros_lint.cli.messages import show
from ros_lint.cli.progress import Progress
from ros_lint.cli.session import Session, UsageError, open_workspace
from ros_lint.cli.settings import ConfigError
from ros_lint.knowledge.store import KnowledgeError
from ros_lint.reporters.ansi import harmless
from ros_lint.workspace.model import Workspace

CommandOutput = tuple[str, str, int]
"""The text for standard output, the text for standard error, and the exit code."""


def run_query(options: Mapping[str, Any], answer: Callable[[Session, Workspace], CommandOutput], *, sources: bool = True) -> int:
    """Load the requested workspace, print the output that ``answer`` returns for it, and return the exit code in that output.

    The exit code is 2 if the workspace cannot be opened. If ``sources`` is False, only manifests are read.
    """
    progress = Progress(sys.stderr, wanted=options.get("progress", True))
    try:
        with progress:
            session = open_workspace(options, os.environ, progress.update)
            workspace = session.loader.load(sources=sources)
        out, err, code = answer(session, workspace)
    except (UsageError, ConfigError, KnowledgeError) as error:
        show(str(error))
        return 2
    for warning in (*session.settings.warnings, *session.warnings, *session.cache.notes):
        show(warning)
    sys.stdout.write(harmless(out))
    sys.stdout.flush()
    sys.stderr.write(harmless(err))
    return code


def current_workspace() -> str:
    """Return the workspace around the package that contains the current folder; outside a package, the current folder itself."""
    in_package = any(os.path.isfile(os.path.join(folder, "package.xml")) for folder in upwards(os.path.realpath(os.curdir)))
    return enclosing_workspace(os.path.join(os.curdir, "package.xml")) if in_package else os.curdir


def enclosing_workspace(file: str) -> str:
    """Return the folder of the workspace that contains a file. It is the first of these folders that exists:

    - the colcon workspace or the git repository around the file,
    - the current folder, if the file is below it,
    - the folder of the package with the file, or else the folder of the file.
    """
    folder = os.path.dirname(os.path.realpath(file))
    current = os.path.realpath(os.curdir)
    return workspace_around(folder) or (current if is_below(folder, current) else outermost_package(folder))
