"""The packages to which a name in a source may belong, by the kind of the name."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import pytest

from ros_lint.facts.repositories import ExpectedRepositories
from ros_lint.facts.sources import Via
from ros_lint.knowledge.providers import Providers
from ros_lint.knowledge.world import Resolution
from ros_lint.workspace.usage.package_files import PackageSource
from ros_lint.workspace.usage.resolve import ProviderMatch, Resolver
from tests.one_package import load

NOTHING = ProviderMatch(())


class Names(NamedTuple):
    """Names that exist, and what is known of the others."""

    packages: tuple[str, ...] = ()
    declared: tuple[str, ...] = ()
    resolutions: Mapping[str, Resolution] = {}
    providers: Mapping[str, Providers] = {}
    """By name, with the kind of the name before a colon."""
    awaited: ExpectedRepositories = ExpectedRepositories()

    def is_package(self, name: str) -> bool:
        return name in self.packages

    def is_declared(self, name: str) -> bool:
        return name in self.declared

    def resolution(self, name: str) -> Resolution:
        return self.resolutions.get(name, "unknown")

    def by_cmake(self, name: str) -> Providers:
        return self.providers.get(f"cmake:{name}", Providers())

    def by_macro(self, package: str) -> Providers:
        return self.providers.get(f"macro:{package}", Providers())

    def by_include(self, header: str) -> Providers:
        return self.providers.get(f"include:{header}", Providers())

    def by_import(self, module: str) -> Providers:
        return self.providers.get(f"import:{module}", Providers())


def source(name: str, *files: str) -> PackageSource:
    return PackageSource(name, name, files, None, {}, (), "ament_cmake")


def resolver_of(names: Names, *sources: PackageSource) -> Resolver:
    resolver = Resolver(names)
    resolver.renew(sources)
    return resolver


def match(via: Via, name: str, names: Names, *sources: PackageSource) -> ProviderMatch:
    return resolver_of(names, *sources).match(via, name)._replace(what="")


# --- names that exist ----------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("via", "name", "provided", "quotation"),
    [
        ("cmake", "Eigen3", "cmake:Eigen3", "find_package(Eigen3)"),
        ("target", "Eigen3::Eigen", "cmake:Eigen3", "Eigen3::Eigen"),
        ("target", "eigen", "cmake:eigen", "eigen"),
        ("macro", "rosidl::generate", "macro:rosidl", "rosidl::generate()"),
        ("include", "Eigen/Dense", "include:Eigen/Dense", "#include <Eigen/Dense>"),
        ("import", "cv2.aruco", "import:cv2.aruco", "import cv2.aruco"),
    ],
)
@pytest.mark.parametrize("sure", [True, False])
def test_a_name_belongs_to_its_providers(via: Via, name: str, provided: str, quotation: str, sure: bool) -> None:
    resolver = resolver_of(Names(providers={provided: Providers(("first", "second"), sure=sure)}))
    expected = ProviderMatch(("first", "second"), sure, quotation)
    assert resolver.match(via, name) == resolver.match(via, name) == expected


@pytest.mark.parametrize(
    ("via", "name", "quotation"),
    [
        ("package", "tf2", "tf2"),
        ("interface", "tf2/Transform", "tf2/Transform"),
        ("symbol", "tf2", "tf2"),
        ("launch", "tf2", "tf2"),
        ("key", "tf2", "tf2"),
        ("cmake", "tf2", "find_package(tf2)"),
    ],
)
def test_the_name_of_a_package_belongs_to_the_package(via: Via, name: str, quotation: str) -> None:
    assert resolver_of(Names(packages=("tf2",))).match(via, name) == ProviderMatch(("tf2",), True, quotation)


def test_what_needs_no_package_has_no_provider() -> None:
    names = Names(providers={"include:vector": Providers(none_needed=True), "cmake:Threads": Providers(none_needed=True)})
    assert match("include", "vector", names) == match("cmake", "Threads", names) == NOTHING


# --- names that do not exist ---------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "via_name", [("include", "arm_msgs/msg/a.hpp"), ("import", "arm_msgs.msg"), ("import", "arm_msgs.srv.A")]
)
@pytest.mark.parametrize(
    ("resolution", "declared", "expected"),
    [
        ("elsewhere", False, ProviderMatch(("arm_msgs",))),
        ("end-of-life", False, ProviderMatch(("arm_msgs",), False)),
        ("unknown", False, ProviderMatch(("arm_msgs",), False)),
        ("unknown", True, ProviderMatch(("arm_msgs",), True)),
        ("unknowable", False, NOTHING),
        ("unknowable", True, ProviderMatch(("arm_msgs",), True)),
    ],
)
def test_an_interface_belongs_to_the_package_of_its_name(
    via_name: tuple[Via, str], resolution: Resolution, declared: bool, expected: ProviderMatch
) -> None:
    names = Names(declared=("arm_msgs",) if declared else (), resolutions={"arm_msgs": resolution})
    assert match(*via_name, names) == expected


@pytest.mark.parametrize(
    ("via", "name"),
    [("include", "arm/a.hpp"), ("import", "arm.a"), ("target", "arm::a"), ("macro", "arm::a"), ("launch", "arm")],
)
@pytest.mark.parametrize(
    ("resolution", "expected"),
    [
        ("elsewhere", ProviderMatch(("arm",))),
        ("end-of-life", ProviderMatch(("arm",), False)),
        ("unknown", NOTHING),
        ("unknowable", NOTHING),
    ],
)
def test_another_unknown_name_belongs_to_a_package_of_another_distribution(
    via: Via, name: str, resolution: Resolution, expected: ProviderMatch
) -> None:
    assert match(via, name, Names(declared=("arm",), resolutions={"arm": resolution})) == expected


@pytest.mark.parametrize(("via", "name"), [("package", "arm"), ("interface", "arm/A"), ("cmake", "arm")])
def test_an_unknown_package_is_a_provider_if_a_manifest_declares_it(via: Via, name: str) -> None:
    assert match(via, name, Names()) == NOTHING
    assert match(via, name, Names(declared=("arm",))) == ProviderMatch(("arm",), True)


def test_a_library_with_a_name_that_no_package_can_have_is_no_package() -> None:
    assert match("cmake", "Arm", Names(packages=("Arm",), declared=("Arm",))) == NOTHING
    assert match("symbol", "arm", Names(declared=("arm",))) == NOTHING
    assert match("include", "arm.hpp", Names(resolutions={"arm.hpp": "elsewhere", "": "elsewhere"})) == NOTHING


@pytest.mark.parametrize("resolution", ["known", "elsewhere", "end-of-life", "unknown", "unknowable"])
def test_only_an_unknown_package_whose_files_are_looked_up_is_an_uncertain_provider(resolution: Resolution) -> None:
    resolver = resolver_of(Names(resolutions={"arm": resolution}))
    assert resolver.looked_up("arm") == (ProviderMatch(("arm",), False, "arm") if resolution == "unknown" else NOTHING)
    assert resolver.looked_up("Arm") == NOTHING


# --- names of the workspace ----------------------------------------------------------------------------------------


def test_a_header_of_several_packages_belongs_first_to_the_package_of_its_folder() -> None:
    sources = [source(name, "include/shapes/line.hpp") for name in ("copies", "shapes", "zoo")]
    expected = ProviderMatch(("shapes", "copies", "zoo"))
    assert match("include", "shapes/line.hpp", Names(), *sources) == expected
    assert match("include", "shapes/circle.hpp", Names(), *sources) == NOTHING


@pytest.mark.parametrize(
    ("provided", "expected"),
    [
        (Providers(("fmt", "libfmt-dev"), sure=False), ProviderMatch(("fmt", "libfmt-dev", "robot"), False)),
        (Providers(("fmt",)), ProviderMatch(("fmt", "robot"))),
        (Providers(("fmt", "robot"), sure=False), ProviderMatch(("robot",))),
        (Providers(), ProviderMatch(("robot",))),
    ],
)
def test_a_copy_of_a_header_belongs_first_to_the_library(provided: Providers, expected: ProviderMatch) -> None:
    names = Names(providers={"include:fmt/core.h": provided, "include:core.h": provided})
    assert match("include", "fmt/core.h", names, source("robot", "include/fmt/core.h")) == expected
    assert match("include", "core.h", names, source("robot", "include/core.h")) == ProviderMatch(("robot",))


@pytest.mark.parametrize(("module", "is_interface"), [("arm.msg", True), ("arm.action.A", True), ("arm.messages", False)])
def test_an_interface_module_of_the_workspace_belongs_to_its_package(module: str, is_interface: bool) -> None:
    names = Names(resolutions={"arm": "known"})
    assert match("import", module, names, source("arm")) == (ProviderMatch(("arm",)) if is_interface else NOTHING)
    assert match("import", module, names, source("leg")) == NOTHING


# --- uses of a package -------------------------------------------------------------------------------------------


USES = """\
CMakeLists.txt:2 ament_cmake cmake Role.BUILD: find_package(ament_cmake)
CMakeLists.txt:4 rclcpp cmake Role.BUILD: find_package(rclcpp)
CMakeLists.txt:5 geometry_msgs cmake Role.BUILD: find_package(geometry_msgs)
CMakeLists.txt:8 action_msgs macro Role.BUILD|EXPORT|EXEC: an action
CMakeLists.txt:8 rosidl_default_generators macro Role.TOOL: rosidl_generate_interfaces()
CMakeLists.txt:13 rclcpp target Role.BUILD: rclcpp::rclcpp
CMakeLists.txt:14 ament_cmake_export_dependencies macro Role.TOOL: ament_export_dependencies()
CMakeLists.txt:14 tf2 target Role.EXPORT: ament_export_dependencies(tf2)
CMakeLists.txt:20 action_msgs macro Role.TEST: an action
CMakeLists.txt:20 rosidl_default_generators macro Role.TEST: rosidl_generate_interfaces()
CMakeLists.txt:21 ament_cmake_gtest macro Role.TEST: ament_add_gtest()
CMakeLists.txt:23 ament_cmake_core macro Role.TOOL: ament_package()
action/Go.action:1 std_msgs interface Role.BUILD|EXPORT|EXEC: std_msgs/Header
include/robot/robot.hpp:1 geometry_msgs include Role.BUILD|EXPORT|EXEC: #include <geometry_msgs/msg/pose.hpp>
launch/robot.launch.xml:1 rviz2 launch Role.EXEC: node rviz2
launch/robot.launch.xml:1 slam_toolbox launch Role.EXEC: include launch/a.launch.py
scripts/go.py:2 arm_msgs import Role.EXEC: import of arm_msgs.msg
scripts/go.py:4 python3-opencv import Role.EXEC: import of cv2, with the error caught optional
scripts/go.py:7 ament_index_python import Role.EXEC: import of ament_index_python
src/idle.cpp:1 shape_msgs include Role.BUILD|EXEC: #include <shape_msgs/msg/plane.hpp> uncertain
src/more.cpp:1 arm_msgs include Role.BUILD|EXEC: #include <arm_msgs/msg/a.hpp>
src/more.cpp:2 hand_msgs include Role.BUILD|EXEC: #include <hand_msgs/msg/a.hpp> uncertain
src/more.cpp:3 leg_msgs include Role.BUILD|EXEC: #include <leg_msgs/msg/a.hpp> uncertain
src/robot.cpp:5 eigen include Role.BUILD|EXEC: #include <Eigen/Dense>
src/robot.cpp:6 nlohmann-json-dev include Role.BUILD|EXEC: #include <nlohmann/json.hpp>
test/t.cpp:1 ament_cmake_gtest include Role.TEST: #include <gtest/gtest.h>
"""


def test_the_uses_of_a_package_are_complete() -> None:
    lines = """
find_package(rclcpp REQUIRED)
find_package(geometry_msgs REQUIRED)
find_package(arm_msgs REQUIRED)
find_package(hand_msgs QUIET)
rosidl_generate_interfaces(robot action/Go.action)
FetchContent_Declare(sqlite3 GIT_REPOSITORY https://code.example/sqlite3.git)
FetchContent_MakeAvailable(sqlite3)
add_library(robot SHARED src/robot.cpp src/more.cpp)
target_include_directories(robot PRIVATE private)
target_link_libraries(robot rclcpp::rclcpp)
ament_export_dependencies(tf2)
install(DIRECTORY include/ DESTINATION include)
install(PROGRAMS scripts/go.py DESTINATION lib/robot)
install(DIRECTORY launch DESTINATION share/robot)
if(BUILD_TESTING)
  find_package(leg_msgs REQUIRED)
  rosidl_generate_interfaces(robot_test action/Go.action)
  ament_add_gtest(t test/t.cpp)
endif()"""
    files = {
        "include/robot/robot.hpp": ["geometry_msgs/msg/pose.hpp"],
        "src/robot.cpp": [
            "robot/robot.hpp",
            "yaml-cpp/yaml.h",
            "sqlite3/core.h",
            "sqlite3.h",
            "Eigen/Dense",
            "nlohmann/json.hpp",
        ],
        "src/more.cpp": [f"{name}_msgs/msg/a.hpp" for name in ("arm", "hand", "leg")],
        "src/idle.cpp": ["shape_msgs/msg/plane.hpp"],
        "private/yaml-cpp/yaml.h": [],
        "test/t.cpp": ["gtest/gtest.h"],
    }
    texts = {path: "".join(f"#include <{header}>\n" for header in found) for path, found in files.items()}
    texts["scripts/go.py"] = (
        "#!/usr/bin/env python3\nimport arm_msgs.msg\ntry:\n    import cv2\nexcept ImportError:\n    pass\n"
        "from ament_index_python import get_package_share_directory as share\nprint(share('nav2_bringup'), share('unknown'))\n"
    )
    texts["launch/robot.launch.xml"] = (
        '<launch><node pkg="rviz2" exec="rviz2"/><include file="$(find-pkg-share slam_toolbox)/launch/a.launch.py"/></launch>'
    )
    texts["action/Go.action"] = "std_msgs/Header header\n---\n---\n"
    workspace = load(lines, texts)
    found = [
        f"{use.span.path[6:]}:{use.span.line} {use.providers[0]} {use.via} {use.role}: {use.what}"
        f"{' optional' * use.optional}{' uncertain' * (not use.certain)}"
        for use in workspace.packages[0].uses
    ]
    assert found == USES.splitlines()
