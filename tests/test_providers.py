"""The providers of headers, modules and CMake packages, and the meaning of misspelled names."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Final

import pytest

from ros_lint.base.text import Span
from ros_lint.facts.build import NOTHING_BUILT, BuildScript, InstalledFile
from ros_lint.facts.sources import Mention
from ros_lint.knowledge import Knowledge
from ros_lint.knowledge.providers import Suggestion, importable_modules
from ros_lint.knowledge.world import Member
from tests.worlds import member, world, write_prefix

JAZZY = Knowledge("jazzy")


@pytest.fixture
def prefix(tmp_path: Path) -> str:
    return write_prefix(tmp_path)


@pytest.mark.parametrize("distro", ["humble", "jazzy", "kilted", "lyrical"])
def test_an_interface_package_of_any_distribution_may_provide_its_module(distro: str) -> None:
    # The messages of turtlesim have moved to turtlesim_msgs; tutorials and students import them from turtlesim as ever.
    assert world(distro=distro).by_import("turtlesim.msg").names == ("turtlesim",)


@pytest.mark.parametrize(
    ("header", "package"),
    [
        ("mrpt/core/Clock.h", "mrpt_libbase"),
        ("mrpt/obs/CObservation.h", "mrpt_libobs"),
        ("mrpt/ros2bridge/pose.h", "mrpt_libros_bridge"),
    ],
)
def test_libraries_of_mrpt_are_in_several_packages(header: str, package: str) -> None:
    result = world().by_include(header)
    assert (result.names[0], result.sure) == (package, True)


def test_contents_of_packages_are_looked_up(prefix: str) -> None:
    result = world(member("mine"), prefixes=(prefix,))
    assert result.executables("demo_nodes_cpp").ask("talker") == "exists"
    assert result.executables("demo_nodes_cpp").ask("tolker") == "missing"
    assert result.executables("private_tool").ask("tool") == "exists"
    assert result.executables("private_tool").ask("tol") == "missing"
    assert result.executables("mine").ask("anything") == "unknowable"
    assert result.executables("nonsense_pkg").ask("anything") == "unknowable"
    assert result.components("composition").ask("composition::Talker") == "exists"
    assert result.launch_files("turtlebot3_bringup").ask("launch/robot.launch.py") == "exists"
    assert result.python_modules("std_msgs").ask("std_msgs") == "exists"
    assert result.python_modules("tf2_ros").ask("tf2_ros") == "missing"
    assert result.plugins("ackermann_steering_controller").names
    assert result.programs("ament_clang_format").ask("ament_clang_format") == "exists"


@pytest.mark.parametrize(
    ("name", "first", "packages", "keys"),
    [
        ("rclcpp", "rclcpp", {"rclcpp"}, set()),
        ("Eigen3", "eigen", {"eigen3_cmake_module"}, {"eigen"}),
        ("osqp", "osqp_vendor", {"osqp_vendor"}, set()),
        ("octomap", "octomap", {"octomap"}, {"liboctomap-dev"}),
        ("ament_cmake_internal", "ament_cmake_core", {"ament_cmake_core"}, set()),
        ("gz-sim8", "gz_sim_vendor", {"gz_sim_vendor"}, set()),
    ],
)
def test_cmake_packages_are_resolved(name: str, first: str, packages: set[str], keys: set[str]) -> None:
    result = world().by_cmake(name)
    assert (result.names[0], {*result.packages}, {*result.keys}) == (first, packages, keys)
    assert result.known
    assert not result.none_needed


def test_cmake_modules_need_no_package_and_unknown_names_have_no_provider() -> None:
    result = world(member("fmt"))
    assert result.by_cmake("Threads").none_needed
    assert result.by_cmake("Threads").known
    assert not result.by_cmake("SomebodysLibrary").known
    assert result.by_cmake("fmt").names == ("fmt",)  # the workspace has a package of that name
    assert not result.by_cmake("roscpp").known


@pytest.mark.parametrize(
    ("header", "names"),
    [
        ("rclcpp/rclcpp.hpp", ("rclcpp",)),
        ("std_msgs/msg/string.hpp", ("std_msgs",)),
        ("Eigen/Dense", ("eigen",)),
        ("octomap/OcTree.h", ("octomap", "liboctomap-dev")),
        ("moveit/benchmarks/server.h", ("moveit_ros_benchmarks",)),
        ("moveit/move_group_interface/move_group_interface.hpp", ("moveit_ros_planning_interface",)),
        ("moveit/planning_scene_monitor/planning_scene_monitor.h", ("moveit_ros_planning",)),
        ("moveit/nobody/x.hpp", ()),
        ("mine/mine.hpp", ("mine",)),
        ("autoware/mine_too/x.hpp", ("autoware_mine_too",)),
        ("autoware/nobody/x.hpp", ()),
        ("mine.hpp", ()),
        ("ros/ros.h", ()),
    ],
)
def test_headers_are_resolved(header: str, names: tuple[str, ...]) -> None:
    result = world(member("mine"), member("autoware_mine_too"), member("moveit")).by_include(header)
    assert result.names == names
    assert result.known == bool(names)


def test_a_package_of_the_workspace_with_the_name_of_a_shared_folder_is_the_only_provider() -> None:
    assert world(member("moveit_benchmarks")).by_include("moveit/benchmarks/server.h").names == ("moveit_benchmarks",)


@pytest.mark.parametrize(
    ("header", "provider", "sure"),
    [
        ("Eigen/Dense", "eigen", True),
        ("opencv/cv.h", "libopencv-dev", False),
        ("tl/expected.hpp", "tl_expected", False),
        ("tl_expected/expected.hpp", "tl_expected", True),
    ],
)
def test_a_header_that_packages_rarely_declare_is_sure_only_if_its_folder_is_the_package(
    header: str, provider: str, sure: bool
) -> None:
    result = world().by_include(header)
    assert (result.names[0], result.sure) == (provider, sure)


def test_headers_of_the_tool_chain_need_no_package() -> None:
    assert all(world().by_include(header).none_needed for header in ("vector", "sys/stat.h", "cstdint", "unistd.h"))


def test_headers_of_an_underlay_are_resolved(prefix: str) -> None:
    result = world(prefixes=(prefix,))
    assert result.by_include("private_base/private_base.hpp").names == ("private_base",)
    (Path(prefix) / "include/private_base/odd_root").mkdir()
    (Path(prefix) / "include/private_base/odd_root/odd.hpp").touch()
    assert world(prefixes=(prefix,)).by_include("odd_root/odd.hpp").names == ("private_base",)
    assert not world(prefixes=(prefix,)).by_include("odd_root/other.hpp").known


def test_the_configuration_files_of_an_underlay_count_before_the_maps_of_names(prefix: str) -> None:
    folder = Path(prefix) / "share/private_base/cmake"
    folder.mkdir()
    for name in ("Threads", "osqp", "rclcpp"):
        (folder / f"{name}Config.cmake").touch()
    result = world(prefixes=(prefix,))
    assert result.by_cmake("Threads").names == ("private_base",)
    assert (result.by_cmake("osqp").names, result.by_cmake("osqp").sure) == (("private_base", "osqp_vendor"), True)
    assert world(member("private_base"), prefixes=(prefix,)).by_cmake("Threads").none_needed
    assert world(member("rclcpp"), prefixes=(prefix,)).by_cmake("rclcpp").names == ("rclcpp",)


@pytest.mark.parametrize(
    ("module", "names"),
    [
        ("rclpy.node", ("rclpy",)),
        ("std_msgs.msg", ("std_msgs",)),
        ("tf2_ros", ("tf2_ros_py",)),
        ("yaml", ("python3-yaml",)),
        ("numpy.linalg", ("python3-numpy",)),
        ("rclcpp", ()),
        ("my_parts", ("mine",)),
        ("other_name", ("other",)),
        ("other", ()),
        ("somebodys_library", ()),
        ("rospy", ()),
    ],
)
def test_python_modules_are_resolved(module: str, names: tuple[str, ...]) -> None:
    result = world(Member("mine", "1.0.0", {}, (), ("my_parts",)), Member("other", "1.0.0", {}, (), ("other_name",))).by_import(
        module
    )
    assert result.names == names
    assert result.known == bool(names)


def test_modules_of_the_standard_library_need_no_package() -> None:
    assert all(world().by_import(module).none_needed for module in ("os.path", "tomllib", "typing"))


@pytest.mark.parametrize(
    ("wrong", "right"),
    [
        # What maintainers wrote instead, in commits that mended these names.
        ("Eigen3", "eigen"),
        ("ALSA", "libasound2-dev"),
        ("opencv-python", "python3-opencv"),
        ("GeographicLib", "geographiclib"),
        ("PkgConfig", "pkg-config"),
        ("opencv2", "libopencv-dev"),
        ("libavcodec", "ffmpeg"),
        ("gz-sim8", "gz_sim_vendor"),
        ("nlohmann-json3-dev", "nlohmann-json-dev"),
        ("uuid-dev", "uuid"),
        ("urdfdom-headers", "urdfdom_headers"),
        ("buildin_interfaces", "builtin_interfaces"),
        ("laser_filter", "laser_filters"),
        ("nav2_utils", "nav2_util"),
        ("turtlebot3_fakenode", "turtlebot3_fake_node"),
        ("python-urdf2webots", "urdf2webots-pip"),
        ("mine_msg", "mine_msgs"),
        ("ros-humble-tf2-ros", "tf2_ros"),
        # No doubt is allowed.
        ("nonsense_pkg", ""),
        ("python3-pcl", ""),
        ("unitree", ""),
        ("rmf_msgs", ""),
        ("ament_python", ""),
        ("ros-humble-nonsense-pkg", ""),
    ],
)
def test_a_misspelled_name_is_corrected(wrong: str, right: str) -> None:
    result = world(member("mine_msgs")).meant(wrong)
    assert (result.name if result else "") == right


@pytest.mark.parametrize(
    ("wrong", "right"),
    [("numpy", "python3-numpy"), ("cv2", "python3-opencv"), ("pycollada", "python3-collada-pip"), ("cv-bridge", "cv_bridge")],
)
def test_a_misspelled_name_is_corrected_for_python(wrong: str, right: str) -> None:
    result = world().meant(wrong, python=True)
    assert result is not None
    assert result.name == right


def test_only_names_that_resolve_are_suggested() -> None:
    """The key that apt's name stands for has no rule for every distribution."""
    for distro in ("humble", "jazzy", "lyrical"):
        result = world(distro=distro)
        for wrong in ("python-numpy", "python-yaml", "gazebo9", "ament_cmake_lint_copyright", "libqt5core5a"):
            for name in result.suggest(wrong):
                assert result.is_package(name) or result.knowledge.resolves(name)
    assert world().suggest("ament_cmake_lint_copyright") == ("ament_cmake_copyright",)


# --- modules of a package ------------------------------------------------------------------------------------------


def script(packages: Sequence[str] = (), installs: Sequence[str] = (), found: Sequence[str] = ()) -> BuildScript:
    """Return the build script of a package, given its Python packages, the files it installs and what it finds with CMake."""
    place = Span("robot/CMakeLists.txt", 1, 1, 1, 2)
    products = NOTHING_BUILT.products._replace(
        python_packages=tuple(packages), installs=tuple(InstalledFile(path, path, False, False, place) for path in installs)
    )
    mentions = tuple(Mention(name, "cmake", place) for name in found)
    return NOTHING_BUILT._replace(products=products, mentions=mentions)


SITE = "lib/python3.12/site-packages"


@pytest.mark.parametrize(
    ("packages", "installs", "files", "modules"),
    [
        (["robot", "robot.parts"], [], ["robot/__init__.py", "robot/parts/__init__.py"], ("robot",)),
        (["robot"], [], [], ("robot",)),
        (["robot"], [], ["setup.py", "robots/a.txt"], ("robot",)),
        # a folder without Python files
        (["robot", "frames"], [], ["robot/a.py", "frames/a.yaml"], ("robot",)),
        (["robot", "frames"], [], ["robot/a.py", "frames/a.yaml", "frames/b.py", "frames/c.yaml"], ("robot", "frames")),
        # a folder with a usual name for data
        (["robot", "launch"], [], ["robot/a.py", "launch/a.launch.py"], ("robot",)),
        (["robot", "launch"], [], ["robot/a.py", "launch/__init__.py"], ("robot", "launch")),
        (["robot", "launch"], [], ["robot/a.py", "launch/sub/__init__.py"], ("robot",)),
        # the folder src
        (["robot", "frames"], [], ["src/robot/a.py", "src/frames/a.yaml"], ("robot",)),
        # files that CMake installs
        ([], [f"{SITE}/robot/a.py", f"{SITE}/robot/b.py", f"{SITE}/single.py"], ["a.py"], ("robot", "single")),
        ([], [f"{SITE}/robot/a.so", f"{SITE}/__init__.py", "lib/robot/a.py"], ["a.py"], None),
        (["robot"], [f"{SITE}/extra/a.py"], ["robot/a.py"], ("robot", "extra")),
    ],
)
def test_the_modules_of_a_package_are_those_that_it_installs(
    packages: list[str], installs: list[str], files: list[str], modules: tuple[str, ...] | None
) -> None:
    assert importable_modules(script(packages, installs), files) == modules


USUAL_DATA: Final = (
    "launch config configs cfg params param resource resources urdf meshes models worlds world maps map rviz scenarios "
    "test tests doc docs examples images scripts include msg srv action build install log"
)


@pytest.mark.parametrize("folder", USUAL_DATA.split())
def test_a_folder_with_a_usual_name_for_data_is_no_module(folder: str) -> None:
    built = script(["robot", folder])
    assert importable_modules(built, ["robot/a.py", f"{folder}/a.py"]) == ("robot",)
    assert importable_modules(built, ["robot/a.py", f"{folder}/__init__.py"]) == ("robot", folder)


@pytest.mark.parametrize(
    ("files", "found", "is_certain"),
    [
        (["CMakeLists.txt", "src/a.cpp"], ["rclcpp"], True),
        (["launch/a.launch.py", "test/a.py", "test_a.py"], [], True),
        (["scripts/a.py"], [], False),
        (["msg/A.msg"], [], False),
        (["src/a.pyx"], [], False),
        (["src/a.cpp"], ["pybind11_vendor"], False),
        (["src/a.cpp"], ["rclcpp", "Python3"], False),
    ],
)
def test_a_package_without_modules_is_certain_if_nothing_can_become_one(
    files: list[str], found: list[str], is_certain: bool
) -> None:
    assert importable_modules(script(found=found), files) == (() if is_certain else None)


@pytest.mark.parametrize(
    ("modules", "module", "names"),
    [
        (("std_msgs",), "std_msgs", ("std_msgs", "mine")),  # the released package certainly has the module
        (("rclcpp",), "rclcpp", ("mine",)),  # the released package certainly lacks it
        (("frames",), "frames.a", ("mine",)),
        (("mine", "parts"), "mine", ("mine",)),
        (("other", "parts"), "other", ("mine",)),
    ],
)
def test_a_module_of_the_workspace_may_also_be_that_of_a_released_package(
    modules: tuple[str, ...], module: str, names: tuple[str, ...]
) -> None:
    members = [Member("mine", "1.0.0", {}, (), modules)]
    members += [Member("other", "1.0.0", {}, (), ())] if "other" in modules else []
    assert world(*members).by_import(module).names == names


# --- similar names -------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("wrong", "python", "expected"),
    [
        ("std_msgs/msg/String", False, Suggestion("std_msgs", "spelling")),
        ("rclpy.qos", False, Suggestion("rclpy", "spelling")),
        ("ros-humble-tf2-ros", False, Suggestion("tf2_ros", "system")),
        ("Eigen3", False, Suggestion("eigen", "cmake")),
        ("urdfdom-headers", False, Suggestion("urdfdom_headers", "spelling")),
        ("Std_Msgs", False, Suggestion("std_msgs", "spelling")),
        ("python-yaml", False, Suggestion("python3-yaml", "spelling")),
        ("numpy", True, Suggestion("python3-numpy", "spelling")),
        ("cv2", True, Suggestion("python3-opencv", "python")),
        ("nlohmann-json3-dev", False, Suggestion("nlohmann-json-dev", "system")),
        ("nav2_utils", False, Suggestion("nav2_util", "slip")),
        ("python3-numpyy", True, Suggestion("python3-numpy", "slip")),
        ("pyserial", True, Suggestion("python3-serial", "spelling")),
        ("ultralytics-pip", False, Suggestion("python3-ultralytics-pip", "spelling")),
        ("python-serial", False, Suggestion("python3-serial", "spelling")),
        ("serial-python", False, Suggestion("python3-serial", "spelling")),
        ("numpy-pip", False, Suggestion("python3-numpy", "spelling")),
    ],
)
def test_a_correction_names_the_kind_of_the_mistake(wrong: str, python: bool, expected: Suggestion) -> None:
    assert world().meant(wrong, python=python) == expected


def test_an_ambiguous_name_is_not_corrected() -> None:
    both = (member("arm_a_msgs"), member("arm-a-msgs"))
    assert world(both[0]).meant("Arm_A_Msgs") == Suggestion("arm_a_msgs", "spelling")
    assert world(*both).meant("Arm_A_Msgs") is None
    assert world(member("fleet_lidars")).meant("fleet_lidas") == Suggestion("fleet_lidars", "slip")
    assert world(member("fleet_lidars"), member("fleet_lidass")).meant("fleet_lidas") is None


def test_similar_names_begin_with_the_intended_one() -> None:
    assert world().suggest("nav2_utils")[0] == "nav2_util"
    assert len(world().suggest("nav2_uti")) <= 3
    assert len(set(world().suggest("rviz_comon"))) == len(world().suggest("rviz_comon"))
