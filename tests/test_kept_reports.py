"""A report that is kept is the one that a run would make: whatever changes that a run looks at, there is a run."""

from __future__ import annotations

import os
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from ros_lint.cache import Cache
from ros_lint.cli import main
from ros_lint.collect import collect_all
from ros_lint.load import Loader
from ros_lint.options import FORMATS
from ros_lint.tree import DiskTree, RecordedTree

DEMO = Path(__file__).parent.parent / "fixtures" / "workspaces" / "demo"


class Runs:
    """Counts how often a workspace is loaded."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.count = 0
        load = Loader.load

        def counted(loader: Loader, *args: object, **options: object) -> object:
            self.count += 1
            return load(loader, *args, **options)  # type: ignore[arg-type]

        monkeypatch.setattr(Loader, "load", counted)


@pytest.fixture
def workspace(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path / "data"))
    target = tmp_path / "ws"
    shutil.copytree(DEMO, target)
    (target / "src" / "here").symlink_to("nowhere")
    return target


def said(workspace: Path, *arguments: str) -> str:
    report = workspace.parent / "report.json"
    assert main([str(workspace), "--distro", "jazzy", "--format", "json", "--jobs", "1", "--output", str(report), *arguments]) < 2
    return report.read_text()


def _write(path: str, text: str) -> Callable[[Path], object]:
    def change(workspace: Path) -> None:
        (workspace / path).parent.mkdir(parents=True, exist_ok=True)
        (workspace / path).write_text(text)

    return change


def _append(path: str, text: str) -> Callable[[Path], object]:
    return lambda workspace: (workspace / path).write_text((workspace / path).read_text() + text)


def _relink(workspace: Path) -> None:
    (workspace / "src" / "here").unlink()
    (workspace / "src" / "here").symlink_to(workspace / "src" / "rover_driver")


DRIVER = "src/rover_driver"
CHANGES: dict[str, Callable[[Path], object]] = {
    "a source": _append(f"{DRIVER}/src/driver_node.cpp", "#include <tf2_ros/buffer.hpp>\n"),
    "a manifest": _append(f"{DRIVER}/package.xml", "<!-- the end -->"),
    "a build script": _append(f"{DRIVER}/CMakeLists.txt", "find_package(nav_msgs REQUIRED)\n"),
    "a file that nobody reads": _write(f"{DRIVER}/docs/more/notes.txt", "x"),
    "a new source": _write(f"{DRIVER}/src/more/a.cpp", "#include <nav_msgs/msg/path.hpp>\n"),
    "a file that goes": lambda workspace: (workspace / DRIVER / "src" / "driver_node.cpp").unlink(),
    "a mode": lambda workspace: (workspace / DRIVER / "CMakeLists.txt").chmod(0o755),
    "a mark": _write(f"{DRIVER}/COLCON_IGNORE", ""),
    "a new package": _write("src/deep/down/package.xml", "<package>"),
    "a link": _relink,
    "what a link leads to": lambda workspace: (workspace / "src" / "nowhere").mkdir(),
    "settings": _write("ros-lint.toml", 'ignore = ["undeclared-dependency"]\n'),
    "a list of sources": _write("more.repos", "repositories: {}\n"),
    "data of the released world": lambda workspace: _write("data/ros-lint/index/new.txt", "")(workspace.parent),
}


@pytest.mark.parametrize("change", CHANGES.values(), ids=CHANGES)
def test_what_changes_is_seen(workspace: Path, monkeypatch: pytest.MonkeyPatch, change: Callable[[Path], object]) -> None:
    runs = Runs(monkeypatch)
    before = said(workspace)
    assert (said(workspace), runs.count) == (before, 1)
    change(workspace)
    after = said(workspace)
    assert runs.count == 2
    assert after == said(workspace, "--no-cache")
    assert (said(workspace), runs.count) == (after, 3)


AROUND: dict[str, Callable[[Path], object]] = {
    "a script": _append("src/shared/x.cmake", "find_package(nav_msgs REQUIRED)\n"),
    "a file that joins": _write("src/shared/launch/b.launch.py", ""),
    "a file that goes": lambda workspace: (workspace / "src/shared/launch/a.launch.py").unlink(),
    "a file that comes": _write("src/shared/y.cmake", "find_package(nav_msgs REQUIRED)\n"),
}


@pytest.mark.parametrize("change", AROUND.values(), ids=AROUND)
def test_what_scripts_name_around_a_package_is_watched(
    workspace: Path, monkeypatch: pytest.MonkeyPatch, change: Callable[[Path], object]
) -> None:
    includes = "include(../shared/x.cmake)\ninclude(../shared/y.cmake OPTIONAL)\n"
    _append(f"{DRIVER}/CMakeLists.txt", f"{includes}install(DIRECTORY ../shared/launch DESTINATION share)\n")(workspace)
    _write("src/shared/COLCON_IGNORE", "")(workspace)  # so that nobody else looks into it
    _write("src/shared/x.cmake", "find_package(std_srvs REQUIRED)\n")(workspace)
    _write("src/shared/launch/a.launch.py", "")(workspace)
    test_what_changes_is_seen(workspace, monkeypatch, change)


ASKED = [["--pedantic"], ["--ignore", "ROS2"], ["--exclude", "rover_driver"], ["--distro", "humble"], ["--select", "all"]]


@pytest.mark.parametrize("arguments", ASKED)
def test_what_is_asked_is_heard(workspace: Path, monkeypatch: pytest.MonkeyPatch, arguments: list[str]) -> None:
    runs = Runs(monkeypatch)
    said(workspace)
    assert said(workspace, *arguments) == said(workspace, "--no-cache", *arguments)
    assert runs.count == 3


def test_how_it_is_written_needs_no_run(workspace: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    runs = Runs(monkeypatch)
    for form in FORMATS:
        kept = said(workspace, "--format", form, "--fail-on", "never", "--jobs", "2")
        assert kept == said(workspace, "--format", form, "--no-cache")
    assert runs.count == 1 + len(FORMATS)


@pytest.mark.parametrize("asked", [True, False], ids=["asked for", "in the environment"])
def test_underlays_are_watched(workspace: Path, monkeypatch: pytest.MonkeyPatch, tmp_path: Path, asked: bool) -> None:
    manifest = tmp_path / "install" / "share" / "sensor_msgs" / "package.xml"
    manifest.parent.mkdir(parents=True)
    manifest.write_text("<package><name>sensor_msgs</name><version>1.0.0</version></package>")
    arguments = ("--underlay", str(tmp_path / "install")) if asked else ()
    if not asked:
        monkeypatch.setenv("AMENT_PREFIX_PATH", f"{tmp_path}/install:{tmp_path}/nowhere")
    runs = Runs(monkeypatch)
    before = said(workspace, *arguments)
    assert (said(workspace, *arguments), runs.count) == (before, 1)
    manifest.write_text("<package><name>sensor_msgs</name><version>1.0.0</version><depend>nav_msgs</depend></package>")
    said(workspace, *arguments)
    (tmp_path / "install" / "share" / "sensor_msgs" / "msg").mkdir()
    (tmp_path / "install" / "share" / "ament_index" / "resource_index" / "packages").mkdir(parents=True)
    after = said(workspace, *arguments)
    assert (said(workspace, *arguments), runs.count) == (after, 3)
    (tmp_path / "nowhere").mkdir()
    (workspace / "install").symlink_to(tmp_path / "install")
    assert said(workspace, *arguments) == said(workspace, "--no-cache", *arguments)


def test_warnings_are_said_again(workspace: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(workspace.parent / "nowhere"))
    said(workspace)
    first = capsys.readouterr().err
    said(workspace)
    assert capsys.readouterr().err == first
    assert "AMENT_PREFIX_PATH" in first


def test_what_is_planted_is_not_obeyed(workspace: Path, tmp_path: Path) -> None:
    want = said(workspace)
    for kept in (tmp_path / "cache" / "ros-lint").iterdir():
        head = kept.read_bytes().partition(b"\n")[0]
        for planted in (b"cposix\nsystem\n(S'touch " + str(tmp_path / "planted").encode() + b"'\ntR.", b"\x80\x05garbage", b"N."):
            kept.write_bytes(head + b"\n" + planted)
            assert said(workspace) == want
    assert not (tmp_path / "planted").exists()


def test_what_has_gone_is_forgotten(workspace: Path, tmp_path: Path) -> None:
    for number in range(12):
        said(workspace, "--exclude", f"nothing{number}")
    kept = list((tmp_path / "cache" / "ros-lint").iterdir())
    assert [path.suffix for path in kept].count(".report") == 8

    tree, folder = DiskTree(str(workspace)), str(tmp_path / "other")
    source, new = f"{DRIVER}/src/driver_node.cpp", f"{DRIVER}/src/new.cpp"
    collect_all(tree, [source], 1, Cache(folder, "ws"), lambda done: None)
    (facts,) = (tmp_path / "other").iterdir()
    assert source.encode() in facts.read_bytes()
    (workspace / source).rename(workspace / new)
    collect_all(tree, [new], 1, Cache(folder, "ws"), lambda done: None)
    assert source.encode() not in facts.read_bytes()
    assert new.encode() in facts.read_bytes()


def again(tree: RecordedTree) -> RecordedTree:
    return RecordedTree(tree.disk)


def test_a_tree_that_changes_while_it_is_read_is_not_trusted(tmp_path: Path) -> None:
    recorded = RecordedTree(DiskTree(str(tmp_path)))
    with pytest.raises(FileNotFoundError):
        recorded.read("a")
    assert recorded.list("") == []
    assert again(recorded).still_says(recorded.said.items())
    (tmp_path / "a").write_text("x")
    assert not again(recorded).still_says(recorded.said.items())
    assert recorded.steady
    recorded.list("")
    assert not recorded.steady
    file = again(recorded)
    assert file.read("a") == b"x"
    os.utime(tmp_path / "a", ns=(1, 1))
    assert not again(file).still_says(file.said.items())


def test_what_was_said_just_now_is_not_asked_for_again(tmp_path: Path) -> None:
    (tmp_path / "a").write_text("x")
    (tmp_path / "gone").mkdir()
    first = RecordedTree(DiskTree(str(tmp_path)))
    said = first.identity(""), first.list(""), first.list("gone"), first.stamp("a")
    (tmp_path / "gone").rmdir()
    second = again(first)
    assert second.identity("") == said[0]
    assert not second.still_says(first.said.items())
    assert second.list("") != said[1]
    with pytest.raises(FileNotFoundError) as raised:
        second.list("gone")
    with pytest.raises(FileNotFoundError) as real:
        second.disk.list("gone")
    assert (raised.value.errno, raised.value.strerror) == (real.value.errno, real.value.strerror)
    assert second.stamp("a") == said[3]
    assert second.steady
    assert set(second.said) == {("identity", ""), ("list", ""), ("list", "gone"), ("stamp", "a")}
