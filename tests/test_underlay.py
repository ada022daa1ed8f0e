"""Install prefixes: those that colcon creates, if it is installed, and others in the layouts of ament_cmake and rosidl."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path

import pytest

from ros_lint.cli.commands import index as command
from ros_lint.knowledge import Knowledge, index, provides
from ros_lint.knowledge import underlays as underlay
from ros_lint.knowledge.underlays import Installed, UnderlayError
from ros_lint.knowledge.world import World

pytestmark = pytest.mark.slow

COLCON = shutil.which("colcon", path=os.path.dirname(sys.executable)) or shutil.which("colcon")

MANIFEST = """<?xml version="1.0"?>
<package format="3">
  <name>{name}</name><version>1.2.3</version><description>d</description>
  <maintainer email="ada@robots.example">Ada</maintainer><license>Apache-2.0</license>
  {depends}
  <export><build_type>{type}</build_type></export>
</package>
"""
SETUP = """
from glob import glob
from setuptools import setup
setup(
    name='{name}', version='1.2.3', packages={packages!r}, zip_safe=True,
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/{name}']),
        ('share/{name}', ['package.xml']),
        ('share/{name}/launch', glob('launch/*')),
    ],
    entry_points={{'console_scripts': {scripts!r}}},
)
"""
SETUP_CFG = "[develop]\nscript_dir=$base/lib/{name}\n[install]\ninstall_scripts=$base/lib/{name}\n"


def write(base: Path, files: Mapping[str, str], programs: frozenset[str] = frozenset()) -> Path:
    for name, content in files.items():
        path = base / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(content, "utf-8")
        if name in programs:
            path.chmod(0o755)
    return base


def manifest(name: str, depends: str = "", type_: str = "ament_cmake") -> str:
    return MANIFEST.format(name=name, depends=depends, type=type_)


def known(installed: Installed) -> dict[str, tuple[str, ...]]:
    return {facet: installed.known(facet).names for facet in provides.LETTERS if installed.known(facet).names}


# --- what colcon builds ----------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def sources(tmp_path_factory: pytest.TempPathFactory) -> Path:
    def package(name: str, depends: str, packages: list[str], scripts: list[str]) -> dict[str, str]:
        return {
            f"src/{name}/package.xml": manifest(name, depends, "ament_python"),
            f"src/{name}/setup.py": SETUP.format(name=name, packages=packages, scripts=scripts),
            f"src/{name}/setup.cfg": SETUP_CFG.format(name=name),
            f"src/{name}/resource/{name}": "",
            **{f"src/{name}/{module}/__init__.py": "def main(): pass\n" for module in packages},
        }

    return write(
        tmp_path_factory.mktemp("colcon"),
        {
            **package(
                "talker",
                "<exec_depend>listener</exec_depend><test_depend>python3-pytest</test_depend>",
                ["talker", "talking_parts"],
                ["talk = talker:main", "shout = talker:main"],
            ),
            **package("listener", "<depend>rclpy</depend>", ["listener"], ["listen = listener:main"]),
            "src/talker/launch/talk.launch.py": "def generate_launch_description(): pass\n",
            "src/talker/launch/plain.py": "def generate_launch_description(): pass\n",
            "src/talker/launch/settings.yaml": "talker: {ros__parameters: {}}\n",
        },
    )


@pytest.mark.skipif(COLCON is None, reason="colcon is not installed")
@pytest.mark.parametrize("layout", ["merged", "isolated"])
def test_a_workspace_built_by_colcon_is_read(layout: str, sources: Path, tmp_path: Path) -> None:
    shutil.copytree(sources / "src", tmp_path / "src")
    extra = {"merged": "--merge-install", "isolated": "--symlink-install"}[layout]
    environment = {**os.environ, "COLCON_LOG_LEVEL": "error", "PYTHONWARNINGS": "ignore", "COLCON_HOME": str(tmp_path)}
    subprocess.run([str(COLCON), "build", extra], cwd=tmp_path, check=True, capture_output=True, env=environment, timeout=120)
    result = {place: underlay.read([str(tmp_path / place)]) for place in ("install", ".")}
    if layout == "isolated":
        result["path"] = underlay.read([str(tmp_path / "install/talker"), str(tmp_path / "install/listener")])
    for layers in result.values():
        packages = {name: installed for layer in layers for name, installed in layer.packages.items()}
        assert sorted(packages) == ["listener", "talker"]
        talker = packages["talker"]
        assert talker.released is not None
        assert (talker.released.version, talker.released.build_type) == ("1.2.3", "ament_python")
        assert talker.released.depends == {"x": ("listener",), "s": ("python3-pytest",)}
        assert talker.known("executables").names == ("shout", "talk")
        assert talker.known("executables").ask("whisper") == "missing"
        assert talker.known("launch").names == ("launch/plain.py", "launch/talk.launch.py")
        assert talker.share_files.ask("launch/settings.yaml") == "exists"
        assert talker.share_files.ask("launch/other.yaml") == "missing"
        world = World([], layers, Knowledge("jazzy"))
        assert world.by_import("listener").names == ("listener",)
        if layout == "merged":  # else a link leads to the modules
            assert world.by_import("talking_parts.deep").names == ("talker",)
    idx, prov = command.scan([str(tmp_path / "install")], "mine", "2026-09-01")
    assert idx == (
        "#ros-index 1 distro=mine rosdistro=unknown date=2026-09-01 packages=2\n"
        "listener\t1.2.3\tp\t\tbex:rclpy\ntalker\t1.2.3\tp\t\ts:python3-pytest\tx:listener\n"
    )
    modules = "Y:talker talking_parts" if layout == "merged" else ""
    lines = [line.rstrip("\t") for line in prov.splitlines()]
    assert lines[0] == "#ros-provides 1 distro=mine packages=2"
    assert lines[2] == f"talker\t=\tX:shout talk\tL:launch/plain.py launch/talk.launch.py\t{modules}".rstrip("\t")


# --- what ament_cmake, rosidl, rclcpp_components and pluginlib leave ---------------------------------------------------

RESOURCES = "share/ament_index/resource_index"
ARM = {
    "share/arm/package.xml": manifest(
        "arm",
        "<depend>rclcpp</depend><exec_depend condition='$ROS_DISTRO == jazzy'>only_jazzy</exec_depend>"
        "<exec_depend condition='$ROS_DISTRO == humble'>only_humble</exec_depend>"
        "<test_depend>ament_lint_auto</test_depend>",
    ),
    f"{RESOURCES}/packages/arm": "",
    f"{RESOURCES}/package_run_dependencies/arm": "rclcpp;only_jazzy;ament_lint_auto",
    f"{RESOURCES}/rclcpp_components/arm": "arm::Driver;lib/libarm.so\narm::Camera;lib/libcam.so\n",
    f"{RESOURCES}/controller_interface__pluginlib__plugin/arm": "share/arm/plugins.xml\n",
    "share/arm/plugins.xml": '<library path="arm"><class name="arm/Very Fast" type="arm::Fast" base_class_type="c::C"/></library>'
    '<library path="arm2"><class type="arm::Slow<arm::A>" base_class_type="c::C"/></library>',
    "share/arm/launch/arm.launch.xml": "<launch/>",
    "share/arm/launch/deep/arm.yaml": "# all of it\nlaunch:\n  - node: {}\n",
    "share/arm/config/arm.yaml": "arm: {}\n",
    "share/arm/cmake/armConfig.cmake": "",
    "share/arm/cmake/armlib-config.cmake": "",
    "share/arm/local_setup.bash": "",
    "lib/arm/arm_node": "#!/bin/sh\n",
    "lib/arm/helper.py": "#!/usr/bin/env python3\n",
    "lib/arm/no_program.txt": "",
    "lib/arm/libinner.so": "",
    "lib/arm/deep/inner_node": "#!/bin/sh\n",
    "lib/libarm.so": "",
    "include/arm/arm/driver.hpp": "",
    "include/arm/shared_names/arm.hpp": "",
}
ARM_MSGS = {
    "share/arm_msgs/package.xml": manifest(
        "arm_msgs",
        "<depend>std_msgs</depend><member_of_group>rosidl_interface_packages</member_of_group>",
    ),
    f"{RESOURCES}/packages/arm_msgs": "",
    f"{RESOURCES}/rosidl_interfaces/arm_msgs": "msg/Joint.idl\nmsg/Joint.msg\nsrv/Move.idl\nsrv/Move.srv\n"
    "srv/Move_Request.msg\nsrv/Move_Response.msg\naction/Go.action\naction/Go.idl\n",
    "lib/python3.12/site-packages/arm_msgs/__init__.py": "",
    "lib/python3.12/site-packages/arm_msgs-1.2.3-py3.12.egg-info/top_level.txt": "arm_msgs\n",
    "include/arm_msgs/arm_msgs/msg/joint.hpp": "",
}
PLAIN = {
    "share/plain/package.xml": manifest("plain", "<exec_depend>yaml-cpp</exec_depend>", "cmake"),
    "share/colcon-core/packages/plain": "yaml-cpp",
    "share/colcon-core/packages/bare": "plain:arm",
    "include/plain/plain.h": "",
    "lib/python3.12/site-packages/arm_tools/__init__.py": "",
    "lib/python3.12/site-packages/arm-9.9.9.dist-info/top_level.txt": "arm_tools\n",
    "bin/plain_tool": "",
}
PROGRAMS = frozenset({"lib/arm/arm_node", "lib/arm/helper.py", "lib/arm/libinner.so", "lib/arm/deep/inner_node"})


@pytest.fixture
def merged(tmp_path: Path) -> Path:
    return write(tmp_path / "opt/ros/jazzy", {**ARM, **ARM_MSGS, **PLAIN}, PROGRAMS)


@pytest.fixture
def isolated(tmp_path: Path) -> Path:
    base = tmp_path / "ws"
    for name, files in (("arm", ARM), ("arm_msgs", ARM_MSGS)):
        write(base / "install" / name, files, PROGRAMS)
    write(base, {"install/.colcon_install_layout": "isolated\n", "install/setup.bash": "", "src/x/package.xml": ""})
    return base


@pytest.mark.parametrize("layout", ["merged", "isolated"])
def test_a_package_is_read_from_either_layout(layout: str, request: pytest.FixtureRequest) -> None:
    (layer,) = underlay.read([str(request.getfixturevalue(layout))], "jazzy")
    arm, messages = layer.packages["arm"], layer.packages["arm_msgs"]
    assert arm.released is not None
    assert arm.released.depends == {
        "b": ("rclcpp",), "e": ("rclcpp",), "x": ("only_jazzy", "rclcpp"), "s": ("ament_lint_auto",)
    }  # fmt: skip
    assert arm.known("executables").names == ("arm_node", "helper.py")
    assert arm.known("components").names == ("arm::Camera", "arm::Driver")
    assert arm.known("plugins").names == ("controller_interface=arm/Very Fast", "controller_interface=arm::Slow<arm::A>")
    assert arm.known("launch").names == ("launch/arm.launch.xml", "launch/deep/arm.yaml")
    assert "config/arm.yaml" in arm.share_files.names
    assert messages.known("interfaces").names == ("action/Go", "msg/Joint", "srv/Move")
    assert messages.groups == ("rosidl_interface_packages",)
    assert layer.headers("arm/driver.hpp") == ("arm",)
    assert layer.headers("shared_names/arm.hpp") == ("arm",)
    assert layer.headers("arm/no_such.hpp") == ()
    assert layer.modules("arm_msgs") == ("arm_msgs",)
    assert layer.cmake("armlib") == layer.cmake("arm") == ("arm",)


def test_a_merged_prefix_determines_owners_if_possible(merged: Path) -> None:
    (layer,) = underlay.read([str(merged)])
    assert list(layer.packages) == ["arm", "arm_msgs", "bare", "plain"]
    assert layer.modules("arm_tools") == ("arm",)
    assert layer.modules("no_module") == ()
    assert layer.headers("plain/plain.h") == ("plain",)
    plain, bare = layer.packages["plain"].released, layer.packages["bare"].released
    assert plain is not None
    assert plain.build_type == "cmake"
    assert bare is not None
    assert (bare.version, bare.depends) == ("", {"x": ("arm", "plain")})
    assert layer.packages["plain"].known("programs").ask("plain_tool") == "unknowable"
    assert layer.packages["arm"].known("modules").ask("no_module") == "unknowable"


def test_a_broken_link_makes_an_executable_unknowable(merged: Path) -> None:
    (merged / "lib/arm/lost_node").symlink_to(merged / "build/lost_node")
    (layer,) = underlay.read([str(merged)])
    executables = layer.packages["arm"].known("executables")
    assert [executables.ask(name) for name in ("lost_node", "arm_node", "x")] == ["unknowable", "exists", "missing"]
    prov = command.scan([str(merged)], "mine")[1]
    assert "X:arm_node helper.py lost_node?" in prov
    assert "P:controller_interface=arm/VeryFast,arm::Slow<arm::A>" in prov


def test_installed_test_modules_are_left_out_of_the_data(isolated: Path) -> None:
    modules = {f"lib/python3.12/site-packages/{name}/__init__.py": "" for name in ("arm_tools", "test")}
    prefix = write(isolated / "install/arm", modules)
    (layer,) = underlay.read([str(prefix)])
    assert layer.modules("test") == ("arm",)
    (line,) = [line for line in command.scan([str(prefix)], "mine")[1].splitlines() if line.startswith("arm\t")]
    assert [field for field in line.split("\t") if field.startswith("Y")] == ["Y:arm_tools"]


def test_cyclic_links_end_the_search(merged: Path) -> None:
    (merged / "share/arm/again").symlink_to(merged / "share/arm")
    (layer,) = underlay.read([str(merged)])
    assert layer.packages["arm"].known("launch").names == ("launch/arm.launch.xml", "launch/deep/arm.yaml")


def test_the_first_prefix_with_a_package_counts(merged: Path, tmp_path: Path) -> None:
    above = write(tmp_path / "above", {"share/arm/package.xml": manifest("arm").replace("1.2.3", "9.0.0")})
    layers = underlay.read([str(above), str(merged)])
    assert World([], layers, Knowledge("jazzy")).version("arm") == "9.0.0"
    assert "arm\t9.0.0\t" in command.scan([str(above), str(merged)], "mine")[0]
    assert World([], layers[::-1], Knowledge("jazzy")).version("arm") == "1.2.3"


def test_scanned_data_can_be_loaded(merged: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    options = {"action": "scan", "prefixes": [str(merged)], "distro": "jazzy", "to": str(tmp_path / "data")}
    assert command.run(options) == 0
    assert "jazzy.idx: 4 lines" in capsys.readouterr().out
    world = World([], [], Knowledge("jazzy", [str(tmp_path / "data")]))
    assert world.layer("arm") == "index"
    assert world.components("arm").ask("arm::Driver") == "exists"
    assert world.components("arm").ask("arm::Other") == "missing"
    assert world.python_modules("arm_msgs").ask("arm_msgs") == "exists"
    package = world.released("arm")
    assert package is not None
    assert index.render(package) == "arm\t1.2.3\tc\t\tbex:rclcpp\ts:ament_lint_auto\tx:only_jazzy"
    assert command.run({**options, "to": ""}) == 0
    assert capsys.readouterr().out.count("#ros-") == 2


@pytest.mark.parametrize(
    ("files", "says"),
    [
        (None, "cannot be read: No such file or directory"),
        ({"src/a/package.xml": "<package/>"}, "is not an install prefix"),
        ({}, "is not an install prefix"),
        ({"install": "a file"}, "is not an install prefix"),
    ],
)
def test_a_folder_that_is_not_a_prefix_is_reported(
    files: dict[str, str] | None, says: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    place = tmp_path / "ws"
    if files is not None:
        place.mkdir()
        write(place, files)
    with pytest.raises(UnderlayError, match=says) as raised:
        underlay.read([str(place)])
    assert str(place) in str(raised.value)
    assert command.run({"action": "scan", "prefixes": [str(place)], "distro": "x", "to": ""}) == 2
    assert capsys.readouterr().err.startswith(f"ros-lint: underlay {place}")


def test_an_empty_prefix_is_valid(tmp_path: Path) -> None:
    for layout in ("isolated", "merged"):
        write(tmp_path / layout, {".colcon_install_layout": f"{layout}\n", "setup.bash": ""})
        assert [package for layer in underlay.read([str(tmp_path / layout)]) for package in layer.packages] == []
    write(tmp_path / "ament", {f"{RESOURCES}/packages/.keep": ""})
    assert underlay.read([str(tmp_path / "ament")])


def test_the_install_folder_of_the_workspace_is_left_out(isolated: Path, merged: Path) -> None:
    own = [str(isolated / "install"), str(isolated / "install/arm"), str(isolated)]
    for base in (isolated, isolated / "src"):
        assert [layer.root for layer in underlay.read([*own[:2], str(merged)], base=str(base))] == [str(merged)]
    assert underlay.read(own, base=str(isolated)) == ()
    assert len(underlay.read(own, base=str(merged))) == 3


def test_a_damaged_package_does_not_affect_the_others(merged: Path) -> None:
    (merged / "share/arm/package.xml").write_bytes(b"\xff\xfe<package>\x00")
    (merged / "share/arm/plugins.xml").write_text("<library path='x'><class name='a'")
    (merged / f"{RESOURCES}/rosidl_interfaces/arm_msgs").unlink()
    (layer,) = underlay.read([str(merged)])
    broken = layer.packages["arm"].released
    assert broken is not None
    assert broken.depends == {"x": ("ament_lint_auto", "only_jazzy", "rclcpp")}  # what ament recorded
    assert known(layer.packages["arm"]).keys() == {"executables", "launch", "components", "modules"}
    assert known(layer.packages["arm_msgs"]) == {"modules": ("arm_msgs",)}
    assert len(command.scan([str(merged)], "mine")[0].splitlines()) == 5


RUNTIME_BODIES = [
    "<depend>a</depend><exec_depend>b</exec_depend><build_export_depend>c</build_export_depend>",
    "<buildtool_export_depend>a</buildtool_export_depend><build_depend>no</build_depend><test_depend>no</test_depend>",
    "<depend version_gte='1.0'>\n  a\n</depend><!-- <depend>no</depend> --><exec_depend><!-- so --> b</exec_depend>",
    "<depend>a</depend><!-- --><depend\n>b</depend ><doc_depend>no</doc_depend><buildtool_depend>no</buildtool_depend>",
    "<depend condition='$ROS_DISTRO == jazzy'>a</depend><depend condition='$ROS_DISTRO == humble'>no</depend>",
    "<depend><![CDATA[a]]></depend>",
    "<depend>&#97;</depend>",
    "<url>https://x.example/?a=1&amp;b=2</url><depend>a</depend>",
]


@pytest.mark.parametrize("body", RUNTIME_BODIES)
def test_the_fast_and_the_full_reading_of_manifests_agree(body: str, tmp_path: Path) -> None:
    write(tmp_path, {"share/arm/package.xml": manifest("arm", body)})
    arm = underlay.read([str(tmp_path)], "jazzy")[0].packages["arm"]
    assert arm.released is not None
    assert arm.runtime == arm.released.on("eux")
    assert arm.runtime
    assert "no" not in arm.runtime


@pytest.mark.skipif("ROS_LINT_CORPUS" not in os.environ, reason="ROS_LINT_CORPUS names no folder of repositories")
def test_the_fast_and_the_full_reading_agree_for_real_manifests(tmp_path: Path) -> None:
    result = [path for path in Path(os.environ["ROS_LINT_CORPUS"]).rglob("package.xml") if path.is_file()]
    for number, path in enumerate(result):
        write(tmp_path, {f"share/p{number}/package.xml": ""})
        shutil.copy(path, tmp_path / f"share/p{number}/package.xml")
    (layer,) = underlay.read([str(tmp_path)], "jazzy")
    assert len(layer.packages) == len(result)
    for installed in layer.packages.values():
        if installed.released is not None:
            assert installed.runtime == installed.released.on("eux"), installed.name
