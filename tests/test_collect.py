"""The number of processes that read files."""

from __future__ import annotations

import concurrent.futures
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import Any

import pytest

from ros_lint.base.tree import DiskTree
from ros_lint.workspace import collect
from ros_lint.workspace.cache.facts import FactCache
from ros_lint.workspace.cache.file import NO_CACHE
from ros_lint.workspace.collect import collect_all


class Pool:
    """Does the work of a ProcessPoolExecutor in this process, and records the requested number of processes."""

    requested: list[int] = []  # noqa: RUF012

    def __init__(self, processes: int) -> None:
        self.requested.append(processes)

    def __enter__(self) -> Pool:
        return self

    def __exit__(self, *_: object) -> None:
        pass

    def map(self, function: Callable[..., Any], *arguments: Iterable[Any]) -> Iterator[Any]:
        return map(function, *arguments)


@pytest.mark.parametrize(
    ("cores", "jobs", "files", "processes"),
    [
        (4, 2000, 200, 4),
        (4, 10**18, 200, 4),
        (4, 3, 200, 3),
        (4, 0, 200, 1),
        (64, 2000, 200, 10),  # of 20 files each
        (64, 2000, 6, 1),
        (200, 200, 2000, 61),
        (1, 8, 200, 1),
    ],
)
def test_at_most_one_process_per_core_is_used(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, cores: int, jobs: int, files: int, processes: int
) -> None:
    monkeypatch.setattr(collect, "available_cores", lambda: cores)
    monkeypatch.setattr(concurrent.futures, "ProcessPoolExecutor", Pool)
    monkeypatch.setattr(Pool, "requested", [])
    names = [f"{number}.cpp" for number in range(files)]
    for name in names:
        (tmp_path / name).write_text("#include <a/b.hpp>\n")
    collected = collect_all(DiskTree(str(tmp_path)), names, jobs, FactCache(NO_CACHE), lambda finished: None)
    assert list(collected) == names
    assert (Pool.requested or [1]) == [processes]
