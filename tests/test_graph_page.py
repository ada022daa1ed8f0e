"""What ``ros-lint graph`` draws, and its page in a browser."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

from ros_lint.cli.commands import graph
from ros_lint.cli.commands.graph_part import GraphOptions, edges_in_cycles, is_test_only, part_of_graph
from ros_lint.cli.session import UsageError
from ros_lint.workspace.model import Workspace
from tests.browser import opened
from tests.one_package import loaded
from tests.packages import manifest_text

DIAMOND = {
    "top": ["<depend>left</depend>", "<depend>right</depend>", "<depend>low</depend>"],
    "left": ["<depend>low</depend>"],
    "right": ["<depend>low</depend>", "<test_depend>rclcpp</test_depend>"],
    "low": ["<depend>rclcpp</depend>"],
    "apart": [],
}
KNOT = {"a": ["<depend>b</depend>"], "b": ["<test_depend>a</test_depend>"], "c": ["<depend>a</depend>"]}


def workspace(depends: dict[str, list[str]]) -> Workspace:
    files = {f"{name}/package.xml": manifest_text(name, tags) for name, tags in depends.items()}
    return loaded({**files, **{f"{name}/CMakeLists.txt": f"project({name})\n" for name in depends}})


def edges(options: GraphOptions, depends: dict[str, list[str]] | None = None) -> set[tuple[str, str]]:
    return set(part_of_graph(workspace(depends or DIAMOND), options).edges)


def names(options: GraphOptions) -> list[str]:
    return list(part_of_graph(workspace(DIAMOND), options).names)


def test_an_edge_that_a_longer_path_implies_is_left_out_on_request() -> None:
    assert ("top", "low") in edges(GraphOptions())
    assert edges(GraphOptions()) - edges(GraphOptions(reduce=True)) == {("top", "low")}


def test_edges_of_a_cycle_are_never_implied() -> None:
    assert edges(GraphOptions(reduce=True), KNOT) == {("a", "b"), ("b", "a"), ("c", "a")}
    assert edges_in_cycles(part_of_graph(workspace(KNOT), GraphOptions())) == {("a", "b"), ("b", "a")}


def test_a_focus_has_its_dependencies_and_dependents() -> None:
    assert names(GraphOptions(focus="left")) == ["left", "low", "top"]
    assert names(GraphOptions(focus="low", depth=1)) == ["left", "low", "right", "top"]
    assert names(GraphOptions(focus="apart")) == ["apart"]


def test_an_unknown_focus_is_an_error_with_a_hint() -> None:
    with pytest.raises(UsageError, match="there is no package 'lef' in the graph; did you mean 'left'"):
        names(GraphOptions(focus="lef"))


def test_external_packages_are_added_on_request() -> None:
    graph_with_external = part_of_graph(workspace(DIAMOND), GraphOptions(external=True))
    assert graph_with_external.places["rclcpp"] == ()
    to_rclcpp = [edge for edge in graph_with_external.edges if edge[1] == "rclcpp"]
    assert [(edge[0], is_test_only(graph_with_external, edge)) for edge in to_rclcpp] == [("low", False), ("right", True)]
    assert ("right", "rclcpp") not in edges(GraphOptions(external=True, kinds=("build",)))


def test_every_format_prints_the_chosen_part() -> None:
    chosen = GraphOptions(focus="left", reduce=True)
    for form in graph.FORMATS:
        text = graph.run(workspace(DIAMOND), form, chosen)[0]
        assert ("left" in text, "apart" in text) == (True, False), form
    document = json.loads(graph.run(workspace(DIAMOND), "json", GraphOptions(external=True), metrics=True)[0])
    assert [package["places"] for package in document["packages"] if package["name"] == "rclcpp"] == [[]]


def page(depends: dict[str, list[str]], title: str = "robot") -> str:
    return graph.run(workspace(depends), "html", title=title)[0]


def test_the_page_has_the_data_and_loads_nothing() -> None:
    text = page(DIAMOND, "</script><b>")
    assert "<title>Dependencies of &lt;/script&gt;&lt;b&gt;</title>" in text
    assert text.count("</script>") == 2, "the data cannot end its element"
    found = re.search(r'<script id="data" type="application/json">(.*?)</script>', text, re.DOTALL)
    assert found
    data = json.loads(found[1])
    assert [node["name"] for node in data["nodes"]] == sorted(DIAMOND)
    [implied] = [edge for edge in data["edges"] if edge["implied"]]
    assert implied["reasons"] == [{"tag": "depend", "place": "top/package.xml:9", "kinds": ["build", "run"], "certain": True}]
    assert not re.search(r"""(?:src|href)=|url\((?!#)|@import|fetch\(|XMLHttpRequest""", text)


@pytest.mark.slow
def test_the_page_in_a_browser(tmp_path: Path) -> None:
    with opened(tmp_path / "graph.html", page({**DIAMOND, **KNOT})) as tab:

        def shown() -> list[str]:
            return sorted(tab.locator(".node text").all_text_contents())

        assert shown() == sorted([*DIAMOND, *KNOT])
        assert "There is a dependency cycle" in tab.inner_text("#status")
        colour = "getComputedStyle(document.querySelector('path.edge.cycle')).stroke"
        colour_of_cycles = tab.evaluate(colour)
        tab.click(".node[aria-label^='a, ']")
        assert tab.locator("path.edge.near").count() == 3
        assert tab.evaluate(colour) == colour_of_cycles, "a selected package keeps the colour of its cycles"
        tab.fill("#search", "left")
        assert shown() == ["left", "low", "top"]
        assert tab.inner_text("#details h2") == "left"
        assert tab.evaluate("document.activeElement.getAttribute('aria-label')").startswith("left, ros.ament_cmake")
        tab.keyboard.press("ArrowRight")
        assert tab.inner_text("#details h2") == "low"
        tab.keyboard.press("Enter")
        assert shown() == ["left", "low", "right", "top"]
        tab.keyboard.press("Escape")
        assert len(shown()) == len(DIAMOND) + len(KNOT)
        count = tab.locator("path.edge").count()
        tab.check("#implied")
        assert tab.locator("path.edge").count() == count + 1
        tab.click("#matrix-button")
        assert tab.locator("td button").count() == count + 1
        assert tab.locator("td button.cycle").count() == 2
        sizes = [button.bounding_box() for button in tab.locator("table button").all()]
        assert min(min(size["width"], size["height"]) for size in sizes) >= 24, "targets of WCAG 2.2 AA"
        tab.fill("#search", "nothing_like_it")
        tab.press("#search", "Enter")
        assert tab.inner_text("#status") == "No package contains 'nothing_like_it'."
