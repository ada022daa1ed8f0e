"""Find the shortest paths through a graph."""

from __future__ import annotations

from heapq import heappop, heappush
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

_MOST_STEPS = 20_000
"""Maximum number of steps of a search, because the number of paths grows exponentially in a graph with many cycles."""


class GraphPaths(NamedTuple):
    """The shortest paths from one node of a graph to another node."""

    paths: tuple[tuple[str, ...], ...]
    """The paths as tuples of node names, without repeated nodes, sorted by length, then by name."""
    more: bool
    """True if further paths exist or may exist."""


def paths(successors: Callable[[str], Iterable[str]], start: str, end: str, most: int) -> GraphPaths:
    """Return the shortest ``most`` paths from ``start`` to ``end``. ``successors`` returns the direct successors of a node.

    If ``start`` and ``end`` are the same node, the paths are the cycles through this node.
    """
    distance = _distances(successors, start, end)
    if start not in distance:
        return GraphPaths((), False)
    result: list[tuple[str, ...]] = []
    queue: list[tuple[int, tuple[str, ...]]] = [(distance[start], (start,))]
    for _ in range(_MOST_STEPS):
        if not queue:
            return GraphPaths(tuple(result), False)
        _, path = heappop(queue)
        if len(path) > 1 and path[-1] == end:
            if len(result) == most:
                return GraphPaths(tuple(result), True)
            result.append(path)
            continue
        for successor in successors(path[-1]):
            if successor in distance and (successor not in path or successor == end):
                heappush(queue, (len(path) + distance[successor], (*path, successor)))
    return GraphPaths(tuple(result), True)


def _distances(successors: Callable[[str], Iterable[str]], start: str, end: str) -> dict[str, int]:
    """Return the number of edges to ``end``, by node, for each node on a path from ``start`` to ``end``."""
    predecessors: dict[str, list[str]] = {}
    visited = {start}
    stack = [start]
    while stack:
        name = stack.pop()
        for successor in successors(name):
            predecessors.setdefault(successor, []).append(name)
            if successor not in visited:
                visited.add(successor)
                stack.append(successor)
    distance = {end: 0} if end in predecessors else {}
    level = list(distance)
    while level:
        edges = [(name, successor) for successor in level for name in predecessors.get(successor, ())]
        level = [name for name, successor in edges if _set_distance(distance, name, successor)]
    return distance


def _set_distance(distance: dict[str, int], name: str, successor: str) -> bool:
    """Set the distance of ``name`` to that of ``successor`` plus 1. Return False if ``name`` already has a distance."""
    if name in distance:
        return False
    distance[name] = distance[successor] + 1
    return True
