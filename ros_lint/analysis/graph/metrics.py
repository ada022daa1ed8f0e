"""Metrics of the packages of a dependency graph. For speed, a set of packages is an integer with one bit for each package."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from ros_lint.analysis.graph.dependency_graph import components, sort

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Mapping

    from ros_lint.analysis.graph.dependency_graph import Graph


class Metrics(NamedTuple):
    """Metrics of a package. Only packages of the workspace are counted."""

    needed_by: int
    """Number of packages that directly depend on the package: the in-degree."""
    needs: int
    """Number of direct dependencies of the package: the out-degree."""
    depth: int
    """Number of edges on the longest chain of dependencies from the package; a cycle counts as one package."""
    reach: int
    """Number of packages that are rebuilt when the package changes: all direct and indirect dependents."""
    redundant: tuple[tuple[str, ...], ...]
    """Redundant dependencies: the package depends on them directly and indirectly.

    Each item is a shortest indirect path from the package to the dependency, both included.
    """


def measure(graph: Graph) -> Mapping[str, Metrics]:
    """Return the metrics of each package by name. Edges within a cycle are never redundant."""
    knot = _knots(graph)
    outer: dict[str, set[str]] = {name: set() for name in knot.values()}
    for name, dependency in graph.edges:
        if knot[name] != knot[dependency]:
            outer[knot[name]].add(knot[dependency])
    order, _ = sort(outer)
    bits = dict.fromkeys(order, 0)
    for index, name in enumerate(graph.names):
        bits[knot[name]] |= 1 << index
    below = dict.fromkeys(order, 0)
    depth = dict.fromkeys(order, 0)
    for name in order:
        for dependency in outer[name]:
            below[name] |= below[dependency] | bits[dependency]
            depth[name] = max(depth[name], depth[dependency] + 1)
    above = dict.fromkeys(order, 0)
    for name in reversed(order):
        for dependency in outer[name]:
            above[dependency] |= above[name] | bits[name]
    return {
        name: Metrics(
            len(graph.needed_by[name] - {name}),
            len(graph.arcs[name] - {name}),
            depth[knot[name]],
            (above[knot[name]] | bits[knot[name]]).bit_count() - 1,
            tuple(_redundant(graph, name, knot, below, bits)),
        )
        for name in graph.names
    }


def _knots(graph: Graph) -> dict[str, str]:
    """Return, for each package, the first member of its strongly connected component: the package itself if it is on no cycle."""
    first_members = {name: name for name in graph.names}
    if graph.order.stuck or graph.possible_cycles:
        for members in components(graph.arcs):
            first_members.update(dict.fromkeys(members, members[0]))
    return first_members


def _redundant(
    graph: Graph, name: str, knot: Mapping[str, str], below: Mapping[str, int], bits: Mapping[str, int]
) -> list[tuple[str, ...]]:
    result = []
    component = knot[name]
    for dependency in graph.needs[name]:
        target = knot[dependency]
        leading = [
            third
            for third in graph.needs[name]
            if knot[third] not in (component, target) and _leads(knot[third], target, below, bits)
        ]
        if target != component and leading:
            result.append((name, *_shortest(graph, leading, dependency, _on_the_way(knot, target, below, bits))))
    return result


def _leads(start: str, end: str, below: Mapping[str, int], bits: Mapping[str, int]) -> bool:
    return start == end or bool(below[start] & bits[end])


def _on_the_way(knot: Mapping[str, str], end: str, below: Mapping[str, int], bits: Mapping[str, int]) -> Callable[[str], bool]:
    return lambda package: _leads(knot[package], end, below, bits)


def _shortest(graph: Graph, starts: Collection[str], end: str, useful: Callable[[str], bool]) -> tuple[str, ...]:
    """Return a shortest path from one of ``starts`` to ``end``, through packages for which ``useful`` is true.

    There has to be such a path.
    """
    predecessor = dict.fromkeys(starts, "")
    level = list(starts)
    while end not in predecessor:
        following = []
        for name in level:
            for dependency in graph.needs[name]:
                if dependency not in predecessor and useful(dependency):
                    predecessor[dependency] = name
                    following.append(dependency)
        level = following
    path = [end]
    while predecessor[path[-1]]:
        path.append(predecessor[path[-1]])
    return tuple(reversed(path))
