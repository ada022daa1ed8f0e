"""Run the commands ``order``, ``why``, ``graph``, ``overlay`` and ``explain-package``."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from typing import Any

from ros_lint.cli.commands import explain_package, explain_silence, graph, order, overlay, why
from ros_lint.cli.commands.graph_part import KINDS, GraphOptions
from ros_lint.cli.commands.query import CommandOutput, current_workspace, run_query
from ros_lint.cli.session import Session, UsageError, no_packages
from ros_lint.workspace.model import Workspace


def _graph(workspace: Workspace, options: Mapping[str, Any]) -> CommandOutput:
    unknown = set(options.get("edges", KINDS)) - set(KINDS)
    if unknown:
        raise UsageError(f"--edges: unknown kind '{min(unknown)}'; available: {', '.join(KINDS)}")
    chosen = GraphOptions(
        options.get("focus", ""),
        options.get("depth", 0),
        options.get("external", False),
        tuple(options.get("edges", KINDS)),
        options.get("reduce", False),
    )
    title = os.path.basename(os.path.realpath(options["paths"][0]))
    return graph.run(workspace, options["format"], chosen, metrics=options.get("metrics", False), title=title)


def _why(workspace: Workspace, options: Mapping[str, Any]) -> CommandOutput:
    names = options["package"], options["dependency"]
    if not options.get("explain-silence"):
        return why.run(workspace, *names, options["format"])
    if options["format"] != "text":
        raise UsageError("--explain-silence prints text only; remove --format")
    return explain_silence.run(workspace, *names)


_COMMANDS: Mapping[str, Callable[[Workspace, Mapping[str, Any]], CommandOutput]] = {
    "order": lambda workspace, options: order.run(workspace, options["format"]),
    "overlay": lambda workspace, options: overlay.run(workspace, options["format"]),
    "graph": _graph,
    "explain-package": lambda workspace, options: explain_package.run(workspace, options["package"], options["format"]),
    "why": _why,
}

_WITH_SOURCES = ("explain-package", "why")
"""Commands for which the sources of the workspace are read; for the others only manifests are read."""


def run(command: str, options: Mapping[str, Any]) -> int:
    """Run one of the commands of this module, print its output and return the exit code."""

    def answer(session: Session, workspace: Workspace) -> CommandOutput:
        out, err, code = _COMMANDS[command](workspace, options)
        return (out, err, code) if workspace.packages else (out, f"{err}ros-lint: {no_packages(session)}\n", 2)

    if command in _WITH_SOURCES and not options.get("paths"):
        options = {**options, "paths": [current_workspace()]}
    return run_query(options, answer, sources=command in _WITH_SOURCES)
