"""Cycles in a graph: the shortest one, and the cheapest edges to take out so that none is left."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from ros_lint.analysis.graph.dependency_graph import Edge, Edges, Graph, components, is_acyclic, reverse

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence

_MOST_EXACT = 12
"""Up to this many nodes every order is weighed, which takes time in proportion to n * 2**n."""
_MOST_CUTS = 2
"""Up to this many edges the smallest cut is found in larger components, too."""


class Cycle(NamedTuple):
    """Packages of which each needs all the others, directly or not."""

    names: tuple[str, ...]
    """Sorted."""
    cycle: tuple[str, ...]
    """A shortest cycle among them, the first name in front."""
    cut: tuple[Edge, ...]
    """The cheapest edges to do without, so that there is an order. At least one of them lies on the cycle."""
    certain: bool
    """False when it is a knot only if a condition holds that nobody can evaluate here."""


def cycles(graph: Graph) -> Iterator[Cycle]:
    """Yield the knots of a graph, the certain ones first."""
    for found, arcs, certain in ((graph.cycles, graph.certain_arcs, True), (graph.possible_cycles, graph.arcs, False)):
        for names in found:
            inner = arcs_within(arcs, names)
            yield Cycle(names, shortest_cycle(inner), cheapest_cut(graph, inner), certain)


def arcs_within(arcs: Mapping[str, Collection[str]], nodes: Collection[str]) -> Edges:
    """Return the part of a graph that lies between some of its nodes."""
    return {name: frozenset(arcs[name]).intersection(nodes) for name in sorted(nodes)}


def shortest_cycle(arcs: Mapping[str, Collection[str]]) -> tuple[str, ...]:
    """Return the nodes of a shortest cycle, first by name in front. () when there is none."""
    best: tuple[str, ...] = ()
    for start in sorted(arcs):
        found = _cycle_through(arcs, start, len(best) or len(arcs) + 1)
        if found and (not best or len(found) < len(best)):
            best = found
    return best


def _cycle_through(arcs: Mapping[str, Collection[str]], start: str, below: int) -> tuple[str, ...]:
    """Return the first of the shortest cycles in which ``start`` is the first name and which have fewer nodes."""
    came: dict[str, str] = {}
    level = [start]
    for _ in range(below - 1):
        following: list[str] = []
        for name in level:
            for other in sorted(arcs[name]):
                if other == start:
                    return _way(came, start, name)
                if other > start and other not in came:
                    came[other] = name
                    following.append(other)
        level = following
    return ()


def _way(came: Mapping[str, str], start: str, end: str) -> tuple[str, ...]:
    """Return the way by which one came from a start to an end, both included."""
    path = [end]
    while path[-1] != start:
        path.append(came[path[-1]])
    return tuple(reversed(path))


def cheapest_cut(graph: Graph, arcs: Mapping[str, Collection[str]]) -> tuple[Edge, ...]:
    """Return the fewest edges without which ``arcs``, a part of the graph, has no cycle.

    Of cuts with as many edges, the one that is easiest to live without: what may not count anyway, then test
    dependencies, then what is needed at run time only, then what a single tag asks for, groups last. With more than 12
    nodes and more than 2 edges to cut there may be a smaller cut, but none of its edges can be left out.
    """
    loops = [(name, name) for name in sorted(arcs) if name in arcs[name]]
    plain = {name: frozenset(others) - {name} for name, others in arcs.items()}
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
        if found := _cut_by_branching(arcs, weight, depth):
            return found
    return _cut_by_greed(arcs, weight)


def _cut_by_orders(arcs: Edges, weight: Callable[[Edge], int]) -> list[Edge]:
    """Weigh every order of the nodes: what is needed from a node further on has to be cut."""
    names = sorted(arcs)
    number = {name: index for index, name in enumerate(names)}
    weights = [[(1 << number[other], weight((name, other))) for other in sorted(arcs[name])] for name in names]
    full = (1 << len(names)) - 1
    best: list[tuple[int, int]] = [(0, -1)] + [(1 << 60, -1)] * full
    for placed in range(full):
        so_far = best[placed][0]
        for index, needs in enumerate(weights):
            bit = 1 << index
            if placed & bit:
                continue
            total = so_far + sum(cost for other, cost in needs if not placed & other)
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
    """Take out one edge of a shortest cycle after the other: one of them must go."""
    cycle = shortest_cycle(arcs)
    best: list[Edge] = []
    for edge in zip(cycle, (*cycle[1:], cycle[0]), strict=True):
        rest = {**arcs, edge[0]: arcs[edge[0]] - {edge[1]}}
        if is_acyclic(rest):
            found = [edge]
        elif depth > 1 and (more := _cut_by_branching(rest, weight, depth - 1)):
            found = [edge, *more]
        else:
            continue
        if not best or sum(map(weight, found)) < sum(map(weight, best)):
            best = found
    return best


def _cut_by_greed(arcs: Edges, weight: Callable[[Edge], int]) -> list[Edge]:
    """Order the nodes by what they are needed for and what they need (Eades, Lin and Smyth), and spare what can be."""
    cut = set(_against(arcs, _greedy_order(arcs, weight)))
    for edge in sorted(cut, key=lambda edge: (-weight(edge), edge)):
        kept = cut - {edge}
        if is_acyclic({name: frozenset(other for other in arcs[name] if (name, other) not in kept) for name in arcs}):
            cut = kept
    return sorted(cut)


def _greedy_order(arcs: Edges, weight: Callable[[Edge], int]) -> list[str]:
    before = reverse(arcs)
    left = set(arcs)
    first: list[str] = []
    last: list[str] = []

    def balance(name: str) -> tuple[int, str]:
        needs = sum(weight((name, other)) for other in arcs[name] & left)
        return needs - sum(weight((other, name)) for other in before[name] & left), name

    while left:
        if free := sorted(name for name in left if not arcs[name] & left):
            first += free
        elif free := sorted(name for name in left if not before[name] & left):
            last += free
        else:
            free = [min(left, key=balance)]
            first += free
        left -= set(free)
    return first + last[::-1]


def _against(arcs: Edges, order: Sequence[str]) -> list[Edge]:
    place = {name: index for index, name in enumerate(order)}
    return sorted((name, other) for name in arcs for other in arcs[name] if place[other] > place[name])
