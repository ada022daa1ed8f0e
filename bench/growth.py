"""Measure how the time of ros-lint grows with the elements of a workspace, as exponents of doubled sizes.

    python -m bench.growth [--most N] [--only TEXT]

Each ladder is a small workspace with N elements of one kind in one file. The whole of ros-lint checks it in a process of its
own. The exponent is the slope of time over size in logarithms, over the last two doublings: 1 is linear, 2 is quadratic.
The time of a workspace without elements is subtracted first. CPU time is measured, because the machine may be busy.
"""

from __future__ import annotations

import argparse
import gc
import math
import os
import resource
import sys
import tempfile
from collections.abc import Callable, Iterable, Sequence
from contextlib import redirect_stdout, suppress
from pathlib import Path

from bench.ladders import LADDERS, OPTIONS, Files
from ros_lint.cli.main import main as start

WANTED = 1.2
"""The largest exponent that passes."""
SECONDS = 60
"""Of CPU time: a workspace that takes longer ends its ladder."""
STEPS = 3
"""How often the number of elements is doubled."""
MOST = {"launch.py": 2_000, "setup.py: unknown": 4_000}
"""The greatest number of elements where it is less than the default, because longer files are not read."""
AS_JSON = ("--format", "json")
"""The options of a check if the ladder has none of its own."""
SHORT = 0.05
"""Seconds: shorter times are noise, so a ladder that stays below has no exponent."""


def write(files: Files, root: Path) -> None:
    for name, text in files.items():
        path = root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)


def check(folder: str, options: Sequence[str] = AS_JSON) -> None:
    """Check a workspace in this process, and discard the report."""
    usual = ["--no-cache", "--isolated", "--jobs", "1", "--distro", "jazzy", "--fail-on", "never"]
    with suppress(SystemExit), open(os.devnull, "w", encoding="utf-8") as nowhere, redirect_stdout(nowhere):
        start([folder, *usual, *options])


def cost(files: Files, options: Sequence[str]) -> tuple[float, float]:
    """Return the CPU seconds and the peak memory in MB of a check. The time is infinite if the check takes too long or fails."""
    with tempfile.TemporaryDirectory() as folder:
        write(files, Path(folder))
        child = os.fork()
        if child == 0:
            gc.disable()  # as in a run from the command line
            resource.setrlimit(resource.RLIMIT_CPU, (SECONDS, SECONDS))
            check(folder, options)
            os._exit(0)
        _, status, used = os.wait4(child, 0)
    return (used.ru_utime + used.ru_stime if status == 0 else math.inf), used.ru_maxrss / 1024


def ladder(build: Callable[[int], Files], sizes: Iterable[int], options: Sequence[str]) -> tuple[list[float], float]:
    """Return the seconds for each size beyond those of a single element, and the largest memory."""
    floor_seconds, memory = cost(build(1), options)
    seconds: list[float] = []
    for size in sizes:
        taken, needed = cost(build(size), options)
        seconds.append(taken - floor_seconds)
        memory = max(memory, needed)
        if math.isinf(taken):
            break
    return seconds, memory


def warm_up() -> None:
    """Import what checks import, so that the processes that are forked do not measure it."""
    for name in ("launch.py: nodes", "launch.xml: nodes", "launch.yaml: nodes", "CMake: targets", "setup.py: entry points"):
        for depends in ("", "rclcpp"):
            files = dict(LADDERS[name](2))
            files["package.xml"] = files["package.xml"].replace("  <export>", f"  <depend>b{depends}</depend>\n  <export>")
            with tempfile.TemporaryDirectory() as folder:
                write(files, Path(folder))
                check(folder)


def exponent(seconds: list[float]) -> float | None:
    """Return the slope over the last two doublings, None if the times are too short to tell."""
    if math.isinf(seconds[-1]):
        return math.inf
    if seconds[-1] < SHORT:
        return None
    before = seconds[-3:]
    return math.log2(before[-1] / max(before[0], 0.01)) / (len(before) - 1)


def main() -> int:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--most", type=int, default=32_000, help="number of elements to end with (default: 32000)")
    parser.add_argument("--only", default="", help="part of the names of the ladders to measure")
    options = parser.parse_args()
    print("| ladder | seconds by number of elements | MB | exponent |\n|---|---|---|---|")
    warm_up()
    slow = 0
    for name, build in LADDERS.items():
        if options.only not in name:
            continue
        most = min(options.most, next((size for start, size in MOST.items() if name.startswith(start)), options.most))
        sizes = [most >> step for step in range(STEPS, -1, -1)]
        seconds, memory = ladder(build, sizes, OPTIONS.get(name, AS_JSON))
        slope = exponent(seconds)
        slow += slope is not None and slope > WANTED
        cells = ", ".join(f"{size:,}: {taken:.2f}" for size, taken in zip(sizes, seconds, strict=False))
        print(f"| {name} | {cells} | {memory:.0f} | {'–' if slope is None else f'{slope:.2f}'} |", flush=True)
    print(f"\n{slow} ladders grow faster than {WANTED}.")
    return slow > 0


if __name__ == "__main__":
    sys.exit(main())
