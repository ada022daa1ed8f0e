"""Garbage collection around large models."""

from __future__ import annotations

import gc
import shutil
from collections.abc import Iterator
from pathlib import Path

import pytest

from ros_lint.base import garbage
from ros_lint.cli.commands.lsp.project import Project

_DEMO = Path(__file__).parents[1] / "fixtures/workspaces/demo"


@pytest.fixture(autouse=True)
def _released() -> Iterator[None]:
    yield
    gc.unfreeze()


@pytest.mark.parametrize("enabled", [True, False])
def test_collections_are_paused_and_then_as_before(enabled: bool) -> None:
    before = gc.isenabled()
    (gc.enable if enabled else gc.disable)()
    try:
        with garbage.paused():
            assert not gc.isenabled()
        assert gc.isenabled() is enabled
    finally:
        (gc.enable if before else gc.disable)()


def test_the_model_of_a_project_is_left_out_of_collections(tmp_path: Path) -> None:
    shutil.copytree(_DEMO, tmp_path / "demo")
    project = Project(str(tmp_path / "demo"), {"cache": False}, {"HOME": str(tmp_path)}, lambda step, finished, total: None)
    packages = project.check({}).workspace.packages
    assert gc.get_freeze_count()
    assert not any(package is tracked for tracked in gc.get_objects() for package in packages)
    project.reopen()
    assert not gc.get_freeze_count()
