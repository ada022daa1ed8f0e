"""Values of launch configurations under default arguments, and which of them a caller cannot change."""

import pytest

from ros_lint.base.text import Text
from ros_lint.collectors.launch.default_configurations import default_configurations
from ros_lint.collectors.launch.markup import xml as launch_xml


@pytest.mark.parametrize(
    ("body", "values", "own"),
    [
        ('<arg name="x" default="a"/>', {"x": ("a",)}, set()),
        ('<arg name="x"/>', {}, set()),
        ('<let name="x" value="a"/>', {"x": ("a",)}, {"x"}),
        ('<arg name="x" default="a"/><let name="x" value="b"/>', {"x": ("b",)}, {"x"}),
        ('<arg name="x" default="a"/><let name="x" value="b" if="$(var c)"/>', {"x": ("a", "b")}, set()),
        ('<let name="x" value="a"/><let name="x" value="b" if="$(var c)"/>', {"x": ("a", "b")}, {"x"}),
        ('<let name="x" value="b" if="$(var c)"/>', {"x": ("b",)}, set()),
        ('<let name="x" value="b" if="$(var c)"/><let name="x" value="a"/>', {"x": ("a",)}, {"x"}),
        ('<let name="x" value="a" if="$(var c)"/><let name="x" value="b" unless="$(var c)"/>', {"x": ("a", "b")}, {"x"}),
        ('<let name="x" value="a" if="$(var c)"/><let name="x" value="b" unless="$(var d)"/>', {"x": ("a", "b")}, set()),
        (
            '<arg name="x"/><group if="$(var c)"><let name="x" value="a"/></group>'
            '<group unless="$(var c)"><let name="x" value="b"/></group>',
            {"x": ("a", "b")},
            {"x"},
        ),
        ('<timer period="1"><let name="x" value="a"/></timer>', {"x": ("a",)}, set()),
    ],
)
def test_values_and_own_configurations_of_a_file(body: str, values: dict[str, tuple[str, ...]], own: set[str]) -> None:
    configurations = default_configurations(launch_xml.collect(Text("a.launch.xml", f"<launch>{body}</launch>")).actions)
    assert (dict(configurations.values), set(configurations.own)) == (values, own)


def test_a_configuration_that_depends_on_an_argument_is_not_own() -> None:
    body = (
        '<arg name="a" default="1"/><let name="b" value="$(var a)"/><let name="c" value="2"/><let name="d" value="$(var c)/x"/>'
    )
    configurations = default_configurations(launch_xml.collect(Text("a.launch.xml", f"<launch>{body}</launch>")).actions)
    assert configurations.own == {"c", "d"}


@pytest.mark.parametrize(("let", "by_default"), [('<let name="p" value="a"/>', False), ('<arg name="p" default="a"/>', True)])
def test_a_package_name_set_by_the_file_is_not_a_default(let: str, by_default: bool) -> None:
    body = f'<launch>{let}<node pkg="$(var p)" exec="b"/></launch>'
    (reference,) = launch_xml.collect(Text("a.launch.xml", body)).references
    assert (reference.package, reference.name, reference.from_default) == ("a", "b", by_default)


def test_two_alternative_values_give_two_conditional_references() -> None:
    lets = '<let name="e" value="one" if="$(var c)"/><let name="e" value="two" unless="$(var c)"/>'
    body = f'<launch><arg name="c" default="true"/>{lets}<node pkg="a" exec="$(var e)"/></launch>'
    configurations = launch_xml.collect(Text("a.launch.xml", body)).references
    assert [(reference.name, reference.conditional, reference.from_default) for reference in configurations] == [
        ("one", True, False),
        ("two", True, False),
    ]
