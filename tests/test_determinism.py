"""The same input gives the same bytes: from any folder, with any number of processes, cold or warm."""

import os
import random
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from ros_lint.reporters import FORMATS

pytestmark = pytest.mark.slow

DEMO = Path(__file__).parent.parent / "fixtures" / "workspaces" / "demo"


def lint(workspace: str, cwd: Path, home: Path, *arguments: str, user: str = "ada") -> bytes:
    environment = {**os.environ, "HOME": str(home), "XDG_CACHE_HOME": str(home / "cache"), "USER": user, "LOGNAME": user}
    command = [sys.executable, "-m", "ros_lint", workspace, "--distro", "jazzy", *arguments]
    process = subprocess.run(command, capture_output=True, cwd=cwd, env=environment, check=False)
    assert process.returncode == 1, process.stderr
    assert process.stdout
    return process.stdout


def shuffled_copy(source: Path, target: Path, seed: int) -> None:
    """Copy a tree so that its files come into being in another order: most file systems list them in that order."""
    files = sorted(path for path in source.rglob("*") if path.is_file())
    random.Random(seed).shuffle(files)
    for path in files:
        place = target / path.relative_to(source)
        place.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy2(path, place)


@pytest.mark.parametrize("form", FORMATS)
def test_the_output_is_the_same_for_any_folder_order_and_cache(tmp_path: Path, form: str) -> None:
    first, second = tmp_path / "a" / "ws", tmp_path / "somewhere else" / "w"
    shuffled_copy(DEMO, first, 1)
    shuffled_copy(DEMO, second, 2)
    home, other = tmp_path / "home", tmp_path / "other"

    def run(workspace: Path, folder: Path, home: Path, jobs: int, *options: str, user: str = "ada") -> bytes:
        # In text and concise, paths are relative to the current folder.
        folder = workspace if form in ("text", "concise") else folder
        path = os.path.relpath(workspace, folder)
        return lint(path, folder, home, "--format", form, "--jobs", str(jobs), *options, user=user)

    expected = run(first, first.parent, home, 1, "--no-cache")
    assert run(first, first, home, 1) == expected, "another folder, cold"
    assert run(first, first, home, 1) == expected, "warm"
    assert run(second, tmp_path, other, 4, "--no-cache", user="grace") == expected, "4 processes"
    assert run(second, Path("/"), other, 4, user="grace") == expected, "4 processes, cold"
    assert run(second, Path("/"), other, 1, user="grace") == expected, "warm from 4 processes"


def test_a_changed_file_is_read_again(tmp_path: Path) -> None:
    shuffled_copy(DEMO, tmp_path / "ws", 1)
    arguments = ("--format", "concise", "--select", "undeclared-dependency")
    assert b"sensor_msgs" in lint("ws", tmp_path, tmp_path, *arguments)
    source = tmp_path / "ws" / "src" / "rover_driver" / "src" / "driver_node.cpp"
    source.write_text(source.read_text().replace("sensor_msgs", "nav_msgs"))
    again = lint("ws", tmp_path, tmp_path, *arguments)
    assert b"nav_msgs" in again
    assert b"sensor_msgs" not in again


def test_a_manipulated_cache_is_ignored(tmp_path: Path) -> None:
    shuffled_copy(DEMO, tmp_path / "ws", 1)
    expected = lint("ws", tmp_path, tmp_path, "--format", "concise")
    kept = list((tmp_path / "cache" / "ros-lint").iterdir())
    assert [cache.suffix for cache in kept] == [".cache"]
    marker = tmp_path / "planted"
    for cache in kept:
        head = cache.read_bytes().partition(b"\n")[0]
        cache.write_bytes(head + b"\ncposix\nsystem\n(S'touch " + str(marker).encode() + b"'\ntR.")
    assert lint("ws", tmp_path, tmp_path, "--format", "concise") == expected
    assert not marker.exists()
    for cache in kept:
        cache.write_bytes(cache.read_bytes().partition(b"\n")[0] + b"\n\x80\x05garbage")
    assert lint("ws", tmp_path, tmp_path, "--format", "concise") == expected
