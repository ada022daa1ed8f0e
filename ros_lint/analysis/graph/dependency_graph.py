"""The dependency graph of a workspace, with the edges by which colcon orders packages.

An edge leads from a package to a package that has to be built first. There is an edge for build, run and test
dependencies, members of groups, and the dependencies that colcon.pkg, or the build script of a package without package.xml, adds.
Documentation dependencies, conflicts and false conditions give no edge.

The nodes are the names that colcon uses (:attr:`Package.colcon_name`). A dependency on the name in package.xml gives no
edge if colcon uses another name. Packages with equal names are one node.
"""

from __future__ import annotations

from functools import cached_property
from heapq import heapify, heappop, heappush
from typing import TYPE_CHECKING, NamedTuple

from ros_lint.analysis.memo import cached_by_workspace
from ros_lint.facts.manifest import DEPENDENCY_KINDS, Role

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence

    from ros_lint.base.text import Span
    from ros_lint.workspace.model import Package, Workspace

Edge = tuple[str, str]
"""A dependent package and its dependency."""

Edges = dict[str, frozenset[str]]
"""For each package, the packages to which its edges lead."""


class Reason(NamedTuple):
    """A reason why one package has to be built before another package, e.g. a ``<depend>`` tag."""

    tag: str
    """Name of the dependency tag, or name of the file (colcon.pkg, CMakeLists.txt) from which colcon takes the edge."""
    categories: tuple[str, ...]
    """Phases for which colcon reads the tag: "build", "run", "test"; "group" for a member of a group."""
    span: Span
    """Place of the tag."""
    certain: bool = True
    """False if the tag has a condition with a variable whose value is unknown."""


class Order(NamedTuple):
    """A build order of the packages, and the packages that cannot be ordered because of a cycle."""

    names: tuple[str, ...]
    """Packages in an order in which dependencies come first."""
    stuck: tuple[str, ...]
    """Packages that lie on a cycle, or depend on a package on a cycle, sorted."""


class Graph:
    """The dependencies between the packages of a workspace. Packages have the names that colcon uses. Names are sorted."""

    def __init__(self, places: Mapping[str, Sequence[Package]], needs: Mapping[str, Mapping[str, Sequence[Reason]]]) -> None:
        self.places = {name: tuple(places[name]) for name in sorted(places)}
        """Packages by name; several for a name if packages have equal names."""
        self.needs = {
            name: {dependency: tuple(needs[name][dependency]) for dependency in sorted(needs.get(name, ()))}
            for name in self.places
        }
        """For each package, its dependencies, each with the reasons for it."""
        self._closures: dict[str, frozenset[str]] = {}

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the packages, sorted."""
        return tuple(self.places)

    @property
    def edges(self) -> Iterator[Edge]:
        """Pairs of a package and one of its direct dependencies."""
        return ((name, dependency) for name, dependencies in self.needs.items() for dependency in dependencies)

    def reasons(self, edge: Edge) -> tuple[Reason, ...]:
        """Return the reasons for an edge. Raises KeyError if there is no such edge."""
        return self.needs[edge[0]][edge[1]]

    @cached_property
    def arcs(self) -> Edges:
        """All edges, certain and uncertain."""
        return {name: frozenset(dependencies) for name, dependencies in self.needs.items()}

    @cached_property
    def certain_arcs(self) -> Edges:
        """The edges that do not depend on an unknown condition."""
        return {
            name: frozenset(
                dependency for dependency, reasons in dependencies.items() if any(reason.certain for reason in reasons)
            )
            for name, dependencies in self.needs.items()
        }

    @cached_property
    def needed_by(self) -> Edges:
        """All edges, reversed: the dependents of each package."""
        return reverse(self.arcs)

    @cached_property
    def order(self) -> Order:
        """A build order: of all packages that can be built next, the alphabetically first comes next.

        The order respects uncertain edges, too, unless they close a cycle.
        """
        names, stuck = sort(self.arcs)
        if stuck and any(self.certain_arcs[name] != self.arcs[name] for name in stuck):
            knots = [frozenset(component) for component in components(self.arcs)]
            inside = {name: knot for knot in knots for name in knot}
            arcs = {
                name: dependencies - (inside.get(name, frozenset()) - self.certain_arcs[name])
                for name, dependencies in self.arcs.items()
            }
            names, stuck = sort(arcs)
        return Order(names, stuck)

    @cached_property
    def cycles(self) -> tuple[tuple[str, ...], ...]:
        """The strongly connected components because of which colcon rejects the workspace, each sorted."""
        return components(self.certain_arcs) if self.order.stuck else ()

    @cached_property
    def possible_cycles(self) -> tuple[tuple[str, ...], ...]:
        """The strongly connected components that have a cycle only if an unknown condition is true."""
        if self.arcs == self.certain_arcs or is_acyclic(self.arcs):
            return ()
        certain = [set(cycle) for cycle in self.cycles]
        return tuple(component for component in components(self.arcs) if not any(cycle <= set(component) for cycle in certain))

    def closure(self, name: str) -> frozenset[str]:
        """Return all direct and indirect dependencies of a package. A package on a cycle is its own dependency."""
        if name not in self._closures:
            self._closures[name] = reachable(self.arcs, name)
        return self._closures[name]


@cached_by_workspace
def dependency_graph(workspace: Workspace) -> Graph:
    """Return the dependency graph of all packages of the workspace."""
    return build(workspace.packages)


def build(packages: Iterable[Package]) -> Graph:
    """Return the dependency graph of ``packages``. Dependencies on any other package are left out."""
    places: dict[str, list[Package]] = {}
    members: dict[str, list[str]] = {}
    for package in packages:
        places.setdefault(package.colcon_name, []).append(package)
        for group in package.groups:
            members.setdefault(group, []).append(package.name)
    needs: dict[str, dict[str, list[Reason]]] = {name: {} for name in places}
    for name, same in places.items():
        for package in same:
            for dependency, reason in _reasons(package, members):
                if dependency in places:
                    needs[name].setdefault(dependency, []).append(reason)
    return Graph(places, needs)


def _reasons(package: Package, members: Mapping[str, Iterable[str]]) -> Iterator[tuple[str, Reason]]:
    if package.type.startswith("ros."):  # otherwise colcon does not read the manifest
        for declared in package.declared:
            if phases := DEPENDENCY_KINDS[declared.depend.tag].phases:
                reason = Reason(declared.depend.tag, phases, declared.depend.span, declared.certain)
                yield declared.name, reason
        for declared in package.group_depends:
            reason = Reason(declared.depend.tag, ("group",), declared.depend.span, declared.certain)
            yield from ((member, reason) for member in members.get(declared.name, ()) if member != package.colcon_name)
    for depend in package.colcon_depends:
        file = depend.span.path.rpartition("/")[2]
        yield depend.name, Reason(file, tuple(_categories(depend.role)), depend.span)


def _categories(role: Role) -> Iterator[str]:
    if role & (Role.BUILD | Role.TOOL):
        yield "build"
    if role & (Role.EXPORT | Role.EXEC):
        yield "run"
    if role & Role.TEST:
        yield "test"


def components(arcs: Mapping[str, Collection[str]]) -> tuple[tuple[str, ...], ...]:
    """Return the strongly connected components that contain a cycle, sorted by their first name. Each component is sorted."""
    import networkx as nx  # noqa: PLC0415  (costs more than a run without a cycle)

    # Nodes without predecessors or without successors lie on no cycle.
    stuck = set(sort(arcs)[1])
    stuck &= set(sort(reverse({name: stuck.intersection(arcs[name]) for name in stuck}))[1])
    graph: nx.DiGraph[str] = nx.DiGraph({name: sorted(stuck.intersection(arcs[name])) for name in sorted(stuck)})
    strong_components = nx.strongly_connected_components(graph)
    return tuple(sorted(tuple(sorted(nodes)) for nodes in strong_components if len(nodes) > 1 or graph.has_edge(*nodes, *nodes)))


def reverse(arcs: Mapping[str, Collection[str]]) -> Edges:
    """Return the graph with each edge reversed."""
    result: dict[str, set[str]] = {name: set() for name in arcs}
    for name, dependencies in arcs.items():
        for dependency in dependencies:
            result[dependency].add(name)
    return {name: frozenset(dependencies) for name, dependencies in result.items()}


def reachable(arcs: Mapping[str, Collection[str]], start: str) -> frozenset[str]:
    """Return the nodes that can be reached from ``start`` over at least one edge; ``start`` itself only if it is on a cycle."""
    result: set[str] = set()
    waiting = [start]
    while waiting:
        new = set(arcs[waiting.pop()]) - result
        result |= new
        waiting += new
    return frozenset(result)


def is_acyclic(arcs: Mapping[str, Collection[str]]) -> bool:
    """Return whether a graph has no cycle."""
    return not sort(arcs)[1]


def sort(arcs: Mapping[str, Collection[str]]) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Return the nodes in an order in which dependencies come first, and the nodes that cannot be ordered.

    Nodes on a cycle, and nodes that depend on such a node, cannot be ordered. Of several possible orders, the
    alphabetically first is returned.
    """
    missing = {name: len(dependencies) for name, dependencies in arcs.items()}
    before = reverse(arcs)
    ready = [name for name, count in missing.items() if not count]
    heapify(ready)
    names: list[str] = []
    while ready:
        name = heappop(ready)
        names.append(name)
        for dependent in before[name]:
            missing[dependent] -= 1
            if not missing[dependent]:
                heappush(ready, dependent)
    return tuple(names), tuple(sorted(missing.keys() - set(names)))
