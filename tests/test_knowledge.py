"""The data about released packages: every shipped line, and the look-ups."""

from __future__ import annotations

import subprocess
import sys
from itertools import combinations
from pathlib import Path

import pytest

from ros_lint.collectors.launch.presence_checks import DISTRIBUTIONS
from ros_lint.knowledge import Knowledge, distros, index, newest_lts, provides, rosdep
from ros_lint.knowledge.builtin import PYTHON_MODULES
from ros_lint.knowledge.names import NOTHING_NEEDED, Names
from ros_lint.knowledge.provides import Known
from ros_lint.knowledge.rosdep import PLATFORMS
from ros_lint.knowledge.store import Store

DISTROS = [distro.name for distro in distros()]


def test_distributions_are_those_with_an_index() -> None:
    assert DISTROS == ["humble", "jazzy", "kilted", "lyrical", "rolling"]
    assert [distro.name for distro in distros() if distro.long_term] == ["humble", "jazzy", "lyrical"]
    assert newest_lts() == "lyrical"
    assert {*DISTROS} <= PLATFORMS.keys()
    assert {platform for name in DISTROS for platform in PLATFORMS[name]} <= {*rosdep.LETTERS.values()}


def test_a_later_distribution_is_classified_by_its_first_letter(tmp_path: Path) -> None:
    for name in ("marvin", "nimbus", "local"):
        (tmp_path / f"{name}.idx").write_text(index.render_file(name, "", "2028-06-01", []))
    known = {distro.name: distro.long_term for distro in distros([str(tmp_path)])}
    assert (known["marvin"], known["nimbus"], known["local"]) == (False, True, False)
    assert newest_lts([str(tmp_path)]) == "nimbus"


@pytest.mark.parametrize("distro", DISTROS)
def test_every_line_of_an_index_survives_parsing_and_rendering(distro: str) -> None:
    head, lines = Store().lines(f"{distro}.idx")
    packages = [index.parse(line.split("\t")) for line in lines]
    assert [index.render(package) for package in packages] == lines
    date, commit = Knowledge(distro).index.date, Knowledge(distro).index.commit
    assert index.render_file(distro, commit, date, packages) == "\n".join([head, *lines, ""])


@pytest.mark.parametrize("distro", DISTROS)
def test_exactly_the_packages_of_the_index_are_found(distro: str) -> None:
    known = Knowledge(distro).index
    names = list(known.names())
    assert len(names) == len(known) == len({*names})
    for name in names:
        package = known.get(name)
        assert package is not None
        assert package.name == name
        assert name in known
        runtime = known.runtime(name)
        if package.described:
            assert runtime is not None
            assert {*runtime} == {*package.on("eux")}
        else:
            assert runtime is None
    for name in names[::7]:
        for wrong in (name[:-1], f"{name}x", name.upper(), ""):
            assert (wrong in known) == (wrong in names)
            assert (known.get(wrong) is not None) == (wrong in names)


@pytest.mark.parametrize("distro", DISTROS)
def test_every_line_of_package_contents_survives_parsing_and_rendering(distro: str) -> None:
    head, lines = Store().lines(f"{distro}.prov")
    result = [provides.parse(line.split("\t")) for line in lines]
    assert [provides.render(entry) for entry in result] == lines
    assert provides.render_file(distro, result) == "\n".join([head, *lines, ""])
    assert {entry.name for entry in result} <= {*Knowledge(distro).index.names()}


def test_every_rosdep_key_survives_parsing_and_rendering() -> None:
    head, lines = Store().lines("rosdep.tsv")
    keys = {line.split("\t")[0]: rosdep.parse(line.split("\t")) for line in lines}
    assert rosdep.render_file(keys) == "\n".join([head, *lines, ""])


def test_the_maps_name_only_existing_packages_and_keys() -> None:
    """A map may serve one distribution only, but a name that no distribution and no rosdep file has is a misprint."""
    known = {name for distro in DISTROS for name in Knowledge(distro).index.names()}
    known.update(Knowledge("jazzy").rosdep.names())
    store = Store()
    for file in ("cmake_ros.tsv", "cmake_system.tsv", "include_ros.tsv", "include_system.tsv", "successors.tsv"):
        for line in store.lines(file)[1]:
            names = {*(line + "\t").split("\t")[1].split()} - {NOTHING_NEEDED}
            assert names <= known, f"{file}: {line}"


def test_the_best_key_of_a_module_comes_first() -> None:
    """What the system packages goes before what pip brings, and the keys of Python 2 go last: rosdep drops them."""
    for line in Store().lines("py_import.tsv")[1]:
        entries = [entry.partition(":")[::2] for entry in line.split("\t")[1].split()]
        for (first, evidence), (second, better) in combinations(entries, 2):
            assert first.replace("python-", "python3-") != second, line
            by_pip = first.endswith("-pip") and evidence == "P"
            assert not (by_pip and "A" in better and not second.endswith("-pip")), line


def test_end_of_life_names_are_in_no_active_distribution() -> None:
    active = {name for distro in DISTROS for name in Knowledge(distro).index.names()}
    names = Names(Store())
    retired = [line.split("\t")[0] for line in Store().lines("eol_names.tsv")[1]]
    assert not active & {*retired}
    assert all(names.end_of_life(name) for name in retired)
    assert names.end_of_life("roscpp") == ("ROS 1 Noetic", "ROS 1 Melodic", "ROS 1 Kinetic")
    assert names.end_of_life("rclcpp") == ()


def test_an_entry_of_the_index_has_version_flags_and_dependencies() -> None:
    known = Knowledge("jazzy")
    package = known.index.get("std_msgs")
    assert package is not None
    assert (package.build_type, package.interfaces, package.repository) == ("ament_cmake", True, "common_interfaces")
    assert package.on("x") == ("builtin_interfaces", "rosidl_default_runtime")
    assert package.groups == ("rosidl_interface_packages",)
    assert "std_msgs" in set(known.index.members("rosidl_interface_packages"))
    assert "rmw_fastrtps_cpp" in set(known.index.members("rmw_implementation_packages"))
    assert known.date == "2026-08-22"
    assert known.elsewhere("gazebo_ros") == ("humble",)


def test_a_name_exists_is_missing_or_unknowable() -> None:
    known = Known(("talker",), ("listener",), complete=True)
    assert [known.ask(name) for name in ("talker", "listener", "speaker")] == ["exists", "unknowable", "missing"]
    assert Known(("talker",)).ask("speaker") == "unknowable"
    endings = Known(("a.launch.py",), complete=True, endings=("launch.py",))
    assert [endings.ask(name) for name in ("a.launch.py", "b.launch.py", "b.py")] == ["exists", "missing", "unknowable"]


@pytest.mark.parametrize(("origin", "answer"), [("=", "missing"), ("b", "missing"), ("~", "unknowable")])
def test_a_name_is_missing_only_in_a_complete_list(origin: str, answer: str) -> None:
    result = provides.parse(["demo", origin, "X:talker listener?", "Y"])
    assert result.known("executables").ask("speaker") == answer
    assert result.known("executables").ask("listener") == "unknowable"
    assert result.known("modules").ask("demo") == "exists"
    assert Knowledge("jazzy").provided("no_such_package", "executables").ask("x") == "unknowable"


def test_lists_of_earlier_and_later_distributions_complete_one_between(tmp_path: Path) -> None:
    lines = {
        "humble": ["both\t=\tX:talker old?", "later\t~\tX:talker", "silent\tb\tX:talker"],
        "jazzy": ["both\t~\tX:talker", "later\t~\tX:talker"],
        "kilted": ["both\t~\tX:talker newer", "later\tb\tX:talker", "silent\t=\tX:talker"],
        "lyrical": ["both\tb\tX:talker"],
    }
    for distro, own in lines.items():
        rows = [f"{name}\t1.0.0\tc\t" for name in ("both", "later", "silent")]
        index = [f"#ros-index 1 distro={distro} date=2026-01-01 packages=3", *rows, ""]
        (tmp_path / f"{distro}.idx").write_text("\n".join(index))
        (tmp_path / f"{distro}.prov").write_text("\n".join([f"#ros-provides 1 distro={distro} packages={len(own)}", *own, ""]))
    jazzy = Knowledge("jazzy", [str(tmp_path)])

    def asked(package: str, *names: str) -> list[str]:
        return [jazzy.provided(package, "executables").ask(name) for name in names]

    assert asked("both", "talker", "old", "newer", "speaker") == ["exists", "unknowable", "unknowable", "missing"]
    assert asked("later", "talker", "speaker") == ["exists", "unknowable"]
    assert asked("silent", "talker", "speaker") == ["unknowable", "missing"]
    assert not jazzy.may_exist_elsewhere("both", "executables", "speaker")
    assert jazzy.may_exist_elsewhere("later", "executables", "speaker")


def test_a_distribution_without_an_index_is_not_covered() -> None:
    for name in ("iron", "../data/jazzy", ""):
        known = Knowledge(name)
        assert (known.covered, known.date, list(known.index.names())) == (False, "", [])
        assert known.resolves("eigen") is (True if name == "iron" else None)


def test_rosdep_keys_resolve_for_the_platform_of_the_distribution() -> None:
    humble, jazzy = Knowledge("humble"), Knowledge("jazzy")
    assert (humble.resolves("eigen"), jazzy.resolves("eigen")) == (True, True)
    assert (humble.resolves("gazebo"), jazzy.resolves("gazebo")) == (True, False)
    assert jazzy.resolves("ament_python") is None
    assert jazzy.distros_resolving("gazebo") == ("humble",)
    assert jazzy.rosdep.installing("uuid-dev") == ("uuid",)
    assert "python3-numpy" in jazzy.rosdep
    assert jazzy.platform == "ubuntu:noble"


@pytest.mark.parametrize(
    ("header", "first"),
    [
        ("Eigen/Dense", "eigen"),
        ("yaml-cpp/yaml.h", "yaml-cpp"),
        ("boost/filesystem/path.hpp", "libboost-filesystem-dev"),
        ("boost/optional.hpp", "boost"),
        ("boost/asio/ip/tcp.hpp", "boost"),
        ("OgreVector3.h", "rviz_ogre_vendor"),
        ("moveit/benchmarks/server.h", "moveit_ros_benchmarks"),
        ("autoware/adapi_specs/routing.hpp", "autoware_adapi_specs"),
        ("mosquitto.h", "mosquitto-dev"),
        ("cxxopts.hpp", "libcxxopts-dev"),
        ("vector", "-"),
        ("sys/types.h", "-"),
        ("unistd.h", "-"),
    ],
)
def test_headers_are_mapped_by_their_longest_prefix(header: str, first: str) -> None:
    assert Names(Store()).header(header)[0] == first


def test_ambiguous_headers_have_no_provider() -> None:
    names = Names(Store())
    assert names.header("my_node.hpp") == names.header("ros_utils.h") == names.header("rclcpp/rclcpp.hpp") == ()
    assert names.shares("moveit")
    assert not names.shares("rclcpp")


def test_python_modules_are_mapped_to_keys_and_packages() -> None:
    names = Names(Store())
    assert names.module("cv2")[0] == "python3-opencv"
    assert names.module("google.protobuf.message") == ("python3-protobuf",)
    assert names.module("google") == ()  # the files of another distribution alone say so
    assert names.module("os.path") == names.module("tomllib") == names.module("distutils") == (NOTHING_NEEDED,)
    assert names.module_packages("tf2_ros", "humble") == ("tf2_ros_py",)
    assert names.module_packages("moveit", "humble") == ("moveit_task_constructor_core",)
    assert names.module_packages("scripts", "humble") == ()
    assert names.module("tkinter.ttk") == ("python3-tk",)  # Debian and Ubuntu install Python without it
    assert {name for name in sys.stdlib_module_names if name[0] != "_"} - PYTHON_MODULES == {"tkinter"}
    assert names.module("adafruit_motor.servo") == ("python3-adafruit-circuitpython-motor-pip",)
    assert names.module("Adafruit_PCA9685") == ("adafruit-pca9685-pip",)
    assert names.module("adafruit_pca9685") == ()  # of adafruit-circuitpython-pca9685, which has no key


def test_file_names_of_headers_are_mapped_to_keys() -> None:
    names = Names(Store())
    assert names.header("gst/app/gstappsink.h")[0] == "libgstreamer1.0-dev"
    assert names.is_header_usually_declared("gst/gst.h")  # the released packages that use it declare it, too
    assert not names.is_header_usually_declared("GLFW/glfw3.h")  # too few use it to tell


def test_cmake_names_are_mapped_to_keys_and_packages() -> None:
    names = Names(Store())
    assert names.cmake("Eigen3")[0] == "eigen"
    assert names.cmake("Threads") == names.cmake("UnixCommands") == (NOTHING_NEEDED,)
    assert names.cmake("ament_cmake_internal") == ("ament_cmake_core",)
    assert names.cmake("nothing_of_the_kind") == ()
    assert names.cmake_any_case("opencv") == names.cmake("OpenCV")


def test_loading_imports_no_slow_modules() -> None:
    code = (
        "import sys; from ros_lint.knowledge import Knowledge; known = Knowledge('jazzy'); known.index.get('rclcpp');"
        "known.rosdep.get('eigen'); known.names.header('Eigen/Dense'); known.provided('rclcpp', 'executables');"
        "print(sorted({'yaml', 'json', 'networkx', 'libcst', 'importlib.metadata', 'dataclasses', 'urllib.request',"
        " 'importlib.resources', 'difflib'} & set(sys.modules)))"
    )
    process = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert process.stdout.strip() == "[]"


def test_the_providers_of_a_name_are_the_packages_whose_closure_has_it() -> None:
    jazzy = index.load(Store(), "jazzy")
    brought = {name: jazzy.closure((name,)) for name in jazzy.names()}
    for name in ("rviz2", "octomap_server", "python3-yaml", "eigen", "rclcpp"):
        having = sum(name in result for other, result in brought.items() if other != name)
        assert jazzy.count_providers(name, len(jazzy)) == having
        assert jazzy.count_providers(name, 3) > 3 or having <= 3


def test_plugins_of_one_base_class_share_an_entry() -> None:
    line = "demo\t=\tP:nav=demo::A,demo::B rviz=demo/C"
    result = provides.parse(line.split("\t"))
    assert result.known("plugins").names == ("nav=demo::A", "nav=demo::B", "rviz=demo/C")
    assert provides.render(result) == line


def test_launch_files_are_interpreted_for_the_distributions_with_an_index() -> None:
    assert tuple(distro.name for distro in distros()) == DISTRIBUTIONS
