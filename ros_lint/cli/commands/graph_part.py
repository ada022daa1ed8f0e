"""Select the part of the dependency graph that the options of ``ros-lint graph`` request, and classify its edges."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from ros_lint.analysis.graph.dependency_graph import Graph, Reason, dependency_graph
from ros_lint.analysis.graph.metrics import measure
from ros_lint.base.suggestions import did_you_mean, similar_names
from ros_lint.cli.session import UsageError
from ros_lint.facts.manifest import DEPENDENCY_KINDS

if TYPE_CHECKING:
    from collections.abc import Collection

    from ros_lint.analysis.graph.dependency_graph import Edge
    from ros_lint.workspace.model import Workspace

KINDS = ("build", "run", "test", "group")
"""Kinds of edges: the phases for which a package depends on another, and "group" for members of a dependency group."""

_Needs = dict[str, dict[str, list[Reason]]]


class GraphOptions(NamedTuple):
    """The options of ``ros-lint graph`` that select packages and edges of the dependency graph."""

    focus: str = ""
    """Name of a package: only this package, its dependencies and its dependents are shown; "" shows all packages."""
    depth: int = 0
    """Maximum number of edges between the package ``focus`` and another package; 0 means no limit."""
    external: bool = False
    """True to show packages and rosdep keys outside of the workspace, too."""
    kinds: tuple[str, ...] = KINDS
    """The kinds of edges to show."""
    reduce: bool = False
    """True to leave out an edge if a longer path connects the same packages."""


def part_of_graph(workspace: Workspace, options: GraphOptions) -> Graph:
    """Return the part of the dependency graph that the options select. Packages outside of the workspace have no places.

    Raises UsageError if the focus is not a package of the graph.
    """
    graph = dependency_graph(workspace)
    if options == GraphOptions():
        return graph
    needs: _Needs = {
        name: {
            dependency: chosen
            for dependency, reasons in dependencies.items()
            if (chosen := [reason for reason in reasons if not set(reason.categories).isdisjoint(options.kinds)])
        }
        for name, dependencies in graph.needs.items()
    }
    if options.external:
        _add_external(workspace, needs, options.kinds)
    part = _graph(graph, needs, needs)
    if options.focus:
        part = _graph(graph, needs, _near(part, options.focus, options.depth))
    if options.reduce:
        implied = implied_edges(part)
        reduced: _Needs = {name: {} for name in part.names}
        for name, dependency in part.edges:
            if (name, dependency) not in implied:
                reduced[name][dependency] = needs[name][dependency]
        part = _graph(graph, reduced, reduced)
    return part


def implied_edges(graph: Graph) -> frozenset[Edge]:
    """Return the edges that are implied by a longer path between the same packages. Edges within a cycle are not returned."""
    return frozenset((path[0], path[-1]) for metrics in measure(graph).values() for path in metrics.redundant)


def edges_in_cycles(graph: Graph) -> frozenset[Edge]:
    """Return the edges that are part of a cycle."""
    member = {name: number for number, names in enumerate(graph.cycles) for name in names}
    return frozenset(edge for edge in graph.edges if edge[0] in member and member[edge[0]] == member.get(edge[1]))


def is_test_only(graph: Graph, edge: Edge) -> bool:
    """Return whether an edge exists only because of test dependencies."""
    return all(reason.categories == ("test",) for reason in graph.reasons(edge))


def _graph(graph: Graph, needs: _Needs, names: Collection[str]) -> Graph:
    """Return a graph of the packages ``names``, with their dependencies from ``needs`` and their places from ``graph``."""
    return Graph(
        {name: graph.places.get(name, ()) for name in names},
        {name: {end: reasons for end, reasons in needs[name].items() if end in names} for name in names},
    )


def _add_external(workspace: Workspace, needs: _Needs, kinds: Collection[str]) -> None:
    """Add the dependencies on packages and rosdep keys outside of the workspace to ``needs``."""
    own = frozenset(needs)
    for package in workspace.packages:
        for declared in package.declared:
            name, phases = declared.name, DEPENDENCY_KINDS[declared.depend.tag].phases
            if name not in own and not set(phases).isdisjoint(kinds):
                reason = Reason(declared.depend.tag, phases, declared.depend.span, declared.certain)
                needs[package.colcon_name].setdefault(name, []).append(reason)
                needs.setdefault(name, {})


def _near(graph: Graph, focus: str, depth: int) -> frozenset[str]:
    """Return the package ``focus``, and its direct and indirect dependencies and dependents within ``depth`` edges.

    A depth of 0 means no limit. Raises UsageError if the graph has no such package.
    """
    if focus not in graph.places:
        hint = did_you_mean(similar_names(focus, graph.names))
        raise UsageError(f"--focus: there is no package '{focus}' in the graph{hint}")
    result = {focus}
    for following in (graph.arcs, graph.needed_by):
        seen = border = {focus}
        distance = 0
        while border and (not depth or distance < depth):
            border = {neighbour for name in border for neighbour in following[name]} - seen
            seen = seen | border
            distance += 1
        result |= seen
    return frozenset(result)
