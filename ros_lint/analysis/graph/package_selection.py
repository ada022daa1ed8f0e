"""Select packages by name and dependencies, as the options of ``colcon-package-selection`` do."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, NamedTuple

from ros_lint.analysis.graph.dependency_graph import reachable

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from ros_lint.analysis.graph.dependency_graph import Edges, Graph


class PackageSelection(NamedTuple):
    """The values of the options ``--packages-select``, ``--packages-up-to``, ``--packages-skip`` and so on.

    An option without values is ignored.
    """

    select: tuple[str, ...] = ()
    up_to: tuple[str, ...] = ()
    above: tuple[str, ...] = ()
    select_regex: tuple[str, ...] = ()
    skip: tuple[str, ...] = ()

    def names(self, graph: Graph) -> frozenset[str]:
        """Return the names of the packages that every option with values selects.

        ``up_to`` selects packages with their direct and indirect dependencies, ``above`` packages with their direct and
        indirect dependents, and ``select_regex`` packages whose name begins with a match. ``select`` and ``select_regex``
        count as one option: each adds packages.
        """
        names = frozenset(graph.names) - frozenset(self.skip)
        if self.select or self.select_regex:
            names &= {name for name in names if name in self.select or any(re.match(regex, name) for regex in self.select_regex)}
        if self.up_to:
            names &= _with_reachable(graph.arcs, self.up_to)
        if self.above:
            names &= _with_reachable(graph.needed_by, self.above)
        return names

    def named(self) -> Iterator[tuple[str, str]]:
        """Yield each option with each of its names that must exist: ("packages-up-to", "talker")."""
        for option, names in (("select", self.select), ("up-to", self.up_to), ("above", self.above)):
            yield from ((f"packages-{option}", name) for name in names)


def _with_reachable(arcs: Edges, names: Iterable[str]) -> frozenset[str]:
    known = [name for name in names if name in arcs]
    return frozenset(known).union(*[reachable(arcs, name) for name in known])
