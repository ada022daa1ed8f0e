"""Names of a hostile workspace cannot control a terminal, a CI service or a browser, in any format and any command.

Control, bidirectional and ANSI characters, workflow commands and markup are in every place that a name can come from: folders,
files, packages, dependencies, targets, launch files, nodes, parameters, interfaces, repositories and suppression comments.
"""

from __future__ import annotations

import json
import re
import subprocess
from pathlib import Path
from typing import Final
from xml.etree import ElementTree

import pytest

from ros_lint.base.diff import unified_bytes
from ros_lint.cli.main import main
from ros_lint.reporters import FORMATS
from tests.fuzz.oracle import Ran, _run
from tests.fuzz.seeds import Files, write

pytestmark = pytest.mark.slow

_IN_NAMES: Final = "x\x1b[31m\x07\x9b1m\u202ea\u2066b\u200fc\u2028d\x85e\nf\rg"
"""What a name of a file can have."""
_IN_TEXTS: Final = "x\x9b1m\u202ea\u2066b\u200fc\u2028d\x85e"
"""What XML and YAML can have, too."""
_COMMANDS: Final = "::error::y ##[error]z ##vso[task.setvariable variable=v]w %0A::warning::u"
_MARKUP: Final = "<script>alert(1)</script>"
_CONTROL: Final = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f\u061c\u200e\u200f\u2028-\u202e\u2066-\u2069\ud800-\udfff]")


_OWN: Final = {
    "text": r"::: ",
    "github": r"::(error|warning|notice) (file|title)=",
    "azure": r"##vso\[task\.logissue type=",
    "markdown": "## ros-lint$",
}
"""By format: matches lines that are commands, or begin like one."""


def _xml(text: str) -> str:
    return text.replace("&", "&amp;").replace("<", "&lt;").replace('"', "&quot;")


def _workspace() -> Files:
    text = f"{_IN_TEXTS}{_COMMANDS}{_MARKUP}"
    escaped = _xml(text)
    manifest = f"""<package format="3">
  <name>NAME</name><version>0.1.0</version><description>{escaped}</description>
  <maintainer email="a@b.org">{escaped}</maintainer><license>TODO {escaped}</license>
  <depend>{escaped}</depend>
  <depend condition="$A == {escaped}">rclcpp</depend>
  <member_of_group>{escaped}</member_of_group>
  <export><build_type>ament_cmake</build_type></export>
</package>
"""
    script = f"""project(a)
find_package(ament_cmake)
find_package("{text}" REQUIRED)
add_executable("{text}" "{text}.cpp")
target_link_libraries("{text}" "{text}")
install(FILES "{text}" DESTINATION "{text}")
rosidl_generate_interfaces(a "msg/{text}.msg")
ament_export_dependencies("{text}")
install(DIRECTORY launch DESTINATION share/a)
ament_package()
"""
    launch = f"""from launch import LaunchDescription
from launch.actions import *
from launch.substitutions import *
from launch_ros.actions import Node
def generate_launch_description():
    return LaunchDescription([
        DeclareLaunchArgument({text!r}, default_value={text!r}, description={text!r}, choices=['a']),
        Node(package={text!r}, executable={text!r}, name={text!r}, parameters=[{{{text!r}: {text!r}}}], condition={text!r}),
        Node(package='a', executable={text!r}, arguments=[LaunchConfiguration({text!r})]),
        IncludeLaunchDescription({text!r}),
        PythonExpression([{text!r}]),
    ])
"""
    xml = f'<launch><node pkg="{escaped}" exec="{escaped}"/><include file="$(find-pkg-share a)/{escaped}"/>{text}</launch>'
    return {
        key: content.encode("utf-8", "surrogatepass")
        for key, content in {
            "a/package.xml": manifest.replace("NAME", "a"),
            "a/CMakeLists.txt": script,
            "a/launch/a.launch.py": launch,
            f"a/launch/{_IN_NAMES}.launch.py": launch,
            "a/launch/b.launch.xml": xml,
            "a/launch/c.launch.yaml": f"launch:\n- node: {{pkg: {json.dumps(text)}, exec: {json.dumps(_IN_NAMES)}}}\n",
            f"a/src/{_IN_NAMES}.cpp": f"#include <{text}/a.hpp>\n// ros-lint: ignore[{text}]\n",
            f"a/msg/{_IN_NAMES}.msg": f"{text}/A b\nint32 {text}\n",
            "a/src/b.cpp": "#include <nav_msgs/msg/odometry.hpp>\nRCLCPP_COMPONENTS_REGISTER_NODE(a::B)\n"
            'auto c = "/home/x/y";  // ##[error]a ##vso[task.b]c\n',
            f"{_IN_NAMES}/package.xml": manifest.replace("NAME", escaped),
            f"::error::{_COMMANDS.replace('/', '')}/package.xml": manifest.replace("NAME", "b"),
            f"::error::{_COMMANDS.replace('/', '')}/colcon.pkg": json.dumps({"name": f"::error::{text}"}),
            "##[error]z/package.xml": "<package>",
            "a.repos": f"repositories:\n  {json.dumps(text)}: {{type: git, url: x, version: y}}\n",
            "ros-lint.toml": f"ignore = [{json.dumps(text)}]\nexclude = [{json.dumps(_IN_NAMES)}]\n",
        }.items()
    }


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    root = tmp_path_factory.mktemp("ws")
    write(_workspace(), str(root))
    assert len(list(root.iterdir())) == 6
    return root


def _ran(*arguments: str) -> Ran:
    return _run(main, (*arguments, "--isolated", "--distro", "jazzy"))


def _check(ran: Ran, own: str = "", *, in_lines: bool = True) -> str:
    """Check that an output has no character or line that controls something. ``own`` matches commands of the format itself.

    If ``in_lines`` is False, the output may have the older commands within its lines, as files of other programs.
    """
    output = ran.out.decode()
    for text in (output, ran.err):
        assert not (match := _CONTROL.search(text)), text[max(0, match.start() - 200) : match.end() + 50]
        lines = [line.strip() for line in text.splitlines()]
        commands = [line for line in lines if line.startswith(("::", "##"))]
        assert [line for line in commands if not (own and re.match(own, line))] == []
        assert not in_lines or not [line for line in lines if re.search(r"##(vso)?\[", line)]
    return output


@pytest.mark.parametrize("form", FORMATS)
@pytest.mark.parametrize("more", [[], ["--pedantic", "--select", "all"]], ids=["default", "pedantic"])
def test_reports(folder: Path, form: str, more: list[str]) -> None:
    own = _OWN.get(form, "")
    in_lines = form not in ("github", "azure", "junit", "checkstyle", "markdown", "html")
    output = _check(_ran(str(folder), "--no-cache", "--format", form, *more), own, in_lines=in_lines)
    assert "launch_ros" in output
    if form in ("html", "markdown"):
        assert _MARKUP not in output
    if form in ("junit", "checkstyle"):
        ElementTree.fromstring(output)
    if form in ("json", "sarif", "gitlab", "rdjson"):
        json.loads(output)


@pytest.mark.parametrize("option", ["--statistics", "--diff", "--show-settings"])
def test_other_outputs_of_a_check(folder: Path, option: str) -> None:
    ran = _ran(str(folder), "--no-cache", option)
    if option == "--diff":  # a patch has the lines of the files as they are, but its headers quote names
        headers = [line for line in ran.out.decode().splitlines() if line.startswith(("--- ", "+++ "))]
        ran = ran._replace(out="\n".join(headers).encode())
    _check(ran)


def test_errors_of_settings(folder: Path) -> None:
    _check(_run(main, (str(folder), "--no-cache")))


@pytest.mark.parametrize("form", ["dot", "mermaid", "json", "html"])
def test_graphs(folder: Path, form: str) -> None:
    output = _check(_ran("graph", str(folder), "--external", "--format", form))
    assert form != "html" or _MARKUP not in output


@pytest.mark.parametrize("command", [("order",), ("overlay",), ("explain-package", "a"), ("why", "a", "b")], ids=" ".join)
def test_queries(folder: Path, command: tuple[str, ...]) -> None:
    _check(_ran(*command, str(folder)))


@pytest.mark.parametrize("file", ["a.launch.py", "b.launch.xml", "c.launch.yaml", f"{_IN_NAMES}.launch.py"])
def test_launch(folder: Path, file: str) -> None:
    for more in ([], ["--format", "json"], ["--show-args"]):
        _check(_ran("launch", f"{folder}/a/launch/{file}", *more))


def test_a_patch_of_a_file_with_a_special_name_is_one_for_git(tmp_path: Path) -> None:
    name = 'a"\\\x1b[31m\u202e\n\udcffb.txt'
    (tmp_path / name).write_bytes(b"old\n")
    patch = unified_bytes(name, b"old\n", b"new\n")
    assert patch.startswith(b'--- "a/a\\042\\134\\033[31m\\342\\200\\256\\012\\377b.txt"\n')
    subprocess.run(["git", "apply", "-"], input=patch, cwd=tmp_path, check=True)
    assert (tmp_path / name).read_bytes() == b"new\n"
