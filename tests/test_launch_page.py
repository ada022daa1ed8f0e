"""The page of ``ros-lint launch --format html``: escapes, conditions, and the controls in a browser."""

from __future__ import annotations

import itertools
import json
import re
from collections.abc import Mapping
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import pytest

from ros_lint.base.tree import MemoryTree
from ros_lint.cli.commands.launch.expanded import full_names
from ros_lint.cli.commands.launch.launch import LaunchOptions, LaunchRequest, answer
from ros_lint.cli.commands.launch.lookup import LaunchFileLookup
from ros_lint.collectors.launch.expand import expand
from ros_lint.collectors.symbolic_text import readable
from ros_lint.workspace.loader import Loader
from ros_lint.workspace.target import TargetDistro
from tests.browser import opened
from tests.packages import manifest_text

CMAKE = """\
project({0})
find_package(ament_cmake REQUIRED)
install(DIRECTORY launch DESTINATION share/{0})
install(PROGRAMS $ENV{{PROGRAMS}} DESTINATION lib/{0})
ament_package()
"""
MAIN = """
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, GroupAction, IncludeLaunchDescription
from launch.conditions import IfCondition, LaunchConfigurationEquals, UnlessCondition
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution, PythonExpression
from launch_ros.actions import Node, PushRosNamespace
from launch_ros.substitutions import FindPackageShare

sim = LaunchConfiguration('sim')
robot = LaunchConfiguration('robot')

def generate_launch_description():
    return LaunchDescription([
        DeclareLaunchArgument('sim', default_value='false', description='Use the simulator & its clock.'),
        DeclareLaunchArgument('robot', default_value='arm', choices=['arm', 'leg']),
        DeclareLaunchArgument('space', default_value=''),
        DeclareLaunchArgument('name', default_value=[robot, '_driver']),
        DeclareLaunchArgument('part', default_value='inner'),
        Node(package='p', executable='gazebo', condition=IfCondition(sim)),
        Node(package='p', executable='driver', name=LaunchConfiguration('name'), namespace=LaunchConfiguration('space'),
             condition=UnlessCondition(sim), parameters=[{'robot': robot}]),
        Node(package='p', executable='leg_only', condition=LaunchConfigurationEquals('robot', 'leg')),
        Node(package='p', executable='both',
             condition=IfCondition(PythonExpression(["'", robot, "' == 'arm' and ", PythonExpression(['not ', sim])]))),
        IncludeLaunchDescription(
            PathJoinSubstitution([FindPackageShare('p'), 'launch', [LaunchConfiguration('part'), '.launch.xml']]),
            launch_arguments={'mode': sim}.items()),
    ])
"""
INNER = """<launch>
  <arg name="mode" default="false"/>
  <node pkg="p" exec="inside" if="$(var mode)"/>
  <node pkg="p" exec="outside" unless="$(var mode)"/>
  <node pkg="p" exec="env" if="$(env REAL)"/>
</launch>
"""
FILES = {
    "p/package.xml": manifest_text("p"),
    "p/CMakeLists.txt": CMAKE.format("p"),
    "p/launch/main.launch.py": MAIN,
    "p/launch/inner.launch.xml": INNER,
}
VALUES = {"sim": ("false", "true"), "robot": ("arm", "leg"), "space": ("", "a/b")}


def page_of(files: Mapping[str, str], arguments: Mapping[str, str] | None = None, **options: Any) -> str:
    tree = MemoryTree(files)
    workspace = Loader(tree, ("",), TargetDistro("jazzy", "--distro")).load()
    request = LaunchRequest("p", "main.launch.py", arguments or {})
    output, err, code = answer(workspace, LaunchFileLookup(workspace, tree), request, "", LaunchOptions("html", **options))
    assert (err, code) == ("", 0)
    return output


def started(arguments: Mapping[str, str]) -> list[str]:
    """Return what certainly starts with the given arguments, as in the page: name and program."""
    tree = MemoryTree(FILES)
    workspace = Loader(tree, ("",), TargetDistro("jazzy", "--distro")).load()
    lookup = LaunchFileLookup(workspace, tree)
    file, place = lookup.installed_file("p", "main.launch.py")
    expansion = expand(file._replace(path=place), arguments, lookup.included, "jazzy")
    nodes = [action for action in expansion.started if action.kind == "node" and action.certain]
    return [" ".join([*map(readable, full_names(action)), *action.package, *action.target]) for action in nodes]


class Elements(HTMLParser):
    """Checks that end tags match, and collects the attributes of start tags by tag."""

    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []
        self.attributes: list[tuple[str, dict[str, str | None]]] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.attributes.append((tag, dict(attrs)))
        if tag not in ("meta", "input", "br"):
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag


def elements_of(page: str) -> Elements:
    elements = Elements()
    elements.feed(page)
    elements.close()
    assert not elements.open
    return elements


def conditions_of(page: str) -> list[dict[str, Any]]:
    match = re.search(r'<script id="data" type="application/json">(.*?)</script>', page, re.DOTALL)
    assert match
    conditions: list[dict[str, Any]] = json.loads(match[1])
    return conditions


def test_the_page_is_well_formed_and_loads_nothing() -> None:
    page = page_of(FILES)
    elements = elements_of(page)
    assert not re.search(r"""(?:src|href)=|url\(|@import|fetch\(""", page)
    names = [attributes["name"] for tag, attributes in elements.attributes if tag in ("input", "select") and "name" in attributes]
    assert names == ["sim", "robot", "space"], "the values of 'name' and 'part' are not changed in the page"
    assert "part = inner" in page
    assert "Use the simulator &amp; its clock." in page


def test_conditions_of_included_files_depend_on_the_arguments_of_the_launched_file() -> None:
    conditions = conditions_of(page_of(FILES))
    sources = [source for condition in conditions for source in condition["texts"]]
    assert {"pieces": ["", "sim", ""]} in sources
    tables = [source for source in sources if source and "table" in source]
    assert [table["arguments"] for table in tables] == [["robot", "sim"]]
    assert tables[0]["table"] == {
        '["arm","false"]': "True",
        '["arm","true"]': "False",
        '["leg","false"]': "False",
        '["leg","true"]': "False",
    }
    assert None in sources, "the environment is unknown"


def test_given_arguments_are_the_first_values() -> None:
    elements = elements_of(page_of(FILES, {"sim": "true", "space": "x"}))
    selected = [attributes["value"] for tag, attributes in elements.attributes if tag == "option" and "selected" in attributes]
    assert selected == ["true", "arm"]
    assert {"name": "space", "value": "x", "autocomplete": "off"} in [attributes for _, attributes in elements.attributes]


def test_hostile_texts_stay_texts() -> None:
    hostile = "</script><script>alert(1)</script><!--TREE-->\"'"
    main = MAIN.replace("default_value='arm', choices=['arm', 'leg']", f"default_value={hostile!r}")
    main = main.replace("'driver'", repr(hostile)).replace("simulator", hostile.replace("'", ""))
    page = page_of({**FILES, "p/launch/main.launch.py": main})
    tags = [tag for tag, _ in elements_of(page).attributes]
    assert tags.count("script") == 2
    assert "alert(1)</script>" not in page


def test_a_file_that_starts_nothing_has_a_page() -> None:
    files = {**FILES, "p/launch/main.launch.py": MAIN.partition("    return")[0] + "    return LaunchDescription([])\n"}
    page = page_of(files)
    elements_of(page)
    assert "The launch file starts nothing." in page
    assert "has no arguments that can be changed" in page


@pytest.mark.slow
def test_the_page_decides_what_a_new_evaluation_decides(tmp_path: Path) -> None:
    with opened(tmp_path / "page.html", page_of(FILES)) as tab:
        for values in itertools.product(*VALUES.values()):
            arguments = dict(zip(VALUES, values, strict=True))
            for name, value in arguments.items():
                field = tab.locator(f'[name="{name}"]')
                field.fill(value) if name == "space" else field.select_option(value)
            running = '.item.node[data-state="on"] > details > summary'
            shown = [" ".join(text.split()[1:]) for text in tab.locator(running).all_inner_texts()]
            assert shown == started(arguments), arguments
        tab.locator('[name="space"]').fill("q")
        assert "/q/" in tab.locator(".name").first.inner_text()


@pytest.mark.slow
def test_search_reset_and_keyboard(tmp_path: Path) -> None:
    with opened(tmp_path / "page.html", page_of(FILES)) as tab:
        visible = ".item.node:visible"
        before = tab.locator(visible).count()
        assert tab.locator("#status").inner_text() == "3 start, 1 perhaps, 3 do not start"
        tab.locator("#all").check()
        assert tab.locator(visible).count() == 7
        tab.locator("#all").uncheck()
        tab.locator("#search").fill("outside")
        assert tab.locator(visible).count() == 1
        assert tab.locator(".item.include:visible").count() == 1, "the include above it is shown"
        tab.locator("#search").fill("")
        assert tab.locator(visible).count() == before
        tab.locator('[name="sim"]').select_option("true")
        assert tab.locator("#status").inner_text() != "3 start, 1 perhaps, 3 do not start"
        tab.locator('button[type="reset"]').click()
        tab.wait_for_function('document.getElementById("status").textContent.startsWith("3 start")')
        summary = tab.locator(".item.node:visible summary").first
        summary.focus()
        tab.keyboard.press("Enter")
        assert tab.locator(".item.node:visible details[open]").count() == 1
        tab.locator("#open").click()
        assert tab.locator(".item:visible details:not([open])").count() == 0
