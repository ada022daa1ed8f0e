"""Launch files in XML: detection, references and problems."""

import pytest

from ros_lint.collectors.launch import detect as launch
from tests.launch_cases import collect, summaries


def xml(body: str) -> list[str]:
    return summaries(*collect("a.launch.xml", f"<launch>\n{body}\n</launch>\n"))


@pytest.mark.parametrize(
    ("path", "text", "expected"),
    [
        ("a.launch.xml", "<launch/>", "xml"),
        ("a.launch", '<?xml version="1.0"?>\n<!-- x -->\n<launch>\n</launch>', "xml"),
        ("a.xml", "<launch><node pkg='a' exec='b'/></launch>", "xml"),
        ("a.launch", '<launch><node pkg="a" type="b" name="c"/></launch>', None),
        ("a.launch", '<launch><include file="$(find a)/launch/b.launch"/></launch>', None),
        ("a.launch", "<launch><rosparam file='x'/></launch>", None),
        ("a.launch", "<launch><group ns='a'><!-- x --> <param name='b' value='1'/></group></launch>", None),
        ("a.launch", "<launch><group><node pkg='a' exec='b'><param name='b' value='1'/></node></group></launch>", "xml"),
        ("a.launch.xml", '<launch><node pkg="a" exec="b"/><include file="$(find a)/b"/></launch>', "xml"),
        ("config/launch.xml", "<launch><node name='a' start='sim'/><node name='b'/></launch>", None),
        ("a.launch.xml", "<launch><node name='a'/></launch>", "xml"),
        ("config/launch.xml", "<launch><node name='a'/><node pkg='a' exec='b'/></launch>", "xml"),
        ("package.xml", "<package><description><launch/></description></package>", None),
        ("a.xml", "<!-- <launch> --><library/>", None),
        ("a.xml", "<launcher/>", None),
        ("a.xml", "<!-- <launch>", None),
    ],
)
def test_launch_files_are_recognised_by_content(path: str, text: str, expected: str | None) -> None:
    assert launch.is_launch_file(path, text) == expected


@pytest.mark.parametrize(
    ("body", "expected"),
    [
        ('<node pkg="a" exec="b"/>', ["node a b"]),
        ('<node name="n" exec="b" pkg="a" if="$(var x)"/>', ["node? a b"]),
        (
            '<group unless="$(var x)"><node pkg="a" exec="b"/></group><node pkg="c" exec="d"/>',
            ["node? a b", "node c d"],
        ),
        ('<node exec="/usr/bin/b"/>', []),
        ('<lifecycle_node pkg="a" exec="b" name="n" namespace=""/>', ["node a b"]),
        (
            '<node_container pkg="rclcpp_components" exec="component_container" name="n" namespace="">'
            '<composable_node pkg="a" plugin="a::B" name="b"/></node_container>',
            ["node rclcpp_components component_container", "component a a::B"],
        ),
        ('<include file="$(find-pkg-share a)/launch/b.launch.py"/>', ["include a launch/b.launch.py"]),
        ('<include file="$(find-pkg-share a)/launch/$(var x).launch.py"/>', ["package a"]),
        ('<include file="$(dirname)/b.launch.xml"/>', ["include  b.launch.xml"]),
        (
            '<node pkg="a" exec="b"><param from="$(find-pkg-share c)/config/d.yaml"/></node>',
            ["node a b", "file c config/d.yaml"],
        ),
        ('<arg name="x" default="$(find-pkg-share a)"/>', ["package a"]),
        ('<let name="x" value="$(find-pkg-prefix a)/lib/a/b"/>', ["node a b"]),
        ('<executable cmd="ros2 run a b --x"/>', ["node a b"]),
        ('<executable cmd="ros2 launch a b.launch.py"/>', ["package a"]),
        ('<executable cmd="echo ros2 run a b"/>', []),
        ('<executable cmd="$(exec-in-pkg b a)"/>', ["node a b"]),
        (
            """<let name="d" value="$(command 'xacro $(find-pkg-share a)/urdf/b.xacro c:=$(var c)')"/>""",
            ["file a urdf/b.xacro", "command xacro xacro"],
        ),
        ('<node pkg="$(var p)" exec="b"/>', []),
        ('<node pkg="a" exec="$(var e)"/>', ["package a"]),
    ],
)
def test_references_of_tags(body: str, expected: list[str]) -> None:
    assert xml(body) == expected


def test_a_computed_package_is_opaque() -> None:
    _, launch_file = collect("a.launch.xml", '<launch><node pkg="$(var p)" exec="b"/></launch>')
    assert [opaque.reason for opaque in launch_file.opaque] == ["the package of a node is computed"]


def test_places_after_non_ascii_characters_and_line_ends_are_exact() -> None:
    text = '<launch>\n  <!-- é -->\n  <node output="ü"\n    pkg="a"\n    exec="ö"/>\n</launch>\n'
    source, launch_file = collect("a.launch.xml", text)
    (node,) = launch_file.references
    assert (source.slice(node.span), source.slice(node.package_span)) == ("ö", "a")
    assert str(node.span) == "a.launch.xml:5:11"


def test_an_escaped_value_is_not_exact() -> None:
    _, launch_file = collect("a.launch.xml", '<launch><node pkg="a" exec="b&amp;c"/></launch>')
    assert [(node.name, node.exact) for node in launch_file.references] == [("b&c", False)]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            "<launch><node></launch>",
            "not valid XML: this closing tag does not belong to the open element; close that element first",
        ),
        ("<launch>", "not valid XML: no element found"),
        ('<launch a="1" a="2"/>', "not valid XML: duplicate attribute"),
        ("<launch>\ud800</launch>", "not valid XML: not well-formed (invalid token)"),
        ('<!DOCTYPE launch [<!ENTITY a "b">]><launch>&a;</launch>', "declares an entity, which is not resolved here"),
        (
            '<!DOCTYPE launch [<!ENTITY a SYSTEM "f">]><launch>&a;</launch>',
            "declares an entity, which is not resolved here",
        ),
    ],
)
def test_invalid_xml_is_a_problem(text: str, message: str) -> None:
    _, launch_file = collect("a.launch.xml", text.replace("\ud800", "\udcff"))
    (problem,) = launch_file.problems
    assert problem.message == message
    assert launch_file.opaque
    assert problem.span.line == 1 <= problem.span.column <= len(text) + 1


@pytest.mark.parametrize(
    ("value", "message"),
    [
        ("$(find-pkg-share a", "$(find-pkg-share is not closed"),
        ("$(find-pkg-share  a)", "arguments are separated by one space"),
        ("$()", "$( is not followed by the name of a substitution"),
        ("$(command 'x)", "the quote ' is not closed"),
        ("$(a " * 60, "substitutions are nested too deeply"),
    ],
)
def test_invalid_substitutions_are_problems(value: str, message: str) -> None:
    _, launch_file = collect("a.launch.xml", f'<launch><let name="x" value="{value}"/></launch>')
    assert [problem.message for problem in launch_file.problems] == [message]


@pytest.mark.parametrize(("tag", "refused"), [("trace", False), ("gz_server", False), ("test", True), ("gtest", True)])
def test_tags_added_by_other_packages_are_accepted(tag: str, refused: bool) -> None:
    _, launch_file = collect("a.launch.xml", f'<launch><{tag} name="a"/></launch>')
    assert [problem.message for problem in launch_file.problems] == [f"there is no tag <{tag}>"] * refused


def test_deeply_nested_xml_is_rejected() -> None:
    def nested(depth: int) -> str:
        return "<group>" * depth + '<node pkg="a" exec="b"/>' + "</group>" * depth

    assert xml(nested(100)) == ["node a b"]
    _, launch_file = collect("a.launch.xml", f"<launch>{nested(5000)}</launch>")
    assert [problem.message for problem in launch_file.problems] == ["elements are nested too deeply"]


@pytest.mark.parametrize(
    ("body", "problems"),
    [
        ('<unset_env name="X"/>', []),
        ("<unset_env/>", ["missing-attribute"]),
        ('<unset_env name="X" value="b"/>', ["unexpected-attribute"]),
        ("<reset_env/>", []),
        ('<reset_env name="X"/>', ["unexpected-attribute"]),
        ("<reset/>", []),
        ('<reset><keep name="x" value="$(var x)"/></reset>', []),
        ('<reset><keep name="x"/></reset>', ["missing-attribute"]),
        ('<reset keep="x"/>', ["unexpected-attribute"]),
        ("<shutdown/>", []),
        ('<shutdown reason="$(var x)" if="$(var y)"/>', []),
        ('<shutdown because="x"/>', ["unexpected-attribute"]),
    ],
)
def test_other_actions_start_nothing(body: str, problems: list[str]) -> None:
    """launch/actions: unset_environment_variable.py, reset_environment.py, reset_launch_configurations.py, shutdown_action.py."""
    _, launch_file = collect("a.launch.xml", f"<launch>{body}<node pkg='a' exec='b'/></launch>")
    assert [problem.kind for problem in launch_file.problems] == problems
    conditions = [len(action.conditions) for action in launch_file.actions]
    first, node = (action.kind for action in launch_file.actions) if not problems else ("other", "node")
    assert first in ("other", "reset", "reset_environment", "unset_environment")
    assert node == "node"
    assert conditions == [int(" if=" in body), 0] or problems
