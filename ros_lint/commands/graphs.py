"""``order``, ``why``, ``graph``, ``overlay`` and ``explain-package``: questions to the model."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Mapping
from typing import Any

from ros_lint.commands import explain_package, graph, order, overlay, silence, why
from ros_lint.config import ConfigError
from ros_lint.knowledge import KnowledgeError
from ros_lint.opening import UsageError, no_packages, open_workspace
from ros_lint.progress import Progress
from ros_lint.workspace import Workspace

Said = Mapping[str, Any]

_COMMANDS: Mapping[str, Callable[[Workspace, Said], tuple[str, str, int]]] = {
    "order": lambda workspace, said: order.run(workspace),
    "overlay": lambda workspace, said: overlay.run(workspace),
    "graph": lambda workspace, said: graph.run(workspace, said["format"], metrics=said.get("metrics", False)),
    "explain-package": lambda workspace, said: explain_package.run(workspace, said["package"], said["format"]),
    "why": lambda workspace, said: (
        silence.run(workspace, said["package"], said["dependency"])
        if said.get("explain-silence")
        else why.run(workspace, said["package"], said["dependency"])
    ),
}

_WITH_SOURCES = ("explain-package", "why")
"""Questions about what the sources say; manifests answer the others."""


def run(command: str, said: Said) -> int:
    """Answer one of the questions, print the answer, return the exit code."""
    progress = Progress(sys.stderr, wanted=said.get("progress", True))
    try:
        with progress:
            opened = open_workspace(said, os.environ, progress.tell)
            workspace = opened.loader.load(sources=command in _WITH_SOURCES)
            out, err, code = _COMMANDS[command](workspace, said)
    except (UsageError, ConfigError, KnowledgeError) as error:
        print(f"ros-lint: {error}", file=sys.stderr)
        return 2
    for warning in opened.warnings:
        print(f"ros-lint: {warning}", file=sys.stderr)
    sys.stdout.write(out)
    sys.stdout.flush()
    sys.stderr.write(err)
    if not workspace.packages:
        print(no_packages(opened), file=sys.stderr)
        return 2
    return code
