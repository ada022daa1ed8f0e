"""The graph against colcon and networkx, and its questions one by one."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterable, Mapping, Sequence
from itertools import combinations, pairwise, permutations
from pathlib import Path
from random import Random

import networkx as nx
import pytest

from ros_lint.analysis.graph.cycles import Cycle, arcs_within, cheapest_cut, cycles, shortest_cycle
from ros_lint.analysis.graph.dependency_graph import Edge, Graph, Reason, build, components, is_acyclic
from ros_lint.analysis.graph.metrics import measure
from ros_lint.base.graph_paths import paths
from ros_lint.base.text import Span, Text
from ros_lint.collectors.manifest import collect as readers
from ros_lint.facts.manifest import ColconDepend, Manifest, Role
from tests.colcon_oracle import colcon_list
from tests.packages import made, package
from tests.random_graphs import manifests

SEEDS = range(int(os.environ.get("ROS_LINT_SEEDS", "60")))
HERE = Span("x", 1, 1, 1, 1)


def graph_of(edges: Mapping[str, Iterable[str]], tag: str = "depend") -> Graph:
    names = {*edges, *(other for others in edges.values() for other in others)}
    reason = Reason(tag, {"test_depend": ("test",), "exec_depend": ("run",)}.get(tag, ("build", "run")), HERE)
    return Graph(dict.fromkeys(names, ()), {name: dict.fromkeys(edges.get(name, ()), (reason,)) for name in names})


def random_graph(random: Random, most: int) -> Graph:
    names = [f"n{number:02}" for number in range(random.randint(1, most))]
    count = random.randint(0, 3 * len(names))
    edges: dict[str, set[str]] = {name: set() for name in names}
    for _ in range(count):
        edges[random.choice(names)].add(random.choice(names))
    return graph_of(edges)


def digraph(graph: Graph) -> nx.DiGraph[str]:
    made: nx.DiGraph[str] = nx.DiGraph()
    made.add_nodes_from(graph.names)
    made.add_edges_from(graph.edges)
    return made


def without(text: str, manifest: Manifest, cut: Iterable[Edge], graph: Graph) -> str:
    """Return the manifest without the elements that make the edges to cut."""
    spans = {reason.span for edge in cut for reason in graph.reasons(edge) if reason.span.path == manifest.path}
    source = Text(manifest.path, text)
    for span in sorted(spans, reverse=True):
        start, end = source.offset(span.line, span.column), source.offset(span.end_line, span.end_column)
        text = text[:start] + " " * (end - start) + text[end:]
    return text


def write(base: Path, texts: Mapping[str, str]) -> None:
    for name, text in texts.items():
        (base / name).mkdir(parents=True, exist_ok=True)
        (base / name / "package.xml").write_text(text)


def test_orders_and_refuses_as_colcon_does(tmp_path: Path) -> None:
    refused = 0
    for seed in SEEDS:
        base = tmp_path / str(seed)
        texts = manifests(Random(seed))
        write(base, texts)
        read = {name: readers.collect(Text(f"{name}/package.xml", text)) for name, text in texts.items()}
        graph = build([made(name, name, "ros.ament_cmake", manifest) for name, manifest in read.items()])
        theirs = colcon_list(base)
        where = f"seed {seed}: {base}"
        assert {name for name, _, _ in theirs.packages} == set(texts), where
        assert (theirs.order is None) == bool(graph.order.stuck) == bool(graph.cycles), where
        for name in texts:
            known = {other: kinds for other, kinds in theirs.needs.get(name, {}).items() if other in texts}
            assert set(graph.needs[name]) == set(known), where
        if theirs.order is None:
            refused += 1
            cut = [edge for cycle in graph.cycles for edge in cheapest_cut(graph, arcs_within(graph.arcs, cycle))]
            write(base, {name: without(texts[name], read[name], cut, graph) for name in texts})
            assert colcon_list(base).order is not None, where
        else:
            assert sorted(graph.order.names) == sorted(texts)
            place = {name: index for index, name in enumerate(graph.order.names)}
            needs = theirs.needs
            assert all(place[other] < place[name] for name in texts for other in needs.get(name, {}) if other in texts), where
    assert len(SEEDS) / 5 < refused < len(SEEDS) * 4 / 5, "the generated workspaces must tell something"


def test_components_are_those_of_networkx() -> None:
    for seed in range(300):
        graph = random_graph(Random(seed), 25)
        theirs = digraph(graph)
        wanted = sorted(
            tuple(sorted(nodes))
            for nodes in nx.strongly_connected_components(theirs)
            if len(nodes) > 1 or theirs.has_edge(*nodes, *nodes)
        )
        assert list(components(graph.arcs)) == list(graph.cycles) == wanted
        assert bool(wanted) == bool(graph.order.stuck) == (not nx.is_directed_acyclic_graph(theirs))
        if not wanted:
            assert list(graph.order.names) == list(nx.lexicographical_topological_sort(theirs.reverse()))


def test_a_shortest_cycle_is_as_short_as_any() -> None:
    for seed in range(200):
        graph = random_graph(Random(seed), 9)
        cycle = shortest_cycle(graph.arcs)
        lengths = [len(found) for found in nx.simple_cycles(digraph(graph))]
        assert len(cycle) == min(lengths, default=0)
        assert all(other in graph.arcs[name] for name, other in zip(cycle, (*cycle[1:], *cycle[:1]), strict=True))
        assert not cycle or cycle[0] == min(cycle)


def test_the_cut_of_a_small_component_is_the_smallest() -> None:
    for seed in range(150):
        graph = random_graph(Random(seed), 6)
        cut = cheapest_cut(graph, graph.arcs)
        assert is_acyclic(without_edges(graph, cut))
        edges = list(graph.edges)
        smaller = (found for size in range(len(cut)) for found in combinations(edges, size))
        if len(edges) <= 14:
            assert not any(is_acyclic(without_edges(graph, found)) for found in smaller), cut


@pytest.mark.parametrize("size", [13, 20, 40])
def test_the_cut_of_a_large_component_breaks_it_and_can_spare_nothing(size: int) -> None:
    for seed in range(12):
        random = Random(seed)
        names = [f"n{number:02}" for number in range(size)]
        edges = {name: {random.choice(names) for _ in range(random.choice((1, 2, 3)))} for name in names}
        graph = graph_of(edges)
        cut = cheapest_cut(graph, graph.arcs)
        assert is_acyclic(without_edges(graph, cut))
        assert all(not is_acyclic(without_edges(graph, set(cut) - {edge})) for edge in cut)


def test_a_single_edge_that_closes_a_large_ring_is_found() -> None:
    names = [f"n{number:02}" for number in range(60)]
    edges = {name: set(names[:index][-4:]) for index, name in enumerate(names)}
    edges["n00"] = {"n59"}
    graph = graph_of(edges)
    assert cheapest_cut(graph, graph.arcs) == (("n00", "n59"),)


def test_a_clique_is_cut_in_time() -> None:
    names = [f"n{number:02}" for number in range(30)]
    graph = graph_of({name: set(names) - {name} for name in names})
    assert len(cheapest_cut(graph, graph.arcs)) == 30 * 29 // 2


def without_edges(graph: Graph, cut: Iterable[Edge]) -> dict[str, set[str]]:
    gone = set(cut)
    return {name: {other for other in graph.arcs[name] if (name, other) not in gone} for name in graph.names}


COSTS = [  # from expensive to cheap
    ("<group_depend>with_{0}</group_depend>",),
    ("<depend>{0}</depend>", "<build_depend>{0}</build_depend>"),
    ("<build_depend>{0}</build_depend>",),
    ("<exec_depend>{0}</exec_depend>", "<test_depend>{0}</test_depend>"),
    ("<test_depend>{0}</test_depend>",),
    ('<depend condition="$WHO_KNOWS == 1">{0}</depend>',),
]


@pytest.mark.parametrize(("costly", "cheap"), list(combinations(COSTS, 2)))
def test_the_cheapest_edge_of_a_cycle_is_cut(costly: tuple[str, ...], cheap: tuple[str, ...]) -> None:
    for names in permutations("ab"):
        lines = dict(zip(names, (costly, cheap), strict=True))
        other = dict(zip("ab", "ba", strict=True))
        member = "<member_of_group>with_{0}</member_of_group>"
        graph = build(
            [package(name, [*(line.format(other[name]) for line in lines[name]), member.format(name)]) for name in "ab"]
        )
        assert cheapest_cut(graph, graph.arcs) == ((names[1], names[0]),)


def rings(count: int) -> tuple[Graph, list[Edge]]:
    """Return a graph of rings with one common node, and the test dependencies: one for each ring."""
    tests: list[Edge] = []
    needs: dict[str, dict[str, list[Reason]]] = {"n": {}}
    for ring in range(count):
        names = ["n", *(f"r{ring}{number:02}" for number in range(13 // count + 1)), "n"]
        tests.append((names[2], names[3]))
        for name, other in pairwise(names):
            reason = Reason("test_depend", ("test",), HERE) if (name, other) in tests else Reason("depend", ("build",), HERE)
            needs.setdefault(name, {})[other] = [reason]
    return Graph(dict.fromkeys(needs, ()), needs), tests


@pytest.mark.parametrize("count", [1, 2])
def test_the_cheapest_of_the_smallest_cuts_of_a_large_component_is_found(count: int) -> None:
    graph, tests = rings(count)
    assert len(graph.names) > 12
    assert list(cheapest_cut(graph, graph.arcs)) == tests


def size_and_cost(graph: Graph, cut: Sequence[Edge]) -> tuple[int, int]:
    """Return the number of edges, and the number of them that are no test dependency."""
    return len(cut), sum(reason.tag != "test_depend" for edge in cut for reason in graph.reasons(edge))


def test_a_cut_of_one_or_two_edges_of_a_large_component_is_found() -> None:
    sizes = set()
    for seed in range(20):
        random = Random(seed)
        names = [f"n{number:02}" for number in range(13)]
        edges = {name: {names[index - 1]} for index, name in enumerate(names)}
        for _ in range(5):
            edges[random.choice(names)].add(random.choice(names))
        tags = (Reason("depend", ("build",), HERE), Reason("test_depend", ("test",), HERE))
        needs = {name: {other: [random.choice(tags)] for other in sorted(others - {name})} for name, others in edges.items()}
        graph = Graph(dict.fromkeys(needs, ()), needs)
        cut = cheapest_cut(graph, graph.arcs)
        pairs = (found for size in (1, 2) for found in combinations(graph.edges, size))
        cuts = [found for found in pairs if is_acyclic(without_edges(graph, found))]
        assert size_and_cost(graph, cut) == min([size_and_cost(graph, found) for found in cuts]) if cuts else len(cut) > 2
        sizes.add(len(cut))
    assert sizes >= {1, 2}


def test_certain_cycles_come_before_possible_ones() -> None:
    maybe = '<depend condition="$WHO_KNOWS == 1">{0}</depend>'
    lines = {"a": maybe.format("b"), "b": "<depend>a</depend>", "c": "<depend>d</depend>", "d": "<exec_depend>c</exec_depend>"}
    graph = build([package(name, [line]) for name, line in lines.items()])
    assert list(cycles(graph)) == [
        Cycle(("c", "d"), ("c", "d"), (("d", "c"),), certain=True),
        Cycle(("a", "b"), ("a", "b"), (("a", "b"),), certain=False),
    ]


@pytest.mark.parametrize(
    ("role", "categories"),
    [
        (Role.TOOL, ("build",)),
        (Role.EXPORT, ("run",)),
        (Role.TEST, ("test",)),
        (Role.BUILD | Role.EXEC | Role.TEST, ("build", "run", "test")),
    ],
)
def test_dependencies_of_colcon_are_read_for_their_phases(role: Role, categories: tuple[str, ...]) -> None:
    graph = build([package("a", extra=[ColconDepend("b", role, Span("src/a/colcon.pkg", 2, 5, 2, 6))]), package("b")])
    assert [(reason.tag, reason.categories) for reason in graph.reasons(("a", "b"))] == [("colcon.pkg", categories)]


def test_reasons_are_the_elements_that_make_an_edge() -> None:
    graph = build(
        [
            package("a", ["<depend>b</depend>", "<test_depend>b</test_depend>", "<group_depend>g</group_depend>"]),
            package("b", extra=[ColconDepend("c", Role.BUILD | Role.EXEC, Span("b/colcon.pkg", 2, 5, 2, 6))]),
            package("c", ["<member_of_group>g</member_of_group>", "<doc_depend>a</doc_depend>", "<exec_depend>z</exec_depend>"]),
            package("d", ["<depend>a</depend>"], kind="cmake"),
        ]
    )
    assert list(graph.edges) == [("a", "b"), ("a", "c"), ("b", "c")]
    assert [(reason.tag, reason.categories, reason.span.line) for reason in graph.reasons(("a", "b"))] == [
        ("depend", ("build", "run"), 7),
        ("test_depend", ("test",), 8),
    ]
    assert [(reason.tag, reason.categories) for reason in graph.reasons(("a", "c"))] == [("group_depend", ("group",))]
    assert [(reason.tag, reason.categories) for reason in graph.reasons(("b", "c"))] == [("colcon.pkg", ("build", "run"))]
    assert graph.order.names == ("c", "b", "a", "d")


def test_packages_of_one_name_are_one_node() -> None:
    same = [package("a", ["<depend>b</depend>"], "x"), package("a", ["<depend>c</depend>"], "y")]
    graph = build([*same, package("b"), package("c")])
    assert graph.arcs["a"] == {"b", "c"}
    assert [place.path for place in graph.places["a"]] == ["x", "y"]


def test_an_unknown_condition_orders_but_makes_no_sure_cycle() -> None:
    maybe = '<depend condition="$WHO_KNOWS == 1">{0}</depend>'
    graph = build([package("a", [maybe.format("z")]), package("z")])
    assert graph.order == (("z", "a"), ())
    graph = build([package("a", [maybe.format("z")]), package("z", ["<depend>a</depend>"]), package("m", ["<depend>z</depend>"])])
    assert graph.order == (("a", "z", "m"), ())
    assert (graph.cycles, graph.possible_cycles) == ((), (("a", "z"),))
    graph = build([package("a", [maybe.format("z"), "<test_depend>z</test_depend>"]), package("z", ["<depend>a</depend>"])])
    assert (graph.cycles, graph.possible_cycles) == ((("a", "z"),), ())


def test_uncertain_edges_that_close_no_cycle_are_respected() -> None:
    maybe = '<depend condition="$WHO_KNOWS == 1">{0}</depend>'
    lines = {"a": [maybe.format("z")], "z": [maybe.format("a")], "b": [maybe.format("y")], "y": []}
    assert build([package(name, needed) for name, needed in lines.items()]).order == (("a", "y", "b", "z"), ())


def test_a_certain_cycle_is_not_part_of_a_possible_one() -> None:
    maybe = '<depend condition="$WHO_KNOWS == 1">{0}</depend>'
    lines = {
        "a": ["<depend>b</depend>"],
        "b": ["<depend>a</depend>", maybe.format("c")],
        "c": ["<depend>a</depend>"],
        "d": [maybe.format("e")],
        "e": ["<depend>d</depend>"],
    }
    graph = build([package(name, needed) for name, needed in lines.items()])
    assert (graph.cycles, graph.possible_cycles) == ((("a", "b"),), (("d", "e"),))


def test_a_member_of_a_group_does_not_depend_on_itself() -> None:
    lines = ["<group_depend>g</group_depend>", "<member_of_group>g</member_of_group>"]
    graph = build([package("a", lines), package("b", lines[1:])])
    assert list(graph.edges) == [("a", "b")]


def test_paths_are_all_simple_paths_shortest_first() -> None:
    for seed in range(200):
        random = Random(seed)
        graph = random_graph(random, 7)
        start, end = random.choice(graph.names), random.choice(graph.names)
        found = paths(graph.needs.__getitem__, start, end, 1000)
        if start == end:
            continue
        wanted = sorted(map(tuple, nx.all_simple_paths(digraph(graph), start, end)), key=lambda path: (len(path), path))
        assert list(found.paths) == wanted
        assert not found.more
        few = paths(graph.needs.__getitem__, start, end, 2)
        assert few.paths == found.paths[:2]
        assert few.more == (len(wanted) > 2)


def test_a_way_from_a_package_to_itself_is_a_cycle() -> None:
    graph = graph_of({"a": ["b"], "b": ["c", "a"], "c": ["a"]})
    assert paths(graph.needs.__getitem__, "a", "a", 9).paths == (("a", "b", "a"), ("a", "b", "c", "a"))


def test_the_cycles_through_a_package_are_all_cycles_shortest_first() -> None:
    for seed in range(100):
        graph = random_graph(Random(seed), 6)
        for name in graph.names:
            found = paths(graph.needs.__getitem__, name, name, 1000)
            wanted = [
                (*cycle[cycle.index(name) :], *cycle[: cycle.index(name)], name)
                for cycle in nx.simple_cycles(digraph(graph))
                if name in cycle
            ]
            assert list(found.paths) == sorted(map(tuple, wanted), key=lambda path: (len(path), path))
            assert not found.more


def test_paths_end_in_a_knot_of_cycles() -> None:
    names = [f"n{number:02}" for number in range(40)]
    graph = graph_of({name: [other for other in names if other != name] for name in names})
    found = paths(graph.needs.__getitem__, "n00", "n39", 10)
    assert len(found.paths) == 10
    assert found.more


def test_the_first_paths_of_very_many_are_found() -> None:
    """A search in the order of the lengths so far would visit 2**40 paths."""
    edges: dict[str, list[str]] = {}
    for number in range(40):
        sides = [f"{number:02}{side}" for side in "ab"]
        edges[f"{number:02}"] = sides
        edges |= {side: [f"{number + 1:02}"] for side in sides}
    found = paths(graph_of(edges).needs.__getitem__, "00", "40", 3)
    assert [path[-3:] for path in found.paths] == [("39", "39a", "40"), ("39", "39b", "40"), ("39", "39a", "40")]
    assert found.more


def test_a_search_that_is_too_long_ends_with_what_it_has_found() -> None:
    clique = [f"k{number}" for number in range(8)]
    edges = {name: ["a", *(other for other in clique if other != name)] for name in clique}
    found = paths(graph_of({**edges, "a": ["b", *clique]}).needs.__getitem__, "a", "b", 2)
    assert found == ((("a", "b"),), True)


def test_metrics_are_those_of_networkx_where_there_is_no_cycle() -> None:
    for seed in range(200):
        random = Random(seed)
        names = [f"n{number:02}" for number in range(random.randint(1, 14))]
        below = {name: names[:index] for index, name in enumerate(names)}
        graph = graph_of({name: random.sample(found, min(len(found), random.randint(0, 4))) for name, found in below.items()})
        theirs = digraph(graph)
        reduced = nx.transitive_reduction(theirs)
        for name, metrics in measure(graph).items():
            assert metrics.needed_by == theirs.in_degree(name)
            assert metrics.needs == theirs.out_degree(name)
            assert metrics.reach == len(nx.ancestors(theirs, name))
            assert metrics.depth == nx.dag_longest_path_length(theirs.subgraph({name, *nx.descendants(theirs, name)}))
            redundant = [way[-1] for way in metrics.redundant]
            assert redundant == sorted(set(graph.needs[name]) - set(reduced[name]))
            for way in metrics.redundant:
                assert way[0] == name
                assert all(graph.reasons(edge) for edge in pairwise(way))
                shorter = theirs.copy()
                shorter.remove_edge(name, way[-1])
                assert len(way) - 1 == nx.shortest_path_length(shorter, name, way[-1])


def test_metrics_take_a_cycle_for_one_package() -> None:
    graph = graph_of({"top": ["a", "low"], "a": ["b", "low"], "b": ["a", "low"]})
    found = measure(graph)
    assert {name: (m.needed_by, m.needs, m.depth, m.reach) for name, m in found.items()} == {
        "a": (2, 2, 1, 2),
        "b": (1, 2, 1, 2),
        "low": (3, 0, 0, 3),
        "top": (0, 2, 2, 0),
    }
    assert {name: m.redundant for name, m in found.items() if m.redundant} == {"top": (("top", "a", "low"),)}


def test_metrics_are_those_of_the_components_of_networkx() -> None:
    for seed in range(150):
        graph = random_graph(Random(seed), 10)
        theirs = digraph(graph)
        condensed = nx.condensation(theirs)
        component = condensed.graph["mapping"]
        for name, metrics in measure(graph).items():
            below = condensed.subgraph({component[name], *nx.descendants(condensed, component[name])})
            assert metrics.needed_by == len(set(theirs.predecessors(name)) - {name})
            assert metrics.needs == len(set(theirs.successors(name)) - {name})
            assert metrics.reach == len(nx.ancestors(theirs, name))
            assert metrics.depth == nx.dag_longest_path_length(below)
            indirect = {}
            for dependency in graph.needs[name]:
                inside = {component[name], component[dependency]}
                lengths = [
                    nx.shortest_path_length(theirs, third, dependency) + 1
                    for third in graph.needs[name]
                    if component[third] not in inside and nx.has_path(theirs, third, dependency)
                ]
                if lengths and len(inside) == 2:
                    indirect[dependency] = min(lengths)
            assert {way[-1]: len(way) - 1 for way in metrics.redundant} == indirect
            assert all(way[0] == name and all(theirs.has_edge(*edge) for edge in pairwise(way)) for way in metrics.redundant)


def test_a_graph_without_a_cycle_waits_for_no_library() -> None:
    """The time of the import would be a tenth of a whole run."""
    code = (
        "import sys; from ros_lint.analysis.graph.dependency_graph import Graph; g = Graph({'a': (), 'b': ()}, {'a': {'b': ()}});"
        "assert g.order.names == ('b', 'a') and g.cycles == () and g.possible_cycles == ();"
        "assert 'networkx' not in sys.modules"
    )
    subprocess.run([sys.executable, "-c", code], check=True, env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)})


def test_the_closure_is_all_that_can_be_reached() -> None:
    for seed in range(100):
        graph = random_graph(Random(seed), 12)
        theirs = digraph(graph)
        for name in graph.names:
            on_cycle = any(name in cycle for cycle in graph.cycles)
            assert graph.closure(name) == nx.descendants(theirs, name) | ({name} if on_cycle else set())
