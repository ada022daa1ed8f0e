"""The part of the dependency graph that ``ros-lint graph`` draws: chosen packages and edges, each with what a drawing shows."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from ros_lint.analysis.graph.dependency_graph import Graph, Reason, dependency_graph, reverse
from ros_lint.base.suggestions import did_you_mean, similar_names
from ros_lint.cli.session import UsageError
from ros_lint.facts.manifest import DEPENDENCY_KINDS

if TYPE_CHECKING:
    from collections.abc import Collection, Mapping, Sequence

    from ros_lint.workspace.model import Workspace

KINDS = ("build", "run", "test", "group")
"""The phases for which a package depends on another, and "group" for members of a group."""


class ViewOptions(NamedTuple):
    """What to draw."""

    focus: str = ""
    """Name of a package: only it, its dependencies and its dependents are drawn; "" draws all packages."""
    depth: int = 0
    """Largest number of edges between the focus and another package; 0 is no limit."""
    external: bool = False
    """True to draw packages and rosdep keys outside of the workspace, too."""
    kinds: tuple[str, ...] = KINDS
    """The kinds of edges to draw."""
    reduce: bool = False
    """True to leave out edges that longer paths imply."""


class ViewNode(NamedTuple):
    """A package to draw."""

    name: str
    path: str
    """Folder relative to the base, "." for the base; "" for a package outside of the workspace."""
    type: str
    """Type as colcon prints it; "" for a package outside of the workspace."""


class ViewEdge(NamedTuple):
    """A dependency to draw."""

    start: str
    end: str
    reasons: tuple[Reason, ...]
    test_only: bool
    """True if the dependency only serves tests."""
    in_cycle: bool
    implied: bool
    """True if a longer path leads from ``start`` to ``end``."""


class GraphView(NamedTuple):
    """The packages, sorted by name, and the dependencies to draw."""

    nodes: tuple[ViewNode, ...]
    edges: tuple[ViewEdge, ...]


def view(workspace: Workspace, options: ViewOptions) -> GraphView:
    """Return what to draw of the dependency graph. Raises UsageError if the focus is not a package of the graph."""
    graph = dependency_graph(workspace)
    needs = _chosen(graph.needs, options.kinds)
    if options.external:
        needs = _with_external(workspace, needs, options.kinds)
    arcs = {name: frozenset(dependencies) for name, dependencies in needs.items()}
    names = _near(arcs, options.focus, options.depth) if options.focus else frozenset(arcs)
    arcs = {name: arcs[name] & names for name in sorted(names)}
    knots = _knots(graph)
    implied = _implied(arcs, knots)
    edges = tuple(
        [
            ViewEdge(
                name,
                dependency,
                tuple(needs[name][dependency]),
                all(reason.categories == ("test",) for reason in needs[name][dependency]),
                name in knots and knots[name] == knots.get(dependency),
                (name, dependency) in implied,
            )
            for name in arcs
            for dependency in sorted(arcs[name])
        ]
    )
    nodes = tuple([_node(graph, name) for name in arcs])
    return GraphView(nodes, tuple([edge for edge in edges if not (options.reduce and edge.implied)]))


def _node(graph: Graph, name: str) -> ViewNode:
    places = graph.places.get(name)
    return ViewNode(name, places[0].path or ".", places[0].type) if places else ViewNode(name, "", "")


_Needs = dict[str, dict[str, list[Reason]]]


def _chosen(needs: Mapping[str, Mapping[str, Sequence[Reason]]], kinds: Collection[str]) -> _Needs:
    """Return the dependencies of each package that have a reason of one of the kinds."""
    return {
        name: {
            dependency: chosen
            for dependency, reasons in dependencies.items()
            if (chosen := [reason for reason in reasons if not set(reason.categories).isdisjoint(kinds)])
        }
        for name, dependencies in needs.items()
    }


def _with_external(workspace: Workspace, needs: _Needs, kinds: Collection[str]) -> _Needs:
    """Return the dependencies with those on packages and rosdep keys outside of the workspace."""
    result = {name: dict(dependencies) for name, dependencies in needs.items()}
    for package in workspace.packages:
        for declared in package.declared:
            name, phases = declared.name, DEPENDENCY_KINDS[declared.depend.tag].phases
            if name not in needs and not set(phases).isdisjoint(kinds):
                reason = Reason(declared.depend.tag, phases, declared.depend.span, declared.certain)
                result[package.colcon_name].setdefault(name, []).append(reason)
                result.setdefault(name, {})
    return result


def _near(arcs: Mapping[str, Collection[str]], focus: str, depth: int) -> frozenset[str]:
    """Return the focus with its direct and indirect dependencies and dependents within ``depth`` edges. Raises UsageError."""
    if focus not in arcs:
        raise UsageError(f"--focus: there is no package '{focus}' in the graph{did_you_mean(similar_names(focus, arcs))}")
    result = {focus}
    for following in (arcs, reverse(arcs)):
        border, distance = {focus}, 0
        seen = {focus}
        while border and (not depth or distance < depth):
            border = {neighbour for name in border for neighbour in following[name]} - seen
            seen |= border
            distance += 1
        result |= seen
    return frozenset(result)


def _knots(graph: Graph) -> dict[str, int]:
    """Return the number of the cycle for each package on a cycle that makes colcon reject the workspace."""
    return {name: number for number, names in enumerate(graph.cycles) for name in names}


def _implied(arcs: Mapping[str, frozenset[str]], knots: Mapping[str, int]) -> frozenset[tuple[str, str]]:
    """Return the edges that longer paths imply. Edges of packages on a cycle are never among them."""
    import networkx as nx  # noqa: PLC0415

    free: nx.DiGraph[str] = nx.DiGraph()
    free.add_edges_from([(name, end) for name, ends in arcs.items() for end in ends if name not in knots and end not in knots])
    if not nx.is_directed_acyclic_graph(free):  # a cycle under an unknown condition
        return frozenset()
    return frozenset(free.edges) - frozenset(nx.transitive_reduction(free).edges)
