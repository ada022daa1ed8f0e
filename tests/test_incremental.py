"""Tests that an incremental check after any edit gives the result of a check from scratch."""

from __future__ import annotations

import os
import random
from pathlib import Path

import pytest

from ros_lint.base.text import to_bytes
from ros_lint.testing import read_cases
from tests.random_edits import Comparison, Files, files_below, first_difference

FIXTURES = Path(__file__).parent.parent / "fixtures"
_FOLDER = os.environ.get("ROS_LINT_EDITED", "")
_EDITS = int(os.environ.get("ROS_LINT_EDITS", "100"))
_SEED = int(os.environ.get("ROS_LINT_SEED", "1"))


def _several_cases(seed: int) -> Files:
    """Return the files of some cases of rules, each in a folder of its own."""
    sources = sorted(FIXTURES.glob("*.md"))
    chosen = random.Random(seed)
    cases = [chosen.choice(list(read_cases(chosen.choice(sources)))) for _ in range(6)]
    return {f"{chosen.choice('abc')}/{path}": to_bytes(text) for case in cases for path, text in case.files.items()}


@pytest.mark.parametrize("seed", range(8))
def test_edits_of_cases_are_checked_incrementally(seed: int) -> None:
    assert not first_difference(Comparison(_several_cases(seed), explicit=seed % 2 == 0), seed, 10)


@pytest.mark.skipif(not _FOLDER, reason="ROS_LINT_EDITED is not set")
def test_edits_of_a_real_workspace_are_checked_incrementally() -> None:
    comparison = Comparison(files_below(_FOLDER))
    assert not first_difference(comparison, _SEED, _EDITS)
