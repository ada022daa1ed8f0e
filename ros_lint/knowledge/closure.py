"""Transitive closures over the names of packages, each computed once.

A set is an integer with a bit for each name. A workspace of 850 packages needs 850 closures of some hundred names;
as sets of strings they would take as long as reading all its files.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable, Container, Iterable, Iterator


class Closure:
    """Names with all names that they provide transitively. ``x in closure`` is as fast as in a set."""

    __slots__ = ("_bits", "_reach")

    def __init__(self, reach: Reach, bits: int) -> None:
        self._reach = reach
        self._bits = bits

    def __contains__(self, name: str) -> bool:
        number = self._reach.numbers.get(name)
        return number is not None and bool(self._bits >> number & 1)

    def __iter__(self) -> Iterator[str]:
        return iter(sorted(self.names))

    def __len__(self) -> int:
        return self._bits.bit_count()

    @property
    def names(self) -> frozenset[str]:
        """All names."""
        return frozenset(self._reach.expand(self._bits))

    def less(self, other: Closure) -> Iterator[str]:
        """Yield the names that another closure of the same graph lacks."""
        return self._reach.expand(self._bits & ~other._bits)

    @property
    def complete(self) -> bool:
        """True if the dependencies of each name are known, so that no name is missing."""
        return not self._bits & self._reach.unknown

    @property
    def unknown(self) -> tuple[str, ...]:
        """Names whose dependencies are unknown, sorted."""
        return tuple(sorted(self._reach.expand(self._bits & self._reach.unknown)))


class Reach:
    """The graph of names and the names that they provide.

    ``brings`` returns the names that a name provides directly, None if unknown.
    """

    def __init__(self, brings: Callable[[str], tuple[str, ...] | None]) -> None:
        self._brings = brings
        self.numbers: dict[str, int] = {}
        self._names: list[str] = []
        self._bits: dict[str, int] = {}
        self._next: dict[str, tuple[str, ...]] = {}
        self.unknown = 0

    def closure(self, names: Iterable[str]) -> Closure:
        """Return the given names with all names that they provide transitively."""
        bits = 0
        for name in names:
            found = self._bits.get(name)
            bits |= self._explore(name) if found is None else found
        return Closure(self, bits)

    def closure_without(self, names: Iterable[str], changed: str, gone: Container[str]) -> Closure:
        """Return the closure of names as if ``changed`` did not itself provide the names in ``gone``.

        Names that do not lead to ``changed`` keep their closure.
        """
        waiting = list(names)
        whole = self.closure(waiting)
        if changed not in whole:
            return whole
        number = self.numbers[changed]
        bits = 0
        seen: set[str] = set()
        while waiting:
            name = waiting.pop()
            if not self._bits[name] >> number & 1:
                bits |= self._bits[name]
            elif name not in seen:
                seen.add(name)
                bits |= 1 << self.numbers[name]
                waiting += [each for each in self._next[name] if name != changed or each not in gone]
        return Closure(self, bits)

    def path(self, starts: Iterable[str], goal: str) -> tuple[str, ...]:
        """Return a shortest path from one of ``starts`` to ``goal``, both ends included, or ().

        Of several paths, the order of ``starts`` and of ``brings`` decides.
        """
        begin = tuple(dict.fromkeys(starts))
        if goal in begin:
            return (goal,)
        if goal not in self.closure(begin):
            return ()
        # Only names whose closure contains the goal are on a path to it.
        number = self.numbers[goal]
        came = {name: "" for name in begin if self._bits[name] >> number & 1}
        queue = list(came)
        for name in queue:
            followers = self._next[name]
            if goal in followers:
                way = [goal, name]
                while came[way[-1]]:
                    way.append(came[way[-1]])
                return tuple(reversed(way))
            for follower in followers:
                if follower not in came and self._bits[follower] >> number & 1:
                    came[follower] = name
                    queue.append(follower)
        return ()

    def expand(self, bits: int) -> Iterator[str]:
        """Yield the names of the set bits."""
        while bits:
            lowest = bits & -bits
            yield self._names[lowest.bit_length() - 1]
            bits ^= lowest

    def _followers(self, name: str) -> tuple[str, ...]:
        found = self._next.get(name)
        if found is None:
            brought = self._brings(name)
            self.numbers[name] = len(self._names)
            self._names.append(name)
            if brought is None:
                self.unknown |= 1 << self.numbers[name]
            found = self._next[name] = brought or ()
        return found

    def _explore(self, root: str) -> int:
        """Compute the closures of everything below a name. Names in a cycle share one (Tarjan, iterative)."""
        done = self._bits
        low: dict[str, int] = {}
        order: dict[str, int] = {}
        stack: list[str] = []
        work: list[tuple[str, Iterator[str]]] = []

        def enter(name: str) -> None:
            low[name] = order[name] = len(order)
            stack.append(name)
            work.append((name, iter(self._followers(name))))

        enter(root)
        while work:
            name, followers = work[-1]
            for follower in followers:
                if follower in done:
                    continue
                if follower not in order:
                    enter(follower)
                    break
                low[name] = min(low[name], order[follower])
            else:
                work.pop()
                if work:
                    low[work[-1][0]] = min(low[work[-1][0]], low[name])
                if low[name] == order[name]:
                    self._close(stack, name)
        return done[root]

    def _close(self, stack: list[str], name: str) -> None:
        circle = [stack.pop()]
        while circle[-1] != name:
            circle.append(stack.pop())
        bits = 0
        for member in circle:
            bits |= 1 << self.numbers[member]
            for follower in self._next[member]:
                bits |= self._bits.get(follower, 0)
        for member in circle:
            self._bits[member] = bits
