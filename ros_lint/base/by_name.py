"""Sequences whose items are found by their names."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from typing import Generic, Protocol, TypeVar


class Named(Protocol):
    """A value with a name."""

    @property
    def name(self) -> str:
        """The name, by which other values refer to this one."""


T = TypeVar("T", bound=Named)


class ByName(tuple[T, ...], Generic[T]):
    """A tuple that finds its items by their names without a scan. The index is built when it is first used."""

    @cached_property
    def _index(self) -> dict[str, tuple[list[int], list[T]]]:
        """The positions and the items by name."""
        index: dict[str, tuple[list[int], list[T]]] = {}
        for position, item in enumerate(self):
            positions, items = index.setdefault(item.name, ([], []))
            positions.append(position)
            items.append(item)
        return index

    def named(self, *names: str) -> Sequence[T]:
        """Return the items that have one of the names, in the order of the tuple."""
        known = [self._index[name] for name in dict.fromkeys(names) if name in self._index]
        if len(known) == 1:
            return known[0][1]
        return [self[position] for position in sorted(position for positions, _ in known for position in positions)]
