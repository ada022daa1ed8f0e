"""Measure the time of ros-lint on real workspaces, as ratios to a floor that is measured in the same rounds.

    python bench/run.py [--rounds N] [--jobs N] WORKSPACE...

The floor is the work that every such tool has to do: walk the workspace and read each file that ros-lint reads. CPU time is
measured instead of elapsed time, because on a busy machine it varies by a few percent only. Each round measures the floor
and all stages once. The figures are medians over the rounds.
"""

from __future__ import annotations

import argparse
import json
import os
import resource
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Sequence
from typing import NamedTuple

from ros_lint.collectors.file_types import kind_of

SKIPPED = frozenset({".git", "__pycache__", "node_modules"})


class Cost(NamedTuple):
    """CPU seconds of a process with its children, and its peak memory in bytes."""

    seconds: float
    memory: int


def main() -> int:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("workspaces", nargs="+")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--jobs", type=int, default=1, help="number of processes of ros-lint (default: 1)")
    options = parser.parse_args()
    print("| workspace | packages | files read | floor | cold | warm | colcon list | peak memory |")
    print("|---|---|---|---|---|---|---|---|")
    for workspace in options.workspaces:
        print(table_row(os.path.abspath(workspace), options.rounds, options.jobs), flush=True)
    print(f"\n| start | ratio to a bare interpreter |\n|---|---|\n{start_rows(options.rounds)}")
    return 0


def table_row(workspace: str, rounds: int, jobs: int) -> str:
    """Return the figures of a workspace as a row of a Markdown table."""
    without_output = ["--format", "json", "--output", os.devnull, "--fail-on", "never"]
    lint = [sys.executable, "-m", "ros_lint", workspace, "--jobs", str(jobs), *without_output]
    colcon = shutil.which("colcon")
    with tempfile.TemporaryDirectory() as cache:
        stages: dict[str, Callable[[], Cost]] = {
            "cold": lambda: measure([*lint, "--no-cache"], cache),
            "warm": lambda: measure(lint, cache),
        }
        if colcon:
            listing = [colcon, "--log-base", os.devnull, "list", "--base-paths", workspace]
            stages["colcon"] = lambda: measure(listing, cache)
        measure(lint, cache)  # fills the cache of ros-lint and the page cache of the system
        floors: list[float] = []
        costs: dict[str, list[Cost]] = {stage: [] for stage in stages}
        files = 0
        for _ in range(rounds):
            seconds, files = measure_floor(workspace)
            floors.append(seconds)
            for stage, run in stages.items():
                costs[stage].append(run())
    ratios = {
        stage: statistics.median(cost.seconds / floor_seconds for cost, floor_seconds in zip(measured, floors, strict=True))
        for stage, measured in costs.items()
    }
    memory = max(cost.memory for cost in costs["cold"]) / 2**20
    cells = [
        os.path.basename(workspace),
        str(count_packages(workspace)),
        str(files),
        f"{statistics.median(floors) * 1000:.1f} ms",
        f"{ratios['cold']:.1f}×",
        f"{ratios['warm']:.1f}×",
        f"{ratios['colcon']:.1f}×" if colcon else "–",
        f"{memory:.0f} MB",
    ]
    return f"| {' | '.join(cells)} |"


def measure_floor(workspace: str) -> tuple[float, int]:
    """Walk a workspace and read the files that ros-lint reads. Returns CPU seconds and the number of files."""
    start = time.process_time()
    count = 0
    folders = [workspace]
    while folders:
        with os.scandir(folders.pop()) as entries:
            for entry in entries:
                if entry.is_dir(follow_symlinks=False):
                    if entry.name not in SKIPPED:
                        folders.append(entry.path)
                elif kind_of(entry.name):
                    count += read_file(entry.path)
    return time.process_time() - start, count


def read_file(path: str) -> int:
    """Read a file and discard its contents. Returns 1, or 0 if it cannot be read."""
    try:
        handle = os.open(path, os.O_RDONLY)
    except OSError:
        return 0
    while len(os.read(handle, 1 << 16)) == 1 << 16:
        pass
    os.close(handle)
    return 1


def measure(command: Sequence[str], cache: str) -> Cost:
    """Run a command with a cache folder. Returns its cost."""
    environment = {**os.environ, "XDG_CACHE_HOME": cache}
    environment.pop("PYTHONDONTWRITEBYTECODE", None)  # otherwise Python would compile ros-lint in every run
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    process = subprocess.Popen(command, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    _, _, used = os.wait4(process.pid, 0)
    process.returncode = 0
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return Cost(seconds, used.ru_maxrss * 1024)


def count_packages(workspace: str) -> int:
    """Return the number of packages that ros-lint finds in a workspace."""
    command = [sys.executable, "-m", "ros_lint", "check", workspace, "--format", "json", "--fail-on", "never"]
    output = subprocess.run(command, capture_output=True, check=False).stdout
    return int(json.loads(output)["packages"])


def start_rows(rounds: int) -> str:
    """Return the cost of starting ros-lint, as rows of a Markdown table."""
    commands = {"--version": ["--version"], "--help": ["--help"]}
    bare = [sys.executable, "-c", "pass"]
    ratios: dict[str, list[float]] = {name: [] for name in commands}
    for _ in range(rounds * 4):
        floor_seconds = measure(bare, "").seconds
        for name, arguments in commands.items():
            ratios[name].append(measure([sys.executable, "-m", "ros_lint", *arguments], "").seconds / floor_seconds)
    return "\n".join(f"| {name} | {statistics.median(values):.1f}× |" for name, values in ratios.items())


if __name__ == "__main__":
    sys.exit(main())
