"""Cycles of a dependency graph, and the cheapest edges whose removal breaks them."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from ros_lint.analysis.graph.dependency_graph import Edge, Edges, Graph, components, is_acyclic, reverse

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence

_MOST_EXACT = 12
"""Maximum number of nodes for which the cut is found by comparing all orders of the nodes. The time grows with n * 2**n."""
_MOST_CUTS = 2
"""Maximum number of edges of the cuts that are tried exhaustively if there are more than ``_MOST_EXACT`` nodes."""


class Cycle(NamedTuple):
    """A strongly connected component: packages that all depend on each other, directly or indirectly."""

    names: tuple[str, ...]
    """Names of the packages, sorted."""
    cycle: tuple[str, ...]
    """A shortest cycle among the packages. It begins with the alphabetically first package on the cycle."""
    cut: tuple[Edge, ...]
    """The cheapest edges whose removal breaks all cycles. At least one of them lies on ``cycle``."""
    certain: bool
    """False if the cycle exists only under a condition that cannot be evaluated."""


def cycles(graph: Graph) -> Iterator[Cycle]:
    """Yield the cycles of a graph, the certain ones first."""
    for name_sets, arcs, certain in ((graph.cycles, graph.certain_arcs, True), (graph.possible_cycles, graph.arcs, False)):
        for names in name_sets:
            inner = arcs_within(arcs, names)
            yield Cycle(names, shortest_cycle(inner), cheapest_cut(graph, inner), certain)


def arcs_within(arcs: Mapping[str, Collection[str]], nodes: Collection[str]) -> Edges:
    """Return the part of a graph that consists of ``nodes`` and the edges between them."""
    return {name: frozenset(arcs[name]).intersection(nodes) for name in sorted(nodes)}


def shortest_cycle(arcs: Mapping[str, Collection[str]]) -> tuple[str, ...]:
    """Return the nodes of a shortest cycle, or () if there is no cycle.

    The alphabetically first node of the cycle comes first.
    """
    best: tuple[str, ...] = ()
    for start in sorted(arcs):
        candidate = _cycle_through(arcs, start, len(best) or len(arcs) + 1)
        if candidate and (not best or len(candidate) < len(best)):
            best = candidate
    return best


def _cycle_through(arcs: Mapping[str, Collection[str]], start: str, below: int) -> tuple[str, ...]:
    """Return a shortest cycle of less than ``below`` nodes in which ``start`` is the first name, or () if there is none."""
    predecessor: dict[str, str] = {}
    level = [start]
    for _ in range(below - 1):
        following: list[str] = []
        for name in level:
            for dependency in sorted(arcs[name]):
                if dependency == start:
                    return _way(predecessor, start, name)
                if dependency > start and dependency not in predecessor:
                    predecessor[dependency] = name
                    following.append(dependency)
        level = following
    return ()


def _way(predecessor: Mapping[str, str], start: str, end: str) -> tuple[str, ...]:
    """Return the path from ``start`` to ``end``, both included. ``predecessor`` has the node before each node of the path."""
    path = [end]
    while path[-1] != start:
        path.append(predecessor[path[-1]])
    return tuple(reversed(path))


def cheapest_cut(graph: Graph, arcs: Mapping[str, Collection[str]]) -> tuple[Edge, ...]:
    """Return the fewest edges whose removal breaks all cycles of ``arcs``, a subgraph of ``graph``.

    Among cuts of equal size, the cheapest is returned. From cheap to expensive:
    - edges that are uncertain,
    - test dependencies,
    - dependencies that are only needed at run time,
    - dependencies with one tag,
    - dependencies with several tags,
    - members of groups.

    If a component has more than 12 nodes, and more than 2 of its edges have to be removed, there may be a smaller cut. Even
    then no edge of the returned cut can be left out.
    """
    loops = [(name, name) for name in sorted(arcs) if name in arcs[name]]
    plain = {name: frozenset(dependencies) - {name} for name, dependencies in arcs.items()}
    cut = list(loops)
    for nodes in components(plain):
        inner = arcs_within(plain, nodes)
        cut += _cut_component(inner, lambda edge: 1000 + _cost(graph, edge))
    return tuple(sorted(cut))


def _cost(graph: Graph, edge: Edge) -> int:
    reasons = graph.reasons(edge)
    categories = {category for reason in reasons for category in reason.categories}
    if not any(reason.certain for reason in reasons):
        return 0
    if categories == {"test"}:
        return 1
    if {reason.tag for reason in reasons} <= {"exec_depend", "test_depend"}:
        return 2
    if "group" in categories:
        return 5
    return 3 if len(reasons) == 1 else 4


def _cut_component(arcs: Edges, weight: Callable[[Edge], int]) -> Iterable[Edge]:
    if len(arcs) <= _MOST_EXACT:
        return _cut_by_orders(arcs, weight)
    for depth in range(1, _MOST_CUTS + 1):
        if smallest := _cut_by_branching(arcs, weight, depth):
            return smallest
    return _cut_by_greed(arcs, weight)


def _cut_by_orders(arcs: Edges, weight: Callable[[Edge], int]) -> list[Edge]:
    """Return the cheapest edges whose removal breaks all cycles, found by comparing all orders of the nodes.

    For an order of the nodes, each edge from a node to a later node has to be cut.
    """
    names = sorted(arcs)
    number = {name: index for index, name in enumerate(names)}
    weights = [[(1 << number[dependency], weight((name, dependency))) for dependency in sorted(arcs[name])] for name in names]
    full = (1 << len(names)) - 1
    best: list[tuple[int, int]] = [(0, -1)] + [(1 << 60, -1)] * full
    for placed in range(full):
        so_far = best[placed][0]
        for index, needs in enumerate(weights):
            bit = 1 << index
            if placed & bit:
                continue
            total = so_far + sum(cost for dependency, cost in needs if not placed & dependency)
            if total < best[placed | bit][0]:
                best[placed | bit] = (total, index)
    order: list[str] = []
    placed = full
    while placed:
        last = best[placed][1]
        order.append(names[last])
        placed ^= 1 << last
    return _against(arcs, order[::-1])


def _cut_by_branching(arcs: Edges, weight: Callable[[Edge], int], depth: int) -> list[Edge]:
    """Return the cheapest cut of at most ``depth`` edges, or [] if every cut needs more edges.

    Each edge of a shortest cycle is tried as a part of the cut, because every cut contains at least one of these edges.
    """
    cycle = shortest_cycle(arcs)
    best: list[Edge] = []
    for edge in zip(cycle, (*cycle[1:], cycle[0]), strict=True):
        rest = {**arcs, edge[0]: arcs[edge[0]] - {edge[1]}}
        if is_acyclic(rest):
            candidate = [edge]
        elif depth > 1 and (more := _cut_by_branching(rest, weight, depth - 1)):
            candidate = [edge, *more]
        else:
            continue
        if not best or sum(map(weight, candidate)) < sum(map(weight, best)):
            best = candidate
    return best


def _cut_by_greed(arcs: Edges, weight: Callable[[Edge], int]) -> list[Edge]:
    """Return a cut without needless edges, from an order of the nodes by their degrees (Eades, Lin and Smyth)."""
    cut = set(_against(arcs, _greedy_order(arcs, weight)))
    for edge in sorted(cut, key=lambda edge: (-weight(edge), edge)):
        smaller = cut - {edge}
        if is_acyclic(
            {name: frozenset(dependency for dependency in arcs[name] if (name, dependency) not in smaller) for name in arcs}
        ):
            cut = smaller
    return sorted(cut)


def _greedy_order(arcs: Edges, weight: Callable[[Edge], int]) -> list[str]:
    before = reverse(arcs)
    remaining = set(arcs)
    first: list[str] = []
    last: list[str] = []

    def balance(name: str) -> tuple[int, str]:
        needs = sum(weight((name, neighbour)) for neighbour in arcs[name] & remaining)
        return needs - sum(weight((neighbour, name)) for neighbour in before[name] & remaining), name

    while remaining:
        if free := sorted(name for name in remaining if not arcs[name] & remaining):
            first += free
        elif free := sorted(name for name in remaining if not before[name] & remaining):
            last += free
        else:
            free = [min(remaining, key=balance)]
            first += free
        remaining -= set(free)
    return first + last[::-1]


def _against(arcs: Edges, order: Sequence[str]) -> list[Edge]:
    place = {name: index for index, name in enumerate(order)}
    return sorted((name, dependency) for name in arcs for dependency in arcs[name] if place[dependency] > place[name])
