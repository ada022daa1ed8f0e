"""Roles of files: in targets, installed, in separate projects, or not in use."""

from __future__ import annotations

import pytest

from ros_lint.facts.manifest import Role
from tests.one_package import HIDDEN, INSTALLED, PUBLIC, include, load, load_python, placed, use


@pytest.mark.parametrize(
    ("lines", "certain"),
    [
        (HIDDEN, False),
        ("add_subdirectory(sdk)", True),
        (HIDDEN + "add_subdirectory(sdk)", True),
        ('add_executable(a a.cpp)\noption(SDK "" OFF)\nif(SDK)\nadd_subdirectory(sdk)\nendif()\n' + HIDDEN, False),
        (HIDDEN + "add_executable(talker sdk/talker.cpp)", True),
    ],
)
def test_a_separate_project_is_in_use_if_the_build_reaches_it(lines: str, certain: bool) -> None:
    files = {"sdk/CMakeLists.txt": "project(sdk)\nadd_library(sdk talker.cpp)\n", "sdk/talker.cpp": include("nav_msgs")}
    assert use(load(lines, files), "nav_msgs").certain is certain


@pytest.mark.parametrize("project", ["CMakeLists.txt", "setup.py", "pyproject.toml"])
def test_tests_of_a_separate_project_are_not_in_use(project: str) -> None:
    lines = HIDDEN + "ament_add_pytest_test(robot test/test_robot.py)"
    files = {"test/test_robot.py": "import launch\n", "sdk/tests/test_sdk.py": "import requests\n", f"sdk/{project}": ""}
    workspace = load(lines, files)
    assert use(workspace, "launch").certain
    assert not use(workspace, "python3-requests").certain


def test_siblings_of_files_installed_by_name_are_not_in_use() -> None:
    lines = HIDDEN + "install(PROGRAMS scripts/talk.py DESTINATION lib/robot)"
    files = {"scripts/talk.py": "import rclpy\n", "scripts/plot.py": "import scipy\n"}
    workspace = load(lines, files)
    assert use(workspace, "rclpy").certain
    assert not use(workspace, "python3-scipy").certain


def test_modules_are_in_use_and_scripts_may_be_if_the_installation_is_hidden() -> None:
    files = {"tools2/a.py": "import pandas\n", "robot/__init__.py": "", "robot/b.py": "import scipy\n"}
    workspace = load(HIDDEN, files)
    assert not use(workspace, "python3-pandas").certain
    assert use(workspace, "python3-scipy").certain


def test_a_missing_subproject_installs_no_modules_from_outside() -> None:
    files = {"sdk/README.md": "", "types/__init__.py": "", "types/a.py": "import pandas\n"}
    lines = "add_subdirectory(sdk)\ninstall(TARGETS sdk DESTINATION lib)"
    assert not use(load("add_subdirectory(sdk)", files), "python3-pandas").certain
    assert not use(load(lines, files), "python3-pandas").certain
    assert use(load("add_subdirectory(sdk)\n" + HIDDEN, files), "python3-pandas").certain


def test_scripts_in_the_root_of_a_cmake_package_are_not_in_use() -> None:
    files = {"release.py": "import scipy\n", "tool.py": "import pandas\n", "robot/__init__.py": "import requests\n"}
    workspace = load(HIDDEN + "install(PROGRAMS tool.py DESTINATION lib/robot)", files)
    assert not use(workspace, "python3-scipy").certain
    assert use(workspace, "python3-pandas").certain
    assert use(workspace, "python3-requests").certain  # the hidden part may install it


def test_siblings_of_sources_compiled_by_name_are_not_in_use() -> None:
    lines = HIDDEN + "ament_add_gtest(t test/a.cpp)"
    files = {"test/a.cpp": include("nav_msgs"), "test/b.cpp": include("shape_msgs")}
    workspace = load(lines, files)
    assert use(workspace, "nav_msgs").certain
    assert not use(workspace, "shape_msgs").certain


@pytest.mark.parametrize(("folder", "certain"), [("tests", True), ("external/asio/tests", False)])
def test_tests_of_third_party_code_are_not_in_use(folder: str, certain: bool) -> None:
    assert use(load(HIDDEN, {f"{folder}/a.cpp": include("nav_msgs")}), "nav_msgs").certain is certain


@pytest.mark.parametrize(
    ("lines", "certain"),
    [
        ("add_subdirectory(sdk)", False),
        ("target_link_libraries(a sdk)", False),
        ("install(DIRECTORY ${SDK}/ DESTINATION lib/robot)", False),
        (HIDDEN, True),
    ],
)
def test_a_missing_subproject_compiles_no_sources_from_outside(lines: str, certain: bool) -> None:
    files = {"src/a.cpp": include("nav_msgs"), "src/old/b.cpp": include("shape_msgs")}
    workspace = load(f"add_executable(a src/a.cpp)\n{lines}", files)
    assert use(workspace, "nav_msgs").certain
    assert use(workspace, "shape_msgs").certain is certain


@pytest.mark.parametrize(
    ("line", "certain"),
    [
        ("ament_add_pytest_test(unit test/test_a.py)", True),
        ("ament_add_pytest_test(unit test/test_b.py)", False),
        ("ament_add_pytest_test(unit test)", True),
        ("foreach(name a b)\nament_add_pytest_test(${name} test/test_${name}.py)\nendforeach()", True),
        ("add_launch_test(test/test_b.py)", False),
        ("add_test(NAME a COMMAND python3 ${CMAKE_CURRENT_SOURCE_DIR}/test/test_a.py)", True),
        ("ament_add_ros_isolated_test(a COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/test/test_a.py)", True),
        ("ament_add_ros_isolated_test(b COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/test/test_b.py)", False),
        ("nav2_add_test(b COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/test/test_b.py)", False),
        ("acme_add_pytest_test(unit test/test_b.py)", True),  # it is unknown which tests it runs
        ("ament_add_test_label(a slow)", False),
        ("add_launch_test(${UNHEARD_OF})\nfind_package(acme)\nadd_launch_test(${acme_TESTS})", True),
        ("", False),
    ],
)
def test_a_python_test_is_in_use_if_it_is_run(line: str, certain: bool) -> None:
    files = {"test/test_a.py": "import requests\n", "test/test_b.py": "import pandas\n"}
    assert use(load(f"if(BUILD_TESTING)\n{line}\nendif()", files), "python3-requests").certain is certain


@pytest.mark.parametrize(
    ("lines", "certain"),
    [
        ("ament_add_test(a COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/test/test_a.launch.py)", True),
        ("ament_add_test(b COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/test/test_b.launch.py)", False),
        ("ament_add_test(b COMMAND test/test_b.launch.py)\ninstall(DIRECTORY test DESTINATION share/robot)", True),
        ("ament_add_gtest(a test/a.cpp)", True),  # users or the test program may start it
        ("ament_lint_auto_find_test_dependencies()", False),
    ],
)
def test_a_launch_file_of_tests_is_in_use_unless_only_others_are_run(lines: str, certain: bool) -> None:
    launch = "import requests\n\ndef generate_launch_description():\n    return LaunchDescription([])\n"
    files = {"test/test_a.launch.py": launch, "test/test_b.launch.py": "", "test/a.cpp": ""}
    workspace = load(f"if(BUILD_TESTING)\n{lines}\nendif()", files)
    assert use(workspace, "python3-requests").certain is certain


@pytest.mark.parametrize(("called", "certain"), [("robot.launch.py", True), ("rover.launch.py", False)])
def test_a_launch_file_named_by_a_test_is_in_use(called: str, certain: bool) -> None:
    launch = "import requests\n\ndef generate_launch_description():\n    return LaunchDescription([])\n"
    test = f"include(os.path.join(os.getenv('LAUNCH_FILES'), '{called}'))\n"
    files = {"test/test_a.py": test, "test/launch/robot.launch.py": launch, "test/launch/rover.launch.py": ""}
    workspace = load("if(BUILD_TESTING)\nadd_launch_test(test/test_a.py)\nendif()", files)
    assert use(workspace, "python3-requests").certain is certain


def test_helpers_next_to_running_tests_are_in_use() -> None:
    files = {"test/test_a.py": "", "test/helper.py": "import requests\n", "other/test/helper.py": "import pandas\n"}
    workspace = load("ament_add_pytest_test(unit test/test_a.py)", files)
    assert use(workspace, "python3-requests").certain
    assert not use(workspace, "python3-pandas").certain


@pytest.mark.parametrize(
    ("line", "extra_files", "certain"),
    [
        ("add_launch_test(test/test_a.py)", {}, True),
        ("add_launch_test(test/test_b.py)", {}, False),
        ("add_launch_test(test/test_a.py)", {"test/old/talker.py": ""}, False),  # it is unknown which of two files is meant
    ],
)
def test_a_program_started_by_a_running_test_is_in_use(line: str, extra_files: dict[str, str], certain: bool) -> None:
    start = 'run([sys.executable, os.path.join(HERE, "fixtures/talker.py")])\n'
    files = {"test/test_a.py": start, "test/test_b.py": "", "test/fixtures/talker.py": "import requests\n", **extra_files}
    assert use(load(f"if(BUILD_TESTING)\n{line}\nendif()", files), "python3-requests").certain is certain


@pytest.mark.parametrize(
    ("lines", "certain"),
    [
        ("add_library(robot src/robot.cpp)", False),
        ("add_library(robot src/robot.cpp src/old.cpp)", True),
        ("", True),  # nothing is compiled, so no header can be
        (HIDDEN + "add_library(robot src/robot.cpp)", True),
        ("file(READ list.txt MORE)\nadd_library(robot src/robot.cpp ${MORE})", True),
    ],
)
def test_a_header_of_an_uncompiled_source_is_not_in_use(lines: str, certain: bool) -> None:
    files = {
        "src/robot.cpp": "#include <robot/robot.hpp>\n",
        "src/old.cpp": "#include <robot/old.hpp>\n",
        "include/robot/robot.hpp": include("nav_msgs"),
        "include/robot/old.hpp": include("shape_msgs"),
        "include/robot/alone.hpp": include("sensor_msgs"),
    }
    workspace = load(INSTALLED + lines, files)
    assert placed(workspace, "nav_msgs") == (PUBLIC, True, False)
    assert placed(workspace, "shape_msgs") == (PUBLIC, certain, False)
    assert placed(workspace, "sensor_msgs") == (PUBLIC, True, False)


@pytest.mark.parametrize(
    ("lines", "certain"),
    [
        ("add_executable(robot src/robot.cpp)", False),
        ("add_executable(robot src/robot.cpp)\n" + INSTALLED, True),
        (
            "add_executable(robot src/robot.cpp)\nament_export_include_directories(include)",
            True,
        ),  # the missing install() is another finding
        ("add_library(robot src/robot.cpp)", True),
        ("add_executable(robot src/robot.cpp)\nif(BUILD_TESTING)\nadd_executable(t src/t.cpp)\nendif()", True),
        (HIDDEN + "add_executable(robot src/robot.cpp)", True),
        ("file(READ list.txt MORE)\nadd_executable(robot src/robot.cpp ${MORE})", True),
    ],
)
def test_an_unreferenced_header_of_a_package_with_only_programs_is_not_in_use(lines: str, certain: bool) -> None:
    files = {
        "src/robot.cpp": "#include <robot/robot.hpp>\n",
        "include/robot/robot.hpp": include("nav_msgs"),
        "include/robot/alone.hpp": include("sensor_msgs"),
        **({"src/t.cpp": "#include <robot/alone.hpp>\n"} if "src/t.cpp" in lines else {}),
    }
    workspace = load(lines, files)
    assert placed(workspace, "nav_msgs") == (PUBLIC, True, False)
    assert placed(workspace, "sensor_msgs") == (PUBLIC, certain, False)


@pytest.mark.parametrize(
    ("lines", "optional"),
    [
        ("find_package(acme QUIET)\nif(acme_FOUND)\nset(MORE src/acme.cpp)\nendif()\nadd_library(r src/r.cpp ${MORE})", True),
        ('option(EXAMPLES "" OFF)\nadd_library(r src/r.cpp)\nif(EXAMPLES)\nadd_library(acme src/acme.cpp)\nendif()', True),
        ('option(ALL "" ON)\nadd_library(r src/r.cpp)\nif(ALL)\nadd_library(acme src/acme.cpp)\nendif()', False),
        ("add_library(r src/r.cpp)\nif(WIN32)\nadd_library(b src/acme.cpp)\nelse()\nadd_library(b src/acme.cpp)\nendif()", False),
        (
            "find_package(acme)\nif(acme_FOUND)\nadd_library(r src/r.cpp src/acme.cpp)\nendif()",
            False,
        ),  # the whole package is conditional
    ],
)
def test_conditionally_compiled_files_are_optional(lines: str, optional: bool) -> None:
    files = {
        "src/r.cpp": "",
        "src/acme.cpp": "#include <robot/acme.hpp>\n#include <robot/common.hpp>\n" + include("nav_msgs"),
        "include/robot/acme.hpp": include("shape_msgs"),
        "include/robot/common.hpp": include("sensor_msgs"),
    }
    workspace = load(INSTALLED + lines, files)
    assert use(workspace, "nav_msgs").optional is optional
    assert use(workspace, "shape_msgs").optional is optional
    assert not use(workspace, "sensor_msgs").optional


@pytest.mark.parametrize(
    ("header", "source", "certain"),
    [
        ("#include <ros/ros.h>\n", "", False),
        ("#include <ros/ros.h>\n", "#include <robot/robot.hpp>\n", True),
        ("#ifdef ROS1\n#include <ros/ros.h>\n#endif\n", "", True),
        ("", "", True),
    ],
)
def test_an_unreferenced_header_of_ros_1_is_not_in_use(header: str, source: str, certain: bool) -> None:
    files = {"src/robot.cpp": source, "include/robot/robot.hpp": header + include("nav_msgs")}
    lines = INSTALLED + "add_library(robot src/robot.cpp)\n"
    assert placed(load(lines, files), "nav_msgs") == (PUBLIC, certain, False)


@pytest.mark.parametrize(
    ("options", "extra_files", "certain"),
    [
        ("packages=['robot']", {}, False),
        ("packages=['robot']", {"robot/tools/__init__.py": ""}, True),
        ("packages=['robot']", {"robot/node.py": "from robot.tools.learn import main\n"}, True),
        ("packages=['robot']", {"robot/node.py": "from other.tools import main\n"}, False),
        ("packages=['robot']", {"robot/tools/__init__.py": "", "robot/tools/setup.py": ""}, False),
        ("packages=['robot', 'robot.tools']", {"robot/tools/__init__.py": "", "robot/tools/setup.py": ""}, True),
        ("packages=['robot', 'robot.tools']", {}, True),
        ("packages=['robot'], entry_points={'console_scripts': ['learn = robot.tools.learn:main']}", {}, True),
    ],
)
def test_a_plain_folder_in_a_python_package_is_not_in_use(options: str, extra_files: dict[str, str], certain: bool) -> None:
    files = {"robot/__init__.py": "", "robot/tools/learn.py": "import nav_msgs.msg\n", **extra_files}
    assert placed(load_python(options, files), "nav_msgs") == (Role.EXEC, certain, False)


@pytest.mark.parametrize(("name", "certain"), [("node.py", True), ("node copy.py", False)])
def test_a_module_with_a_name_that_cannot_be_imported_is_not_in_use(name: str, certain: bool) -> None:
    files = {"robot/__init__.py": "", f"robot/{name}": "import nav_msgs.msg\n"}
    assert placed(load_python("packages=['robot']", files), "nav_msgs") == (Role.EXEC, certain, False)


@pytest.mark.parametrize(("name", "certain"), [("a.launch.py", True), ("a.launch (copy).py", False), ("a (2).launch.py", True)])
def test_a_copy_of_a_launch_file_is_not_in_use(name: str, certain: bool) -> None:
    text = "import nav_msgs.msg\n\ndef generate_launch_description():\n    return LaunchDescription([])\n"
    workspace = load("install(DIRECTORY launch DESTINATION share/robot)", {f"launch/{name}": text})
    assert placed(workspace, "nav_msgs") == (Role.EXEC, certain, False)


def test_headers_installed_only_for_tests_have_the_test_role() -> None:
    lines = "if(BUILD_TESTING)\ninstall(DIRECTORY test/ DESTINATION include/robot)\nendif()\n" + INSTALLED
    files = {"test/common.hpp": include("nav_msgs"), "include/robot/robot.hpp": include("shape_msgs")}
    workspace = load(lines, files)
    assert placed(workspace, "nav_msgs") == (Role.TEST, True, False)
    assert placed(workspace, "shape_msgs") == (PUBLIC, True, False)


def test_interfaces_are_in_use_if_code_is_generated_from_them() -> None:
    lines = "rosidl_generate_interfaces(robot msg/A.msg srv/C.srv DEPENDENCIES nav_msgs)"
    files = {"msg/A.msg": "nav_msgs/Path a\n", "msg/B.msg": "shape_msgs/Plane b\n", "srv/C.srv": "sensor_msgs/Imu a\n---\n"}
    workspace = load(lines, files)
    assert [use.certain for use in workspace.packages[0].uses if use.package == "nav_msgs"] == [True, True]
    assert placed(workspace, "shape_msgs") == (PUBLIC, False, False)
    assert placed(workspace, "sensor_msgs") == (PUBLIC, True, False)
    assert use(load("rosidl_generate_interfaces(robot ${UNHEARD_OF}/A.msg)\n" + HIDDEN, files), "shape_msgs").certain


@pytest.mark.parametrize(
    ("lines", "role"),
    [
        ("if(BUILD_TESTING)\nadd_subdirectory(src/spin)\nendif()", Role.TEST),
        ("add_subdirectory(src/spin)", Role.EXEC),
        (
            "install(PROGRAMS src/spin/tester.py DESTINATION lib/${PROJECT_NAME})\n"
            "if(BUILD_TESTING)\nadd_subdirectory(src/spin)\nendif()",
            Role.EXEC,
        ),
    ],
)
def test_a_folder_built_only_for_tests_has_the_test_role(lines: str, role: Role) -> None:
    files = {"src/spin/CMakeLists.txt": "add_executable(spin spin.cpp)\n", "src/spin/tester.py": "import rclpy\n"}
    assert use(load(lines, files), "rclpy").role == role
