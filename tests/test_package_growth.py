"""No rule searches all packages once for each package: the cost of a package does not grow with the workspace."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cache
from typing import Any

import pytest

from ros_lint.analysis.rule import Rule
from ros_lint.base.questions import Memo
from ros_lint.engine import registry
from ros_lint.engine.run import run_rules
from ros_lint.workspace.model import Workspace
from tests.one_package import loaded
from tests.packages import manifest_text

_LAUNCH = """
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    inner = PathJoinSubstitution([FindPackageShare('%b'), 'launch', 'a.launch.py'])
    return LaunchDescription([
        DeclareLaunchArgument('speed', default_value='1'),
        Node(package='%a', executable='node', parameters=[{'speed': LaunchConfiguration('speed')}]),
        IncludeLaunchDescription(inner, launch_arguments={'speed': '2', 'other': '3'}.items()),
    ])
"""
_SCRIPT = """
project(%a)
find_package(ament_cmake REQUIRED)
find_package(rclcpp REQUIRED)
find_package(%b REQUIRED)
add_executable(node src/node.cpp)
target_link_libraries(node rclcpp::rclcpp %b::%b)
install(TARGETS node DESTINATION lib/${PROJECT_NAME})
install(DIRECTORY launch config DESTINATION share/${PROJECT_NAME})
ament_package()
"""
_NODE = "#include <rclcpp/rclcpp.hpp>\n#include <%b/b.hpp>\n#include <std_msgs/msg/string.hpp>\n"


class _Packages(tuple[Any, ...]):
    """The packages of a workspace, which counts how often they are searched."""

    searched = 0

    def __iter__(self) -> Iterator[Any]:
        type(self).searched += 1
        return super().__iter__()


def _files(count: int) -> dict[str, str]:
    files: dict[str, str] = {}
    for number in range(count):
        own, other = f"p{number}", f"p{(number + 1) % count}"
        texts = {
            "package.xml": manifest_text(
                "%a", ["<depend>rclcpp</depend>", "<depend>%b</depend>", "<exec_depend>rviz2</exec_depend>"]
            ),
            "CMakeLists.txt": _SCRIPT,
            "src/node.cpp": _NODE,
            "launch/a.launch.py": _LAUNCH,
            "config/a.yaml": "node:\n  ros__parameters:\n    speed: $(var speed)\n",
            "scripts/a.py": "import rclpy\nimport %b.c\n",
        }
        files |= {f"{own}/{path}": text.replace("%a", own).replace("%b", other) for path, text in texts.items()}
    return files


@cache
def _workspace(count: int) -> Workspace:
    workspace = loaded(_files(count))
    workspace.packages = _Packages(workspace.packages)
    return workspace


def _searches(count: int, rule: Rule) -> int:
    workspace = _workspace(count)
    workspace.memo = Memo()
    _Packages.searched = 0
    run_rules(workspace, [rule])
    return _Packages.searched


def _rules() -> Sequence[Rule]:
    return [rule for rule in registry.load() if rule.package or rule.workspace]


@pytest.mark.parametrize("rule", _rules(), ids=lambda rule: rule.name)
def test_a_rule_searches_the_packages_as_often_in_a_larger_workspace(rule: Rule) -> None:
    assert _searches(6, rule) == _searches(3, rule)
