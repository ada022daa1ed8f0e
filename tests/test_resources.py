"""Packages and files that resource files name."""

import pytest

from ros_lint.base.text import Text
from ros_lint.collectors.resources import collect as resources
from ros_lint.workspace.collect import collect


def names(text: str) -> dict[str, bool]:
    """Return the mentioned packages, each with whether the mention is certain."""
    source = Text("r", text)
    facts = resources.collect(source).mentions
    assert all(source.slice(mention.span) == mention.name for mention in facts)
    return {mention.name: not mention.optional for mention in facts}


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ('<mesh filename="package://arm_description/meshes/a.stl"/>', {"arm_description": True}),
        ('<xacro:include filename="$(find arm_description)/urdf/a.xacro"/>', {"arm_description": True}),
        ("map: $(find-pkg-share maps)/map.yaml", {"maps": True}),
        ("<uri>model://arm_description/a.stl</uri>", {"arm_description": False}),
        ("    - Class: rviz_default_plugins/Grid", {"rviz_default_plugins": False}),
        ("    - Class: rviz_common/Displays", {}),
        ("type: joint_trajectory_controller/JointTrajectoryController", {"joint_trajectory_controller": False}),
        ('plugin: "nav2_smac_planner::SmacPlanner2D"', {"nav2_smac_planner": False}),
        ("moveit_controller_manager: moveit_simple_controller_manager/Simple", {"moveit_simple_controller_manager": False}),
        ("<plugin>mock_components/GenericSystem</plugin>", {"mock_components": False}),
        ('<class type="a_plugins::Thing" base_class_type="nav2_core::Behavior">', {}),
        ('<transmission name="arm" type="a_transmissions/Simple">', {"a_transmissions": False}),
        ('- ros_type_name: "std_msgs/msg/String"\n  gz_type_name: "gz.msgs.StringMsg"', {}),
        ("  type: example_interfaces/msg/String", {"example_interfaces": False}),
        ("-\n  ros1_package_name: 'a_msgs'\n  ros2_package_name: 'b_msgs'", {"b_msgs": False}),
        ('<include ros_pkg="trees" path="grasp.xml"/>', {"trees": True}),
        ("frame: base_link\nrate: 10", {}),
        ("# plugin: a/B\nb: 1 # type: a/B\n", {}),
        ("<!-- package://gone/a.stl -->\n<a b='package://here/a.stl'/>", {"here": True}),
        ("image: docker://x/y\nwho: http://a/b", {}),
        ('<launch><node pkg="a" type="b" name="c" args="$(find views)/a.rviz"/></launch>', {"views": False}),
    ],
)
def test_packages_are_found_in_every_notation(text: str, expected: dict[str, bool]) -> None:
    assert names(text) == expected


def test_a_package_is_mentioned_once_and_certainly_if_any_mention_is() -> None:
    text = "Class: tools/A\nfile: package://tools/a\nfile: package://tools/b\n"
    source = Text("r", text)
    (mention,) = resources.collect(source).mentions
    assert (mention.name, mention.optional, mention.span.line) == ("tools", False, 2)


def test_paths_in_other_notations_are_normalized() -> None:
    text = "$(find arm)//urdf/a.xacro package://arm/meshes/../b.stl package://arm/../hand/c.stl $(find arm)/urdf/./a.xacro"
    facts = resources.collect(Text("r", text)).lookups
    assert [(mention.package, mention.path) for mention in facts] == [("arm", "urdf/a.xacro"), ("arm", "b.stl")]


def test_files_of_included_behavior_trees_are_looked_up() -> None:
    text = """<root BTCPP_format="4">
  <include ros_pkg="trees" path="trees/grasp.xml"/>
  <include
    path="put.xml"
    ros_pkg='more'/>
  <include path="own.xml"/> <include path="/x/absolute.xml" ros_pkg="trees"/>
  <!-- <include ros_pkg="trees" path="gone.xml"/> -->
</root>
"""
    source = Text("tree.xml", text)
    facts = resources.collect(source).lookups
    assert [(mention.package, mention.path) for mention in facts] == [("trees", "trees/grasp.xml"), ("more", "put.xml")]
    assert [source.slice(mention.span) for mention in facts] == ["trees/grasp.xml", "put.xml"]


def test_controller_managers_in_python_launch_files_are_mentioned() -> None:
    code = 'manager = {"moveit_controller_manager": "moveit_simple_controller_manager/MoveItSimpleControllerManager"}\n'
    source = Text("launch/arm.launch.py", f"from launch import LaunchDescription\n{code}def generate_launch_description(): ...\n")
    facts = collect(source, "python").facts
    assert facts is not None
    assert ("moveit_simple_controller_manager", True) in {(mention.name, mention.optional) for mention in facts.mentions}
