"""Which packages a resource file names."""

import pytest

from ros_lint.base.text import Text
from ros_lint.collectors.resources import collect as resources
from ros_lint.workspace.collect import collect


def names(text: str) -> dict[str, bool]:
    """Return each package with whether it is certain."""
    source = Text("r", text)
    found = resources.collect(source).mentions
    assert all(source.slice(mention.span) == mention.name for mention in found)
    return {mention.name: not mention.optional for mention in found}


@pytest.mark.parametrize(
    ("text", "wanted"),
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
def test_forms(text: str, wanted: dict[str, bool]) -> None:
    assert names(text) == wanted


def test_each_package_once_and_the_certain_form_wins() -> None:
    text = "Class: tools/A\nfile: package://tools/a\nfile: package://tools/b\n"
    source = Text("r", text)
    (mention,) = resources.collect(source).mentions
    assert (mention.name, mention.optional, mention.span.line) == ("tools", False, 2)


def test_paths_that_are_written_in_another_way() -> None:
    text = "$(find arm)//urdf/a.xacro package://arm/meshes/../b.stl package://arm/../hand/c.stl $(find arm)/urdf/./a.xacro"
    found = resources.collect(Text("r", text)).lookups
    assert [(each.package, each.path) for each in found] == [("arm", "urdf/a.xacro"), ("arm", "b.stl")]


def test_trees_that_are_included() -> None:
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
    found = resources.collect(source).lookups
    assert [(each.package, each.path) for each in found] == [("trees", "trees/grasp.xml"), ("more", "put.xml")]
    assert [source.slice(each.span) for each in found] == ["trees/grasp.xml", "put.xml"]


def test_what_moveit_is_told_to_load_by_a_launch_file_in_python() -> None:
    code = 'manager = {"moveit_controller_manager": "moveit_simple_controller_manager/MoveItSimpleControllerManager"}\n'
    source = Text("launch/arm.launch.py", f"from launch import LaunchDescription\n{code}def generate_launch_description(): ...\n")
    facts = collect(source, "python").facts
    assert facts is not None
    assert ("moveit_simple_controller_manager", True) in {(mention.name, mention.optional) for mention in facts.mentions}
