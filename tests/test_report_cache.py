"""A cached report equals that of a run, and each change that affects the report causes a run."""

from __future__ import annotations

import os
import pickle
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from ros_lint.base.tree import DiskTree, RecordedTree
from ros_lint.cli.main import main
from ros_lint.reporters import FORMATS
from ros_lint.workspace import cache_files as kept_files
from ros_lint.workspace.collect import collect_all
from ros_lint.workspace.fact_cache import FactCache
from ros_lint.workspace.loader import Loader

pytestmark = pytest.mark.slow

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
    for name, package in (("a", "nav_msgs"), ("b", "std_srvs")):
        (tmp_path / f"{name}.cpp").write_text(f"#include <{package}/srv/x.hpp>\n")
        os.utime(tmp_path / f"{name}.cpp", ns=(1, 1))
    (target / "src" / "rover_driver" / "src" / "linked.cpp").symlink_to(tmp_path / "a.cpp")
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


def _same_stamp(workspace: Path) -> None:
    """Change a file and set its time back, as ``cp -p`` and ``rsync -t`` do."""
    source = workspace / DRIVER / "src" / "driver_node.cpp"
    before = source.stat()
    source.write_text(source.read_text().replace("sensor_msgs", "vision_msgs"))
    os.utime(source, ns=(before.st_atime_ns, before.st_mtime_ns))
    assert source.stat().st_size == before.st_size


def _swap(workspace: Path) -> None:
    """Lead a link to another file of the same size and time."""
    link = workspace / DRIVER / "src" / "linked.cpp"
    link.unlink()
    link.symlink_to(workspace.parent / "b.cpp")


CHANGES: dict[str, Callable[[Path], object]] = {
    "a source": _append(f"{DRIVER}/src/driver_node.cpp", "#include <tf2_ros/buffer.hpp>\n"),
    "a source with the time that it had": _same_stamp,
    "a link that leads to the like": _swap,
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
def test_each_change_of_the_workspace_causes_a_run(
    workspace: Path, monkeypatch: pytest.MonkeyPatch, change: Callable[[Path], object]
) -> None:
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
def test_files_outside_a_package_that_its_scripts_name_are_watched(
    workspace: Path, monkeypatch: pytest.MonkeyPatch, change: Callable[[Path], object]
) -> None:
    includes = "include(../shared/x.cmake)\ninclude(../shared/y.cmake OPTIONAL)\n"
    _append(f"{DRIVER}/CMakeLists.txt", f"{includes}install(DIRECTORY ../shared/launch DESTINATION share)\n")(workspace)
    _write("src/shared/COLCON_IGNORE", "")(workspace)  # so that nobody else looks into it
    _write("src/shared/x.cmake", "find_package(std_srvs REQUIRED)\n")(workspace)
    _write("src/shared/launch/a.launch.py", "")(workspace)
    test_each_change_of_the_workspace_causes_a_run(workspace, monkeypatch, change)


ASKED = [["--pedantic"], ["--ignore", "ROS2"], ["--exclude", "rover_driver"], ["--distro", "humble"], ["--select", "all"]]


@pytest.mark.parametrize("arguments", ASKED)
def test_each_option_that_affects_the_report_causes_a_run(
    workspace: Path, monkeypatch: pytest.MonkeyPatch, arguments: list[str]
) -> None:
    runs = Runs(monkeypatch)
    said(workspace)
    assert said(workspace, *arguments) == said(workspace, "--no-cache", *arguments)
    assert runs.count == 3


def test_options_of_the_output_cause_no_run(workspace: Path, monkeypatch: pytest.MonkeyPatch) -> None:
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


def test_warnings_are_printed_for_a_cached_report(
    workspace: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(workspace.parent / "nowhere"))
    said(workspace)
    first = capsys.readouterr().err
    said(workspace)
    assert capsys.readouterr().err == first
    assert "AMENT_PREFIX_PATH" in first


def _of_short(text: str) -> bytes:
    return b"X" + len(text).to_bytes(4, "little") + text.encode()


_RUN = _of_short("__import__('os').system('touch \"$PLANTED\"')")
_NO_LISTS = pickle.dumps(("CMakeLists.txt", [((5, "\0"), 5)], 5), 2)
PLANTED = {
    "a function of the system": b"cposix\nsystem\n" + _of_short('touch "$PLANTED"') + b"\x85R.",
    "builtins of a module of facts": b"cros_lint.base.tree\nitemgetter\n" + _of_short("eval") + b"\x85R"
    b"cros_lint.base.tree\n__builtins__\n\x85R" + _RUN + b"\x85R.",
    "a name with dots": b"\x80\x04"
    + b"".join(b"\x8c" + bytes([len(name)]) + name for name in (b"ros_lint.base.tree", b"os.system"))
    + b"\x93" + _of_short('touch "$PLANTED"') + b"\x85R.",
    "a class that has gone": b"cros_lint.facts.visibility\nGone\n)R.",
    "a class of a module that has gone": b"cros_lint.facts.gone\nGone\n)R.",
    "a text": pickle.dumps("text"),
    "a list of numbers": pickle.dumps([1, 2, 3]),
    "nothing": pickle.dumps(None),
    "an empty dictionary": pickle.dumps({}),
    "numbers by paths": pickle.dumps({"src/rover_driver/CMakeLists.txt": 5, 5: ((), 5)}),
    "no lists": _NO_LISTS,
    "an exabyte": b"\x80\x04\x8e" + (1 << 60).to_bytes(8, "little") + b"x.",
    "depth": b"(" * 100_000 + b"t" * 100_000 + b".",
    "an end in the middle": pickle.dumps(tuple(range(100)))[:-5],
    "garbage": b"\x80\x05garbage",
    "no bytes": b"",
}  # fmt: skip


@pytest.mark.parametrize("suffix", [".report", ".facts"])
@pytest.mark.parametrize("pickled", PLANTED.values(), ids=PLANTED)
def test_a_manipulated_cache_file_causes_a_run_and_is_overwritten(
    workspace: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, pickled: bytes, suffix: str
) -> None:
    monkeypatch.setenv("PLANTED", str(tmp_path / "planted"))
    runs = Runs(monkeypatch)
    expected = said(workspace)
    files = list((tmp_path / "cache" / "ros-lint").iterdir())
    for kept in files:
        state = kept.read_bytes().partition(b"\n")[0].rpartition(b" ")[0].decode()
        if kept.suffix == suffix:
            kept.write_bytes(kept_files._head(state, pickled) + b"\n" + pickled)
        elif kept.suffix == ".report":
            kept.unlink()  # so that the facts are read
    planted = {kept: kept.read_bytes() for kept in files if kept.suffix == suffix}
    assert (said(workspace), runs.count) == (expected, 2)
    assert not (tmp_path / "planted").exists()
    assert all(kept.read_bytes() != data for kept, data in planted.items())
    assert (said(workspace), runs.count) == (expected, 2)


def test_a_cache_folder_that_others_can_write_is_not_used(
    workspace: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    runs = Runs(monkeypatch)
    expected = said(workspace)
    folder = tmp_path / "cache" / "ros-lint"
    before = {path: path.read_bytes() for path in folder.iterdir()}
    folder.chmod(0o777)
    assert [said(workspace), said(workspace)] == [expected, expected]
    assert runs.count == 3
    assert {path: path.read_bytes() for path in folder.iterdir()} == before
    folder.chmod(0o700)
    assert (said(workspace), runs.count) == (expected, 3)


def test_the_oldest_reports_are_removed(workspace: Path, tmp_path: Path) -> None:
    for number in range(12):
        said(workspace, "--exclude", f"nothing{number}")
    kept = list((tmp_path / "cache" / "ros-lint").iterdir())
    assert [path.suffix for path in kept].count(".report") == 8

    tree, folder = DiskTree(str(workspace)), str(tmp_path / "other")
    source, new = f"{DRIVER}/src/driver_node.cpp", f"{DRIVER}/src/new.cpp"
    collect_all(tree, [source], 1, FactCache(folder, "ws"), lambda done: None)
    (facts,) = (tmp_path / "other").iterdir()
    assert source.encode() in facts.read_bytes()
    (workspace / source).rename(workspace / new)
    collect_all(tree, [new], 1, FactCache(folder, "ws"), lambda done: None)
    assert source.encode() not in facts.read_bytes()
    assert new.encode() in facts.read_bytes()


def again(tree: RecordedTree) -> RecordedTree:
    return RecordedTree(tree.disk)


def test_a_report_is_not_cached_if_a_file_changes_during_the_run(tmp_path: Path) -> None:
    recorded = RecordedTree(DiskTree(str(tmp_path)))
    with pytest.raises(FileNotFoundError):
        recorded.read("a")
    assert recorded.list("") == []
    assert again(recorded).is_unchanged(recorded.answers.items())
    (tmp_path / "a").write_text("x")
    assert not again(recorded).is_unchanged(recorded.answers.items())
    assert recorded.steady
    recorded.list("")
    assert not recorded.steady
    file = again(recorded)
    assert file.read("a") == b"x"
    os.utime(tmp_path / "a", ns=(1, 1))
    assert not again(file).is_unchanged(file.answers.items())


def test_answers_of_the_comparison_are_reused_in_the_run(tmp_path: Path) -> None:
    (tmp_path / "a").write_text("x")
    (tmp_path / "gone").mkdir()
    first = RecordedTree(DiskTree(str(tmp_path)))
    output = first.identity(""), first.list(""), first.list("gone"), first.stamp("a")
    (tmp_path / "gone").rmdir()
    second = again(first)
    assert second.identity("") == output[0]
    assert not second.is_unchanged(first.answers.items())
    assert second.list("") != output[1]
    with pytest.raises(FileNotFoundError) as raised:
        second.list("gone")
    with pytest.raises(FileNotFoundError) as real:
        second.disk.list("gone")
    assert (raised.value.errno, raised.value.strerror) == (real.value.errno, real.value.strerror)
    assert second.stamp("a") == output[3]
    assert second.steady
    assert set(second.answers) == {("identity", ""), ("list", ""), ("list", "gone"), ("stamp", "a")}
