"""The severity of findings of rules whose findings differ in severity."""

from __future__ import annotations

from ros_lint.base.tree import MemoryTree
from ros_lint.engine import registry
from ros_lint.engine.check import ReportContext, check
from ros_lint.engine.selection import select
from ros_lint.workspace.loader import Loader
from ros_lint.workspace.target import TargetDistro
from tests.packages import manifest_text

HEAD = "cmake_minimum_required(VERSION 3.16)\nproject(robot)\nfind_package(ament_cmake REQUIRED)\n"
TOOL = "<buildtool_depend>ament_cmake</buildtool_depend>"
LAUNCH_FILE = """import yaml
from lifecycle_msgs.msg import Transition
from std_msgs.msg import String
from launch import LaunchDescription
from launch_ros.actions import Node

def generate_launch_description():
    print(Transition, String)
    return LaunchDescription([Node(package='robot', executable='a', parameters=[yaml.safe_load('a: 1')])])
"""


def severities(rule: str, files: dict[str, str], *depends: str) -> dict[str, str]:
    """Return the severity of each finding of a rule in a package with these files, by subject."""
    files = {f"robot/{path}": text for path, text in files.items()}
    build_type = "ament_cmake" if "robot/CMakeLists.txt" in files else "ament_python"
    files["robot/package.xml"] = manifest_text("robot", [TOOL, *depends], build_type)
    loader = Loader(MemoryTree(files), ("",), TargetDistro("jazzy", "--distro", True))
    rules = registry.load()
    report = check(loader.load_all(), (), select(rules, chosen=(rule,)), ReportContext(rules, "", ("",), ()))
    return {issue.finding.subject: str(issue.severity) for issue in report.issues}


def test_dependencies_of_launch_are_infos_in_launch_files() -> None:
    cmake = f"{HEAD}install(DIRECTORY launch DESTINATION share/robot)\nament_package()\n"
    files = {"CMakeLists.txt": cmake, "launch/robot.launch.py": LAUNCH_FILE}
    assert severities("undeclared-dependency", files, "<exec_depend>launch_ros</exec_depend>") == {"std_msgs": "error"}
    assert severities("undeclared-dependency", files) == {"launch_ros": "info", "std_msgs": "error"}


def test_pytest_is_a_warning_because_colcon_depends_on_it() -> None:
    setup = "from setuptools import setup\nsetup(name='robot', version='1.0.0', packages=['robot'], tests_require=['pytest'])\n"
    files = {"setup.py": setup, "robot/__init__.py": "", "test/test_a.py": "import pytest\nimport numpy\nprint(pytest, numpy)\n"}
    assert severities("undeclared-dependency", files) == {"python3-pytest": "warning", "python3-numpy": "error"}


def test_parts_of_ament_cmake_are_infos() -> None:
    cmake = f"{HEAD}find_package(ament_cmake_python REQUIRED)\nament_python_install_package(robot)\n"
    files = {"CMakeLists.txt": f"{cmake}find_package(rclcpp_action REQUIRED)\nament_package()\n", "robot/__init__.py": ""}
    found = severities("transitive-dependency", files, "<depend>nav2_util</depend>")
    assert found["ament_cmake_python"] == "info"


def test_an_empty_export_of_a_package_that_has_nothing_to_export_is_an_info() -> None:
    unset = "ament_export_dependencies(${NEEDED})\nament_package()\n"
    assert severities("unset-variable", {"CMakeLists.txt": f"{HEAD}{unset}"}) == {"NEEDED": "info"}
    library = "add_library(robot robot.cpp)\ninstall(TARGETS robot DESTINATION lib)\n"
    files = {"CMakeLists.txt": f"{HEAD}{library}{unset}", "robot.cpp": "int x;\n"}
    assert severities("unset-variable", files) == {"NEEDED": "warning"}
