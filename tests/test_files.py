"""FIFOs, devices and huge files: a run ends, and the memory suffices."""

from __future__ import annotations

import errno
import json
import os
import resource
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from ros_lint.base import files
from ros_lint.base.tree import DiskTree, MachineTree
from ros_lint.knowledge.store import KnowledgeError, Store
from tests.test_bad_input import GOOD, lint, package, rules

pytestmark = pytest.mark.slow


def fifo(place: Path) -> None:
    os.mkfifo(place)


def link_to_a_device(place: Path) -> None:
    place.symlink_to("/dev/zero")


IRREGULAR = pytest.mark.parametrize("make", [fifo, link_to_a_device])


def test_files_are_read_up_to_the_limit(tmp_path: Path) -> None:
    place = tmp_path / "f"
    for size in (0, 1, 65536, 3_000_000):
        place.write_bytes(b"x" * size)
        assert files.read(str(place), 3_000_000) == b"x" * size
    with pytest.raises(OSError, match="3 MB is more than the limit of 2 MB") as raised:
        files.read(str(place), 2 << 20)
    assert raised.value.errno == errno.EFBIG
    with pytest.raises(IsADirectoryError):
        files.read(str(tmp_path))


def test_a_growing_file_is_cut_at_its_size_when_opened(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    place = tmp_path / "f"
    place.write_bytes(b"one")
    ask = os.fstat

    def grow(handle: int) -> os.stat_result:
        status = ask(handle)
        place.write_bytes(b"one and more")
        return status

    monkeypatch.setattr(os, "fstat", grow)
    assert files.read(str(place)) == b"one"


def test_a_shrinking_file_is_read_to_its_end(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    place = tmp_path / "f"
    place.write_bytes(b"one and more")
    ask = os.fstat

    def shrink(handle: int) -> os.stat_result:
        status = ask(handle)
        os.truncate(place, 3)
        return status

    monkeypatch.setattr(os, "fstat", shrink)
    assert files.read(str(place)) == b"one"


@IRREGULAR
@pytest.mark.parametrize("tree", [DiskTree, lambda folder: MachineTree()])
def test_only_regular_files_are_read(tmp_path: Path, make: Callable[[Path], None], tree: Callable[[str], DiskTree]) -> None:
    make(tmp_path / "f")
    with pytest.raises(OSError, match="not a regular file|links to a place outside the workspace"):
        tree(str(tmp_path)).read(str(tmp_path / "f") if tree is not DiskTree else "f")


@IRREGULAR
@pytest.mark.parametrize("name", [".gitignore", "src/.gitignore", ".gitmodules", "x.repos", "src/x.rosinstall"])
def test_irregular_ignore_and_repository_files_are_skipped(tmp_path: Path, make: Callable[[Path], None], name: str) -> None:
    package(tmp_path / "src" / "good", "good")
    make(tmp_path / name)
    ran = lint(tmp_path)
    assert rules(ran, "src/good/") == ["undeclared-dependency"]
    assert [entry["what"] for entry in ran.out["not_checked"]] == [name]


@IRREGULAR
def test_irregular_manifests_of_an_underlay_are_skipped(tmp_path: Path, make: Callable[[Path], None]) -> None:
    package(tmp_path / "ws" / "good", "good")
    for name in ("other", "sensor_msgs"):
        (tmp_path / "base" / "share" / name).mkdir(parents=True)
    (tmp_path / "base" / "share" / "other" / "package.xml").write_text(GOOD.format("other"))
    make(tmp_path / "base" / "share" / "sensor_msgs" / "package.xml")
    ran = lint(tmp_path / "ws", "--underlay", tmp_path / "base")
    assert rules(ran, "good/") == ["undeclared-dependency"]


def test_an_endless_data_file_is_an_error(tmp_path: Path) -> None:
    (tmp_path / "jazzy.idx").write_text("")
    os.truncate(tmp_path / "jazzy.idx", 1 << 40)
    with pytest.raises(KnowledgeError, match="MB is more than the limit"):
        Store((str(tmp_path),)).lines("jazzy.idx")


@pytest.mark.parametrize("text", ["x = = 1\n", "return 1\n"])
def test_the_compiler_opens_no_file_of_the_current_folder(tmp_path: Path, text: str) -> None:
    good = package(tmp_path / "ws" / "good", "good")
    (good / "launch").mkdir()
    (good / "launch" / "a.launch.py").write_text(f"def generate_launch_description():\n    pass\n{text}")
    with (good / "CMakeLists.txt").open("a") as script:
        script.write("install(DIRECTORY launch DESTINATION share/${PROJECT_NAME})\n")
    here = tmp_path / "here" / "good" / "launch"
    here.mkdir(parents=True)
    fifo(here / "a.launch.py")
    for name in ("<unknown>", "<string>"):
        fifo(tmp_path / "here" / name)
    ran = lint(tmp_path / "ws", cwd=tmp_path / "here")
    assert "launch-invalid" in rules(ran, "good/")


def limited(*arguments: str | Path) -> dict[str, object]:
    """Run with less memory than a large file has."""
    command = [sys.executable, "-m", "ros_lint", *map(str, arguments), "--no-cache", "--distro", "jazzy", "--format", "json"]
    most = 800 << 20

    def limit() -> None:
        resource.setrlimit(resource.RLIMIT_AS, (most, most))

    process = subprocess.run(command, capture_output=True, timeout=60, check=False, preexec_fn=limit)
    assert process.stderr == b""
    out: dict[str, object] = json.loads(process.stdout)
    return out


@pytest.mark.parametrize("name", ["a.cpp", "x.db3", "x.csv", "x.pt", "core", "launch/a.launch.py", "package.xml"])
def test_a_file_larger_than_the_memory_is_not_read(tmp_path: Path, name: str) -> None:
    package(tmp_path / "good", "good")
    place = package(tmp_path / "large", "large") / name
    with (tmp_path / "large" / "CMakeLists.txt").open("a") as script:
        script.write("find_package(unknown_package REQUIRED)\n")
    place.parent.mkdir(exist_ok=True)
    place.write_text("// text\n" * 1000)
    os.truncate(place, 1 << 32)
    out = limited(tmp_path)
    result = out["findings"]
    assert isinstance(result, list)
    assert any(finding["rule"] == "undeclared-dependency" and finding["package"] == "good" for finding in result)
    assert out["crashes"] == []
    not_checked = out["not_checked"]
    assert isinstance(not_checked, list)
    reasons = {entry["what"]: entry["reason"] for entry in not_checked}
    source = name in ("a.cpp", "launch/a.launch.py", "package.xml")
    assert reasons == ({f"large/{name}": "4096 MB is more than the limit of 4 MB"} if source else {})


def test_many_large_files_do_not_exhaust_the_memory(tmp_path: Path) -> None:
    large = package(tmp_path / "large", "large")
    with (large / "CMakeLists.txt").open("a") as script:
        script.write("find_package(OpenCV REQUIRED)\nfind_package(unknown_package REQUIRED)\n")
    (large / "a.csv").write_bytes(b"1, 2\n" * 700_000)
    for number in range(250):
        (large / f"{number}.csv").hardlink_to(large / "a.csv")
    assert limited(tmp_path)["crashes"] == []
