"""A campaign: inputs of all targets, each given to two servers that hash differently, until the time is over."""

from __future__ import annotations

import hashlib
import json
import os
import shutil
import subprocess
import sys
from collections.abc import Iterator, Sequence
from itertools import cycle, islice
from pathlib import Path
from random import Random
from typing import Final, NamedTuple

from tests.fuzz import hostile
from tests.fuzz.oracle import Measured, Plan
from tests.fuzz.seeds import Files, Seed, write
from tests.fuzz.targets import CACHE, TARGETS, Source

_BATCH: Final = 60
"""Inputs that one child process examines."""
_HASH_SEEDS: Final = ("1", "2")
_CHECK: Final = Plan()
MAIN: Final = "ros_lint.cli.main:main"


class Input(NamedTuple):
    target: str
    name: str
    files: Files
    plan: Plan


class Found(NamedTuple):
    """An input that breaks a property, and which one."""

    input: Input
    failure: str


class Server:
    """A process that runs ros-lint on folders."""

    def __init__(self, main: str, hash_seed: str, *, warm: bool) -> None:
        command = [sys.executable, "-m", "tests.fuzz.server", main, *(["warm"] if warm else [])]
        root = str(Path(__file__).parents[2])
        environment = {**os.environ, "PYTHONHASHSEED": hash_seed, "PYTHONPATH": root, "ROS_DISTRO": "", "XDG_CONFIG_HOME": root}
        self._process = subprocess.Popen(
            command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, env=environment, cwd=root
        )

    def examine(self, folders: Sequence[str], plans: Sequence[Plan]) -> list[Measured]:
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        self._process.stdin.write(json.dumps({"folders": folders, "plans": plans}) + "\n")
        self._process.stdin.flush()
        return [Measured(*json.loads(self._process.stdout.readline())) for _ in folders]

    def close(self) -> None:
        self._process.communicate()


class Row:
    """Figures of a target."""

    def __init__(self) -> None:
        self.inputs: set[str] = set()
        self.runs = self.hostile = self.failures = 0
        self.slowest = self.memory = 0.0

    def add(self, given: Input, measured: Sequence[Measured], failed: bool) -> None:
        self.inputs.add(_digest(given.files))
        self.runs += sum(one.runs for one in measured)
        self.hostile += given.name.startswith("hostile")
        self.failures += failed
        self.slowest = max(self.slowest, *(one.seconds for one in measured))
        self.memory = max(self.memory, *(one.memory for one in measured))


class Campaign:
    """Gives inputs to servers and collects figures and failures."""

    def __init__(self, folder: str, main: str = MAIN, *, warm: bool = True) -> None:
        self._folder = folder
        self._servers = [Server(main, seed, warm=warm) for seed in _HASH_SEEDS]
        self.rows: dict[str, Row] = {}
        self.found: list[Found] = []

    def run(self, inputs: Sequence[Input]) -> None:
        """Examine inputs with both servers."""
        names = [os.path.join(self._folder, f"{number}") for number in range(len(inputs))]
        for name, given in zip(names, inputs, strict=True):
            os.makedirs(name)
            write(given.files, name)
        try:
            first = self._servers[0].examine(names, [_CHECK] * len(names))
            second = self._servers[1].examine(names, [given.plan for given in inputs])
        finally:
            shutil.rmtree(self._folder, ignore_errors=True)
        for given, *both in zip(inputs, first, second, strict=True):
            failure = next((one.failure for one in both if one.failure), "")
            if not failure and both[0].digest != both[1].digest:
                failure = "other results with another hash seed"
            self.rows.setdefault(given.target, Row()).add(given, both, bool(failure))
            if failure:
                self.found.append(Found(given, failure))

    def close(self) -> None:
        for server in self._servers:
            server.close()


def planned(random: Random) -> Plan:
    """Return what to do with an input: always a check, and sometimes more, so that many inputs fit into a minute."""
    kind = random.random()
    return Plan(fix=kind < 0.3, cache=0.3 <= kind < 0.4, other=random.randrange(1 << 30) if kind > 0.7 else -1)


def mutated(random: Random, seeds: Sequence[Seed], targets: Sequence[str]) -> Iterator[Input]:
    """Yield mutated workspaces without end, the targets in turns."""
    sources = [Source(target, seeds) for target in TARGETS if target.name in targets]
    for number, source in enumerate(cycle(sources)):
        plan = planned(random)
        if source.target.name == CACHE:
            plan = Plan(cache=True, other=random.randrange(1 << 30))
        yield Input(source.target.name, f"mutation {number}", source.make(random), plan)


def hostile_inputs(random: Random, targets: Sequence[str]) -> Iterator[Input]:
    """Yield the hostile seeds of the targets."""
    for target, name, files in hostile.seeds():
        if any(one in targets for one in (target, *_PARTS.get(target, ()))):
            yield Input(target, f"hostile: {name}", files, Plan(fix=True, other=random.randrange(1 << 30)))


_PARTS: Final = {
    "setup.cfg": ["setup.py"], "pyproject": ["setup.py"], "idl": ["interfaces"], "rviz": ["robots"], "gitmodules": ["repositories"],
    "colcon.meta": ["colcon"], "java": ["other languages"],
}  # fmt: skip
"""Targets of hostile seeds that have an own name."""


def batches(inputs: Iterator[Input]) -> Iterator[list[Input]]:
    """Yield inputs in groups for one child process."""
    while batch := list(islice(inputs, _BATCH)):
        yield batch


def table(rows: dict[str, Row]) -> str:
    """Return the figures by target."""
    lines = [
        "| target | workspaces | hostile | runs | failures | slowest, s | peak memory, MB |",
        "|---|---|---|---|---|---|---|",
    ]
    lines += [
        f"| {name} | {len(row.inputs):,} | {row.hostile} | {row.runs:,} | {row.failures} | {row.slowest:.2f} | {row.memory:.0f} |"
        for name, row in sorted(rows.items())
    ]
    total = list(rows.values())
    if total:
        distinct, runs = sum(len(row.inputs) for row in total), sum(row.runs for row in total)
        several, failures = sum(row.hostile for row in total), sum(row.failures for row in total)
        slowest, memory = max(row.slowest for row in total), max(row.memory for row in total)
        lines.append(f"| all | {distinct:,} | {several} | {runs:,} | {failures} | {slowest:.2f} | {memory:.0f} |")
    return "\n".join(lines)


def save(found: Found, folder: str) -> str:
    """Write an input with its failure below a folder, and return where."""
    place = os.path.join(folder, f"{found.input.target.replace(' ', '-')}-{_digest(found.input.files)[:12]}")
    os.makedirs(place, exist_ok=True)
    write(found.input.files, os.path.join(place, "workspace"))
    Path(place, "failure.txt").write_text(
        f"{found.input.name}\n{found.input.plan}\n{found.failure}\n", "utf-8", "backslashreplace"
    )
    return place


def _digest(files: Files) -> str:
    result = hashlib.sha256()
    for path, content in sorted(files.items()):
        kind, data = ("", content) if isinstance(content, bytes) else content
        for part in (path.encode("utf-8", "surrogateescape"), kind.encode(), data):
            result.update(b"%d:" % len(part) + part)
    return result.hexdigest()
