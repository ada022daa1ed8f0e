"""Tests that an incremental check after any edit gives the result of a check from scratch."""

from __future__ import annotations

import os

import pytest

from ros_lint.base.tree import MemoryTree
from ros_lint.knowledge import Knowledge
from ros_lint.workspace.loader import Loader
from ros_lint.workspace.state import DistroData
from ros_lint.workspace.target import TargetDistro
from tests.packages import manifest_text
from tests.random_edits import Comparison, EditedTree, files_below, first_difference, several_cases

_FOLDER = os.environ.get("ROS_LINT_EDITED", "")
_EDITS = int(os.environ.get("ROS_LINT_EDITS", "100"))
_SEED = int(os.environ.get("ROS_LINT_SEED", "1"))


@pytest.mark.parametrize("seed", range(8))
def test_edits_of_cases_are_checked_incrementally(seed: int) -> None:
    distros = ("jazzy", "humble") if seed % 4 > 1 else ("jazzy",)
    assert not first_difference(Comparison(several_cases(seed), *distros, explicit=seed % 2 == 0), seed, 10)


def test_a_load_without_sources_between_two_loads_loses_no_change() -> None:
    tree = EditedTree({"a/package.xml": manifest_text("a").encode()})
    targets = [TargetDistro(name, "test") for name in ("jazzy", "humble")]
    loader = Loader(tree, ("",), targets[0], others=[DistroData(targets[1], Knowledge("humble"))], again=True)
    loader.load(sources=False)
    before = loader.load_all()
    tree.now = MemoryTree({"a/package.xml": manifest_text("a", ["<depend>rclcpp</depend>"]).encode()})
    loader.forget(["a/package.xml"])
    assert [use.name for use in loader.load(sources=False).packages[0].declared] == ["rclcpp"]
    assert loader.load() is before[0]
    for workspace in loader.load_all():
        assert [use.name for use in workspace.packages[0].declared] == ["rclcpp"]


def test_a_package_that_comes_back_has_the_facts_of_its_files_as_they_are_then() -> None:
    inner = {"a/b/package.xml": manifest_text("b").encode(), "a/b/CMakeLists.txt": b"project(b)\nunknown_function()\n"}
    comparison = Comparison(inner)
    comparison.apply({"a/package.xml": manifest_text("a").encode()})  # colcon searches no packages in packages
    assert comparison.incremental() == comparison.from_scratch()
    comparison.apply({"a/b/CMakeLists.txt": b"project(b)\nother_function()\n"})
    assert comparison.incremental() == comparison.from_scratch()
    comparison.apply({"a/package.xml": None})
    assert comparison.incremental() == comparison.from_scratch()


@pytest.mark.skipif(not _FOLDER, reason="ROS_LINT_EDITED is not set")
def test_edits_of_a_real_workspace_are_checked_incrementally() -> None:
    comparison = Comparison(files_below(_FOLDER))
    assert not first_difference(comparison, _SEED, _EDITS)
