"""``ros-lint order``: print the names of the packages in build order, one per line, or as JSON."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ros_lint.analysis.graph.cycles import cycles
from ros_lint.analysis.graph.dependency_graph import dependency_graph
from ros_lint.cli.commands.output import document

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from ros_lint.analysis.graph.cycles import Cycle
    from ros_lint.analysis.graph.dependency_graph import Graph
    from ros_lint.workspace.model import Workspace


def run(workspace: Workspace, form: str = "text") -> tuple[str, str, int]:
    """Return standard output, standard error and the exit code. ``form`` is the output format, "text" or "json".

    The code is 1 if colcon would reject the workspace because of a cycle or of duplicate package names. The packages that
    can be ordered are printed nevertheless.
    """
    graph = dependency_graph(workspace)
    messages = [*_cycles(graph), *_behind_cycles(graph), *_duplicates(graph)]
    code = int(bool(messages))
    if form == "json":
        return _json(graph, messages), "", code
    return "".join(f"{name}\n" for name in graph.order.names), "".join(f"{line}\n" for line in messages), code


def _json(graph: Graph, messages: Sequence[str]) -> str:
    packages = [{"name": name, "paths": [package.path for package in graph.places[name]]} for name in graph.order.names]
    return document({"packages": packages, "complete": not messages, "problems": list(messages)})


def _cycles(graph: Graph) -> Iterator[str]:
    for cycle in cycles(graph):
        if cycle.certain:
            yield f"no build order, because of a dependency cycle: {', '.join(cycle.names)}"
            yield from _edges(graph, cycle)


def _edges(graph: Graph, cycle: Cycle) -> Iterator[str]:
    edges = tuple(zip(cycle.cycle, (*cycle.cycle[1:], cycle.cycle[0]), strict=True))
    yield f"  shortest cycle: {' -> '.join((*cycle.cycle, cycle.cycle[0]))}"
    for edge in (*edges, *(edge for edge in cycle.cut if edge not in edges)):
        out = "; removing it breaks the cycle" if edge in cycle.cut else ""
        for reason in graph.reasons(edge):
            yield f"    {reason.span}: {edge[0]} depends on {edge[1]} ({reason.tag}){out}"


def _behind_cycles(graph: Graph) -> Iterator[str]:
    on_cycles = {name for cycle in graph.cycles for name in cycle}
    if blocked := [name for name in graph.order.stuck if name not in on_cycles]:
        yield f"no build order, because of a dependency on a package of the cycle: {', '.join(blocked)}"


def _duplicates(graph: Graph) -> Iterator[str]:
    for name, places in graph.places.items():
        if len(places) > 1:
            where = " and ".join(package.path or "." for package in places)
            yield f"{len(places)} packages are named '{name}', so colcon rejects the workspace: {where}"
