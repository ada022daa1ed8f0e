"""Faults: runs that are killed, disks that are full, files that change meanwhile, and kinds of files that are no texts.

    python -m tests.fuzz.faults --kills 2000 --faults 500

Runs are forked from a process that has imported ros-lint, so a run takes some hundredths of a second. After each fault, every file
is old or new and whole, no run reports an error of ros-lint, and the next run gives the result of a run without a fault.
"""

from __future__ import annotations

import argparse
import json
import os
import resource
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from functools import partial
from pathlib import Path
from random import Random
from typing import Any, Final, NamedTuple

from ros_lint.cli import main as cli
from tests.fuzz.trees import NAMES

COMMANDS: Final[Mapping[str, tuple[str, ...]]] = {
    "--fix": ("--fix", "--no-cache"),
    "--write-baseline": ("--write-baseline", "--no-cache"),
    "cache": ("--format", "json"),
}
"""What is interrupted, and its options."""

_PACKAGES: Final = 4
_MANIFEST: Final = """<package format="3">
  <name>{name}</name><version>0.1.0</version><description>d</description>
  <maintainer email="a@b.org">A</maintainer><license>MIT</license>
  <depend>rclcpp</depend>
{filling}  <depend>rclcpp</depend>
</package>
"""
_SECONDS: Final = 60
_EVENTS: Final = ("open", "os.chmod", "os.listdir", "os.mkdir", "os.remove", "os.rename", "os.scandir", "tempfile.mkstemp")

Contents = dict[str, bytes]
Fault = Callable[["World", Random], None]


class FaultError(AssertionError):
    """A property that does not hold after a fault."""


class Ended(NamedTuple):
    """A run that has ended."""

    status: int
    out: bytes
    err: str

    @property
    def killed(self) -> bool:
        return os.WIFSIGNALED(self.status)


class World:
    """A workspace with duplicate tags, which a fix removes, and with what a run without a fault makes of it."""

    def __init__(self, root: Path, command: str) -> None:
        self.root, self.command = root, command
        self.old_folder, self.work = root / "old", root / "work"
        _create(self.old_folder / "ws", baseline=command == "--write-baseline")
        self.old = contents(self.old_folder)
        self.reset()
        started = time.monotonic()
        ended = self.run()
        self.seconds = time.monotonic() - started
        self.new, self.out = contents(self.work), ended.out
        self.reset()
        self.events = self._count_events()

    def reset(self) -> None:
        """Create the workspace again, as it was in the beginning."""
        shutil.rmtree(self.work, ignore_errors=True)
        shutil.copytree(self.old_folder, self.work)

    def start(self, prepare: Callable[[], object] = lambda: None, command: str = "", **streams: int) -> int:
        """Start a run in a child process, and return the id of the process."""
        child = os.fork()
        if child == 0:
            try:
                os.environ["XDG_CACHE_HOME"] = str(self.work / "cache")
                self._redirect(streams)
                options = COMMANDS[command or self.command]
                sys.argv = ["ros-lint", str(self.work / "ws"), "--distro", "jazzy", "--jobs", "1", "--no-progress", *options]
                prepare()
                cli.run()
            finally:
                os._exit(99)
        return child

    def _redirect(self, streams: Mapping[str, int]) -> None:
        for number, name in ((1, "out"), (2, "err")):
            handle = streams.get(name)
            if handle is None:
                handle = os.open(self.root / name, os.O_WRONLY | os.O_CREAT | os.O_TRUNC)
            os.dup2(handle, number)
        # As at the start of Python, a second reference keeps the streams open.
        sys.stdout = sys.__stdout__ = open(1, "w", closefd=False)  # type: ignore[misc]  # noqa: SIM115
        sys.stderr = sys.__stderr__ = open(2, "w", closefd=False)  # type: ignore[misc]  # noqa: SIM115

    def run(self, prepare: Callable[[], object] = lambda: None, command: str = "", **streams: int) -> Ended:
        """Run to the end, and return what was printed. A run that takes too long is ended, which breaks a property."""
        return self.wait(self.start(prepare, command, **streams))

    def wait(self, child: int) -> Ended:
        end = time.monotonic() + _SECONDS
        while True:
            done, status = os.waitpid(child, os.WNOHANG)
            if done:
                break
            if time.monotonic() > end:
                os.kill(child, signal.SIGKILL)
                os.waitpid(child, 0)
                raise FaultError(f"no end after {_SECONDS} s")
            time.sleep(0.001)
        ended = Ended(status, (self.root / "out").read_bytes(), (self.root / "err").read_text("utf-8", "replace"))
        if "Traceback" in ended.err or "bug in ros-lint" in ended.err:
            raise FaultError(ended.err)
        return ended

    def _count_events(self) -> int:
        counted = self.root / "events"
        ended = self.wait(self.start(partial(_on_event, 1 << 60, lambda: None, counted)))
        assert not ended.killed
        self.reset()
        return len(counted.read_bytes())

    def check_files(self, also: Mapping[str, Sequence[bytes]] | None = None) -> None:
        """Check that every file is old or new.

        If the run had other inputs, ``also`` are further contents that files may have, and a baseline must only be complete.
        """
        now = contents(self.work)
        if also is not None and "ws/known.json" in now:
            json.loads(now.pop("ws/known.json"))
        for name, content in now.items():
            allowed = [*(also or {}).get(name, ()), *(part[name] for part in (self.old, self.new) if name in part)]
            if content not in allowed and "/.ros-lint-" not in f"/{name}" and "/cache/" not in f"/{name}":
                raise FaultError(f"{name} is neither old nor new: {content[:200]!r}")
        if lost := self.old.keys() - now.keys() - (also or {}).keys():
            raise FaultError(f"{sorted(lost)} are gone")

    def check_next(self) -> None:
        """Check that the next run gives the result of a run without a fault."""
        ended = self.run()
        if self.command == "cache":
            if ended.out != self.out:
                raise FaultError(f"another result: {ended.out[:500]!r}")
            return
        now = {name: content for name, content in contents(self.work).items() if "/.ros-lint-" not in f"/{name}"}
        if now != self.new:
            raise FaultError(
                f"the next run leaves other files: {sorted(name for name in now if now[name] != self.new.get(name))}"
            )


def _create(folder: Path, *, baseline: bool) -> None:
    for number in range(_PACKAGES):
        package = folder / f"p{number}"
        package.mkdir(parents=True)
        filling = "".join(f"  <!-- {line} -->\n" for line in range(100))
        (package / "package.xml").write_text(_MANIFEST.format(name=f"p{number}", filling=filling))
    if baseline:
        (folder / "ros-lint.toml").write_text('baseline = "known.json"\n')


def contents(root: Path) -> Contents:
    """Return the contents of the regular files of the workspace."""
    return {
        str(path.relative_to(root)): path.read_bytes()
        for path in (root / "ws").rglob("*")
        if path.is_file() and not path.is_symlink()
    }


def _on_event(number: int, act: Callable[[], object], counted: Path | None = None, without: Sequence[str] = ()) -> None:
    """Call a function when the process uses files for the n-th time, as Python's audit events count it."""
    seen = 0
    inside = False

    def hook(event: str, _arguments: tuple[Any, ...]) -> None:
        nonlocal seen, inside
        if inside or event not in _EVENTS or event in without:
            return
        inside = True
        if counted:
            with counted.open("ab") as file:
                file.write(b".")
        if seen == number:
            act()
        seen += 1
        inside = False

    sys.addaudithook(hook)


def kill(world: World, random: Random) -> bool:
    """Kill a run at a random moment or at a random use of a file, check the files, and return whether it was alive."""
    if random.random() < 0.5:
        child = world.start()
        time.sleep(random.uniform(0, world.seconds * 1.2))
        with suppress(ProcessLookupError):
            os.kill(child, signal.SIGKILL)
    else:
        at = random.randrange(world.events)
        child = world.start(partial(_on_event, at, lambda: os.kill(os.getpid(), signal.SIGKILL)))
    ended = world.wait(child)
    world.check_files()
    world.check_next()
    return ended.killed


def full_disk(world: World, random: Random) -> None:
    """Files have a limit of size."""
    limit = random.choice((0, 1, 100, 1_000, random.randrange(5_000), random.randrange(5_000)))

    def prepare() -> None:
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))

    reading, writing = os.pipe()  # standard output itself is not limited
    os.set_inheritable(writing, True)
    try:
        world.run(prepare, out=writing, err=writing)
    finally:
        os.close(reading)
        os.close(writing)
    world.check_files()
    world.check_next()


def full_filesystem(world: World, random: Random) -> None:
    """The workspace is on a small file system, which is full."""
    small = world.root / "small"
    with _mounted(small, 256) as mounted:
        if not mounted:
            return
        shutil.rmtree(world.work)
        shutil.copytree(world.old_folder, small / "work")
        world.work.symlink_to(small / "work")
        try:
            with (small / "filling").open("wb") as file, suppress(OSError):
                file.write(b"x" * (random.randrange(0, 60) << 12))
                file.write(b"x" * (1 << 20)) if random.random() < 0.7 else None
            world.run()
            world.check_files()
            (small / "filling").unlink()
            world.check_next()
        finally:
            world.work.unlink()


@contextmanager
def _mounted(place: Path, kilobytes: int) -> Iterator[bool]:
    place.mkdir(exist_ok=True)
    command = ["mount", "-t", "tmpfs", "-o", f"size={kilobytes}k", "tmpfs", str(place)]
    mounted = shutil.which("mount") is not None and subprocess.run(command, check=False, capture_output=True).returncode == 0
    try:
        yield mounted
    finally:
        if mounted:
            subprocess.run(["umount", "-l", str(place)], check=True)


def change(world: World, random: Random) -> None:
    """Another process changes, removes or replaces a file while the run uses files. The change is never lost."""
    package = f"p{random.randrange(_PACKAGES)}"
    name = f"ws/{package}/package.xml"
    place = world.work / name
    old = world.old[name]
    edited = {
        "an edit": old.replace(b"<description>d", b"<description>edited"),
        "more lines": b"\n" * 300 + old,
        "fewer lines": old[:400],
        "no content": b"",
        "bytes": bytes(range(256)),
        "nothing": None,
        "a folder": None,
        "a link": None,
        "a pipe": None,
        "a read-only file": old,
    }
    how = random.choice(list(edited))
    new = edited[how]

    def act() -> None:
        with suppress(FileNotFoundError):
            place.unlink()
        if new is not None:
            place.write_bytes(new)
            if how == "a read-only file":
                place.chmod(0o444)
        elif how == "a folder":
            place.mkdir()
        elif how == "a link":
            place.symlink_to("/etc/hostname")
        elif how == "a pipe":
            os.mkfifo(place)

    # Between the last comparison and the renaming, no program can protect a change.
    at = random.randrange(world.events)
    world.run(partial(_on_event, at, act, None, ("os.rename",)))
    happened = not place.is_file() or place.is_symlink() or place.read_bytes() not in (world.old[name], world.new.get(name, b""))
    if new is None and how in ("a folder", "a pipe", "a link") and happened:
        _check_kind(place, how)
    world.check_files({name: [content for content in (new, _fixed(new)) if content is not None]})
    _restore(world, place, name)
    world.check_files({name: [content for content in (new, _fixed(new)) if content is not None]})
    world.check_next()


def _check_kind(place: Path, how: str) -> None:
    kinds = {"a folder": place.is_dir(), "a pipe": place.is_fifo(), "a link": place.is_symlink()}
    if not kinds[how]:
        raise FaultError(f"{place} was {how}, and is no more")


def _fixed(content: bytes | None) -> bytes | None:
    """Return what a fix makes of an edited manifest."""
    tag = b"  <depend>rclcpp</depend>\n"
    return (
        None
        if content is None or content.count(tag) != 2
        else tag.join([content.split(tag)[0], *content.split(tag)[1:2]]) + content.split(tag)[2]
    )


def _restore(world: World, place: Path, name: str) -> None:
    if place.is_symlink() or place.is_fifo() or place.is_file():
        place.unlink()
    elif place.is_dir():
        place.rmdir()
    place.write_bytes(world.old[name])


def at_once(world: World, random: Random) -> None:
    """Two to four runs at once."""
    children = [world.start() for _ in range(random.randrange(2, 5))]
    for child in children:
        world.wait(child)
    world.check_files()
    world.check_next()


def read_only(world: World, random: Random) -> None:
    """Files or folders without write permission."""
    places = [world.work / "ws", *(world.work / "ws").glob("*"), *(world.work / "ws").glob("*/*")]
    chosen = random.sample(places, random.randrange(1, len(places)))
    for place in chosen:
        place.chmod(0o555 if place.is_dir() else 0o444)
    world.run()
    world.check_files()
    for place in chosen:
        place.chmod(0o755 if place.is_dir() else 0o644)
    world.check_next()


def several_names(world: World, random: Random) -> None:
    """Hard links, and symbolic links from one package to the other."""
    first, second = random.sample(range(_PACKAGES), 2)
    source = world.work / f"ws/p{first}/package.xml"
    target = world.work / f"ws/p{second}/package.xml"
    content = source.read_bytes()
    target.unlink()
    if random.random() < 0.5:
        target.hardlink_to(source)
    else:
        target.symlink_to(f"../p{first}/package.xml")
    world.run()
    if world.command == "--fix" and source.read_bytes() not in (content, world.new[f"ws/p{first}/package.xml"]):
        raise FaultError("a file with two names is damaged")
    target.unlink()
    target.write_bytes(world.old[f"ws/p{second}/package.xml"])
    world.check_files({})
    world.check_next()


def odd_files(world: World, random: Random) -> None:
    """FIFOs, sockets, devices, loops of links, links out of the workspace, and names of all kinds."""
    folder = world.work / f"ws/p{random.randrange(_PACKAGES)}"
    added: list[Path] = []
    for _ in range(random.randrange(1, 6)):
        name = random.choice(
            (*NAMES, ".gitignore", "setup.py", "CMakeLists.txt", "a.launch.py", "b.launch.xml", "c.repos", "colcon.pkg", "d.hpp")
        )
        place = folder / name
        with suppress(OSError, ValueError):
            if not os.path.lexists(place):
                _odd(place, random)
                added.append(place)
    outside = Path("/etc/hostname").read_bytes() if Path("/etc/hostname").exists() else b""
    world.run()
    if outside and Path("/etc/hostname").read_bytes() != outside:
        raise FaultError("a file outside of the workspace was written")
    for place in added:
        if place.is_dir() and not place.is_symlink():
            shutil.rmtree(place)
        else:
            place.unlink()
    world.check_files({})
    world.check_next()


def _odd(place: Path, random: Random) -> None:
    kind = random.randrange(9)
    if kind == 0:
        os.mkfifo(place)
    elif kind == 1:
        with socket.socket(socket.AF_UNIX) as end:
            end.bind(str(place))
    elif kind == 2:
        os.mknod(place, 0o020644, os.makedev(1, 5))  # as /dev/zero; only for root
    elif kind == 3:
        place.symlink_to(random.choice(("/dev/zero", "/dev/full", "/dev/tty", "/proc/self/mem")))
    elif kind == 4:
        place.symlink_to(place.name)
    elif kind == 5:
        place.symlink_to(random.choice(("..", "../..", ".", "/", "/etc", "/etc/hostname", "nowhere")))
    elif kind == 6:
        place.mkdir()
    elif kind == 7:
        (place / "a").mkdir(parents=True)
        (place / "a" / "package.xml").symlink_to("../../package.xml")
    else:
        place.write_bytes(bytes(random.randrange(256) for _ in range(300)))


def broken_output(world: World, random: Random) -> None:
    """Standard output is full, closed, or a pipe that is interrupted."""
    kind = random.randrange(3)
    if kind == 0:
        handle = os.open("/dev/full", os.O_WRONLY)
        world.run(out=handle, **({"err": handle} if random.random() < 0.3 else {}))
        os.close(handle)
    elif kind == 1:
        reading, writing = os.pipe()
        child = world.start(out=writing)
        os.close(writing)
        if random.random() < 0.5:
            os.read(reading, 1)
        os.close(reading)
        world.wait(child)
    else:
        world.run(partial(os.close, random.choice((1, 2))))
    world.check_files()
    world.check_next()


FAULTS: Final[Mapping[Fault, int]] = {
    change: 8,
    full_disk: 5,
    odd_files: 5,
    full_filesystem: 3,
    broken_output: 3,
    at_once: 2,
    read_only: 2,
    several_names: 2,
}
"""Kinds of faults, and how often each occurs in proportion."""


class Tally:
    """Counts what was done, and what broke."""

    def __init__(self) -> None:
        self.done: Counter[str] = Counter()
        self.alive: Counter[str] = Counter()
        self.broken: list[str] = []

    def kill(self, world: World, random: Random) -> None:
        name = f"kill, {world.command}"
        self.alive[name] += bool(self._try(name, world, partial(kill, world, random)))

    def fault(self, world: World, random: Random) -> None:
        one = random.choices(list(FAULTS), list(FAULTS.values()))[0]
        self._try(f"{one.__name__.replace('_', ' ')}, {world.command}", world, partial(one, world, random))

    def _try(self, name: str, world: World, act: Callable[[], object]) -> object:
        world.reset()
        self.done[name] += 1
        try:
            return act()
        except Exception as error:
            self.broken.append(f"{name}: {type(error).__name__}: {error}")
            print(self.broken[-1][:3000], flush=True)
            return None

    def table(self) -> str:
        lines = ["| fault | number | of these, killed before the end |", "|---|---|---|"]
        lines += [f"| {name} | {number} | {self.alive.get(name, '')} |" for name, number in sorted(self.done.items())]
        return "\n".join([*lines, f"| all | {self.done.total()} | {self.alive.total()} |", "", f"{len(self.broken)} broken"])


def main() -> int:
    """Cause faults, print their numbers, and return whether a property was broken."""
    parser = argparse.ArgumentParser(prog="python -m tests.fuzz.faults", description="Interrupt ros-lint.")
    parser.add_argument("--kills", type=int, default=2_000)
    parser.add_argument("--faults", type=int, default=500)
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    from tests.fuzz.server import warm_up

    warm_up()
    random, tally = Random(options.seed), Tally()
    with tempfile.TemporaryDirectory() as folder:
        worlds = [World(Path(folder) / name, name) for name in COMMANDS]
        for number in range(options.kills):
            tally.kill(worlds[number % len(worlds)], random)
            if number % 200 == 199:
                print(f"{number + 1} kills, {len(tally.broken)} broken", flush=True)
        for number in range(options.faults):
            tally.fault(worlds[number % len(worlds)], random)
    print(tally.table())
    return bool(tally.broken)


if __name__ == "__main__":
    sys.exit(main())
