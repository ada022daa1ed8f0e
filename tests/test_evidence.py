"""From mentions to uses, and from uses to needs."""

from __future__ import annotations

import pytest

from ros_lint.analysis.dependencies.declared_closure import provided_transitively
from ros_lint.analysis.dependencies.needs import needs
from ros_lint.analysis.dependencies.undeclared import undeclared
from ros_lint.analysis.dependencies.unknown_closure import may_provide
from ros_lint.analysis.dependencies.unresolved import intended_names
from ros_lint.facts.manifest import Role
from ros_lint.facts.sources import Use
from ros_lint.workspace.model import Workspace
from ros_lint.workspace.usage.resolve import used_names
from tests.one_package import loaded

HEAD = """<package format="3"><name>{name}</name><version>1.0.0</version><description>Does it.</description>
<maintainer email="ada@robots.example">Ada</maintainer><license>Apache-2.0</license>{depends}
<export><build_type>{kind}</build_type></export></package>
"""


def cmake(name: str, depends: str, lines: str, **files: str) -> dict[str, str]:
    """Return the files of an ament_cmake package; names of files have __ for / and _dot_ for a dot."""
    result = {
        f"{name}/package.xml": HEAD.format(name=name, depends=depends, kind="ament_cmake"),
        f"{name}/CMakeLists.txt": f"project({name})\nfind_package(ament_cmake REQUIRED)\n{lines}\nament_package()\n",
    }
    result.update({f"{name}/{path.replace('__', '/').replace('_dot_', '.')}": text for path, text in files.items()})
    return result


def uses(workspace: Workspace, name: str) -> list[Use]:
    return [use for use in workspace.packages[0].uses if use.package == name]


def test_the_role_of_a_use_is_the_role_of_its_file() -> None:
    workspace = loaded(
        cmake(
            "talker",
            "",
            "add_executable(talker src/talker.cpp)\ninstall(DIRECTORY include/ DESTINATION include)\n"
            "if(BUILD_TESTING)\nament_add_gtest(t test/t.cpp)\nendif()",
            src__talker_dot_cpp="#include <nav_msgs/msg/path.hpp>\n",
            include__talker__talker_dot_hpp="#include <sensor_msgs/msg/imu.hpp>\n",
            test__t_dot_cpp="#include <std_msgs/msg/string.hpp>\n",
            src__idle_dot_cpp="#include <shape_msgs/msg/plane.hpp>\n",
        )
    )
    assert [(use.role, use.certain) for use in uses(workspace, "nav_msgs")] == [(Role.BUILD | Role.EXEC, True)]
    assert [(use.role, use.certain) for use in uses(workspace, "sensor_msgs")] == [(Role.BUILD | Role.EXPORT | Role.EXEC, True)]
    assert [(use.role, use.certain) for use in uses(workspace, "std_msgs")] == [(Role.TEST, True)]
    assert [use.certain for use in uses(workspace, "shape_msgs")] == [False]


def test_headers_in_the_packages_include_folder_are_its_own() -> None:
    workspace = loaded(
        cmake(
            "talker",
            "",
            "add_library(talker src/talker.cpp)",
            src__talker_dot_cpp="#include <gazebo_ros/ui_main.h>\n#include <nav_msgs/msg/path.hpp>\n",
            include__gazebo_ros__talker_dot_hpp="",
        ),
        "humble",
    )
    assert [use.package for use in workspace.packages[0].uses if use.via == "include"] == ["nav_msgs"]


@pytest.mark.parametrize(("lines", "expected"), [("", False), ("add_subdirectory(sdk)", True), ("include(more)", True)])
def test_a_metapackage_provides_no_headers(lines: str, expected: bool) -> None:
    source = "#include <robot/can/socket.hpp>\n"
    driver = cmake("driver", "", "add_library(driver driver.cpp)", driver_dot_cpp=source)
    workspace = loaded({**driver, **cmake("robot", "", lines, sdk__CMakeLists_dot_txt="")})
    assert bool(uses(workspace, "robot")) == expected


@pytest.mark.parametrize(
    ("header", "expected"),
    [
        ("geometry_msgs/Pose.h", False),
        ("geometry_msgs/msg/pose.h", True),
        ("sensor_msgs/image_encodings.hpp", True),
        ("std_srvs/Empty.h", False),
    ],
)
def test_a_ros_1_message_header_belongs_to_no_package(header: str, expected: bool) -> None:
    workspace = loaded(cmake("bridge", "", "add_executable(bridge bridge.cpp)", bridge_dot_cpp=f"#include <{header}>\n"))
    assert bool(uses(workspace, header.partition("/")[0])) is expected


def test_uses_resolved_by_the_handwritten_map_are_uncertain() -> None:
    workspace = loaded(cmake("talker", "", "find_package(CUDA REQUIRED)\nfind_package(Eigen3 REQUIRED)"))
    assert [use.certain for use in uses(workspace, "nvidia-cuda")] == [False]
    assert [use.certain for use in uses(workspace, "eigen")] == [True]


def test_an_action_needs_action_msgs_unless_the_generators_provide_it() -> None:
    files = cmake(
        "robot_msgs",
        "<buildtool_depend>rosidl_default_generators</buildtool_depend>",
        "find_package(rosidl_default_generators REQUIRED)\nrosidl_generate_interfaces(robot_msgs action/Go.action)",
        action__Go_dot_action="---\n---\n",
    )
    humble, jazzy = loaded(files, "humble"), loaded(files, "jazzy")
    assert [need.name for need, _ in undeclared(humble.packages[0], humble)] == ["action_msgs"]
    assert not undeclared(jazzy.packages[0], jazzy)


def test_an_exported_dependency_has_the_export_role_only() -> None:
    workspace = loaded(cmake("base", "", "find_package(nav_msgs REQUIRED)\nament_export_dependencies(nav_msgs rclcpp)"))
    assert [use.role for use in uses(workspace, "rclcpp")] == [Role.EXPORT]


def test_each_need_has_one_declaration() -> None:
    workspace = loaded(
        cmake(
            "talker",
            "<depend>sensor_msgs</depend><depend>rclcpp</depend>",
            "find_package(rclcpp REQUIRED)\nfind_package(sensor_msgs REQUIRED)\nfind_package(std_msgs REQUIRED)\n"
            "find_package(nav_msgs REQUIRED)\nfind_package(shape_msgs QUIET)\nif(shape_msgs_FOUND)\nendif()",
        )
    )
    result = {need.name: (need.declared, need.is_transitive) for need in needs(workspace.packages[0], workspace)}
    assert result["rclcpp"] == (("rclcpp",), True)
    assert result["std_msgs"] == ((), True)
    assert result["nav_msgs"] == ((), False)
    assert "shape_msgs" not in result
    assert [need.name for need, certain in undeclared(workspace.packages[0], workspace) if certain] == ["nav_msgs"]


def test_a_key_provides_the_keys_of_its_system_dependencies() -> None:
    workspace = loaded(cmake("talker", "<depend>libpcl-all-dev</depend>", "find_package(Eigen3 REQUIRED)"))
    assert "eigen" not in [need.name for need, _ in undeclared(workspace.packages[0], workspace)]
    assert [need.is_transitive for need in needs(workspace.packages[0], workspace) if need.name == "eigen"] == [True]


@pytest.mark.parametrize(("declared", "used"), [("ament_auto_cmake", "ament_cmake_auto"), ("nimbus-msgs", "nimbus_msgs")])
def test_a_need_explained_by_a_misspelt_declaration_is_uncertain(declared: str, used: str) -> None:
    lines = f"find_package({used} REQUIRED)\nadd_executable(talker talker.cpp)"
    code = {"talker_dot_cpp": f"#include <{used}/msg/state.hpp>\n"}
    workspace = loaded(cmake("talker", f"<depend>{declared}</depend>", lines, **code))
    assert (used, False) in [(need.name, certain) for need, certain in undeclared(workspace.packages[0], workspace)]
    assert used in intended_names(workspace.packages[0], workspace)


@pytest.mark.parametrize(("key", "library"), [("ffmpeg-dev", "FFMPEG"), ("python3-qt5-bindings", "Qt5")])
def test_any_key_that_installs_a_library_satisfies_the_need(key: str, library: str) -> None:
    workspace = loaded(cmake("talker", f"<depend>{key}</depend>", f"find_package({library} REQUIRED)"))
    assert {need.name for need, _ in undeclared(workspace.packages[0], workspace)}.isdisjoint({"ffmpeg", "qtbase5-dev"})


def test_an_unresolved_name_may_provide_only_plausible_packages() -> None:
    workspace = loaded(cmake("talker", "", "") | cmake("base", "", ""))
    assert not may_provide(("strange",), "base", workspace)  # other repositories do not depend on this workspace
    assert may_provide(("strange",), "rclcpp", workspace)
    assert may_provide(("strange_msgs",), "std_msgs", workspace)
    assert not may_provide(("strange_msgs",), "rclcpp", workspace)
    assert may_provide(("acme_cmake",), "ament_cmake_auto", workspace)
    assert not may_provide(("strange",), "ament_lint_auto", workspace)
    assert not may_provide(("Eigen3", "python3-strange", "ament_python", "roscpp", "sensor_msg"), "rclcpp", workspace)
    assert not may_provide(("rosidl_interface_packages",), "rosidl_default_generators", workspace)  # a group


def test_a_tag_covers_transitive_dependencies_of_its_role() -> None:
    workspace = loaded(cmake("talker", "<build_depend>nav_msgs</build_depend><exec_depend>std_msgs</exec_depend>", ""))
    package = workspace.packages[0]
    assert provided_transitively(package, workspace, ("geometry_msgs",), Role.BUILD)
    assert not provided_transitively(package, workspace, ("geometry_msgs",), Role.EXEC)
    assert not provided_transitively(package, workspace, ("nav_msgs",), Role.BUILD)  # only another package may provide it


def test_ros_environment_variables_are_uses_of_ros_environment() -> None:
    lines = 'set(distro $ENV{ROS_DISTRO})\nmessage(STATUS "for $ENV{ROS_VERSION}")'
    assert [(use.what, use.optional) for use in uses(loaded(cmake("talker", "", lines)), "ros_environment")] == [
        ("$ENV{ROS_DISTRO}", False)
    ]
    guarded = loaded(cmake("talker", "", f"if(DEFINED ENV{{ROS_DISTRO}})\n{lines}\nendif()"))
    assert all(use.optional for use in uses(guarded, "ros_environment"))
    packed = loaded(cmake("talker", "", 'set(CPACK_DEBIAN_PACKAGE_DEPENDS "ros-$ENV{ROS_DISTRO}-rclcpp")'))
    assert uses(packed, "ros_environment") == []


def test_a_submodule_is_not_a_top_level_module() -> None:
    files = {
        "talker/package.xml": HEAD.format(name="talker", depends="", kind="ament_python"),
        "talker/setup.py": "from setuptools import setup\nsetup(name='talker', version='1.0.0', packages=['talker'])\n",
        "talker/talker/__init__.py": "",
        "talker/talker/controller_manager.py": "import controller_manager\nimport yaml\n",
        "talker/talker/rclpy.py": "",
        "talker/talker/main.py": "import rclpy\nimport controller_manager\n",
    }
    result = {(use.package, use.span.path.rpartition("/")[2]) for use in loaded(files).packages[0].uses}
    assert ("controller_manager", "controller_manager.py") in result  # not itself
    assert not {("controller_manager", "main.py"), ("rclpy", "main.py")} & result  # main.py may be started where it is


def test_a_package_that_provides_the_best_provider_is_not_a_provider() -> None:
    lines = "find_package(cv_bridge REQUIRED)\nfind_package(OpenCV REQUIRED)"
    workspace = loaded(cmake("talker", "<depend>cv_bridge</depend>", lines))
    result = {need.name: (need.declared, need.is_transitive) for need in needs(workspace.packages[0], workspace)}
    assert result["cv_bridge"] == (("cv_bridge",), True)
    assert result["libopencv-dev"] == ((), True)


def test_uses_that_name_a_package_come_before_transitive_ones() -> None:
    headers = {"a_dot_cpp": "#include <opencv2/core.hpp>\n", "b_dot_cpp": "#include <cv_bridge/cv_bridge.h>\n"}
    workspace = loaded(cmake("talker", "", "add_library(talker a.cpp b.cpp)", **headers))
    result = {need.name: [use.package for use in need.uses] for need, _ in undeclared(workspace.packages[0], workspace)}
    assert result == {"ament_cmake": ["ament_cmake"], "cv_bridge": ["cv_bridge", "libopencv-dev"]}


def test_uses_by_include_folder_keep_the_order_of_the_file() -> None:
    source = '#include "boost/program_options.hpp"\n#include "boost/tokenizer.hpp"\n'
    workspace = loaded(cmake("talker", "", "add_library(talker a.cpp)", a_dot_cpp=source))
    result = {need.name: [use.span.line for use in need.uses] for need, _ in undeclared(workspace.packages[0], workspace)}
    assert result["boost"] == [1, 2]


def test_each_use_of_a_need_has_its_own_declaration() -> None:
    lines = "if(BUILD_TESTING)\nfind_package(ament_cmake_gtest REQUIRED)\nament_add_gtest(t test/t.cpp)\nendif()"
    depends = "<depend>cv_bridge</depend><test_depend>gtest</test_depend>"
    workspace = loaded(cmake("talker", depends, lines, test__t_dot_cpp="#include <gtest/gtest.h>\n"))
    result = [need for need in needs(workspace.packages[0], workspace) if need.name == "ament_cmake_gtest"]
    assert [(need.declared, sorted({use.via for use in need.uses})) for need in result] == [
        ((), ["cmake", "macro"]),
        (("gtest",), ["include"]),
    ]


def test_a_vendored_key_satisfies_macros_of_the_vendor_package() -> None:
    lines = "find_package(pybind11 REQUIRED)\npybind11_add_module(talker src/talker.cpp)"
    workspace = loaded(cmake("talker", "<depend>pybind11-dev</depend>", lines))
    assert "pybind11_vendor" not in [need.name for need in needs(workspace.packages[0], workspace)]


def test_rarely_provided_packages_are_not_provided_by_unresolved_names() -> None:
    workspace = loaded(cmake("talker", "", "") | cmake("base", "<depend>octomap_server</depend>", ""))
    assert not may_provide(("acme_arm",), "depthimage_to_laserscan", workspace)
    assert may_provide(("acme_laserscan",), "depthimage_to_laserscan", workspace)  # a package of the same family
    assert may_provide(("depthimage2",), "depthimage_to_laserscan", workspace)  # another generation of the family
    assert may_provide(("acme_depthimages",), "depthimage_to_laserscan", workspace)  # the family by a longer word
    assert may_provide(("acme_arm",), "octomap_server", workspace)  # another package of the workspace provides it
    assert may_provide(("acme_arm",), "rviz_common", workspace)  # many packages provide it
    assert may_provide(("acme_arm",), "protobuf", workspace)  # many packages provide libraries
    assert not may_provide(("acme_arm",), "python3-websockets", workspace)


def test_packages_of_other_distributions_are_known() -> None:
    workspace = loaded(cmake("talker", "", ""), "lyrical")
    assert workspace.world.resolution("gazebo_ros") == "elsewhere"
    assert may_provide(("gazebo_ros",), "rclpy", workspace)
    assert not may_provide(("gazebo_ros",), "rviz_common", workspace)
    assert may_provide(("gazebo_ros",), "gazebo", workspace)
    assert may_provide(("mocap4r2_msgs",), "rclcpp", workspace)  # although it is a package of messages
    assert may_provide(("reach",), "ros_industrial_cmake_boilerplate", workspace)  # although it is not a build tool


def test_needs_of_modules_with_launch_actions_are_uncertain() -> None:
    files = {
        "talker/package.xml": HEAD.format(name="talker", depends="", kind="ament_python"),
        "talker/setup.py": "from setuptools import setup\nsetup(name='talker', version='1.0.0', packages=['talker'])\n",
        "talker/talker/__init__.py": "",
        "talker/talker/nodes.py": "from launch_ros.actions import Node\nRVIZ = Node(package='rviz2', executable='rviz2')\n",
    }
    workspace = loaded(files)
    assert [certain for need, certain in undeclared(workspace.packages[0], workspace) if need.name == "rviz2"] == [False]


def test_the_best_declared_provider_counts_as_used() -> None:
    workspace = loaded(cmake("talker", "", "find_package(PCL REQUIRED)"))
    (use,) = uses(workspace, "libpcl-all-dev")
    assert used_names(("pcl_ros", "pcl_conversions"), [use]) == {"pcl_conversions"}
    assert used_names(("pcl_ros", "libpcl-all-dev"), [use]) == {"libpcl-all-dev"}


def test_a_folder_with_launch_files_is_not_a_module() -> None:
    launch = "from launch import LaunchDescription\ndef generate_launch_description():\n    return LaunchDescription([])\n"
    lines = "install(DIRECTORY launch DESTINATION share/${PROJECT_NAME})"
    files = cmake("talker", "", lines, launch__a_dot_launch_dot_py=launch)
    assert uses(loaded(files), "launch")
    assert not uses(loaded({**files, "talker/launch/__init__.py": ""}), "launch")


def test_templates_recipes_documentation_and_copies_have_no_uses() -> None:
    files = {
        **cmake("talker", "", "find_package(acme_cmake REQUIRED)\nacme_package()"),
        "talker/conanfile.py": "import yaml\n",
        "talker/docs/source/conf.py": "import yaml\n",
        "talker/docs/source/youtube.py": "import yaml\n",
        "talker/pages/conf.py": "import yaml\n",
        "talker/pages/index.rst": "Talker\n",
        "talker/templates/node.jinja.cpp": "#include <rclcpp/rclcpp.hpp>\n",
        "talker/resource/setup.py.em": "import yaml\n",
        "talker/scripts/.ipynb_checkpoints/main-checkpoint.py": "import yaml\n",
        "talker/launch/.ipynb_checkpoints/all-checkpoint.launch.xml": '<launch><node pkg="joy" exec="joy_node"/></launch>',
        "talker/launch/all.launch.xml": '<launch><node pkg="joy" exec="joy_node"/></launch>',
        "talker/talker/__init__.py": "",
        "talker/talker/conf.py": "import yaml\n",
        "talker/talker/main.py": "import yaml\n",
    }
    result = {use.span.path for use in loaded(files).packages[0].uses if use.via in ("import", "include", "launch")}
    assert result == {"talker/launch/all.launch.xml", "talker/talker/conf.py", "talker/talker/main.py"}


def _python(**files: str) -> Workspace:
    lines = "install(PROGRAMS scripts/a.py scripts/b.py DESTINATION lib/${PROJECT_NAME})"
    return loaded(cmake("talker", "", lines, **files))


def test_a_module_that_is_optional_in_one_file_is_optional_in_all() -> None:
    guarded = "try:\n    import serial.tools\nexcept ImportError:\n    pass\n"
    plain = "import serial\nimport serial.tools.list_ports\n"
    result = uses(_python(scripts__a_dot_py=guarded, scripts__b_dot_py=plain), "python3-serial")
    assert [(use.span.path, use.optional) for use in result] == [
        ("talker/scripts/a.py", True),
        ("talker/scripts/b.py", False),
        ("talker/scripts/b.py", True),
    ]
    in_test = uses(_python(test__test_a_dot_py=guarded, scripts__b_dot_py=plain), "python3-serial")
    assert [use.optional for use in in_test if "scripts" in use.span.path] == [False, False]


def test_a_vendored_copy_does_not_replace_the_library_for_others() -> None:
    lines = "add_library(r r.cpp)\nadd_library(s s.cpp)"
    base_files = {
        "include__nlohmann__json_dot_hpp": "",
        "include__shapes__box_dot_hpp": "",
        "r_dot_cpp": "#include <nlohmann/json.hpp>\n",
    }
    code = "#include <nlohmann/json.hpp>\n#include <shapes/box.hpp>\n"
    workspace = loaded({**cmake("base", "", lines, **base_files), **cmake("talker", "", lines, r_dot_cpp=code)})
    base, talker = workspace.packages
    assert [use.package for use in base.uses if use.via == "include"] == []
    assert [use.providers for use in talker.uses if use.via == "include"] == [("nlohmann-json-dev", "base"), ("base",)]


def test_uses_that_missing_folders_may_provide_are_uncertain() -> None:
    code = "import sys\nsys.path.append('/opt/serial')\nimport serial\nimport std_msgs\n"
    workspace = _python(scripts__a_dot_py=code, scripts__b_dot_py="import serial\n")
    assert [use.optional for use in uses(workspace, "python3-serial")] == [True, False]
    files = cmake("talker", "", "install(PROGRAMS a.py DESTINATION lib/${PROJECT_NAME})", a_dot_py="import serial\nimport cv2\n")
    workspace = loaded({**files, ".gitmodules": '[submodule "x"]\n\tpath = talker/deps/serial\n'})
    assert [use.certain for use in uses(workspace, "python3-serial")] == [False]
    assert [use.certain for use in uses(workspace, "python3-opencv")] == [True]
    lines = "add_library(r r.cpp)\ntarget_link_libraries(r nlohmann_json::nlohmann_json)"
    files = cmake("talker", "", lines, r_dot_cpp="#include <nlohmann/json.hpp>\n#include <yaml-cpp/yaml.h>\n")
    workspace = loaded({**files, ".gitmodules": '[submodule "x"]\n\tpath = talker/deps/json\n'})
    assert [use.certain for use in uses(workspace, "nlohmann-json-dev")] == [False, False]
    assert [use.certain for use in uses(workspace, "yaml-cpp")] == [True]
    files = cmake("talker", "", "add_library(r r.cpp)", r_dot_cpp="#include <gtest/gtest_prod.h>\n")
    workspace = loaded({**files, ".gitmodules": '[submodule "x"]\n\tpath = talker/deps/googletest\n'})
    assert [use.certain for use in uses(workspace, "ament_cmake_gtest")] == [False]
    assert [use.certain for use in uses(loaded(files), "ament_cmake_gtest")] == [True]


def test_installed_programs_named_like_tests_are_not_tests() -> None:
    launch = "import launch_ros\ndef generate_launch_description():\n    return []\n"
    files = {
        "launch__test_all_dot_launch_dot_py": launch,
        "test__test_some_dot_launch_dot_py": launch,
        "launch__test_not_dot_launch_dot_py": launch,
        "scripts__test_motor_dot_py": "import serial\n",
    }
    lines = (
        "install(FILES launch/test_all.launch.py DESTINATION share/${PROJECT_NAME}/launch)\n"
        "install(FILES test/test_some.launch.py DESTINATION share/${PROJECT_NAME}/test)\n"
        "install(PROGRAMS scripts/test_motor.py DESTINATION lib/${PROJECT_NAME})"
    )
    workspace = loaded(cmake("talker", "", lines, **files))
    roles = {use.span.path[7:]: use.role for use in workspace.packages[0].uses}
    assert roles == {
        "launch/test_all.launch.py": Role.EXEC,
        "launch/test_not.launch.py": Role.TEST,
        "scripts/test_motor.py": Role.EXEC,
        "test/test_some.launch.py": Role.TEST,
        "CMakeLists.txt": Role.TOOL,
    }


def test_folders_of_data_are_not_importable_modules() -> None:
    example = {
        "example/package.xml": HEAD.format(name="example", depends="", kind="ament_python"),
        "example/setup.py": "from setuptools import find_namespace_packages, setup\nsetup(packages=find_namespace_packages())\n",
        "example/launch/a.launch.py": "import launch\n",
        "example/models/a.sdf": "",
        "example/arms/left.py": "",
        "example/yaml/__init__.py": "",
    }
    names = {name: loaded(example).world.by_import(name).names for name in ("launch", "models", "arms", "yaml")}
    assert names == {"launch": ("launch",), "models": (), "arms": ("example",), "yaml": ("example",)}
    workspace = loaded({**example, "example/rclpy/__init__.py": ""})
    assert workspace.world.by_import("rclpy").names == ("rclpy", "example")
