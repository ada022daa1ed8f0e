"""Look-ups of names: layers, closures, contents and providers."""

from __future__ import annotations

import itertools
import random
from pathlib import Path

import networkx as nx
import pytest

import ros_lint
from ros_lint.knowledge import Knowledge
from ros_lint.knowledge.closure import Reach
from tests.worlds import member, world, write_prefix

JAZZY = Knowledge("jazzy")


@pytest.fixture
def prefix(tmp_path: Path) -> str:
    return write_prefix(tmp_path)


# --- layers ----------------------------------------------------------------------------------------------------------


def test_the_topmost_layer_with_a_package_counts(prefix: str) -> None:
    result = world(member("rclcpp", "100.0.0"), member("mine"), prefixes=(prefix,))
    assert result.layer("rclcpp") == "workspace"
    assert result.version("rclcpp") == "100.0.0"
    assert world(prefixes=(prefix,)).version("rclcpp") == "99.0.0"
    assert world().version("rclcpp") == (JAZZY.index.get("rclcpp") or result.released("x")).version  # type: ignore[union-attr]
    assert [result.layer(name) for name in ("mine", "private_tool", "rclpy", "eigen", "nonsense_pkg")] == [
        "workspace", "underlay", "index", None, None
    ]  # fmt: skip
    assert result.version("nonsense_pkg") is None


def test_a_name_can_be_a_package_and_a_key() -> None:
    result = world(member("mine"))
    assert [(result.is_package(n), result.is_key(n)) for n in ("mine", "eigen", "rclcpp", "nonsense_pkg")] == [
        (True, False), (False, True), (True, False), (False, False)
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("name", "standing"),
    [
        ("rclcpp", "known"),
        ("eigen", "known"),
        ("mine", "known"),
        ("gazebo_ros", "elsewhere"),
        ("roscpp", "end-of-life"),
        ("nonsense_pkg", "unknown"),
        ("ament_python", "unknown"),
    ],
)
def test_a_declared_name_is_classified(name: str, standing: str) -> None:
    assert world(member("mine")).resolution(name) == standing


def test_nothing_is_unknown_without_an_index() -> None:
    result = world(member("mine"), distro="iron")
    assert result.resolution("nonsense_pkg") == "unknowable"
    assert result.resolution("mine") == result.resolution("eigen") == "known"
    assert not result.closure(["rclcpp"]).complete


def test_of_two_members_with_one_name_the_first_counts() -> None:
    assert world(member("twin", "1.0.0"), member("twin", "2.0.0")).version("twin") == "1.0.0"


def test_dependencies_are_selected_by_kind(prefix: str) -> None:
    result = world(member("mine", b=("rclcpp",), x=("rclpy", "eigen")), prefixes=(prefix,))
    assert result.depends("mine", "bx") == ("eigen", "rclcpp", "rclpy")
    assert result.depends("private_tool", "x") == ("rclcpp", "rclpy")
    assert result.depends("private_tool", "b") == ("rclpy",)
    assert "rosidl_default_runtime" in (result.depends("std_msgs", "x") or ())
    assert result.depends("nonsense_pkg", "x") is None
    assert result.depends("unbag", "x") is None  # only its name is known


def test_dependents_in_underlays_are_found(prefix: str) -> None:
    assert world(member("rclcpp"), prefixes=(prefix,)).dependents_below("rclcpp") == ("private_tool",)
    assert world(member("rclcpp"), member("private_tool"), prefixes=(prefix,)).dependents_below("rclcpp") == ()


# --- closures --------------------------------------------------------------------------------------------------------


def _keys() -> nx.DiGraph[str]:
    graph: nx.DiGraph[str] = nx.DiGraph()
    for line in (Path(ros_lint.__file__).parent / "knowledge/data/key_brings.tsv").read_text("utf-8").splitlines()[1:]:
        key, _, brought = line.partition("\t")
        graph.add_edges_from((key, other) for other in brought.split())
    return graph


_KEYS = _keys()


def _expected(known: Knowledge, starts: list[str]) -> set[str]:
    """Return the closure over the index alone, as networkx finds it."""
    graph: nx.DiGraph[str] = nx.DiGraph()
    for name in known.index.names():
        package = known.index.get(name)
        assert package is not None
        graph.add_node(name)
        if package.described:
            graph.add_edges_from((name, other) for kind in "eux" for other in package.depends.get(kind, ()))
    known_packages = set(known.index.names())
    for name in [name for name in graph if name in _KEYS and name not in known_packages]:
        graph.add_edges_from((name, other) for other in nx.descendants(_KEYS, name))
    return set().union(*({start} | nx.descendants(graph, start) for start in starts))


def test_closures_equal_those_of_networkx() -> None:
    chance = random.Random(3)
    names = list(JAZZY.index.names())
    result = world()
    for _ in range(15):
        starts = chance.sample(names, chance.randint(1, 8))
        closure = result.closure(starts)
        expected = _expected(JAZZY, starts)
        assert closure.names == expected
        assert len(closure) == len(expected)
        assert sorted(closure) == sorted(expected)
        assert all((name in closure) == (name in expected) for name in names[::11])


def test_closures_of_cycles_do_not_depend_on_the_order_of_queries() -> None:
    chance = random.Random(5)
    for _ in range(200):
        count = chance.randint(1, 12)
        edges = [(a, b) for a, b in itertools.product(range(count), repeat=2) if chance.random() < 0.2]
        graph = nx.DiGraph(edges)
        graph.add_nodes_from(range(count))
        dark = {str(node) for node in range(count) if chance.random() < 0.1}
        graph.remove_edges_from([edge for edge in edges if str(edge[0]) in dark])
        after = {str(node): tuple(map(str, graph.successors(node))) for node in graph}
        reach = Reach(lambda name, after=after, dark=dark: None if name in dark else after[name])
        asked = list(map(str, range(count)))
        chance.shuffle(asked)
        for name in asked:
            expected = {name} | {str(node) for node in nx.descendants(graph, int(name))}
            closure = reach.closure([name])
            assert closure.names == expected
            assert closure.complete == expected.isdisjoint(dark)
            assert {*closure.unknown} == expected & dark
            for goal in map(str, range(count)):
                path = reach.path([name], goal)
                if goal not in expected:
                    assert path == ()
                    continue
                assert (path[0], path[-1]) == (name, goal)
                assert all(b in after[a] for a, b in itertools.pairwise(path))
                assert len(path) == 1 + nx.shortest_path_length(graph, int(name), int(goal))
        changed, *gone = chance.choices(asked, k=4)
        left = {**after, changed: tuple([name for name in after[changed] if name not in gone])}
        other = Reach(lambda name, after=left, dark=dark: None if name in dark else after[name])
        for names in ([name, asked[0]] for name in asked):
            result, expected = reach.closure_without(names, changed, gone), other.closure(names)
            assert (result.names, result.unknown) == (expected.names, expected.unknown)


def test_exported_and_run_time_dependencies_propagate() -> None:
    result = world(
        member("app", b=("built",), t=("tool",), s=("tested",), d=("docs",), x=("run",)),
        *(member(name) for name in ("built", "tool", "tested", "docs", "run")),
    )
    assert result.closure(["app"]).names == {"app", "run"}
    kinds = {"e": ("exported",), "u": ("exported_tool",), "x": ("run",)}
    result = world(member("app", **kinds), member("exported"), member("exported_tool"), member("run"))
    assert result.closure(["app"]).names == {"app", "exported", "exported_tool", "run"}


def test_the_closure_has_workspace_members_of_a_group() -> None:
    result = world(member("app", G=("talkers",)), member("ada", groups=("talkers",)), member("bob"))
    assert result.closure(["app"]).names == {"app", "ada"}
    assert result.group_members("talkers") == ("ada",)
    assert result.group_members("nobody") == ()
    assert "rmw_cyclonedds_cpp" in result.group_members("rmw_implementation_packages")
    assert "std_msgs" in result.group_members("rosidl_interface_packages")


def test_a_closure_follows_the_topmost_layer(prefix: str) -> None:
    result = world(member("mine", x=("private_tool",)), prefixes=(prefix,))
    closure = result.closure(["mine"])
    assert {"private_tool", "rclcpp", "private_base", "std_msgs", "builtin_interfaces", "rcl"} <= closure.names
    assert closure.complete
    assert result.path(["mine"], "builtin_interfaces")[:2] == ("mine", "private_tool")
    # The rclcpp of the underlay needs nothing but private_base, and the one of the workspace nothing at all.
    assert "libstatistics_collector" not in result.closure(["rclcpp"])
    assert result.closure(["rclcpp"]).names >= {"private_base", "std_msgs"}
    assert world(member("rclcpp"), prefixes=(prefix,)).closure(["rclcpp"]).names == {"rclcpp"}


@pytest.mark.parametrize(
    ("name", "complete"),
    [("rclcpp", True), ("eigen", True), ("nonsense_pkg", False), ("unbag", False), ("roscpp", False)],
)
def test_a_closure_is_complete_if_all_dependencies_are_known(name: str, complete: bool) -> None:
    closure = world(member("mine", x=(name,))).closure(["mine"])
    assert closure.complete is complete
    assert closure.unknown == (() if complete else (name,))


@pytest.mark.parametrize(
    ("declared", "comes", "distros"),
    [
        ("rclcpp_components", "class_loader", "humble jazzy lyrical"),
        ("rclcpp_components", "ament_index_cpp", "humble jazzy lyrical"),
        ("pluginlib", "class_loader", "humble jazzy lyrical"),
        ("launch_ros", "ament_index_python", "humble jazzy lyrical"),
        ("ros2launch", "launch_xml", "humble jazzy lyrical"),
        ("tf2_ros", "geometry_msgs", "humble jazzy lyrical"),
        ("rclcpp_lifecycle", "lifecycle_msgs", "humble jazzy lyrical"),
        ("ament_cmake_auto", "ament_cmake", "humble jazzy lyrical"),
        ("controller_interface", "hardware_interface", "humble jazzy lyrical"),
        ("launch_testing_ament_cmake", "launch_testing", "humble jazzy lyrical"),
        ("rosidl_default_generators", "action_msgs", "jazzy lyrical"),
        ("std_msgs", "service_msgs", "jazzy lyrical"),
        ("tf2_ros", "tf2_ros_py", ""),
        ("launch_ros", "launch_xml", ""),
        ("rclcpp", "rosidl_runtime_py", ""),
    ],
)
def test_closures_equal_independently_computed_ones(declared: str, comes: str, distros: str) -> None:
    """Taken from the packages as another distributor builds them (reference, section E3.7)."""
    known = {distro for distro in ("humble", "jazzy", "lyrical") if comes in world(distro=distro).closure([declared])}
    assert known == {*distros.split()}


# --- what packages provide ----------------------------------------------------------------------------------------------


# --- whose name is it ------------------------------------------------------------------------------------------------


# --- what was meant --------------------------------------------------------------------------------------------------
