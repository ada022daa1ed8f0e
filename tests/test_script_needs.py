"""What a build script needs and brings along: by what it names, finds, builds and is told."""

from __future__ import annotations

import pytest

from ros_lint.analysis.dependencies.needs import needs
from ros_lint.analysis.dependencies.undeclared import undeclared
from ros_lint.facts.manifest import Role
from tests.one_package import BUILT, INSTALLED, PUBLIC, load, placed, use


@pytest.mark.parametrize(
    ("lines", "files"),
    [
        ("include(FetchContent)\nFetchContent_Declare(fcl URL x)\nFetchContent_MakeAvailable(fcl)", {}),
        ("include(ExternalProject)\nExternalProject_Add(fcl URL x)", {}),
        ("add_subdirectory(thirdparty/lib)", {"thirdparty/lib/CMakeLists.txt": "project(fcl)\n"}),
        ("add_subdirectory(thirdparty/fcl)", {"thirdparty/fcl/CMakeLists.txt": "", "thirdparty/fcl/include/fcl/b.h": ""}),
    ],
)
def test_what_is_built_along_is_no_need(lines: str, files: dict[str, str]) -> None:
    files = {"src/a.cpp": "#include <fcl/collision.h>\n#include <Eigen/Core>\n", **files}
    found = "find_package(fcl REQUIRED)\nadd_library(r src/a.cpp)\ntarget_link_libraries(r fcl::fcl)"
    workspace = load(f"{lines}\n{found}", files)
    assert {use.package for use in workspace.packages[0].uses} == {"ament_cmake", "ament_cmake_core", "eigen"}
    assert "libfcl-dev" in {use.package for use in load("add_library(r src/a.cpp)", files).packages[0].uses}


@pytest.mark.parametrize(
    ("folder", "sure"),
    [
        ("${CMAKE_CURRENT_SOURCE_DIR}/../../third_party/sql/include", False),
        ("$<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/../sql>", False),
        ("../sql", False),
        ("${SQL_DIR}", False),
        ("include", True),
        ("${CMAKE_CURRENT_SOURCE_DIR}/a/../include", True),
        ("/usr/include/../local", True),
        ("${acme_INCLUDE_DIRS}", True),
    ],
)
def test_a_header_without_a_folder_may_lie_where_the_script_leads(folder: str, sure: bool) -> None:
    files = {"src/a.cpp": "#include <sqlite3.h>\n#include <Eigen/Core>\n"}
    path = "set(SQL_DIR ${CMAKE_CURRENT_SOURCE_DIR}/../sql)\nif(NOT EXISTS ${SQL_DIR})\nset(SQL_DIR /opt/sql)\nendif()\n"
    workspace = load(f"{path}add_library(r src/a.cpp)\ntarget_include_directories(r PRIVATE {folder})", files)
    assert use(workspace, "libsqlite3-dev").certain is sure
    assert use(workspace, "eigen").certain


def test_the_namespace_of_a_target_need_not_be_its_package() -> None:
    lines = "find_package(std_msgs REQUIRED)\nadd_library(r a.cpp)\ntarget_link_libraries(r nav_msgs::std_msgs shape_msgs::a)"
    found = {use.package for use in load(lines, {"a.cpp": ""}).packages[0].uses}
    assert found == {"ament_cmake", "ament_cmake_core", "std_msgs", "shape_msgs"}


def test_what_tests_are_written_with_is_needed_by_tests() -> None:
    lines = INSTALLED + "add_library(r src/r.cpp)\nadd_library(harness src/harness.cpp)"
    files = {
        "src/r.cpp": "",
        "src/harness.cpp": "#include <gmock/gmock.h>\n",
        "include/robot/matchers.hpp": "#include <gtest/gtest.h>\n",
    }
    workspace = load(lines, files)
    assert placed(workspace, "ament_cmake_gtest") == (PUBLIC, True, False)  # an installed header is for others
    assert placed(workspace, "ament_cmake_gmock") == (BUILT, True, False)
    not_installed = load(lines.removeprefix(INSTALLED), files)
    assert placed(not_installed, "ament_cmake_gtest")[0] is Role.TEST
    declared = load(lines, files, "<depend>ament_cmake</depend><build_depend>libgmock-dev</build_depend>")
    assert not undeclared(declared.packages[0], declared)


def test_cmake_files_for_others_name_what_these_need() -> None:
    lines = (
        "configure_package_config_file(cmake/robotConfig.cmake.in x INSTALL_DESTINATION share)\n"
        'list(APPEND robot_CONFIG_EXTRAS "robot-extras.cmake")'
    )
    files = {
        "cmake/robotConfig.cmake.in": "find_dependency(nav_msgs)\nif(NOT TARGET a)\nfind_package(OpenGL REQUIRED)\nendif()\n"
        "find_package(std_msgs)\nif(WIN32)\nfind_package(ZLIB REQUIRED)\nendif()\n",
        "robot-extras.cmake": "find_package(shape_msgs REQUIRED)\nmacro(f)\nfind_package(rclcpp REQUIRED)\nendmacro()\n",
    }
    workspace = load(lines, files)
    for package in ("nav_msgs", "shape_msgs", "opengl"):
        assert placed(workspace, package) == (Role.EXPORT, True, False)
    assert placed(workspace, "std_msgs") == (Role.EXPORT, True, True)
    assert placed(workspace, "zlib") == (Role.EXPORT, False, False)
    assert "rclcpp" not in {use.package for use in workspace.packages[0].uses}


@pytest.mark.parametrize(
    ("lines", "optional"),
    [
        ("find_package(nav_msgs)", True),
        ("find_package(nav_msgs REQUIRED)", False),
        ("find_package(nav_msgs)\nset(X ${nav_msgs_LIBRARIES})", False),
        ("find_package(nav_msgs)\nament_export_dependencies(nav_msgs)", False),
    ],
)
def test_what_need_not_be_found_and_nothing_takes_is_optional(lines: str, optional: bool) -> None:
    found = [use for use in load(lines, {}).packages[0].uses if use.what == "find_package(nav_msgs)"]
    assert [use.optional for use in found] == [optional]


def test_tools_work_by_being_found() -> None:
    uses = load("find_package(python_cmake_module)\nfind_package(launch_testing_ament_cmake)", {}).packages[0].uses
    assert {use.package: use.optional for use in uses if use.via == "cmake" and use.package != "ament_cmake"} == {
        "python_cmake_module": False,
        "launch_testing_ament_cmake": True,  # it has commands, and none is called
    }


def test_all_that_is_found_together_is_no_use_of_each() -> None:
    lines = (
        "find_package(ament_cmake_auto REQUIRED)\nament_auto_find_build_dependencies()\nadd_library(r a.cpp)\n"
        "ament_target_dependencies(r ${${PROJECT_NAME}_FOUND_BUILD_DEPENDS})"
    )
    workspace = load(lines, {"a.cpp": ""}, "<depend>nav_msgs</depend><depend>ament_cmake_auto</depend>")
    assert "nav_msgs" not in {use.package for use in workspace.packages[0].uses}
    assert not [opaque for opaque in workspace.packages[0].opaque if "known" in opaque.reason]


@pytest.mark.parametrize(
    ("line", "depends", "missing"),
    [
        ("find_package(Python3 REQUIRED)", "", []),
        ("find_package(Python3 REQUIRED COMPONENTS Interpreter)", "", []),
        ("find_package(Python3 REQUIRED COMPONENTS Interpreter Development)", "", ["python3-dev"]),
        ("find_package(Python3 REQUIRED COMPONENTS Development.Module)", "", ["python3-dev"]),
        ("find_package(Python3 REQUIRED COMPONENTS Development)", "<build_depend>pybind11_vendor</build_depend>", []),
        ("find_package(Python3 REQUIRED COMPONENTS Development)", "<depend>rosidl_default_generators</depend>", []),
        ("find_package(Python3 REQUIRED COMPONENTS Development)", "<build_depend>python_qt_binding</build_depend>", []),
        ("find_package(Qt5 REQUIRED COMPONENTS Core)", "<depend>libqt5-core</depend>", ["qtbase5-dev"]),
        ("find_package(Qt5 REQUIRED)", "<build_depend>qtbase5-dev</build_depend><exec_depend>libqt5-core</exec_depend>", []),
        ("find_package(Qt5 REQUIRED COMPONENTS Core)", "<depend>rviz_common</depend>", []),
    ],
)
def test_to_build_takes_more_than_to_run(line: str, depends: str, missing: list[str]) -> None:
    workspace = load(line, {}, f"<buildtool_depend>ament_cmake</buildtool_depend>{depends}")
    assert [need.name for need, _ in undeclared(workspace.packages[0], workspace)] == missing
    assert not [need for need in needs(workspace.packages[0], workspace) if need.name == "libqt5-core"]
