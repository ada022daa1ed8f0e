"""``ros-lint explain-package``: its sections, as text and as JSON."""

import json

from ros_lint.base.tree import MemoryTree
from ros_lint.cli.commands import explain_package
from ros_lint.workspace.loader import Loader
from ros_lint.workspace.model import Workspace
from ros_lint.workspace.target import TargetDistro

FILES = {
    "robot/package.xml": """\
<package format="3">
  <name>robot</name><version>0.1.0</version><description>d</description>
  <maintainer email="a@b.org">A</maintainer><license>Apache-2.0</license>
  <depend>rclcpp</depend>
  <export><build_type>ament_cmake</build_type></export>
</package>
""",
    "robot/CMakeLists.txt": """\
project(robot)
find_package(ament_cmake REQUIRED)
find_package(rclcpp REQUIRED)
add_executable(talker talker.cpp)
install(TARGETS talker DESTINATION lib/${PROJECT_NAME})
include(${SOMEWHERE}/more.cmake)
ament_package()
""",
    "robot/talker.cpp": "#include <rclcpp/rclcpp.hpp>\n#include <rclcpp/node.hpp>\n#include <rclcpp/time.hpp>\n",
}


def workspace() -> Workspace:
    return Loader(MemoryTree(FILES), ("",), TargetDistro("jazzy", "--distro")).load()


def test_every_section_has_its_rows() -> None:
    out, err, code = explain_package.run(workspace(), "robot")
    assert (err, code) == ("", 0)
    lines = [line.split() for line in out.splitlines()]
    assert ["rclcpp", "<depend>", "robot/package.xml:4:3"] in lines
    assert ["talker", "executable", "target", "robot/CMakeLists.txt:4:16"] in lines
    assert ["lib/robot/talker", "built", "as", "talker,", "executable", "robot/CMakeLists.txt:5:17"] in lines
    assert any(line[-1] == "robot/talker.cpp:1:11" for line in lines if line)
    assert any("affect" in line for line in lines)


def test_text_has_the_first_uses_and_json_has_all() -> None:
    result = workspace()
    assert "more, e.g." in explain_package.run(result, "robot")[0]
    (package,) = json.loads(explain_package.run(result, "robot", "json")[0])["packages"]
    places = {(row["path"], row["line"]) for row in package["uses"] if row["name"] == "rclcpp"}
    assert places >= {("robot/talker.cpp", 1), ("robot/talker.cpp", 2), ("robot/talker.cpp", 3)}
    assert [row["name"] for row in package["installs"]] == sorted(row["name"] for row in package["installs"])


def test_a_similar_name_is_suggested_for_an_unknown_package() -> None:
    out, err, code = explain_package.run(workspace(), "robots")
    assert (out, code) == ("", 2)
    assert "did you mean 'robot'?" in err


def test_the_name_in_the_manifest_and_that_of_colcon_are_accepted() -> None:
    renamed = {**FILES, "robot/colcon.pkg": '{"name": "vendor_robot"}\n'}
    result = Loader(MemoryTree(renamed), ("",), TargetDistro("jazzy", "--distro")).load()
    for name in ("robot", "vendor_robot"):
        out, err, code = explain_package.run(result, name)
        assert (err, code) == ("", 0)
        assert out.startswith("robot (ros.ament_cmake, vendor_robot to colcon), robot\n")


def test_a_target_of_a_script_that_is_evaluated_twice_is_listed_once() -> None:
    files = {
        **FILES,
        "robot/CMakeLists.txt": "project(robot)\nif(UNKNOWN)\nadd_subdirectory(test)\nelse()\nadd_subdirectory(test)\nendif()\n",
        "robot/test/CMakeLists.txt": "add_executable(check check.cpp)\n",
    }
    result = Loader(MemoryTree(files), ("",), TargetDistro("jazzy", "--distro")).load()
    assert explain_package.run(result, "robot")[0].count("executable target") == 1
