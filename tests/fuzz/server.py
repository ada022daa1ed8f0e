"""A server that runs ros-lint on folders in child processes.

    python -m tests.fuzz.server MODULE:FUNCTION [warm]

Each line of standard input is a request in JSON, ``{"folders": [...], "plans": [[fix, cache, other], ...]}``. The answer is one line for
each folder, whose fields are those of ``Measured``. A child process serves all folders of a request, so that a folder costs as
little as a call; if it dies, the answer for the folder at hand says how, and a new child continues with the next folder.
"""

from __future__ import annotations

import importlib
import json
import os
import resource
import select
import shutil
import signal
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Final

from ros_lint import knowledge
from ros_lint.knowledge.store import Store
from tests.fuzz.oracle import SECONDS_PER_MB, Main, Measured, Plan, examine, megabytes
from tests.fuzz.seeds import of_cases, write

MOST_MEMORY: Final = 6 << 30
"""Bytes: a child that wants more gets a MemoryError."""
_WALL_SECONDS: Final = 60
"""Without an answer and without the use of a processor for so long, a child hangs."""
_WARMING: Final = 20
"""One case of so many is checked before the first child starts."""
_RUNS: Final = 6
"""How many runs an input has at most, each with its share of processor time."""


def serve(main: Main) -> None:
    """Answer the requests of standard input."""
    for line in sys.stdin:
        request = json.loads(line)
        folders, plans = request["folders"], [Plan(*plan) for plan in request["plans"]]
        while folders:
            done = _serve_batch(main, folders, plans)
            folders, plans = folders[done:], plans[done:]


def _serve_batch(main: Main, folders: Sequence[str], plans: Sequence[Plan]) -> int:
    """Examine folders in one child process until it dies, and return how many are done."""
    reading, writing = os.pipe()
    child = os.fork()
    if child == 0:
        os.close(reading)
        _examine_all(main, folders, plans, writing)
    os.close(writing)
    answers, status = _read_answers(reading, child)
    os.close(reading)
    complete = answers.split(b"\n")[:-1]
    for answer in complete:
        _answer(json.loads(answer))
    if len(complete) == len(folders):
        return len(folders)
    _answer(Measured("", 0.0, 0.0, 0, _death(status)))
    return len(complete) + 1


def _read_answers(reading: int, child: int) -> tuple[bytes, int]:
    data, used = b"", 0.0
    while True:
        if select.select([reading], [], [], _WALL_SECONDS)[0]:
            chunk = os.read(reading, 65536)
            if not chunk:
                return data, os.waitpid(child, 0)[1]
            data += chunk
        else:
            before, used = used, _processor_seconds(child)
            if used - before < 0.1:  # it waits; on a busy machine it would have made some progress
                os.kill(child, signal.SIGKILL)
                os.waitpid(child, 0)
                return data, -1


def _processor_seconds(process: int) -> float:
    try:
        fields = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()
    except OSError:
        return 0.0
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def _death(status: int) -> str:
    if status == -1:
        return f"hangs: no answer after {_WALL_SECONDS} s"
    if os.WIFSIGNALED(status):
        number = os.WTERMSIG(status)
        return "slow: ended by the limit of processor time" if number == signal.SIGPROF else f"killed by signal {number}"
    return f"ended the process with {os.WEXITSTATUS(status)}"


def _answer(measured: Sequence[Any]) -> None:
    sys.stdout.write(json.dumps(measured) + "\n")
    sys.stdout.flush()


def _examine_all(main: Main, folders: Sequence[str], plans: Sequence[Plan], writing: int) -> None:
    resource.setrlimit(resource.RLIMIT_AS, (MOST_MEMORY, MOST_MEMORY))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    for folder, plan in zip(folders, plans, strict=True):
        os.environ["XDG_CACHE_HOME"] = f"{folder}.cache"
        signal.setitimer(signal.ITIMER_PROF, _RUNS * SECONDS_PER_MB * max(1.0, megabytes(folder)))
        os.write(writing, json.dumps(examine(main, folder, plan)).encode() + b"\n")
        shutil.rmtree(f"{folder}.cache", ignore_errors=True)
    os._exit(0)


def main_of(name: str) -> Main:
    """Return the function that a name ``MODULE:FUNCTION`` stands for."""
    module, _, function = name.partition(":")
    result: Main = getattr(importlib.import_module(module), function)
    return result


def warm_up() -> None:
    """Import what checks import and read the data of released packages, so that children do not do it again."""
    from bench import growth

    _share_knowledge()
    growth.warm_up()
    for seed in of_cases()[::_WARMING]:
        with tempfile.TemporaryDirectory() as folder:
            write(seed.files, folder)
            growth.check(folder)


def _share_knowledge() -> None:
    """Let all runs of this process share the parsed data of released packages, which takes most of the time of a small run."""
    make = knowledge._DataFiles
    made: dict[tuple[str, ...], Any] = {}

    def shared(store: Store) -> Any:
        if store.places not in made:
            made[store.places] = make(store)
        return made[store.places]

    knowledge._DataFiles = shared


if __name__ == "__main__":
    if "warm" in sys.argv[2:]:
        warm_up()
    serve(main_of(sys.argv[1]))
