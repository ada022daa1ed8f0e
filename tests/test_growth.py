"""The work of a check grows in proportion to the elements of a workspace.

The ladders are those of bench/ladders.py: small workspaces with a number of elements of one kind. Steps are counted, which are
the lines of Python that run, because they are the same on a busy machine. Scans inside the interpreter, such as those of a list,
do not count; bench/growth.py measures them as time.
"""

from __future__ import annotations

import math
import sys
from functools import cache
from pathlib import Path
from types import FrameType
from typing import Any, Final

import pytest

from bench import growth
from bench.ladders import LADDERS, OPTIONS

pytestmark = pytest.mark.slow

_FEW: Final = 60
_WANTED: Final = 1.2
_LITTLE: Final = 20_000
"""Steps: what takes fewer for all elements has no exponent, because fixed costs prevail."""

EXCEPTIONS: Final = {
    "launch.py: nested helpers": "the depth of calls is limited, and more than 100 levels are parsed in a second way",
    "launch.py: helpers in a row": "most of the few steps are those of long sources, which are parsed in a second way",
    "launch.py: what a call gets": "each call gets all values of a list; at most 1,000 are followed, and they take steps",
    "CMake: unknown conditions of a text": "each condition adds an alternative; the characters of a script are limited",
    "CMake: a list, written again": "each command writes the whole list; the characters of a script are limited",
    "launch.py: packages": "each look-up is compared with the references before it; longer launch files are not read",
    "CMake: targets in a chain": "each target is followed to all below it, at most 200",
    "CMake: targets in a ring": "each target is followed to all below it, at most 200",
    "CMake: replacements": "a compiled expression is extended by states when it first needs them, at most 1,000",
    **{
        name: "a name is compared with all others if these are at most 100, otherwise with a few"
        for name in LADDERS
        if name.startswith("similar names")
    },
}
"""Ladders that may grow faster, with the reason, which includes the limit that ends the growth."""


def _steps(name: str, count: int, folder: Path) -> int:
    steps = 0

    def trace(_frame: FrameType, _event: str, _argument: Any) -> Any:
        nonlocal steps
        steps += 1
        return trace

    options = OPTIONS.get(name, growth.AS_JSON)
    growth.write(LADDERS[name](count), folder)
    for _ in range(2):
        growth.check(str(folder), options)  # imports and caches are not counted
    before = sys.gettrace()
    sys.settrace(trace)
    try:
        growth.check(str(folder), options)
    finally:
        sys.settrace(before)
    return steps


@cache
def _warm() -> None:
    growth.warm_up()


@pytest.mark.parametrize("name", sorted(LADDERS.keys() - EXCEPTIONS.keys()))
def test_steps_grow_linearly(tmp_path: Path, name: str) -> None:
    _warm()
    few, double, many = (_steps(name, count, tmp_path / str(count)) for count in (_FEW, 2 * _FEW, 4 * _FEW))
    if many - few < _LITTLE:
        return
    exponent = math.log2((many - double) / max(double - few, 1))  # differences are free of the fixed costs
    assert exponent <= _WANTED, f"{exponent:.2f}: {few:,}, {double:,} and {many:,} steps"


def test_exceptions_name_ladders() -> None:
    assert EXCEPTIONS.keys() | OPTIONS.keys() <= LADDERS.keys()
