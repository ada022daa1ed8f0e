"""A cached report equals that of a run, and each change that affects the report causes a run."""

from __future__ import annotations

import errno
import os
import pickle
import shutil
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from ros_lint.base.columns import Codec
from ros_lint.base.recorded_tree import RecordedTree
from ros_lint.base.tree import DiskTree
from ros_lint.cli.main import main
from ros_lint.engine.kept_findings import KeptFindings
from ros_lint.engine.report_cache import _CachedReport
from ros_lint.reporters import FORMATS
from ros_lint.workspace.cache import layout
from ros_lint.workspace.cache.facts import CachedFacts
from ros_lint.workspace.loader import Loader

pytestmark = pytest.mark.slow

DEMO = Path(__file__).parent.parent / "fixtures" / "workspaces" / "demo"


class Runs:
    """Counts how often a workspace is loaded."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.count = 0
        load = Loader.load_all

        def counted(loader: Loader, *args: object, **options: object) -> object:
            self.count += 1
            return load(loader, *args, **options)  # type: ignore[arg-type]

        monkeypatch.setattr(Loader, "load_all", counted)


@pytest.fixture
def workspace(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path / "data"))
    target = tmp_path / "ws"
    shutil.copytree(DEMO, target)
    (target / "src" / "here").symlink_to("nowhere")
    for name, package in (("a", "nav_msgs"), ("b", "std_srvs")):
        (target / f"{name}.cpp").write_text(f"#include <{package}/srv/x.hpp>\n")
        os.utime(target / f"{name}.cpp", ns=(1, 1))
    (target / "src" / "rover_driver" / "src" / "linked.cpp").symlink_to("../../../a.cpp")
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
    link.symlink_to("../../../b.cpp")


CHANGES: dict[str, Callable[[Path], object]] = {
    "a source": _append(f"{DRIVER}/src/driver_node.cpp", "#include <tf2_ros/buffer.hpp>\n"),
    "a source with the time that it had": _same_stamp,
    "a link that leads to the like": _swap,
    "a manifest": _append(f"{DRIVER}/package.xml", "<!-- the end -->"),
    "a build script": _append(f"{DRIVER}/CMakeLists.txt", "find_package(nav_msgs REQUIRED)\n"),
    "a file that is not read": _write(f"{DRIVER}/docs/more/notes.txt", "x"),
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
    _write("src/shared/COLCON_IGNORE", "")(workspace)  # so that only one package reads it
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


def of_reports(name: str) -> bool:
    return name.startswith("report-")


def of_facts(name: str) -> bool:
    return name.startswith("facts-")


def cache_file(workspace: Path) -> Path:
    (file,) = (workspace.parent / "cache" / "ros-lint").iterdir()
    return file


def records(workspace: Path) -> dict[str, bytes]:
    return layout.read(str(cache_file(workspace)), lambda name: True)


class Planted:
    """Creates a folder when it is unpickled."""

    def __reduce__(self) -> tuple[object, ...]:
        return os.mkdir, ("planted",)


def _report(codec: Codec[_CachedReport], data: bytes, **changes: object) -> bytes:
    """Return a report whose answers are changed."""
    cached = codec.decode(data)
    answers = cached.answers[0]._replace(**changes)
    return codec.encode(cached._replace(answers=(answers, *cached.answers[1:])))


_REPORTS: Codec[_CachedReport] = Codec(_CachedReport)
_FACTS: Codec[tuple[CachedFacts, ...]] = Codec(tuple[CachedFacts, ...])
DAMAGED: dict[str, Callable[[bytes], bytes]] = {
    "a pickle": lambda data: pickle.dumps(Planted()),
    "no bytes": lambda data: b"",
    "garbage": lambda data: b"garbage" * 100,
    "an end in the middle": lambda data: data[: len(data) // 2],
    "further bytes": lambda data: data + b"0",
    "an exabyte": lambda data: (1 << 60).to_bytes(8, "little") + data[8:],
    "another type": lambda data: Codec(tuple[str, ...]).encode(("src", "x")),
}
PLANTED_REPORTS: dict[str, Callable[[bytes], bytes]] = {
    "a path with NUL": lambda data: _report(_REPORTS, data, errors=(("a\0b", "stamp", errno.EACCES),)),
    "stamps without files": lambda data: _report(_REPORTS, data, files=()),
    "files without stamps": lambda data: _report(_REPORTS, data, stamps=b""),
    "half of a stamp": lambda data: _report(_REPORTS, data, stamps=b"12345678", files=("src",)),
    "files without digests": lambda data: _report(_REPORTS, data, digests=b"", settled=b""),
    "no trees": lambda data: _REPORTS.encode(_REPORTS.decode(data)._replace(answers=())),
}


def plant(workspace: Path, chosen: Callable[[str], bool], change: Callable[[bytes], bytes]) -> None:
    """Change some records of the cache file, with correct checksums, and remove the report so that facts are read."""
    changed = {name: change(data) if chosen(name) else data for name, data in records(workspace).items()}
    file = cache_file(workspace)
    file.write_bytes(layout._pack({name: data for name, data in changed.items() if chosen(name) or not of_reports(name)}))
    file.chmod(0o600)


@pytest.mark.parametrize("chosen", [of_reports, of_facts])
@pytest.mark.parametrize("change", DAMAGED.values(), ids=DAMAGED)
def test_damaged_records_cause_a_run_and_are_replaced(
    workspace: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    change: Callable[[bytes], bytes],
    chosen: Callable[[str], bool],
) -> None:
    monkeypatch.chdir(workspace.parent)
    runs = Runs(monkeypatch)
    expected = said(workspace)
    plant(workspace, chosen, change)
    assert capsys.readouterr().err == ""
    assert (said(workspace), runs.count) == (expected, 2)
    assert (
        capsys.readouterr().err
        == f"ros-lint: the cached results are not used, so this run is slower: '{cache_file(workspace)}': damaged\n"
    )
    assert not (workspace.parent / "planted").exists()
    assert (said(workspace), runs.count) == (expected, 2)
    assert capsys.readouterr().err == ""


@pytest.mark.parametrize("change", PLANTED_REPORTS.values(), ids=PLANTED_REPORTS)
def test_planted_reports_are_not_used(workspace: Path, monkeypatch: pytest.MonkeyPatch, change: Callable[[bytes], bytes]) -> None:
    runs = Runs(monkeypatch)
    expected = said(workspace)
    plant(workspace, of_reports, change)
    assert (said(workspace), runs.count) == (expected, 2)
    assert (said(workspace), runs.count) == (expected, 2)


def test_planted_facts_are_not_used(workspace: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def change(data: bytes) -> bytes:
        facts = _FACTS.decode(data)
        return _FACTS.encode((*facts, facts[0]._replace(path="a\0b"), facts[0]._replace(path="../../etc/passwd")))

    runs = Runs(monkeypatch)
    expected = said(workspace)
    plant(workspace, of_facts, change)
    assert (said(workspace), runs.count) == (expected, 2)


def test_a_new_clone_with_the_same_contents_causes_no_run(workspace: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    runs = Runs(monkeypatch)
    expected = said(workspace)
    shutil.copytree(workspace, workspace.parent / "copy", symlinks=True, copy_function=shutil.copy)
    shutil.rmtree(workspace)
    (workspace.parent / "copy").rename(workspace)
    assert (said(workspace), runs.count) == (expected, 1)


def test_a_change_within_a_tick_of_the_clock_causes_a_run(workspace: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The test sets the modification time back and ignores the change time, as if both changes had the same times."""
    stamp = DiskTree.stamp
    monkeypatch.setattr(DiskTree, "stamp", lambda self, path: stamp(self, path)._replace(changed=0))
    source = workspace / DRIVER / "src" / "driver_node.cpp"
    source.write_text(source.read_text())
    runs = Runs(monkeypatch)
    said(workspace)
    _same_stamp(workspace)
    assert said(workspace) == said(workspace, "--no-cache")
    assert runs.count == 3


def test_findings_are_kept_from_the_second_run_on(workspace: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    valid: list[int] = []
    restore = KeptFindings.restore

    def counted(kept: KeptFindings, *args: object) -> None:
        restore(kept, *args)  # type: ignore[arg-type]
        valid.append(len(kept.places))

    monkeypatch.setattr(KeptFindings, "restore", counted)
    source = workspace / "src" / "rover_driver" / "src" / "kept.cpp"
    for number in range(3):
        source.write_text(f"#include <tf2_ros/buffer.h>\n// {number}\n")
        assert said(workspace) == said(workspace, "--no-cache")
    assert len(valid) == 2
    assert not valid[0]
    assert valid[1]


def test_contents_are_compared_only_until_the_stamps_are_settled(workspace: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    runs = Runs(monkeypatch)
    for path in workspace.rglob("*"):
        if path.is_file():
            path.touch()
    expected = said(workspace)
    now = time.time_ns
    monkeypatch.setattr(time, "time_ns", lambda: now() + 10_000_000_000)
    before = records(workspace)
    assert said(workspace) == expected
    assert records(workspace) != before
    monkeypatch.setattr("ros_lint.base.recorded_tree.has_contents", lambda *_: 1 / 0)
    assert (said(workspace), runs.count) == (expected, 1)


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


def test_the_oldest_reports_are_removed(workspace: Path) -> None:
    for number in range(12):
        said(workspace, "--exclude", f"nothing{number}")
    assert sum(map(of_reports, records(workspace))) == 8


def test_reports_of_another_version_are_removed(workspace: Path) -> None:
    said(workspace)
    (report,) = filter(of_reports, records(workspace))
    _write("data/ros-lint/index/new.txt", "")(workspace.parent)
    said(workspace)
    (other,) = filter(of_reports, records(workspace))
    assert report != other


def test_a_full_disk_is_noted(workspace: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    def fail(*_: object) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(layout, "replace", fail)
    expected = said(workspace)
    assert "ros-lint: the results are not cached, so the next run is slower: '" in capsys.readouterr().err
    assert main(["graph", str(workspace), "--distro", "jazzy"]) == 0
    assert main(["why", "rover_driver", "sensor_msgs", "-C", str(workspace), "--distro", "jazzy"]) == 1
    assert capsys.readouterr().err.count("No space left on device") == 1
    monkeypatch.undo()
    monkeypatch.setenv("XDG_CACHE_HOME", str(workspace.parent / "cache"))
    monkeypatch.setenv("XDG_DATA_HOME", str(workspace.parent / "data"))
    assert said(workspace) == expected


def again(tree: RecordedTree) -> RecordedTree:
    return RecordedTree(tree.disk)


def test_a_report_is_not_cached_if_a_file_changes_during_the_run(tmp_path: Path) -> None:
    recorded = RecordedTree(DiskTree(str(tmp_path)))
    with pytest.raises(FileNotFoundError):
        recorded.read("a")
    assert recorded.list("") == []
    assert again(recorded).is_unchanged(recorded.answers)
    (tmp_path / "a").write_text("x")
    assert not again(recorded).is_unchanged(recorded.answers)
    assert recorded.steady
    recorded.list("")
    assert not recorded.steady
    file = again(recorded)
    assert file.read("a") == b"x"
    os.utime(tmp_path / "a", ns=(1, 1))
    assert again(file).is_unchanged(file.answers)
    (tmp_path / "a").write_text("y")
    assert not again(file).is_unchanged(file.answers)
    file.read("a")
    assert not file.steady


def test_answers_of_the_comparison_are_reused_in_the_run(tmp_path: Path) -> None:
    (tmp_path / "a").write_text("x")
    (tmp_path / "gone").mkdir()
    first = RecordedTree(DiskTree(str(tmp_path)))
    output = first.identity(""), first.list(""), first.list("gone"), first.stamp("a")
    (tmp_path / "gone").rmdir()
    second = again(first)
    assert second.identity("") == output[0]
    assert not second.is_unchanged(first.answers)
    assert second.list("") != output[1]
    with pytest.raises(FileNotFoundError) as raised:
        second.list("gone")
    with pytest.raises(FileNotFoundError) as real:
        second.disk.list("gone")
    assert (raised.value.errno, raised.value.strerror) == (real.value.errno, real.value.strerror)
    assert second.stamp("a") == output[3]
    assert second.steady
    answers = second.answers
    assert answers.lists == (("", "a/file"),)
    assert answers.files == ("a",)
    assert answers.identities == (("", str(tmp_path)),)
    assert answers.errors == (("gone", "list", errno.ENOENT),)
