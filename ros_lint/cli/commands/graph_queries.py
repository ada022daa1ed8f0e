"""The commands ``order``, ``why``, ``graph``, ``overlay`` and ``explain-package``."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from ros_lint.cli.commands import explain_package, graph, order, overlay, why
from ros_lint.cli.commands import explain_silence as silence
from ros_lint.cli.commands.query import CommandOutput, current_workspace, run_query
from ros_lint.cli.session import Session, no_packages
from ros_lint.workspace.model import Workspace

Said = Mapping[str, Any]

_COMMANDS: Mapping[str, Callable[[Workspace, Said], CommandOutput]] = {
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
"""Commands that need the sources; the others need only the manifests."""


def run(command: str, options: Said) -> int:
    """Run one of the commands, print the answer, return the exit code."""

    def answer(session: Session, workspace: Workspace) -> CommandOutput:
        out, err, code = _COMMANDS[command](workspace, options)
        return (out, err, code) if workspace.packages else (out, f"{err}{no_packages(session)}\n", 2)

    if command in _WITH_SOURCES and not options.get("paths"):
        options = {**options, "paths": [current_workspace()]}
    return run_query(options, answer, sources=command in _WITH_SOURCES)
