"""``ros-lint why A B --explain-silence`` gives the reason why a dependency rule reports nothing."""

from __future__ import annotations

import re

import pytest

from ros_lint.cli.commands import explain_silence as silence
from ros_lint.workspace.model import Workspace
from tests.one_package import loaded

FILES = {
    "talker/package.xml": """<package format="3"><name>talker</name><version>1.0.0</version><description>Talks.</description>
<maintainer email="ada@robots.example">Ada</maintainer><license>Apache-2.0</license>
<buildtool_depend>ament_cmake</buildtool_depend>
<depend>rclcpp</depend>
<depend>sensor_msgs</depend>
<depend>tf2_msgs</depend>
<depend>eigen</depend>
<build_depend condition="$X == 1">shape_msgs</build_depend>
<export><build_type>ament_cmake</build_type></export></package>
""",
    "talker/CMakeLists.txt": """project(talker)
find_package(ament_cmake REQUIRED)
find_package(std_msgs REQUIRED)
find_package(nav_msgs REQUIRED)
find_package(map_msgs QUIET)
find_package(visualization_msgs QUIET)
find_package(builtin_interfaces QUIET)
if(map_msgs_FOUND OR builtin_interfaces_FOUND)
endif()
add_executable(talker talker.cpp)
ament_package()
""",
    "talker/talker.cpp": "#include <rclcpp/rclcpp.hpp>\n",
    "talker/idle.cpp": "#include <diagnostic_msgs/msg/key_value.hpp>\n#include <visualization_msgs/msg/marker.hpp>\n",
    "talker/notes.txt": "sensor_msgs may be needed one day\n",
}


@pytest.fixture(scope="module")
def workspace() -> Workspace:
    return loaded(FILES)


DECLARED = "not reported, because it is declared"
NOT_DECLARED = "not reported, because it is not declared"
PROVIDED = "not reported, because a declared dependency provides it"
UNSURE = "reported with lower confidence"


@pytest.mark.parametrize(
    ("name", "undeclared", "unused"),
    [
        ("nav_msgs", "reported", NOT_DECLARED),
        ("std_msgs", f"{PROVIDED}: sensor_msgs -> std_msgs", NOT_DECLARED),
        ("map_msgs", f"{UNSURE}, because every use is optional", NOT_DECLARED),
        ("diagnostic_msgs", f"{UNSURE}, because no use is certain", NOT_DECLARED),
        ("visualization_msgs", f"{UNSURE}, because no use is certain", NOT_DECLARED),
        ("rclcpp", DECLARED, "not reported, because it is used: talker/talker.cpp:1"),
        ("sensor_msgs", DECLARED, "not reported, because its name appears here: talker/notes.txt:1"),
        ("shape_msgs", DECLARED, "not reported, because it is declared under a condition"),
        ("tf2_msgs", DECLARED, "reported"),
        ("eigen", DECLARED, f"{UNSURE}, because it may be used without being named in the sources"),
        ("builtin_interfaces", f"{PROVIDED}: rclcpp -> builtin_interfaces", NOT_DECLARED),
        ("joy", "not reported, because no use of it was found", NOT_DECLARED),
    ],
)
def test_the_reason_for_each_rule_is_given(workspace: Workspace, name: str, undeclared: str, unused: str) -> None:
    out, err, code = silence.run(workspace, "talker", name)
    output = dict(line.split(": ", 1) for line in out.splitlines() if line.startswith("un"))
    assert (err, code) == ("", 0)
    assert output["undeclared-dependency"].startswith(undeclared)
    assert output["unused-dependency"].startswith(unused)


def test_an_unknown_package_gives_exit_code_2(workspace: Workspace) -> None:
    assert silence.run(workspace, "listener", "rclcpp")[2] == 2


def test_a_finding_that_another_one_explains_is_named() -> None:
    files = {
        "talker/package.xml": re.sub(r"<(build_)?depend.*\n", "", FILES["talker/package.xml"]),
        "talker/CMakeLists.txt": "project(talker)\nfind_package(ament_cmake REQUIRED)\n"
        "install(DIRECTORY launch DESTINATION share/talker)\nament_package()\n",
        "talker/launch/a.launch.py": "from ament_index_python import get_package_prefix\n"
        "from launch_ros.actions import Node\ndef generate_launch_description():\n  return LaunchDescription([])\n",
    }
    output, _, code = silence.run(loaded(files), "talker", "ament_index_python")
    assert code == 0
    assert "undeclared-dependency: not shown, because the finding about 'launch_ros' explains it\n" in output
