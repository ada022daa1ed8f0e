"""The commands that query the dependency graph: order, why, graph and overlay."""

from __future__ import annotations

import html
import json
import re
import shutil
import subprocess
from collections.abc import Iterable
from pathlib import Path

import pytest

from ros_lint.analysis.graph.dependency_graph import dependency_graph
from ros_lint.base.text import Span
from ros_lint.cli.commands import graph, order, overlay, why
from ros_lint.facts.manifest import Role
from ros_lint.facts.sources import Use
from ros_lint.knowledge import Knowledge
from ros_lint.knowledge import underlays as underlay
from ros_lint.knowledge.world import Member, World
from ros_lint.workspace.model import Package, Workspace
from ros_lint.workspace.target import TargetDistro
from tests.one_package import loaded
from tests.packages import manifest_text, package

ODD = 'a "b" \\ <c>\n;'


def workspace(packages: Iterable[Package], prefixes: Iterable[Path] = ()) -> Workspace:
    result = tuple(packages)
    members = [Member(entry.name, entry.manifest.version if entry.manifest else "", {}) for entry in result]
    underlays = underlay.read([str(prefix) for prefix in prefixes]) if prefixes else ()
    return Workspace(result, (), World(members, underlays, Knowledge("jazzy")), TargetDistro("jazzy", "--distro"), ())


CHAIN = (
    package("top", ["<depend>middle</depend>", "<test_depend>low</test_depend>"]),
    package("middle", ["<exec_depend>low</exec_depend>", "<build_depend>low</build_depend>", "<depend>rclcpp</depend>"]),
    package("low"),
)
KNOT = (
    package("a", ["<depend>b</depend>"]),
    package("b", ["<test_depend>a</test_depend>"]),
    package("c", ["<depend>b</depend>"]),
    package("free"),
)


def test_order_prints_dependencies_first() -> None:
    assert order.run(workspace(CHAIN)) == ("low\nmiddle\ntop\n", "", 0)
    assert order.run(workspace(())) == ("", "", 0)


def test_order_names_packages_that_a_cycle_blocks() -> None:
    assert order.run(workspace(KNOT)) == (
        "free\n",
        "no build order, because of a dependency cycle: a, b\n"
        "  shortest cycle: a -> b -> a\n"
        "    a/package.xml:7:3: a depends on b (depend)\n"
        "    b/package.xml:7:3: b depends on a (test_depend); removing it breaks the cycle\n"
        "no build order, because of a dependency on a package of the cycle: c\n",
        1,
    )


def test_order_rejects_duplicate_names() -> None:
    out, output, code = order.run(
        workspace([package("a", path="x"), package("a", path="y"), package("b", ["<depend>a</depend>"])])
    )
    assert (out, code) == ("a\nb\n", 1)
    assert output == "2 packages are named 'a', so colcon rejects the workspace: x and y\n"


def test_why_prints_every_path_with_tag_and_line() -> None:
    use = Use("low", ("low",), Role.BUILD, "#include <low/low.hpp>", "include", False, Span("middle/src/m.cpp", 3, 1, 3, 9))
    packages = [entry._replace(uses=(use,) * (entry.name == "middle")) for entry in CHAIN]
    assert why.run(workspace(packages), "top", "low") == (
        "'top' depends on 'low' through 2 paths; shortest first:\n"
        "\n"
        "1. top -> low\n"
        "   top -> low: <test_depend> top/package.xml:8:3\n"
        "\n"
        "2. top -> middle -> low\n"
        "   top -> middle: <depend> top/package.xml:7:3\n"
        "   middle -> low: <exec_depend> middle/package.xml:7:3\n"
        "   middle -> low: <build_depend> middle/package.xml:8:3\n"
        "      because of #include <low/low.hpp> middle/src/m.cpp:3:1\n",
        "",
        0,
    )


def test_why_follows_dependencies_of_released_packages() -> None:
    out, output, code = why.run(workspace(CHAIN), "top", "rcl", most=1)
    assert (output, code) == ("", 0)
    head = "'top' depends on 'rcl' through at least 1 path:\n\n1. top -> middle -> rclcpp -> rcl\n"
    assert out.startswith(head)
    assert "   middle -> rclcpp: <depend> middle/package.xml:9:3\n" in out
    assert "   rclcpp -> rcl: <exec_depend> as released in jazzy\n" in out


def test_why_follows_test_dependencies_only_of_the_first_package() -> None:
    packages = [
        package("top", ["<depend>middle</depend>"]),
        package("middle", ["<test_depend>low</test_depend>"]),
        package("low"),
    ]
    assert why.run(workspace(packages), "top", "low") == ("'top' does not depend on 'low'\n", "", 1)
    assert "middle -> low: <test_depend>" in why.run(workspace(packages), "middle", "low")[0]
    both = package("middle", ["<test_depend>low</test_depend>", "<exec_depend>low</exec_depend>"])
    out = why.run(workspace([packages[0], both, packages[2]]), "top", "low")[0]
    assert "middle -> low: <exec_depend>" in out
    assert "test_depend" not in out


def test_why_without_a_path_gives_exit_code_1() -> None:
    assert why.run(workspace(CHAIN), "middle", "top") == (
        "'middle' does not depend on 'top'; but 'top' depends on 'middle': see 'ros-lint why top middle'\n",
        "",
        1,
    )
    assert why.run(workspace(CHAIN), "low", "rclcpp") == ("'low' does not depend on 'rclcpp'\n", "", 1)


def test_why_suggests_names_for_unknown_ones() -> None:
    out, output, code = why.run(workspace(CHAIN), "midle", "rclcp")
    assert (out, code) == ("", 2)
    first, second = output.splitlines()
    assert first.startswith("ros-lint: unknown package or rosdep key 'midle'; did you mean ")
    assert re.match("ros-lint: unknown package or rosdep key 'rclcp'; did you mean .*rclcpp", second)


def test_why_prints_the_condition_of_an_edge() -> None:
    lines = ['<depend condition="$X == 1">b</depend>', '<depend condition="$X == 2">curl</depend>']
    result = workspace([package("a", lines), package("b")])
    assert "a -> b: <depend> if its condition is true a/package.xml:7:3" in why.run(result, "a", "b")[0]
    assert "a -> curl: <depend> if $X == 2 a/package.xml:8:3" in why.run(result, "a", "curl")[0]


def test_why_ignores_a_manifest_that_colcon_does_not_read() -> None:
    result = workspace([package("a", ["<depend>b</depend>", "<depend>rclcpp</depend>"], kind="cmake"), package("b")])
    assert why.run(result, "a", "b")[2] == why.run(result, "a", "rclcpp")[2] == 1


def test_graph_prints_dot() -> None:
    assert graph.run(workspace(CHAIN)) == (
        "digraph workspace {\n"
        "  rankdir=LR;\n"
        "  node [shape=box, fontname=Helvetica];\n"
        '  "low";\n'
        '  "middle";\n'
        '  "top";\n'
        '  "middle" -> "low";\n'
        '  "top" -> "low" [style=dashed];\n'
        '  "top" -> "middle";\n'
        "}\n",
        "",
        0,
    )
    assert '"b" -> "a" [style=dashed, color=red];' in graph.run(workspace(KNOT))[0]


def test_graph_prints_mermaid() -> None:
    assert graph.run(workspace(KNOT), "mermaid")[0] == (
        "flowchart LR\n"
        '  p0["a"]\n'
        '  p1["b"]\n'
        '  p2["c"]\n'
        '  p3["free"]\n'
        "  p0 --> p1\n"
        "  p1 -.-> p0\n"
        "  p2 --> p1\n"
        "  linkStyle 0,1 stroke:red\n"
    )


def test_odd_names_are_quoted() -> None:
    result = workspace([package("a")._replace(name=ODD)])
    assert '  "a \\"b\\" &#92; <c>\n;";\n' in graph.run(result)[0]
    assert '  p0["a #34;b#34; #92; #60;c#62;#10;#59;"]\n' in graph.run(result, "mermaid")[0]


@pytest.mark.skipif(shutil.which("dot") is None, reason="Graphviz is not installed")
def test_graphviz_reads_the_names() -> None:
    for packages in (CHAIN, KNOT, [package("a")._replace(name=ODD)]):
        text = graph.run(workspace(packages))[0]
        read = json.loads(subprocess.run(["dot", "-Tjson0"], input=text, capture_output=True, text=True, check=True).stdout)
        assert [html.unescape(node["name"]) for node in read["objects"]] == sorted(package.name for package in packages)


def test_graph_prints_json() -> None:
    document = json.loads(graph.run(workspace(KNOT), "json", metrics=True)[0])
    assert document["schema_version"] == 1
    assert [entry["name"] for entry in document["packages"]] == ["a", "b", "c", "free"]
    assert document["packages"][2] == {
        "name": "c",
        "places": [{"path": "c", "type": "ros.ament_cmake"}],
        "metrics": {"needed_by": 0, "needs": 1, "depth": 1, "reach": 0, "redundant": []},
    }
    assert document["edges"][1] == {
        "from": "b",
        "to": "a",
        "test_only": True,
        "certain": True,
        "reasons": [{"tag": "test_depend", "categories": ["test"], "path": "b/package.xml", "line": 7, "column": 3}],
    }
    assert document["cycles"] == [{"packages": ["a", "b"], "cycle": ["a", "b"], "cut": [["b", "a"]], "certain": True}]
    assert "metrics" not in json.loads(graph.run(workspace(KNOT), "json")[0])["packages"][0]


def test_metrics_are_printed_as_a_table() -> None:
    assert graph.run(workspace(CHAIN), metrics=True)[0] == (
        "package  needed by  needs  depth  reach  redundant\n"
        "low              2      0      0      2          0\n"
        "middle           1      1      1      1          0\n"
        "top              0      2      2      0          1\n"
        "\n"
        "Redundant edges, because another path implies the same build order:\n"
        "  top -> low: top -> middle -> low\n"
    )


def prefix(root: Path, *names: str) -> Path:
    for name in names:
        (root / "share" / name).mkdir(parents=True)
        (root / "share" / name / "package.xml").write_text(manifest_text(name).replace("0.1.0", "7.0.0"))
        (root / "share" / "ament_index" / "resource_index" / "packages").mkdir(parents=True, exist_ok=True)
        (root / "share" / "ament_index" / "resource_index" / "packages" / name).write_text("")
    return root


def test_overlay_marks_the_layer_that_wins(tmp_path: Path) -> None:
    upper, lower = prefix(tmp_path / "upper", "mine", "both"), prefix(tmp_path / "lower", "both", "alone")
    result = workspace([package("mine", path="src/mine"), package("new")], [upper, lower])
    text, output, code = overlay.run(result)
    assert (output, code) == ("", 0)
    assert text.replace(str(tmp_path), "/opt") == (
        "both\n"
        "  * /opt/upper  7.0.0  underlay 1\n"
        "    /opt/lower  7.0.0  underlay 2\n"
        "\n"
        "mine\n"
        f"  * src/mine{' ' * (len(str(upper)) - len('src/mine'))}  0.1.0  workspace\n"
        "    /opt/upper  7.0.0  underlay 1\n"
    )


def test_overlay_lists_released_packages_and_duplicates() -> None:
    text = overlay.run(workspace([package("rclcpp", path="x"), package("rclcpp", path="y"), package("own")]))[0]
    assert re.fullmatch(
        r"rclcpp\n"
        r"  \? x                  0\.1\.0  +workspace\n"
        r"  \? y                  0\.1\.0  +workspace\n"
        r"    released in jazzy  \d+\.\d+\.\d+ +distribution\n"
        r"    colcon rejects the workspace, because 2 packages are named 'rclcpp'\n",
        text,
    )


def test_overlay_without_packages_in_several_layers() -> None:
    assert overlay.run(workspace([package("own")])) == ("No package exists in more than one layer.\n", "", 0)


def test_why_prints_the_uses_of_an_undeclared_dependency() -> None:
    files = {
        "a/package.xml": manifest_text("a"),
        "a/CMakeLists.txt": "project(a)\nfind_package(nav_msgs REQUIRED)\nament_package()\n",
    }
    result = loaded(files)
    assert why.run(result, "a", "nav_msgs") == (
        "'a' uses 'nav_msgs', but declares neither it nor anything that depends on it:\n"
        "   a/CMakeLists.txt:2:14: find_package(nav_msgs), needed to build\n",
        "",
        1,
    )


RENAMED = (
    package("top", ["<depend>low</depend>"])._replace(renamed="vendor_top"),
    package("low", ["<depend>rclcpp</depend>"])._replace(renamed="vendor_low"),
    package("user", ["<depend>vendor_low</depend>"]),
)
"""Packages that colcon calls by other names than package.xml does."""


def test_order_and_graph_have_the_names_of_colcon() -> None:
    result = workspace(RENAMED)
    assert order.run(result) == ("vendor_low\nuser\nvendor_top\n", "", 0)
    assert list(dependency_graph(result).edges) == [("user", "vendor_low")], (
        "colcon does not see what a manifest calls by another name"
    )


@pytest.mark.parametrize("name", ["low", "vendor_low"])
def test_why_accepts_the_name_in_the_manifest_and_that_of_colcon(name: str) -> None:
    out, output, code = why.run(workspace(RENAMED), name, "rcl", 1)
    assert (output, code) == ("", 0)
    assert f"{name} -> rclcpp: <depend> low/package.xml:7:3\n" in out


def test_overlay_with_one_name_in_the_manifests_and_two_for_colcon() -> None:
    twins = [package("rclcpp", path="x"), package("rclcpp", path="y")._replace(renamed="rclcpp_2")]
    assert "refuses" not in overlay.run(workspace(twins))[0]
