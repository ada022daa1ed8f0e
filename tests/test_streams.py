"""Standard output in any encoding, on a full disk, or closed."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.test_bad_input import CMAKE, GOOD, package

pytestmark = pytest.mark.slow

ENCODINGS = ["latin-1:strict", "ascii:strict", "ascii:surrogateescape"]


def run(*arguments: str | Path, encoding: str = "utf-8:strict") -> subprocess.CompletedProcess[bytes]:
    command = [sys.executable, "-m", "ros_lint", *map(str, arguments)]
    env = {**os.environ, "PYTHONIOENCODING": encoding}
    return subprocess.run(command, capture_output=True, timeout=60, check=False, env=env)


@pytest.fixture
def workspace(tmp_path: Path) -> Path:
    """A workspace with something to fix beside bytes that are no UTF-8, and beside letters that few encodings have."""
    folder = package(tmp_path / "ws" / "robot", "robot")
    (folder / "package.xml").write_text(GOOD.format("robot").replace("<export>", "<depend>sensor_msgs</depend>\n  <export>"))
    (folder / "launch").mkdir()
    (folder / "launch" / "a.launch.xml").write_text("<launch/>")
    comments = "# Universit\xe9 \u6f22\nament_package()"
    text = CMAKE.format("robot").replace("ament_package()", comments)
    (folder / "CMakeLists.txt").write_bytes(text.encode().replace("\xe9".encode(), b"\xe9"))
    return tmp_path / "ws"


def check_patch(workspace: Path, place: Path, patch: bytes) -> bytes:
    """Apply a patch and take it back; what it makes is what a fix makes. Returns the fixed file."""
    before = place.read_bytes()
    subprocess.run(["patch", "-p1", "-s"], input=patch, cwd=workspace, check=True)
    patched = place.read_bytes()
    subprocess.run(["patch", "-R", "-p1", "-s"], input=patch, cwd=workspace, check=True)
    assert place.read_bytes() == before
    run(workspace, "--fix", "--no-cache")
    assert place.read_bytes() == patched != before
    return patched


@pytest.mark.parametrize("encoding", ["utf-8:strict", *ENCODINGS])
def test_a_patch_has_the_original_bytes_of_the_file(workspace: Path, encoding: str) -> None:
    process = run(workspace, "--diff", "--no-cache", encoding=encoding)
    assert (process.returncode, process.stderr) == (1, b"")
    assert b"\n # Universit\xe9 \xe6\xbc\xa2\n+install(DIRECTORY launch" in process.stdout
    check_patch(workspace, workspace / "robot" / "CMakeLists.txt", process.stdout)


def test_a_patch_of_a_latin_1_file_has_its_bytes(workspace: Path) -> None:
    place = workspace / "robot" / "launch" / "a.launch.py"
    text = (
        "# coding: latin-1\nfrom launch import LaunchDescription\nfrom launch_ros.actions import Node\n\n\n"
        "def generate_launch_description():\n"
        "    # \xe9\n    return LaunchDescription([Node(package='joy', node_executable='joy_node')])\n"
    )
    place.write_bytes(text.encode("latin-1"))
    process = run(workspace, "--diff", "--no-cache")
    assert b"\n     # \xe9\n" in process.stdout
    assert b" executable='joy_node'" in check_patch(workspace, place, process.stdout)


@pytest.mark.parametrize("encoding", ENCODINGS)
@pytest.mark.parametrize("command", [("graph",), ("order",), ("explain-package", "r\u6f22"), ("launch",)])
def test_names_that_the_terminal_cannot_show_are_escaped(tmp_path: Path, encoding: str, command: tuple[str, ...]) -> None:
    folder = package(tmp_path / "ws" / "robot", "robot")
    (folder / "package.xml").write_text(GOOD.format("robot"))
    (folder / "colcon.pkg").write_text("name: r\u6f22\n", "utf-8")
    (folder / "CMakeLists.txt").write_text(CMAKE.format("robot") + "install(DIRECTORY launch DESTINATION share/robot)\n")
    (folder / "launch").mkdir()
    launch = folder / "launch" / "\u6f22.launch.xml"
    launch.write_text("<launch><node pkg='robot' exec='\u6f22'/></launch>")
    place = {"explain-package": ["-C", tmp_path / "ws"], "launch": [launch]}.get(command[0], [tmp_path / "ws"])
    process = run(*command, *place, "--no-cache", encoding=encoding)
    assert b"Traceback" not in process.stderr
    assert b"Error" not in process.stderr
    assert b"\xe6\xbc\xa2" in process.stdout or b"\\u6f22" in process.stdout


@pytest.mark.parametrize("arguments", [(".",), (".", "--diff"), ("order", "."), ("rules",), ("--help",), ("--version",)])
@pytest.mark.parametrize("where", [">/dev/full", ">&-"])
def test_unwritable_output_gives_a_message_and_exit_code_2(workspace: Path, arguments: tuple[str, ...], where: str) -> None:
    command = " ".join([sys.executable, "-m", "ros_lint", *arguments, where])
    process = subprocess.run(["bash", "-c", command], capture_output=True, text=True, cwd=workspace, check=False)
    assert process.returncode == 2
    reason = "No space left on device" if "full" in where else "Bad file descriptor"
    assert process.stderr == f"ros-lint: standard output: {reason}\n"


@pytest.mark.parametrize("where", ["2>&-", "2>&- >&-", "2>/dev/full"])
def test_unwritable_standard_error_raises_no_error(workspace: Path, where: str) -> None:
    command = " ".join([sys.executable, "-m", "ros_lint", "nowhere", where])
    process = subprocess.run(["bash", "-c", command], capture_output=True, text=True, cwd=workspace, check=False)
    assert (process.returncode, process.stdout, process.stderr) == (2, "", "")


def test_a_run_that_writes_to_a_file_needs_no_standard_output(workspace: Path) -> None:
    command = " ".join([sys.executable, "-m", "ros_lint", ".", "--output", "report", ">&-"])
    process = subprocess.run(["bash", "-c", command], capture_output=True, text=True, cwd=workspace, check=False)
    assert (process.returncode, process.stderr) == (1, "")
    assert (workspace / "report").read_text().startswith("robot: ")
