"""Paths through a graph, the shortest first."""

from __future__ import annotations

from heapq import heappop, heappush
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

_MOST_STEPS = 20_000
"""Limit of the steps of a search: a graph with many cycles has too many paths."""


class Paths(NamedTuple):
    """Paths from one node to another."""

    found: tuple[tuple[str, ...], ...]
    """Paths without repeated nodes, from start to end, sorted by length, then by name."""
    more: bool
    """True if there are or may be further paths."""


def paths(successors: Callable[[str], Iterable[str]], start: str, end: str, most: int) -> Paths:
    """Return up to ``most`` paths from a node to another one."""
    distance = _distances(successors, start, end)
    if start not in distance:
        return Paths((), False)
    found: list[tuple[str, ...]] = []
    todo: list[tuple[int, tuple[str, ...]]] = [(distance[start], (start,))]
    for _ in range(_MOST_STEPS):
        if not todo:
            return Paths(tuple(found), False)
        _, path = heappop(todo)
        if len(path) > 1 and path[-1] == end:
            if len(found) == most:
                return Paths(tuple(found), True)
            found.append(path)
            continue
        for other in successors(path[-1]):
            if other in distance and (other not in path or other == end == start):
                heappush(todo, (len(path) + distance[other], (*path, other)))
    return Paths(tuple(found), True)


def _distances(successors: Callable[[str], Iterable[str]], start: str, end: str) -> dict[str, int]:
    """Return the distance to the end for each node on a path to it."""
    before: dict[str, list[str]] = {}
    seen = {start}
    todo = [start]
    while todo:
        name = todo.pop()
        for other in successors(name):
            before.setdefault(other, []).append(name)
            if other not in seen:
                seen.add(other)
                todo.append(other)
    distance = {end: 0} if end in before else {}
    level = list(distance)
    while level:
        level = [name for other in level for name in before.get(other, ()) if _closer(distance, name, other)]
    return distance


def _closer(distance: dict[str, int], name: str, other: str) -> bool:
    if name in distance:
        return False
    distance[name] = distance[other] + 1
    return True
