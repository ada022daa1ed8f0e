"""Measure ros-lint on real workspaces, as ratios to a floor taken in the same rounds.

    python bench/run.py [--rounds N] [--jobs N] WORKSPACE...

The floor is the least that any tool with this job must do: walk the workspace and read every file that ros-lint reads.
CPU time is used and not the clock, because it stays within a few percent on a busy machine. Every round takes the floor
and all stages once; the figures are medians over the rounds.
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
    parser.add_argument("--jobs", type=int, default=1, help="processes of ros-lint (default: 1)")
    options = parser.parse_args()
    print("| workspace | packages | files read | floor | cold | warm | colcon list | peak memory |")
    print("|---|---|---|---|---|---|---|---|")
    for workspace in options.workspaces:
        print(row(os.path.abspath(workspace), options.rounds, options.jobs), flush=True)
    print(f"\n| start | to a bare interpreter |\n|---|---|\n{starts(options.rounds)}")
    return 0


def row(workspace: str, rounds: int, jobs: int) -> str:
    """Return the figures of a workspace as a line of a table."""
    quietly = ["--format", "json", "--output", os.devnull, "--fail-on", "never"]
    lint = [sys.executable, "-m", "ros_lint", workspace, "--jobs", str(jobs), *quietly]
    colcon = shutil.which("colcon")
    with tempfile.TemporaryDirectory() as cache:
        stages: dict[str, Callable[[], Cost]] = {
            "cold": lambda: spend([*lint, "--no-cache"], cache),
            "warm": lambda: spend(lint, cache),
        }
        if colcon:
            listing = [colcon, "--log-base", os.devnull, "list", "--base-paths", workspace]
            stages["colcon"] = lambda: spend(listing, cache)
        spend(lint, cache)  # fills the cache, and the pages of the system
        floors: list[float] = []
        costs: dict[str, list[Cost]] = {stage: [] for stage in stages}
        files = 0
        for _ in range(rounds):
            seconds, files = floor(workspace)
            floors.append(seconds)
            for stage, run in stages.items():
                costs[stage].append(run())
    ratios = {
        stage: statistics.median(cost.seconds / least for cost, least in zip(measured, floors, strict=True))
        for stage, measured in costs.items()
    }
    memory = max(cost.memory for cost in costs["cold"]) / 2**20
    cells = [
        os.path.basename(workspace),
        str(packages(workspace)),
        str(files),
        f"{statistics.median(floors) * 1000:.1f} ms",
        f"{ratios['cold']:.1f}×",
        f"{ratios['warm']:.1f}×",
        f"{ratios['colcon']:.1f}×" if colcon else "–",
        f"{memory:.0f} MB",
    ]
    return f"| {' | '.join(cells)} |"


def floor(workspace: str) -> tuple[float, int]:
    """Walk a workspace and read what ros-lint reads. Returns CPU seconds and the number of files."""
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
                    count += read(entry.path)
    return time.process_time() - start, count


def read(path: str) -> int:
    """Read a file and throw it away. Returns 1, or 0 when it cannot be read."""
    try:
        handle = os.open(path, os.O_RDONLY)
    except OSError:
        return 0
    while len(os.read(handle, 1 << 16)) == 1 << 16:
        pass
    os.close(handle)
    return 1


def spend(command: Sequence[str], cache: str) -> Cost:
    """Run a command with the cache folder given, and return what it cost."""
    environment = {**os.environ, "XDG_CACHE_HOME": cache}
    environment.pop("PYTHONDONTWRITEBYTECODE", None)  # a checkout would be compiled anew in every run
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    process = subprocess.Popen(command, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    _, _, used = os.wait4(process.pid, 0)
    process.returncode = 0
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return Cost(seconds, used.ru_maxrss * 1024)


def packages(workspace: str) -> int:
    """Return how many packages ros-lint finds."""
    command = [sys.executable, "-m", "ros_lint", "check", workspace, "--format", "json", "--fail-on", "never"]
    output = subprocess.run(command, capture_output=True, check=False).stdout
    return int(json.loads(output)["packages"])


def starts(rounds: int) -> str:
    """Return the cost of starting, as lines of a table."""
    commands = {"--version": ["--version"], "--help": ["--help"]}
    bare = [sys.executable, "-c", "pass"]
    ratios: dict[str, list[float]] = {name: [] for name in commands}
    for _ in range(rounds * 4):
        least = spend(bare, "").seconds
        for name, arguments in commands.items():
            ratios[name].append(spend([sys.executable, "-m", "ros_lint", *arguments], "").seconds / least)
    return "\n".join(f"| {name} | {statistics.median(values):.1f}× |" for name, values in ratios.items())


if __name__ == "__main__":
    sys.exit(main())
