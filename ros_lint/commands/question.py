"""Commands that answer a question about a workspace: open it, load it, print the answer."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Mapping
from typing import Any

from ros_lint.config import ConfigError
from ros_lint.knowledge.store import KnowledgeError
from ros_lint.opening import Opened, UsageError, open_workspace
from ros_lint.progress import Progress
from ros_lint.workspace import Workspace

Answer = tuple[str, str, int]
"""What goes to standard output, what to standard error, and the exit code."""


def ask(said: Mapping[str, Any], answer: Callable[[Opened, Workspace], Answer], *, sources: bool = True) -> int:
    """Print what is answered about the workspace that the options name. Returns the exit code, 2 when there is no answer.

    Without ``sources`` only manifests are read.
    """
    progress = Progress(sys.stderr, wanted=said.get("progress", True))
    try:
        with progress:
            opened = open_workspace(said, os.environ, progress.tell)
            workspace = opened.loader.load(sources=sources)
        out, err, code = answer(opened, workspace)
    except (UsageError, ConfigError, KnowledgeError) as error:
        print(f"ros-lint: {error}", file=sys.stderr)
        return 2
    for warning in opened.warnings:
        print(f"ros-lint: {warning}", file=sys.stderr)
    sys.stdout.write(out)
    sys.stdout.flush()
    sys.stderr.write(err)
    return code
