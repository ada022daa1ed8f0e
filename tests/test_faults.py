"""Runs that are killed, full disks, changing files and odd files, a small share. Longer: ``python -m tests.fuzz.faults``."""

from __future__ import annotations

import os
import signal
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from random import Random

import pytest

from ros_lint import knowledge
from tests.fuzz import faults
from tests.fuzz.faults import COMMANDS, FAULTS, FaultError, Tally, World
from tests.fuzz.server import warm_up

pytestmark = pytest.mark.slow

_KILLS = 8
_EACH = 2


@pytest.fixture(scope="module")
def _warm() -> Iterator[None]:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(knowledge, "_DataFiles", knowledge._DataFiles)  # restored in the end
        warm_up()
        yield


@pytest.fixture(scope="module", params=COMMANDS)
def world(_warm: None, request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> World:
    return World(tmp_path_factory.mktemp("world"), request.param)


def test_a_killed_run_leaves_whole_files_and_right_results(world: World) -> None:
    random, tally = Random(1), Tally()
    for _ in range(_KILLS):
        tally.kill(world, random)
    assert tally.broken == []
    assert tally.alive.total() > 0
    assert f"| all | {_KILLS} | " in tally.table()


@pytest.mark.parametrize("fault", FAULTS, ids=lambda fault: fault.__name__)
def test_a_fault_leaves_whole_files_and_right_results(world: World, fault: faults.Fault) -> None:
    random = Random(2)
    for _ in range(_EACH):
        world.reset()
        fault(world, random)


def test_the_runs_change_something(world: World) -> None:
    world.reset()
    assert (world.new != world.old) is (world.command != "cache")
    assert world.out.startswith(b"{") is (world.command == "cache")
    ended = world.run(partial(faults._on_event, world.events // 2, lambda: os.kill(os.getpid(), signal.SIGKILL)))
    assert ended.killed


@pytest.mark.usefixtures("_warm")
def test_damage_is_found(tmp_path: Path) -> None:
    world = World(tmp_path, "--fix")
    manifest = world.work / "ws/p0/package.xml"
    world.check_files()
    manifest.write_bytes(world.new["ws/p0/package.xml"])
    world.check_files()
    manifest.write_bytes(world.new["ws/p0/package.xml"][:100])
    with pytest.raises(FaultError, match="neither old nor new"):
        world.check_files()
    with pytest.raises(FaultError, match="the next run leaves other files"):
        world.check_next()
    manifest.unlink()
    with pytest.raises(FaultError, match="are gone"):
        world.check_files()
    with pytest.raises(FaultError, match="RuntimeError: planted"):
        world.run(partial(faults._on_event, 0, _plant))


def _plant() -> None:
    raise RuntimeError("planted")


@pytest.mark.usefixtures("_warm")
def test_an_endless_run_is_found(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    world = World(tmp_path, "--fix")
    monkeypatch.setattr(faults, "_SECONDS", 1)
    with pytest.raises(FaultError, match="no end after 1 s"):
        world.run(partial(signal.pause))
