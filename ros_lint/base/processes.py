"""Run calls of one function in several processes that are copies of this process.

A copy (``fork``) has all that this process has read, so that only results are sent. The copies take their calls from a common
queue, because the durations of the calls differ.
"""

from __future__ import annotations

import os
import pickle
import signal
import sys
from collections.abc import Callable
from contextlib import suppress
from typing import NamedTuple, TypeVar

T = TypeVar("T")

_DIGITS = 4
"""Length of the number of a call in the queue."""

_MOST_CALLS = 1024
"""The largest number of calls in the queue. Their numbers fit in the smallest buffer of a pipe."""


def available_cores() -> int:
    """Return the number of processor cores that this process may use, at least 1."""
    cores = os.cpu_count() or 1
    return min(cores, len(os.sched_getaffinity(0))) if sys.platform == "linux" else cores


def can_copy() -> bool:
    """Return whether this process can be copied: on Linux, as long as it has a single thread.

    A copy has only the thread that has made it, and a lock that another thread has taken stays locked in the copy.
    """
    threading = sys.modules.get("threading")
    return sys.platform == "linux" and (threading is None or threading.active_count() == 1)


def call_all(function: Callable[[int], T], count: int, processes: int) -> dict[int, T]:
    """Return ``function(number)`` by number, for the numbers below ``count``.

    The calls are made by this process and ``processes - 1`` copies of it. ``function`` must be pure except for caches, and its
    results must be picklable. The calls that raise an exception, and those of a copy that dies, are missing in the result.
    """
    queue, end = os.pipe()
    os.write(end, b"".join([number.to_bytes(_DIGITS, "big") for number in range(min(count, _MOST_CALLS))]))
    os.close(end)
    copies: list[_Copy] = []
    try:
        copies.extend(_copy(function, queue) for _ in range(min(processes, count) - 1))
        results = _results(function, queue)
        for copy in copies:
            results |= _received(copy)
    finally:
        os.close(queue)
        for copy in copies:
            os.close(copy.output)
            os.kill(copy.process, signal.SIGKILL)  # it has ended, unless this process has been interrupted
            os.waitpid(copy.process, 0)
    return results


class _Copy(NamedTuple):
    """A copy of this process."""

    process: int
    output: int
    """File descriptor of the results."""


def _copy(function: Callable[[int], object], queue: int) -> _Copy:
    """Return a new copy of this process that makes calls of the queue."""
    output, results = os.pipe()
    process = os.fork()
    if process:
        os.close(results)
        return _Copy(process, output)
    try:  # in the copy
        os.close(output)
        with open(results, "wb") as file:
            pickle.dump(_results(function, queue), file, pickle.HIGHEST_PROTOCOL)
    finally:
        os._exit(0)


def _results(function: Callable[[int], T], queue: int) -> dict[int, T]:
    """Return the results of the calls that this process takes from the queue, without calls that raise an exception."""
    results = {}
    while (number := _next(queue)) is not None:
        with suppress(Exception):
            results[number] = function(number)
    return results


def _next(queue: int) -> int | None:
    """Return the next number of the queue, None at its end."""
    data = os.read(queue, _DIGITS)
    return int.from_bytes(data, "big") if data else None


def _received(copy: _Copy) -> dict[int, T]:
    """Return the results of a copy, {} if it has died."""
    with open(copy.output, "rb", closefd=False) as file:
        data = file.read()
    try:
        results: dict[int, T] = pickle.loads(data)  # noqa: S301  (of a process of our own)
    except Exception:  # cut off, or with an object of a plugin that cannot be pickled
        return {}
    return results
