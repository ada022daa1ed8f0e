"""Projects of FetchContent and ExternalProject, and projects in the sources."""

from __future__ import annotations

import pytest

from ros_lint.workspace.model import Package
from tests.one_package import loaded
from tests.packages import manifest_text

MANIFEST = manifest_text("robot")
LINKED = "add_library(r r.cpp)\ntarget_link_libraries(r nlohmann_json::nlohmann_json)"


def load(lines: str, source: str = "#include <nlohmann/json.hpp>\n") -> Package:
    script = f"project(robot)\nfind_package(ament_cmake REQUIRED)\n{lines}\n{LINKED}\nament_package()\n"
    files = {"package.xml": MANIFEST, "CMakeLists.txt": script, "r.cpp": source}
    return loaded({f"robot/{path}": text for path, text in files.items()}).packages[0]


def uses(package: Package) -> set[str]:
    return {use.package for use in package.uses} - {"ament_cmake", "ament_cmake_core"}


@pytest.mark.parametrize(
    "lines",
    [
        "FetchContent_Declare(json URL https://github.com/nlohmann/json/releases/download/v3/json.tar.xz)\n"
        "FetchContent_MakeAvailable(json)",
        "FetchContent_Declare(Json GIT_REPOSITORY https://github.com/nlohmann/json.git GIT_TAG v3)\nFetchContent_Populate(Json)",
        "FetchContent_Declare(j GIT_REPOSITORY git@github.com:nlohmann/json)\nFetchContent_MakeAvailable(j)",
        "ExternalProject_Add(j GIT_REPOSITORY https://github.com/nlohmann/json.git)",
    ],
)
def test_a_fetched_project_is_recognized_by_its_address(lines: str) -> None:
    assert uses(load(lines)) == set()


@pytest.mark.parametrize(
    "lines",
    [
        "",
        "FetchContent_Declare(json URL https://github.com/nlohmann/json)",
        "FetchContent_Declare(fmt URL https://github.com/fmtlib/fmt)\nFetchContent_MakeAvailable(fmt)",
    ],
)
def test_a_project_that_is_not_fetched_is_used(lines: str) -> None:
    assert uses(load(lines)) == {"nlohmann-json-dev"}


def test_targets_of_a_fetched_project_can_differ_from_its_repository() -> None:
    linked = "\ntarget_link_libraries(r GTest::gtest_main GTest::gmock_main)"
    fetched = "FetchContent_Declare(googletest URL https://github.com/google/googletest/archive/a.zip)\n"
    assert "gtest" in str(uses(load(LINKED + linked, "")))
    assert uses(load(f"{fetched}FetchContent_MakeAvailable(googletest)\n{LINKED}{linked}", "")) == {"nlohmann-json-dev"}


@pytest.mark.parametrize(
    ("lines", "built"),
    [
        ("FetchContent_Declare(log URL https://x.org/log.tar.gz)\nFetchContent_MakeAvailable(log)\n", False),
        ("ExternalProject_Add(log URL https://x.org/log.tar.gz)\n", False),
        ("ExternalProject_Add(all SOURCE_DIR ${CMAKE_CURRENT_SOURCE_DIR})\n", True),
    ],
)
def test_an_external_project_does_not_build_sources_of_the_package(lines: str, built: bool) -> None:
    script = f"project(robot)\nfind_package(ament_cmake REQUIRED)\n{lines}add_library(r r.cpp)\nament_package()\n"
    files = {"package.xml": MANIFEST, "CMakeLists.txt": script, "r.cpp": "", "test/t.cpp": "#include <gtest/gtest.h>\n"}
    package = loaded({f"robot/{path}": text for path, text in files.items()}).packages[0]
    (use,) = (use for use in package.uses if "gtest" in use.package)
    assert use.certain is built


def test_a_project_in_the_sources_is_not_used() -> None:
    search = "find_package(nlohmann_json REQUIRED)"
    in_sources = "set(nlohmann_json_DIR ${CMAKE_CURRENT_SOURCE_DIR}/../json/cmake)\n"
    installed = "set(nlohmann_json_DIR ${CMAKE_PREFIX_PATH}/share/nlohmann_json/cmake)\n"
    assert uses(load(in_sources + "find_package(nlohmann_json REQUIRED)", "#include <nlohmann_json/json.hpp>\n")) == set()
    assert uses(load(installed + search)) == uses(load(search)) == {"nlohmann-json-dev"}


def test_the_folder_of_a_fetched_project_is_unknown() -> None:
    lines = (
        "FetchContent_Declare(Json GIT_REPOSITORY https://github.com/nlohmann/json.git)\n"
        "FetchContent_GetProperties(Json)\nif(NOT json_POPULATED)\nFetchContent_Populate(Json)\n"
        "add_subdirectory(${json_SOURCE_DIR} ${json_BINARY_DIR} EXCLUDE_FROM_ALL)\nendif()"
    )
    script = load(lines).script
    assert script is not None
    assert script.problems == ()
    assert "the folder of add_subdirectory() was not found" in {opaque.reason for opaque in script.opaque}


def test_a_project_built_by_execute_process_is_not_used() -> None:
    build = "execute_process(COMMAND ${CMAKE_COMMAND} -S ${CMAKE_CURRENT_SOURCE_DIR}/part_msgs -B b)\n"
    lines = "find_package(part_msgs REQUIRED)\ntarget_link_libraries(r part_msgs::part_msgs)"
    files = {"package.xml": MANIFEST, "r.cpp": "#include <part_msgs/msg/part.hpp>\n", "part_msgs/CMakeLists.txt": ""}
    for command, needs in ((build, set()), ("", {"part_msgs"})):
        script = f"project(robot)\nfind_package(ament_cmake REQUIRED)\nadd_library(r r.cpp)\n{command}{lines}\nament_package()\n"
        paths = {f"robot/{path}": text for path, text in {**files, "CMakeLists.txt": script}.items()}
        assert uses(loaded(paths).packages[0]) == needs
