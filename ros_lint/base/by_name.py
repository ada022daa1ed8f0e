"""A tuple with a fast look-up of its items by name."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from typing import Generic, Protocol, TypeVar


class Named(Protocol):
    """An object with an attribute ``name``."""

    @property
    def name(self) -> str:
        """The name by which other objects refer to this object."""


T = TypeVar("T", bound=Named)


class ByName(tuple[T, ...], Generic[T]):
    """A tuple of objects with names, and a look-up by name without a scan. Its index is built at the first look-up."""

    @cached_property
    def _index(self) -> dict[str, tuple[list[int], list[T]]]:
        """The items of the tuple by name: for each name, the positions of its items, and the items."""
        index: dict[str, tuple[list[int], list[T]]] = {}
        for position, item in enumerate(self):
            positions, items = index.setdefault(item.name, ([], []))
            positions.append(position)
            items.append(item)
        return index

    def named(self, *names: str) -> Sequence[T]:
        """Return the items whose name is one of ``names``, in the order of the tuple."""
        known = [self._index[name] for name in dict.fromkeys(names) if name in self._index]
        if len(known) == 1:
            return known[0][1]
        return [self[position] for position in sorted(position for positions, _ in known for position in positions)]
