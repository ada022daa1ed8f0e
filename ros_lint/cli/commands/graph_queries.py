"""The commands ``order``, ``why``, ``graph``, ``overlay`` and ``explain-package``."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from ros_lint.cli.commands import explain_package, explain_silence, graph, order, overlay, why
from ros_lint.cli.commands.query import CommandOutput, current_workspace, run_query
from ros_lint.cli.session import Session, no_packages
from ros_lint.workspace.model import Workspace

_COMMANDS: Mapping[str, Callable[[Workspace, Mapping[str, Any]], CommandOutput]] = {
    "order": lambda workspace, options: order.run(workspace),
    "overlay": lambda workspace, options: overlay.run(workspace),
    "graph": lambda workspace, options: graph.run(workspace, options["format"], metrics=options.get("metrics", False)),
    "explain-package": lambda workspace, options: explain_package.run(workspace, options["package"], options["format"]),
    "why": lambda workspace, options: (
        explain_silence.run(workspace, options["package"], options["dependency"])
        if options.get("explain-silence")
        else why.run(workspace, options["package"], options["dependency"])
    ),
}

_WITH_SOURCES = ("explain-package", "why")
"""Commands that need the sources; the others need only the manifests."""


def run(command: str, options: Mapping[str, Any]) -> int:
    """Run ``command``, one of the commands of this module, print its output and return the exit code."""

    def answer(session: Session, workspace: Workspace) -> CommandOutput:
        out, err, code = _COMMANDS[command](workspace, options)
        return (out, err, code) if workspace.packages else (out, f"{err}{no_packages(session)}\n", 2)

    if command in _WITH_SOURCES and not options.get("paths"):
        options = {**options, "paths": [current_workspace()]}
    return run_query(options, answer, sources=command in _WITH_SOURCES)
