"""Which tag is written for a need."""

from __future__ import annotations

import pytest

from ros_lint.analysis.dependencies.tags import tag_for
from ros_lint.facts.manifest import Role
from ros_lint.workspace.model import Package, Workspace
from tests import one_package

HEAD = """<package format="{form}">
  <name>talker</name>
  <version>1.0.0</version>
  <description>Talks.</description>
  <maintainer email="ada@robots.example">Ada</maintainer>
  <license>Apache-2.0</license>
"""


def loaded(depends: str, form: int = 3) -> tuple[Package, Workspace]:
    text = f"{HEAD.format(form=form)}{depends}<export><build_type>ament_cmake</build_type></export></package>"
    script = "project(talker)\nament_package()\n"
    workspace = one_package.loaded({"talker/package.xml": text, "talker/CMakeLists.txt": script})
    return workspace.packages[0], workspace


MIXED = "<depend>rclcpp</depend><exec_depend>rviz2</exec_depend>"
ALWAYS = "<buildtool_depend>ament_cmake</buildtool_depend><depend>rclcpp</depend><depend>rviz2</depend>"


@pytest.mark.parametrize(
    ("role", "depends", "tag"),
    [
        (Role.TEST, ALWAYS, "test_depend"),
        (Role.EXEC, MIXED, "exec_depend"),
        (Role.EXEC, ALWAYS, "depend"),
        (Role.EXEC, "", "exec_depend"),
        (Role.EXEC | Role.TEST, MIXED, "exec_depend"),
        (Role.BUILD, MIXED, "depend"),
        (Role.BUILD | Role.EXEC, MIXED, "depend"),
        (Role.BUILD | Role.EXPORT | Role.EXEC | Role.TEST, MIXED, "depend"),
        (Role.EXPORT, MIXED, "depend"),
        (Role.TOOL, ALWAYS, "buildtool_depend"),
        (Role.TOOL | Role.TEST, ALWAYS, "buildtool_depend"),
    ],
)
def test_the_tag_holds_all_that_is_needed(role: Role, depends: str, tag: str) -> None:
    package, workspace = loaded(depends)
    assert tag_for(package, workspace, "nav_msgs", role) == tag


def test_what_is_run_is_not_found_and_linked_with_all_that_is_declared() -> None:
    text = f"{HEAD.format(form=3)}{ALWAYS}<export><build_type>ament_cmake</build_type></export></package>"
    lines = "project(talker)\nfind_package(ament_cmake_auto REQUIRED)\nament_auto_find_build_dependencies()\n"
    workspace = one_package.loaded({"a/package.xml": text, "a/CMakeLists.txt": lines})
    package = workspace.packages[0]
    assert tag_for(package, workspace, "nav_msgs", Role.EXEC) == "exec_depend"
    assert tag_for(package, workspace, "nav_msgs", Role.BUILD) == "depend"


def test_what_others_declare_as_a_tool_is_a_tool() -> None:
    package, workspace = loaded(MIXED)
    assert tag_for(package, workspace, "ament_cmake_python", Role.BUILD) == "buildtool_depend"
    assert tag_for(package, workspace, "std_msgs", Role.BUILD) == "depend"


@pytest.mark.parametrize(("role", "tag"), [(Role.EXEC, "run_depend"), (Role.BUILD | Role.EXEC, "build_depend")])
def test_format_1_has_other_tags(role: Role, tag: str) -> None:
    package, workspace = loaded("", form=1)
    assert tag_for(package, workspace, "nav_msgs", role) == tag


def test_what_is_compiled_against_says_nothing_of_what_is_run() -> None:
    built = "<buildtool_depend>ament_cmake</buildtool_depend><depend>rclcpp</depend><depend>std_msgs</depend>"
    text = f"{HEAD.format(form=3)}{built}<export><build_type>ament_cmake</build_type></export></package>"
    lines = "project(a)\nfind_package(rclcpp REQUIRED)\nfind_package(std_msgs REQUIRED)\nament_package()\n"
    workspace = one_package.loaded({"a/package.xml": text, "a/CMakeLists.txt": lines})
    assert tag_for(workspace.packages[0], workspace, "rviz2", Role.EXEC) == "exec_depend"


def test_what_is_run_and_tested_is_only_run() -> None:
    declared = "<depend>rclpy</depend><depend>std_msgs</depend><export><build_type>ament_python</build_type></export>"
    files = {
        "a/package.xml": f"{HEAD.format(form=3)}{declared}</package>",
        "a/setup.py": "from setuptools import setup\n\nsetup(name='talker', version='1.0.0', packages=['talker'])\n",
        "a/talker/__init__.py": "import rclpy\nimport std_msgs.msg\n",
        "a/test/test_talker.py": "import rclpy\nimport std_msgs.msg\n",
    }
    workspace = one_package.loaded(files)
    assert tag_for(workspace.packages[0], workspace, "rviz2", Role.EXEC) == "depend"
