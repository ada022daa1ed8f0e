"""Oracles: what must hold for every input, however broken.

* No exception, no crashed rule, no file on which ros-lint failed.
* Processor time and memory are bounded by the bytes of the input.
* The same bytes a second time, and from the cache.
* ``--fix`` leaves every file old or well-formed, and a second ``--fix`` changes nothing.
* The other formats and commands end without an exception as well.
"""

from __future__ import annotations

import hashlib
import io
import json
import os
import sys
import time
import warnings
from collections.abc import Callable, Mapping
from contextlib import suppress
from pathlib import Path
from random import Random
from typing import Any, Final, NamedTuple
from xml.parsers import expat

from ros_lint.base.text import read
from ros_lint.collectors.cmake import syntax as cmake_syntax
from ros_lint.reporters import FORMATS
from ros_lint.workspace.collect import FAILED
from tests.fuzz.mutate import Material, mutate

SECONDS_PER_MB: Final = 5.0
MEMORY_PER_MB: Final = 300
"""In MB. Inputs of less than a MB count as one."""
SLACK: Final = float(os.environ.get("FUZZ_SLACK", "1"))
"""Factor of the allowed seconds, for a machine that is busy with other work, whose processor seconds are worth less."""

Main = Callable[[list[str]], int]
_OPTIONS: Final = ("--distro", "jazzy", "--jobs", "1", "--no-progress")
_FAILED: Final = FAILED.partition("(")[0]
_CLEAR: Final = "/proc/self/clear_refs"


class Ran(NamedTuple):
    code: int
    out: bytes
    err: str


class OracleError(Exception):
    """A property does not hold. The message says which one, and what was seen."""


class Measured(NamedTuple):
    """What an input did."""

    digest: str
    """Of the output of the check: equal for equal inputs."""
    seconds: float
    """Processor seconds of the slowest run."""
    memory: float
    """MB that the input added at most; 0 where the system cannot say."""
    runs: int
    failure: str


class Plan(NamedTuple):
    """How much is done with an input."""

    fix: bool = False
    cache: bool = False
    other: int = -1
    """Seed for the choice of a further command or format; -1: none."""


def megabytes(folder: str) -> float:
    """Return the size of the regular files below a folder."""
    total = 0
    for place, _, names in os.walk(folder):
        for name in names:
            with suppress(OSError):
                total += os.lstat(os.path.join(place, name)).st_size
    return total / (1 << 20)


def examine(main: Main, folder: str, plan: Plan) -> Measured:
    """Run ros-lint on a folder, check the oracles, and return what was measured."""
    allowed = max(1.0, megabytes(folder))
    digest, failure, slowest, runs = "", "", 0.0, 0
    base = _clear_peak()

    def run(*arguments: str) -> Ran:
        nonlocal slowest, runs
        started = time.process_time()
        try:
            return _run(main, arguments)
        finally:
            slowest, runs = max(slowest, time.process_time() - started), runs + 1

    try:
        ran = run(folder, "--format", "json", "--no-cache", *_OPTIONS)
        digest = hashlib.sha256(ran.out + ran.err.encode("utf-8", "replace") + bytes([ran.code])).hexdigest()
        report = check_report(ran)
        if plan.cache:
            _check_cached(run, folder, ran, Random(plan.other))
        elif plan.other >= 0:
            _run_other(run, folder, Random(plan.other))
        if plan.fix and any(finding.get("fix") for finding in report.get("findings", ())):
            _check_fix(run, folder)
    except OracleError as problem:
        failure = str(problem)
    memory = max(0.0, _peak() - base)
    if not failure and slowest > SECONDS_PER_MB * allowed * SLACK:
        failure = f"slow: {slowest:.1f} s of processor time for {allowed:.1f} MB"
    if not failure and memory > MEMORY_PER_MB * allowed:
        failure = f"memory: {memory:.0f} MB for {allowed:.1f} MB"
    return Measured(digest, slowest, memory, runs, failure)


def _run(main: Main, arguments: tuple[str, ...]) -> Ran:
    out, err = io.TextIOWrapper(io.BytesIO(), "utf-8", "backslashreplace"), io.StringIO()
    streams = sys.stdout, sys.stderr
    sys.stdout, sys.stderr = out, err
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            code = main(list(arguments))
    except SystemExit as end:
        code = end.code if isinstance(end.code, int) else 2
    except BaseException as error:
        raise OracleError(f"raised {type(error).__name__}: {error}\n{_place(error)}") from error
    finally:
        sys.stdout, sys.stderr = streams
    out.flush()
    buffer = out.buffer
    assert isinstance(buffer, io.BytesIO)
    message = err.getvalue()
    if "Traceback" in message or "bug in ros-lint" in message:
        raise OracleError(f"exception: {' '.join(arguments[1:])}\n{message[-3000:]}")
    if code not in (0, 1, 2):
        raise OracleError(f"exit code {code}")
    return Ran(code, buffer.getvalue(), message)


def _place(error: BaseException) -> str:
    import traceback

    return "".join(traceback.format_exception(error))[-3000:]


def check_report(ran: Ran) -> dict[str, Any]:
    """Return the report of a run in JSON. Raises OracleError for crashed rules, and for files on which ros-lint failed."""
    if not ran.out:
        if ran.code != 2 or not ran.err.startswith("ros-lint: "):
            raise OracleError(f"no report, exit code {ran.code}: {ran.err[:500]}")
        return {}
    try:
        report: dict[str, Any] = json.loads(ran.out)
    except ValueError as error:
        raise OracleError(f"not JSON: {error}: {ran.out[:200]!r}") from error
    if report["crashes"]:
        raise OracleError(f"crashed rule: {report['crashes'][0]}")
    for entry in report["not_checked"]:
        if _FAILED in entry["reason"]:
            raise OracleError(f"ros-lint failed: {entry}")
    return report


def _check_cached(run: Callable[..., Ran], folder: str, ran: Ran, random: Random) -> None:
    """The report is the same with an empty cache, from the cache, and with a damaged cache."""
    for how in ("an empty cache", "the cache", "a damaged cache", "a repaired cache"):
        if how == "a damaged cache":
            _damage_cache(random)
        again = run(folder, "--format", "json", *_OPTIONS)
        if again[:2] != ran[:2] or (again.err != ran.err and how != "a damaged cache"):
            raise OracleError(f"other results with {how}: {_first_difference(ran, again)}")


def _damage_cache(random: Random) -> None:
    for place, _, names in os.walk(os.environ["XDG_CACHE_HOME"]):
        for name in names:
            path = Path(place, name)
            path.write_bytes(mutate(random, path.read_bytes(), Material((), ())))


def _first_difference(first: Ran, second: Ran) -> str:
    for name, left, right in zip(Ran._fields, first, second, strict=True):
        if left != right:
            at = next((n for n, pair in enumerate(zip(str(left), str(right), strict=False)) if pair[0] != pair[1]), 0)
            return f"{name}: {str(left)[max(0, at - 100) : at + 200]!r} and {str(right)[max(0, at - 100) : at + 200]!r}"
    return ""


def _run_other(run: Callable[..., Ran], folder: str, random: Random) -> None:
    """Run another format or command, whose output is only to be complete."""
    command = random.choice(
        (
            *([folder, "--format", name] for name in FORMATS if name != "json"),
            [folder, "--pedantic", "--format", random.choice(FORMATS)],
            [folder, "--diff", "--unsafe-fixes"],
            [folder, "--statistics"],
            [folder, "--show-settings"],
            [folder, "--write-baseline", "--baseline", f"{folder}.known"],
            ["graph", folder],
            ["graph", folder, "--format", random.choice(("dot", "mermaid", "json", "html"))],
            ["order", folder],
            ["overlay", folder],
            *(["explain-package", name, folder] for name in _packages(folder)),
            *(["launch", path] for path in _launch_files(folder)),
        )
    )
    run(
        *command, *(() if command[0] in ("order", "overlay", "graph", "launch", "explain-package") else ("--no-cache", *_OPTIONS))
    )


def _packages(folder: str) -> list[str]:
    return [name for name in os.listdir(folder) if os.path.isdir(os.path.join(folder, name)) and not name.startswith("-")][:3]


def _launch_files(folder: str) -> list[str]:
    places = [os.path.join(place, name) for place, _, names in os.walk(folder) for name in names if "launch" in name]
    return [place for place in places if os.path.isfile(place)][:3]


def _check_fix(run: Callable[..., Ran], folder: str) -> None:
    before = contents(folder)
    run(folder, "--fix", "--unsafe-fixes", "--no-cache", *_OPTIONS)
    after = contents(folder)
    if lost := before.keys() - after.keys():
        raise OracleError(f"--fix: {sorted(lost)} is gone")
    for path, content in after.items():
        if content != before.get(path) and (problem := damage(path, before.get(path), content)):
            raise OracleError(f"--fix: {path}: {problem}\n{content[:3000]!r}")
    run(folder, "--fix", "--unsafe-fixes", "--no-cache", *_OPTIONS)
    if (again := contents(folder)) != after:
        changed = sorted(path for path in again if again[path] != after.get(path))
        raise OracleError(f"--fix: a second run changes {changed}")


def contents(folder: str) -> Mapping[str, bytes]:
    """Return the contents of the regular files below a folder, without those of links."""
    result = {}
    for place, _, names in os.walk(folder):
        for name in names:
            path = os.path.join(place, name)
            if os.path.isfile(path) and not os.path.islink(path):
                with suppress(OSError):
                    result[os.path.relpath(path, folder)] = Path(path).read_bytes()
    return result


def damage(path: str, before: bytes | None, after: bytes) -> str:
    """Return what is wrong with the new content of a file that was well-formed; "" if nothing."""
    parse = next((parser for suffix, parser in _PARSERS if path.endswith(suffix)), None)
    if parse is None:
        return ""
    was, now = parse(before or b""), parse(after)
    return now if now and not was else ""


def _xml(content: bytes) -> str:
    try:
        expat.ParserCreate().Parse(content, True)
    except expat.ExpatError as error:
        return str(error)
    return ""


def _python(content: bytes) -> str:
    try:
        compile(content, "<fixed>", "exec", dont_inherit=True)
    except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
        return str(error)
    return ""


def _cmake(content: bytes) -> str:
    return "; ".join(str(problem) for problem in cmake_syntax.parse(read("CMakeLists.txt", content)).problems)


_PARSERS: Final = ((".xml", _xml), (".py", _python), ("CMakeLists.txt", _cmake), (".cmake", _cmake))


def _clear_peak() -> float:
    """Begin a new measurement of the peak memory, and return the present memory in MB."""
    with suppress(OSError):
        Path(_CLEAR).write_text("5")
    return _peak()


def _peak() -> float:
    try:
        lines = Path("/proc/self/status").read_text().splitlines()
    except OSError:
        return 0.0
    return next((int(line.split()[1]) / 1024 for line in lines if line.startswith("VmHWM")), 0.0)
