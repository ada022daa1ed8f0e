"""Shared code of the commands that query a workspace: open and load it, print the output."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Mapping
from typing import Any

from ros_lint.base.paths import upwards
from ros_lint.base.tree import repository_of
from ros_lint.cli.progress import Progress
from ros_lint.cli.session import Session, UsageError, open_workspace
from ros_lint.cli.settings import ConfigError
from ros_lint.knowledge.store import KnowledgeError
from ros_lint.workspace.model import Workspace

CommandOutput = tuple[str, str, int]
"""Standard output, standard error and the exit code."""


def run_query(options: Mapping[str, Any], answer: Callable[[Session, Workspace], CommandOutput], *, sources: bool = True) -> int:
    """Load the requested workspace, print what ``answer`` returns for it, and return the exit code of the answer.

    The exit code is 2 if the workspace cannot be opened. Without ``sources`` only manifests are read.
    """
    progress = Progress(sys.stderr, wanted=options.get("progress", True))
    try:
        with progress:
            session = open_workspace(options, os.environ, progress.update)
            workspace = session.loader.load(sources=sources)
        out, err, code = answer(session, workspace)
    except (UsageError, ConfigError, KnowledgeError) as error:
        print(f"ros-lint: {error}", file=sys.stderr)
        return 2
    for warning in (*session.settings.warnings, *session.warnings):
        print(f"ros-lint: {warning}", file=sys.stderr)
    sys.stdout.write(out)
    sys.stdout.flush()
    sys.stderr.write(err)
    return code


def current_workspace() -> str:
    """Return the workspace of the package that contains the current folder; else the current folder itself."""
    in_package = any(os.path.isfile(os.path.join(folder, "package.xml")) for folder in upwards(os.path.realpath(os.curdir)))
    return enclosing_workspace(os.path.join(os.curdir, "package.xml")) if in_package else os.curdir


def enclosing_workspace(file: str) -> str:
    """Return the folder of the workspace that contains a file: the first of these that exists.

    - the folder whose ``src`` contains the package of the file, if the folder is in the same repository or colcon has
      built in it,
    - the repository,
    - the current folder, if the file is below it,
    - the folder of the package, or else of the file.
    """
    folders = list(upwards(os.path.dirname(os.path.realpath(file))))
    repository = repository_of(folders[0])
    inside = folders[: folders.index(repository) + 1] if repository else folders
    # The outermost package, because colcon does not look for packages inside of packages.
    packages = [folder for folder in inside if os.path.isfile(os.path.join(folder, "package.xml"))]
    start = packages[-1] if packages else folders[0]
    for folder in folders[folders.index(start) + 1 :]:
        above = os.path.dirname(folder)
        built = any(os.path.isdir(os.path.join(above, name)) for name in ("build", "install", "log"))
        if os.path.basename(folder) == "src" and (built or (repository and above in inside)):
            return above
    current = os.path.realpath(os.curdir)
    return repository or (current if current in folders else start)
