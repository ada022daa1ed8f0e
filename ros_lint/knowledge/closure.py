"""Transitive closures of the dependencies of packages, each computed once.

A package provides the names of its run-time and exported dependencies: a package that depends on it can use these, too. A
closure is stored as an integer with a bit for each name. A workspace of 850 packages needs 850 closures of some hundred
names, and sets of strings would take as much time as reading all files of the workspace.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable, Container, Iterable, Iterator


class Closure:
    """A set of package names and rosdep keys, together with all names that these provide directly or indirectly.

    ``x in closure`` is as fast as in a set.
    """

    __slots__ = ("_bits", "_reach")

    def __init__(self, reach: Reach, bits: int) -> None:
        self._reach = reach
        self._bits = bits

    def __eq__(self, other: object) -> bool:
        """Return whether both closures have equal names, with equal dependencies of unknown extent."""
        return (
            isinstance(other, Closure)
            and self._reach.numbers is other._reach.numbers
            and self._bits == other._bits
            and self._bits & self._reach.unknown == self._bits & other._reach.unknown
        )

    __hash__ = None  # type: ignore[assignment]

    def __contains__(self, name: str) -> bool:
        number = self._reach.numbers.get(name)
        return number is not None and bool(self._bits >> number & 1)

    def __iter__(self) -> Iterator[str]:
        return iter(sorted(self.names))

    def __len__(self) -> int:
        return self._bits.bit_count()

    @property
    def names(self) -> frozenset[str]:
        """All names in the closure."""
        return frozenset(self._reach.expand(self._bits))

    def difference(self, other: Closure) -> Iterator[str]:
        """Yield the names of this closure that are not in ``other``. Both closures must be created by the same Reach object."""
        return self._reach.expand(self._bits & ~other._bits)

    @property
    def complete(self) -> bool:
        """True if the dependencies of every name in the closure are known, so that no name can be missing."""
        return not self._bits & self._reach.unknown

    @property
    def unknown(self) -> tuple[str, ...]:
        """Names in the closure whose own dependencies are unknown, sorted."""
        return tuple(sorted(self._reach.expand(self._bits & self._reach.unknown)))


class Reach:
    """The graph from which closures are computed: the run-time and exported dependencies of packages and rosdep keys.

    ``provided_by`` is a function that returns the direct dependencies of a package or key, None if they are unknown. Closures of
    a graph can be compared with those of an ``earlier`` graph, because names have the same numbers in both.
    """

    def __init__(self, provided_by: Callable[[str], tuple[str, ...] | None], earlier: Reach | None = None) -> None:
        self._provided_by = provided_by
        self.numbers: dict[str, int] = earlier.numbers if earlier else {}
        self._names: list[str] = earlier._names if earlier else []
        self._bits: dict[str, int] = {}
        self._next: dict[str, tuple[str, ...]] = {}
        self.unknown = 0

    def closure(self, names: Iterable[str]) -> Closure:
        """Return the closure of the given names: these names and all names that they provide directly or indirectly."""
        bits = 0
        for name in names:
            known_bits = self._bits.get(name)
            bits |= self._explore(name) if known_bits is None else known_bits
        return Closure(self, bits)

    def closure_without(self, names: Iterable[str], changed: str, removed: Container[str]) -> Closure:
        """Return the closure of ``names`` as if the package ``changed`` did not depend directly on the names in ``removed``."""
        stack = list(names)
        closure = self.closure(stack)
        if changed not in closure:
            return closure
        number = self.numbers[changed]
        bits = 0
        visited: set[str] = set()
        while stack:
            name = stack.pop()
            if not self._bits[name] >> number & 1:
                bits |= self._bits[name]
            elif name not in visited:
                visited.add(name)
                bits |= 1 << self.numbers[name]
                stack += [follower for follower in self._next[name] if name != changed or follower not in removed]
        return Closure(self, bits)

    def path(self, starts: Iterable[str], goal: str) -> tuple[str, ...]:
        """Return a shortest path from one of ``starts`` to ``goal``, with both ends; () if there is none.

        Of several shortest paths, the first is returned in the order of ``starts`` and of the results of ``provided_by``.
        """
        first = tuple(dict.fromkeys(starts))
        if goal in first:
            return (goal,)
        if goal not in self.closure(first):
            return ()
        # Only names whose closure contains the goal are on a path to it.
        number = self.numbers[goal]
        predecessor = {name: "" for name in first if self._bits[name] >> number & 1}
        queue = list(predecessor)
        for name in queue:
            followers = self._next[name]
            if goal in followers:
                path = [goal, name]
                while predecessor[path[-1]]:
                    path.append(predecessor[path[-1]])
                return tuple(reversed(path))
            for follower in followers:
                if follower not in predecessor and self._bits[follower] >> number & 1:
                    predecessor[follower] = name
                    queue.append(follower)
        return ()

    def expand(self, bits: int) -> Iterator[str]:
        """Yield the names whose bits are set in ``bits``."""
        while bits:
            lowest = bits & -bits
            yield self._names[lowest.bit_length() - 1]
            bits ^= lowest

    def _followers(self, name: str) -> tuple[str, ...]:
        followers = self._next.get(name)
        if followers is None:
            provided = self._provided_by(name)
            if name not in self.numbers:
                self.numbers[name] = len(self._names)
                self._names.append(name)
            if provided is None:
                self.unknown |= 1 << self.numbers[name]
            followers = self._next[name] = provided or ()
        return followers

    def _explore(self, root: str) -> int:
        """Return the transitive dependencies of ``root`` as bits, and store those of ``root`` and of all names in the result.

        The names in a cycle share one closure. The algorithm is that of Tarjan, without recursion.
        """
        finished = self._bits
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
                if follower in finished:
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
        return finished[root]

    def _close(self, stack: list[str], name: str) -> None:
        component = [stack.pop()]
        while component[-1] != name:
            component.append(stack.pop())
        bits = 0
        for member in component:
            bits |= 1 << self.numbers[member]
            for follower in self._next[member]:
                bits |= self._bits.get(follower, 0)
        for member in component:
            self._bits[member] = bits
