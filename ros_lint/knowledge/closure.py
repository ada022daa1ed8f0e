"""What comes along with what: transitive closures over the names of packages, each computed once.

Sets are bits of one integer. A workspace of 850 packages asks for 850 closures of some hundred names each, which as
sets of strings would take as long as reading every file of it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable, Container, Iterable, Iterator


class Closure:
    """Names that come along with some names, these included. ``x in closure`` costs no more than in a set."""

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
        return frozenset(self._reach.expand(self._bits))

    def less(self, other: Closure) -> Iterator[str]:
        """Yield the names that another closure of the same graph does not have."""
        return self._reach.expand(self._bits & ~other._bits)

    @property
    def complete(self) -> bool:
        """Return whether no other name can come along: what each of them brings is known."""
        return not self._bits & self._reach.unknown

    @property
    def unknown(self) -> tuple[str, ...]:
        """Return the names of which nobody knows what they bring, sorted."""
        return tuple(sorted(self._reach.expand(self._bits & self._reach.unknown)))


class Reach:
    """The graph of what brings what.

    ``brings`` returns the names that come along with a name: None when nobody knows.
    """

    def __init__(self, brings: Callable[[str], tuple[str, ...] | None]) -> None:
        self._brings = brings
        self.numbers: dict[str, int] = {}
        self._names: list[str] = []
        self._bits: dict[str, int] = {}
        self._next: dict[str, tuple[str, ...]] = {}
        self.unknown = 0

    def closure(self, names: Iterable[str]) -> Closure:
        """Return all names that come along with any of these, and these."""
        bits = 0
        for name in names:
            found = self._bits.get(name)
            bits |= self._explore(name) if found is None else found
        return Closure(self, bits)

    def closure_without(self, names: Iterable[str], changed: str, gone: Container[str]) -> Closure:
        """Return the closure of names as it would be if one name did not bring some of the others itself.

        What does not lead to that one brings what it always does.
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
        """Return a shortest way from one of the names to another, both ends included: empty when there is none.

        Of several the one whose names were given first, as starts or by ``brings``.
        """
        begin = tuple(dict.fromkeys(starts))
        if goal in begin:
            return (goal,)
        if goal not in self.closure(begin):
            return ()
        # Only what leads to the goal is on a way to it, which its closure tells.
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
        """Yield the names that the bits stand for."""
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
        """Find the closures of everything below a name. Names in a circle share one (Tarjan, without recursion)."""
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
