"""A run that is killed, or that cannot write a file completely, leaves each file old or new, and whole.

A longer run: ``python -m tests.test_faults KILLS``.
"""

from __future__ import annotations

import os
import random
import resource
import shutil
import signal
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Final

import pytest

from ros_lint.cli.main import main

pytestmark = pytest.mark.slow

_PACKAGES: Final = 8
_COMMANDS: Final = (("--fix",), ("--write-baseline",))
_MANIFEST: Final = """<package format="3">
  <name>{name}</name><version>0.1.0</version><description>d</description>
  <maintainer email="a@b.org">A</maintainer><license>MIT</license>
  <depend>rclcpp</depend>
{filling}  <depend>rclcpp</depend>
</package>
"""

Contents = dict[str, bytes]


def _workspace(root: Path, command: tuple[str, ...]) -> None:
    for number in range(_PACKAGES):
        folder = root / "ws" / f"p{number}"
        folder.mkdir(parents=True)
        filling = "".join(f"  <!-- {line} -->\n" for line in range(100))
        (folder / "package.xml").write_text(_MANIFEST.format(name=f"p{number}", filling=filling))
    if "--write-baseline" in command:
        (root / "ws" / "ros-lint.toml").write_text('baseline = "known.json"\n')


def _contents(root: Path) -> Contents:
    return {str(path.relative_to(root)): path.read_bytes() for path in (root / "ws").rglob("*") if path.is_file()}


def _without_temporary(contents: Contents) -> Contents:
    """Return the files without those that a killed run left behind."""
    return {name: content for name, content in contents.items() if "/.ros-lint-" not in f"/{name}"}


def _start(root: Path, command: tuple[str, ...], prepare: Callable[[], None] = lambda: None) -> int:
    """Start a run in a process of its own, and return the id of the process."""
    child = os.fork()
    if child == 0:
        try:
            os.environ["XDG_CACHE_HOME"] = str(root / "cache")
            sys.stdout = sys.stderr = Path(os.devnull).open("w")  # noqa: SIM115
            prepare()
            main([str(root / "ws"), "--distro", "jazzy", "--jobs", "1", *command])
        finally:
            os._exit(0)
    return child


def _finish(root: Path, command: tuple[str, ...]) -> float:
    started = time.monotonic()
    os.waitpid(_start(root, command), 0)
    return time.monotonic() - started


def _check(old: Contents, new: Contents, now: Contents) -> None:
    for name, content in now.items():
        if name in old or name in new:
            assert content in (old.get(name), new.get(name)), name
        else:
            assert "/.ros-lint-" in f"/{name}", name  # a temporary file, which a run after an hour removes
    assert old.keys() <= now.keys()


def _kill(root: Path, command: tuple[str, ...], kills: int, seed: int) -> int:
    """Kill runs at random moments, check the files after each, and return the number of runs that were alive."""
    moments, alive = random.Random(seed), 0
    _workspace(root / "old", command)
    old = _contents(root / "old")
    shutil.copytree(root / "old", root / "new")
    _finish(root / "new", command)
    new = _contents(root / "new")
    assert new != old
    shutil.copytree(root / "old", root / "timed")
    duration = _finish(root / "timed", command)
    for number in range(kills):
        folder = root / str(number)
        shutil.copytree(root / "old", folder)
        child = _start(folder, command)
        time.sleep(moments.uniform(0, duration * 1.2))
        os.kill(child, signal.SIGKILL)
        _, status = os.waitpid(child, 0)
        alive += os.WIFSIGNALED(status)
        _check(old, new, _contents(folder))
        if number % 5 == 0:
            _finish(folder, command)
            assert _without_temporary(_contents(folder)) == new
        shutil.rmtree(folder)
    return alive


@pytest.mark.parametrize("command", _COMMANDS, ids=" ".join)
def test_a_killed_run_leaves_whole_files(tmp_path: Path, command: tuple[str, ...]) -> None:
    _kill(tmp_path, command, 25, 1)


@pytest.mark.parametrize("command", _COMMANDS, ids=" ".join)
@pytest.mark.parametrize("limit", [0, 100, 1_000, 2_000])
def test_a_size_limit_leaves_whole_files(tmp_path: Path, command: tuple[str, ...], limit: int) -> None:
    _workspace(tmp_path / "old", command)
    old = _contents(tmp_path / "old")
    shutil.copytree(tmp_path / "old", tmp_path / "new")
    _finish(tmp_path / "new", command)

    def prepare() -> None:
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))

    os.waitpid(_start(tmp_path / "old", command, prepare), 0)
    _check(old, _contents(tmp_path / "new"), _contents(tmp_path / "old"))


def test_two_runs_at_once_leave_whole_files(tmp_path: Path) -> None:
    _workspace(tmp_path / "old", ("--fix",))
    old = _contents(tmp_path / "old")
    shutil.copytree(tmp_path / "old", tmp_path / "new")
    _finish(tmp_path / "new", ("--fix",))
    new = _contents(tmp_path / "new")
    for child in [_start(tmp_path / "old", ("--fix",)) for _ in range(4)]:
        os.waitpid(child, 0)
    _check(old, new, _contents(tmp_path / "old"))
    _finish(tmp_path / "old", ("--fix",))
    assert _contents(tmp_path / "old") == new


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as place:
        for index, chosen in enumerate(_COMMANDS):
            total = int(sys.argv[1]) // len(_COMMANDS)
            print(*chosen, _kill(Path(place) / str(index), chosen, total, index), "of", total, "runs killed")
