"""Tests that findings which are kept from one run to the next are those of a run from scratch."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from ros_lint.analysis.finding import Finding
from ros_lint.base.columns import Codec
from ros_lint.base.recorded_tree import RecordedTree
from ros_lint.base.text import file_start
from ros_lint.base.tree import MachineTree, MemoryTree
from ros_lint.engine import registry
from ros_lint.engine.kept_findings import KeptFindings, _Kept, _KeptFinding
from ros_lint.engine.run import find_issues
from ros_lint.engine.shared_answers import SharedAnswers
from ros_lint.knowledge import Knowledge
from ros_lint.workspace.cache.file import CacheFile
from ros_lint.workspace.loader import Loader
from ros_lint.workspace.target import TargetDistro
from tests.packages import manifest_text
from tests.random_edits import Edits, Files, files_below, several_cases

_KNOWLEDGE = Knowledge("jazzy")
_RULES = registry.load(())
_DEMO = Path(__file__).parent.parent / "fixtures" / "workspaces" / "demo"
_FOLDER = os.environ.get("ROS_LINT_EDITED", "")
_EDITS = int(os.environ.get("ROS_LINT_EDITS", "100"))
_SEED = int(os.environ.get("ROS_LINT_SEED", "1"))


def _loader(files: Files, *, again: bool) -> Loader:
    return Loader(MemoryTree(files), ("",), TargetDistro("jazzy", "test"), knowledge=_KNOWLEDGE, again=again)


def _issues(loader: Loader) -> list[str]:
    return [f"{issue.rule.code} {issue.package} {issue.finding}" for issue in _checked(loader)]


def _checked(loader: Loader) -> tuple[object, ...]:
    return find_issues(loader.load_all(), _RULES, loader.suppressions(), _RULES).issues


class _Run:
    """One run of ros-lint with findings that the last run has kept."""

    def __init__(self, files: Files, cache: CacheFile, findings: str = "findings-test") -> None:
        machine = RecordedTree(MachineTree())
        loader = _loader(files, again=True)
        loader.load_all()
        kept = KeptFindings(cache, findings, machine)
        if loader.recorded:
            kept.restore(loader.recorded[1], _RULES)
        self.restored = kept.places
        self.issues = _issues(loader)
        if loader.recorded:
            kept.store(*loader.recorded, _RULES)


def _first_difference(files: Files, cache: CacheFile, seed: int, count: int) -> str:
    edits, kept = Edits(seed), 0
    done: list[str] = []
    for _ in range(count):
        run = _Run(files, cache)
        kept += len(run.restored)
        if run.issues != (expected := _issues(_loader(files, again=False))):
            return "\n".join([*done[-4:], *(set(run.issues) ^ set(expected))])
        changes, description = edits.next(files)
        done.append(description)
        files = {path: data for path, data in {**files, **changes}.items() if data is not None}
    return "" if kept else "nothing was kept"


@pytest.mark.parametrize("seed", range(4))
def test_kept_findings_are_those_of_a_run_from_scratch(seed: int, tmp_path: Path) -> None:
    cache = CacheFile(str(tmp_path / "cache"), str(tmp_path))
    assert not _first_difference({**files_below(str(_DEMO)), **several_cases(seed, 1)}, cache, seed, 10)


@pytest.mark.skipif(not _FOLDER, reason="ROS_LINT_EDITED is not set")
def test_kept_findings_of_a_real_workspace_are_those_of_a_run_from_scratch(tmp_path: Path) -> None:
    cache = CacheFile(str(tmp_path / "cache"), str(tmp_path))
    assert not _first_difference(files_below(_FOLDER), cache, _SEED, _EDITS)


_FINDING = Finding("x", file_start("x"), "x")
_A = manifest_text("a", ["<depend>rclcpp</depend>"]).encode()
_FILES: Files = {
    "a/package.xml": _A,
    "a/CMakeLists.txt": b"find_package(ament_cmake REQUIRED)\nfind_package(rclcpp REQUIRED)\nament_package()\n",
    "a/src/x.cpp": b"#include <tf2_ros/buffer.h>\n",
    "b/package.xml": manifest_text("b", ["<depend>a</depend>"]).encode(),
    "c/package.xml": manifest_text("c").encode(),
}


def test_only_places_that_have_read_a_changed_part_are_checked_again(tmp_path: Path) -> None:
    cache = CacheFile(str(tmp_path / "cache"), str(tmp_path))
    assert not _Run(_FILES, cache).restored
    everything = _Run(_FILES, cache).restored
    assert {"a", "b", "c"} < everything
    assert _Run({**_FILES, "a/src/x.cpp": b"#include <tf2_ros/buffer.h>\n// comment\n"}, cache).restored == everything
    restored = _Run({**_FILES, "a/src/x.cpp": b"\n#include <tf2_ros/buffer.h>\n"}, cache).restored
    assert "a" not in restored
    assert "c" in restored


def test_shared_answers_of_each_kind_have_names_that_give_their_values() -> None:
    loader = _loader(_FILES, again=True)
    loader.load_all()
    _checked(loader)
    assert loader.recorded is not None
    recorder, handles = loader.recorded
    shared = SharedAnswers(handles)
    values = {answer: value for _, answer, value in recorder.answers(handles.workspace.memo)}
    named = {name: values[answer] for answer, name in shared.named(recorder)}
    assert {name.split(" ")[2] for name in named} == {"workspace", "package", "name"}
    assert {name.partition(" package ")[2] for name in named} == {"", "a", "b", "c"}
    for name, value in named.items():
        assert shared.value(name) == (value[1] if isinstance(value, tuple) and " package " in name else value), name


def test_findings_of_other_options_are_not_used(tmp_path: Path) -> None:
    cache = CacheFile(str(tmp_path / "cache"), str(tmp_path))
    _Run(_FILES, cache, "findings-first")
    assert not _Run(_FILES, cache, "findings-second").restored


def test_manipulated_records_are_not_used(tmp_path: Path) -> None:
    cache = CacheFile(str(tmp_path / "cache"), str(tmp_path))
    expected = _Run(_FILES, cache).issues
    codec = Codec(_Kept)
    kept = cache.read(lambda name: name == "findings-test", codec)["findings-test"]
    first, *others = kept.places
    for crafted in (
        kept._replace(inputs=kept.inputs[:1]),
        kept._replace(inputs=(kept.inputs[0]._replace(reads=b"\0" * 4), *kept.inputs[1:])),
        kept._replace(places=(first._replace(reads=b"x"), *others)),
        *(
            kept._replace(inputs=tuple(entry._replace(name=name) for entry in kept.inputs))
            for name in (
                "",
                "x",
                "field x a",
                "field 999 a",
                "answer",
                "answer x:y package a",
                "answer x:y",
                "world \0",
                "name x \0",
            )
        ),
        kept._replace(places=(first._replace(reads=b"\xff" * 4), *others)),
        kept._replace(places=tuple(place._replace(found=(_KeptFinding("x", "", _FINDING),)) for place in kept.places)),
    ):
        cache.write({"findings-test": crafted}, codec, lambda names: ())
        run = _Run(_FILES, cache)
        assert not run.restored
        assert run.issues == expected
