"""Metrics of the packages of a graph. Sets of packages are bits of integers, for speed."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from ros_lint.analysis.graph.dependency_graph import components, sort

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Mapping

    from ros_lint.analysis.graph.dependency_graph import Graph


class Metrics(NamedTuple):
    """Metrics of a package. Only packages of the workspace are counted."""

    needed_by: int
    """Number of packages that depend on it directly: the in-degree."""
    needs: int
    """Number of packages that it depends on directly: the out-degree."""
    depth: int
    """Number of edges on the longest chain of its dependencies; a cycle counts as one package."""
    reach: int
    """Number of packages that are rebuilt when it changes: all direct and indirect dependents."""
    redundant: tuple[tuple[str, ...], ...]
    """Redundant edges, each as a shortest longer path from the package to the same dependency."""


def measure(graph: Graph) -> Mapping[str, Metrics]:
    """Return the metrics of each package by name. Edges within a cycle are never redundant."""
    knot = _knots(graph)
    outer: dict[str, set[str]] = {name: set() for name in knot.values()}
    for name, other in graph.edges:
        if knot[name] != knot[other]:
            outer[knot[name]].add(knot[other])
    order, _ = sort(outer)
    bits = dict.fromkeys(order, 0)
    for index, name in enumerate(graph.names):
        bits[knot[name]] |= 1 << index
    below = dict.fromkeys(order, 0)
    depth = dict.fromkeys(order, 0)
    for name in order:
        for other in outer[name]:
            below[name] |= below[other] | bits[other]
            depth[name] = max(depth[name], depth[other] + 1)
    above = dict.fromkeys(order, 0)
    for name in reversed(order):
        for other in outer[name]:
            above[other] |= above[name] | bits[name]
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
    """Return the first member of the component of each package."""
    found = {name: name for name in graph.names}
    if graph.order.stuck or graph.possible_cycles:
        for members in components(graph.arcs):
            found.update(dict.fromkeys(members, members[0]))
    return found


def _redundant(
    graph: Graph, name: str, knot: Mapping[str, str], below: Mapping[str, int], bits: Mapping[str, int]
) -> list[tuple[str, ...]]:
    result = []
    own = knot[name]
    for other in graph.needs[name]:
        target = knot[other]
        leading = [
            third for third in graph.needs[name] if knot[third] not in (own, target) and _leads(knot[third], target, below, bits)
        ]
        if target != own and leading:
            result.append((name, *_shortest(graph, leading, other, _on_the_way(knot, target, below, bits))))
    return result


def _leads(start: str, end: str, below: Mapping[str, int], bits: Mapping[str, int]) -> bool:
    return start == end or bool(below[start] & bits[end])


def _on_the_way(knot: Mapping[str, str], end: str, below: Mapping[str, int], bits: Mapping[str, int]) -> Callable[[str], bool]:
    return lambda package: _leads(knot[package], end, below, bits)


def _shortest(graph: Graph, starts: Collection[str], end: str, useful: Callable[[str], bool]) -> tuple[str, ...]:
    """Return a shortest path from one of the starts to the end."""
    came = dict.fromkeys(starts, "")
    level = list(starts)
    while end not in came:
        following = []
        for name in level:
            for other in graph.needs[name]:
                if other not in came and useful(other):
                    came[other] = name
                    following.append(other)
        level = following
    path = [end]
    while came[path[-1]]:
        path.append(came[path[-1]])
    return tuple(reversed(path))
