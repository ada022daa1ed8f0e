"""Models of helper functions of released packages: their actions have the place of the call."""

from __future__ import annotations

import pytest

from tests.launch_cases import collect, summaries, summary

MOVEIT = """
from moveit_configs_utils import MoveItConfigsBuilder
from moveit_configs_utils.launches import {name}

def generate_launch_description():
    config = MoveItConfigsBuilder("arm", package_name="arm_config").to_moveit_configs()
    return {name}(config)
"""


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("generate_rsp_launch", ["node robot_state_publisher robot_state_publisher"]),
        ("generate_moveit_rviz_launch", ["node? rviz2 rviz2"]),
        ("generate_setup_assistant_launch", ["node? moveit_setup_assistant moveit_setup_assistant"]),
        ("generate_static_virtual_joint_tfs_launch", ["node? tf2_ros static_transform_publisher"]),
        ("generate_spawn_controllers_launch", ["node? controller_manager spawner", "node controller_manager spawner"]),
        (
            "generate_warehouse_db_launch",
            ["node warehouse_ros_mongo mongo_wrapper_ros.py", "node? moveit_ros_warehouse moveit_init_demo_warehouse"],
        ),
        ("generate_move_group_launch", ["node? moveit_ros_move_group move_group"]),
    ],
)
def test_launch_helpers_of_moveit_are_modelled(name: str, expected: list[str]) -> None:
    source, launch_file = collect("a.launch.py", MOVEIT.format(name=name))
    assert summaries(source, launch_file) == ["package arm_config", *expected]
    assert not launch_file.opaque
    assert not launch_file.problems
    started = [reference for reference in launch_file.references if reference.kind == "node"]
    assert {source.slice(reference.span) for reference in started} == {f"{name}(config)"}
    assert all(reference.optional for reference in started), "they are the need of the package that has the helper"


def test_the_moveit_demo_includes_launch_files_of_its_package() -> None:
    source, launch_file = collect("a.launch.py", MOVEIT.format(name="generate_demo_launch"))
    assert summaries(source, launch_file) == [
        "include? arm_config launch/static_virtual_joint_tfs.launch.py",
        "include arm_config launch/rsp.launch.py",
        "include arm_config launch/move_group.launch.py",
        "include? arm_config launch/moveit_rviz.launch.py",
        "include? arm_config launch/warehouse_db.launch.py",
        "node controller_manager ros2_control_node",
        "file arm_config config/ros2_controllers.yaml",
        "include arm_config launch/spawn_controllers.launch.py",
    ]
    needed = {
        summary(reference) for reference in launch_file.references if not (reference.optional or reference.existence_checked)
    }
    assert needed == {
        "include arm_config launch/rsp.launch.py",
        "include arm_config launch/move_group.launch.py",
        "include arm_config launch/spawn_controllers.launch.py",
        "file arm_config config/ros2_controllers.yaml",
    }


CONTROLLERS = """
from controller_manager.launch_utils import {name}
from launch.substitutions import PathJoinSubstitution
from launch_ros.substitutions import FindPackageShare

def generate_launch_description():
    file = PathJoinSubstitution([FindPackageShare("arm"), "config", "a.yaml"])
    return {name}({given})
"""


@pytest.mark.parametrize(
    ("name", "given"),
    [
        ("generate_load_controller_launch_description", "'a', controller_params_file=file"),
        ("generate_controllers_spawner_launch_description", "['a'], [file]"),
        ("generate_controllers_spawner_launch_description_from_dict", "{'a': [file], 'b': None}"),
        ("generate_spawner_launch_description", "{'a': {'param_file': file}, 'b': {}}"),
    ],
)
def test_spawned_controllers_get_the_passed_parameter_files(name: str, given: str) -> None:
    source, launch_file = collect("a.launch.py", CONTROLLERS.format(name=name, given=given))
    assert summaries(source, launch_file) == ["node controller_manager spawner", "file arm config/a.yaml"]
    assert not launch_file.opaque
    assert [reference.optional for reference in launch_file.references] == [True, False]


def test_packages_passed_to_a_helper_belong_to_its_caller() -> None:
    text = """
from launch import LaunchDescription
from moveit_configs_utils.launch_utils import DeclareBooleanLaunchArg, add_debuggable_node

def generate_launch_description():
    found = LaunchDescription([DeclareBooleanLaunchArg("debug")])
    add_debuggable_node(found, package="driver", executable="run")
    return found
"""
    source, launch_file = collect("a.launch.py", text)
    assert summaries(source, launch_file) == ["node? driver run"]
    (reference,) = launch_file.references
    assert (reference.exact, reference.package_exact, reference.optional) == (True, True, False)


LAUNCH_PAL = """
from dataclasses import dataclass
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch_pal import get_pal_configuration
from launch_pal.arg_utils import LaunchArgumentsBase, read_launch_argument
from launch_pal.include_utils import include_launch_py_description, include_scoped_launch_py_description
from launch_pal.param_utils import merge_param_files
from launch_pal.robot_arguments import CommonArgs
from launch_pal.robot_utils import get_robot_name
from launch_ros.actions import Node

@dataclass(frozen=True)
class Arguments(LaunchArgumentsBase):
    rviz: DeclareLaunchArgument = CommonArgs.rviz
    base: DeclareLaunchArgument = DeclareLaunchArgument("base", default_value="wheels")

def start(context):
    return [Node(package="base", executable=read_launch_argument("base", context))]

def generate_launch_description():
    found = LaunchDescription()
    arguments = Arguments()
    arguments.add_to_launch_description(found)
    found.add_action(get_robot_name("rolly"))
    config = get_pal_configuration("driver", "run", found)
    files = [config["parameters"], merge_param_files(["a.yaml"])]
    found.add_action(Node(package="driver", executable="run", parameters=files, remappings=config["remappings"]))
    found.add_action(include_launch_py_description("first", ["launch", "a.launch.py"]))
    found.add_action(include_scoped_launch_py_description(
        pkg_name="second", paths=["launch", "b.launch.py"], namespace="n", launch_arguments={"base": arguments.base, "c": "1"}))
    found.add_action(OpaqueFunction(function=start))
    return found
"""


def test_helpers_of_launch_pal_are_modelled() -> None:
    source, launch_file = collect("a.launch.py", LAUNCH_PAL)
    assert summaries(source, launch_file) == [
        "node base wheels",
        "node driver run",
        "include first launch/a.launch.py",
        "include second launch/b.launch.py",
    ]
    assert not launch_file.opaque
    assert not launch_file.problems
    assert [action.target.texts for action in launch_file.actions if action.kind == "argument" and action.target] == [
        ("rviz",),
        ("base",),
        ("robot_name",),
    ]
    assert not any(reference.optional for reference in launch_file.references)
    (group,) = [action for action in launch_file.actions if action.kind == "group"]
    (included,) = [action for action in group.children if action.kind == "include"]
    assert [name for name, _ in included.arguments] == ["base", "c"]


def test_further_configurations_read_by_a_helper_are_unknown() -> None:
    _, launch_file = collect("a.launch.py", LAUNCH_PAL)
    assert launch_file.configurations_read[-1] == "\ue000"


def test_the_node_passed_to_the_webots_helper_is_started() -> None:
    text = """
from launch import LaunchDescription
from launch.actions import RegisterEventHandler
from launch.event_handlers import OnProcessIO
from launch_ros.actions import Node
from webots_ros2_driver.urdf_spawner import URDFSpawner, get_webots_driver_node

def generate_launch_description():
    spawn = URDFSpawner(name="a")
    node = Node(package="driver", executable="run")
    wait = OnProcessIO(target_action=spawn, on_stdout=lambda event: get_webots_driver_node(event, node))
    return LaunchDescription([spawn, RegisterEventHandler(event_handler=wait)])
"""
    assert summaries(*collect("a.launch.py", text)) == ["node driver run"]
