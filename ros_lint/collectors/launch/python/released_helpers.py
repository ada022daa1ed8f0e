"""Models, written in Python, of the helper functions of released packages that launch files call.

A model has only the relation between arguments and actions. If the workspace contains the package, its source is interpreted
instead, except for moveit_configs_utils.
"""

from __future__ import annotations

import ast
from collections.abc import Mapping
from functools import cache

from ros_lint.collectors.python.syntax import placed

HELPERS: Mapping[str, str] = {
    # controller_manager (ros2_control): controller_manager/launch_utils.py
    "controller_manager.launch_utils": """
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch_ros.actions import Node

def generate_controllers_spawner_launch_description(controller_names, controller_params_files=None, extra_spawner_args=()):
    words = list(controller_names) + ["--controller-manager", LaunchConfiguration("controller_manager_name")]
    for file in controller_params_files or []:
        words += ["--param-file", file]
    return LaunchDescription([
        DeclareLaunchArgument("controller_manager_name", default_value="controller_manager"),
        DeclareLaunchArgument("unload_on_kill", default_value="false"),
        _spawner(words + list(extra_spawner_args)),
    ])

def generate_controllers_spawner_launch_description_from_dict(controller_info_dict, extra_spawner_args=()):
    files = []
    for given in controller_info_dict.values():
        if given:
            files += given if isinstance(given, list) else [given]
    return generate_controllers_spawner_launch_description(list(controller_info_dict), files, extra_spawner_args)

def generate_load_controller_launch_description(controller_name, controller_params_file=None, extra_spawner_args=(), **old):
    files = [controller_params_file] if controller_params_file else []
    return generate_controllers_spawner_launch_description([controller_name], files, extra_spawner_args)

def generate_spawner_launch_description(controller_info_dict, extra_spawner_args=()):
    words = []
    for name, given in controller_info_dict.items():
        words += ["--controller", name]
        files = given.get("param_file") or []
        for file in files if isinstance(files, list) else [files]:
            words += ["--param-file", file]
    return LaunchDescription([_spawner(words + list(extra_spawner_args))])

def _spawner(words):
    return Node(package="controller_manager", executable="spawner", arguments=words)
""",
    # launch_pal: launch_pal/pal_parameters.py; files of other packages decide on the parameters of a node
    "launch_pal": """
import json

def get_pal_configuration(pkg, node, ld=None, cmdline_args=True):
    return {key: json.loads(input()) for key in ("parameters", "arguments", "remappings")}
""",
    # launch_pal: launch_pal/arg_utils.py
    "launch_pal.arg_utils": """
from dataclasses import fields
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration

class LaunchArgumentsBase:
    def add_to_launch_description(self, launch_description):
        for field in fields(self):
            launch_description.add_action(getattr(self, field.name))

class LaunchArgCreator:
    def get_argument(self, arg_name):
        return DeclareLaunchArgument(arg_name, default_value=input())

def parse_launch_args_from_yaml(yaml_file):
    return LaunchArgCreator()

def read_launch_argument(arg_name, context):
    return LaunchConfiguration(arg_name).perform(context)
""",
    # launch_pal: launch_pal/include_utils.py
    "launch_pal.include_utils": """
from launch.actions import DeclareLaunchArgument, GroupAction, IncludeLaunchDescription
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import PushRosNamespace
from launch_ros.substitutions import FindPackageShare

def include_launch_py_description(pkg_name, paths, **kwargs):
    path = PathJoinSubstitution([FindPackageShare(pkg_name)] + paths)
    return IncludeLaunchDescription(PythonLaunchDescriptionSource(path), **kwargs)

def include_scoped_launch_py_description(
    pkg_name, paths, launch_arguments={}, env_vars=[], condition=None, namespace=None, **kwargs
):
    passed, declared = {}, []
    for name, value in launch_arguments.items():
        if isinstance(value, DeclareLaunchArgument):
            declared.append(value)
            passed[name] = LaunchConfiguration(value.name)
        else:
            passed[name] = value
    first = [PushRosNamespace(namespace)] if namespace else []
    included = include_launch_py_description(pkg_name, paths, launch_arguments=passed.items(), **kwargs)
    actions = first + env_vars + declared + [included]
    return GroupAction(actions, forwarding=False, condition=condition, launch_configurations=passed)
""",
    # launch_pal: launch_pal/param_utils.py; both functions write a file and return its path
    "launch_pal.param_utils": """
def merge_param_files(yaml_files):
    return input()

def parse_parametric_yaml(source_files, param_rewrites, ld=None):
    return input()
""",
    # launch_pal: launch_pal/robot_arguments/common.py and robot.py
    "launch_pal.robot_arguments": """
from launch.actions import DeclareLaunchArgument

def _of(names):
    return [DeclareLaunchArgument(name, default_value=input()) for name in names.split()]

class CommonArgs:
    use_sim_time, namespace, robot_name, navigation, advanced_navigation, side, docking, moveit, slam = _of(
        "use_sim_time namespace robot_name navigation advanced_navigation side docking moveit slam")
    world_name, gazebo_version, gzclient, rviz, map_name, is_public_sim, use_sensor_manager, tuck_arm = _of(
        "world_name gazebo_version gzclient rviz map_name is_public_sim use_sensor_manager tuck_arm")
    x, y, z, roll, pitch, yaw, sim_type = _of("x y z roll pitch yaw sim_type")

class RobotArgs:
    base_type, arm_type, arm_type_right, arm_type_left, end_effector, end_effector_right, end_effector_left = _of(
        "base_type arm_type arm_type_right arm_type_left end_effector end_effector_right end_effector_left")
    ft_sensor, ft_sensor_right, ft_sensor_left, wrist_model, wrist_model_right, wrist_model_left = _of(
        "ft_sensor ft_sensor_right ft_sensor_left wrist_model wrist_model_right wrist_model_left")
    wheel_model, laser_model, camera_model, has_screen, robot_model = _of(
        "wheel_model laser_model camera_model has_screen robot_model")
""",
    # launch_pal: launch_pal/robot_utils.py
    "launch_pal.robot_utils": """
from launch.actions import DeclareLaunchArgument

def get_robot_name(default_robot_name="pmb2"):
    return DeclareLaunchArgument("robot_name", default_value=default_robot_name)

def _of(name):
    return lambda robot: DeclareLaunchArgument(name, default_value=input())

get_wheel_model, get_laser_model, get_robot_model = _of("wheel_model"), _of("laser_model"), _of("robot_model")
get_courier_rgbd_sensors, get_camera_model = _of("courier_rgbd_sensors"), _of("camera_model")
get_arm, get_wrist_model, get_end_effector = _of("arm"), _of("wrist_model"), _of("end_effector")
get_ft_sensor = _of("ft_sensor")
""",
    # moveit_configs_utils (moveit2): moveit_configs_utils/launch_utils.py
    "moveit_configs_utils.launch_utils": """
from launch.conditions import IfCondition, UnlessCondition
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

def add_debuggable_node(
    ld, package, executable, condition_name="debug", commands_file=None, extra_debug_args=None, arguments=(), **kwargs
):
    asked = LaunchConfiguration(condition_name)
    words = list(arguments)
    ld.add_action(Node(package=package, executable=executable, condition=UnlessCondition(asked), arguments=words, **kwargs))
    words = words + list(extra_debug_args or ())
    ld.add_action(
        Node(package=package, executable=executable, condition=IfCondition(asked), prefix="gdb", arguments=words, **kwargs))
""",
    # moveit_configs_utils (moveit2): moveit_configs_utils/launches.py
    "moveit_configs_utils.launches": """
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.conditions import IfCondition
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node
from moveit_configs_utils.launch_utils import add_debuggable_node

def _told(**defaults):
    return [DeclareLaunchArgument(name, default_value=default) for name, default in defaults.items()]

def generate_rsp_launch(moveit_config):
    node = Node(package="robot_state_publisher", executable="robot_state_publisher",
                parameters=[{"publish_frequency": LaunchConfiguration("publish_frequency")}])
    return LaunchDescription(_told(publish_frequency="15.0") + [node])

def generate_moveit_rviz_launch(moveit_config):
    found = LaunchDescription(_told(debug="False", rviz_config=input()))
    add_debuggable_node(found, package="rviz2", executable="rviz2", arguments=["-d", LaunchConfiguration("rviz_config")])
    return found

def generate_setup_assistant_launch(moveit_config):
    found = LaunchDescription(_told(debug="False"))
    add_debuggable_node(found, package="moveit_setup_assistant", executable="moveit_setup_assistant")
    return found

def generate_static_virtual_joint_tfs_launch(moveit_config):
    joints = moveit_config.robot_description_semantic
    return LaunchDescription([Node(package="tf2_ros", executable="static_transform_publisher") for joint in joints])

def generate_spawn_controllers_launch(moveit_config):
    found = LaunchDescription([_spawner(name) for name in moveit_config.trajectory_execution])
    found.add_action(_spawner("joint_state_broadcaster"))
    return found

def _spawner(name):
    return Node(package="controller_manager", executable="spawner", arguments=[name])

def generate_warehouse_db_launch(moveit_config):
    found = LaunchDescription(_told(moveit_warehouse_database_path=input(), reset="False", moveit_warehouse_port="33829"))
    found.extend(_told(moveit_warehouse_host="localhost"))
    found.add_action(Node(package="warehouse_ros_mongo", executable="mongo_wrapper_ros.py"))
    found.add_action(Node(package="moveit_ros_warehouse", executable="moveit_init_demo_warehouse",
                          condition=IfCondition(LaunchConfiguration("reset"))))
    return found

def generate_move_group_launch(moveit_config):
    found = LaunchDescription(_told(debug="False", allow_trajectory_execution="True", monitor_dynamics="False"))
    found.extend(_told(publish_monitored_planning_scene="True", capabilities=input(), disable_capabilities=input()))
    add_debuggable_node(found, package="moveit_ros_move_group", executable="move_group", extra_debug_args=["--debug"])
    return found

def generate_demo_launch(moveit_config, launch_package_path=None):
    folder = launch_package_path or moveit_config.package_path
    found = LaunchDescription(_told(db="False", debug="False", use_rviz="True"))
    if (folder / "launch/static_virtual_joint_tfs.launch.py").exists():
        found.add_action(_included(folder, "static_virtual_joint_tfs"))
    found.add_action(_included(folder, "rsp"))
    found.add_action(_included(folder, "move_group"))
    found.add_action(_included(folder, "moveit_rviz", condition=IfCondition(LaunchConfiguration("use_rviz"))))
    found.add_action(_included(folder, "warehouse_db", condition=IfCondition(LaunchConfiguration("db"))))
    found.add_action(Node(package="controller_manager", executable="ros2_control_node",
                          parameters=[str(moveit_config.package_path / "config/ros2_controllers.yaml")]))
    found.add_action(_included(folder, "spawn_controllers"))
    return found

def _included(folder, name, **more):
    return IncludeLaunchDescription(PythonLaunchDescriptionSource(str(folder / ("launch/" + name + ".launch.py"))), **more)
""",
    # webots_ros2_driver (webots_ros2): webots_ros2_driver/urdf_spawner.py
    "webots_ros2_driver.urdf_spawner": """
def get_webots_driver_node(event, driver_node):
    return driver_node
""",
}  # fmt: skip


def helper(name: str, at: ast.stmt) -> ast.Module:
    """Return the syntax tree of the model of a module in :data:`HELPERS`.

    All nodes of the tree have the position of ``at``, the statement that imports the module.
    """
    return placed(_parsed(name), at)


@cache
def _parsed(name: str) -> ast.Module:
    return ast.parse(HELPERS[name])
