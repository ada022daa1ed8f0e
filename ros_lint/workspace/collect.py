"""Collect the facts of files: each file once, in several processes if there are many files.

Facts are the data that a collector extracts from the text of one file. Facts of unchanged files are taken from the cache.
Only this module decides which collector reads which file.
"""

from __future__ import annotations

import errno
import re
from collections.abc import Callable, Iterable, Iterator, Sequence

from ros_lint.base import garbage
from ros_lint.base.processes import available_cores
from ros_lint.base.recorded_tree import NOT_READ, RecordedTree, content_digest
from ros_lint.base.text import Text, file_start, read
from ros_lint.base.tree import DiskTree, Tree
from ros_lint.collectors import machine_paths
from ros_lint.collectors.cmake.syntax import ParsedScript
from ros_lint.collectors.file_types import _SUFFIXES, Kind, kind_of
from ros_lint.collectors.suffixes import HEADERS, INTERFACES, SOURCES
from ros_lint.facts.launch import LaunchFile
from ros_lint.facts.sources import FileFacts
from ros_lint.facts.suppressions import MARKER, Suppression
from ros_lint.facts.visibility import ALL_FACETS, Facet, Opaque
from ros_lint.workspace.cache.facts import FactCache
from ros_lint.workspace.collected import Collected, ReadFile

FAILED = "ros-lint failed on this file ({}); please report this bug"

_FILES_PER_PROCESS = 500
"""Number of files for each further process: with fewer files, starting the process costs more than it saves."""

_MAX_PROCESSES = 61
"""Maximum number of processes: Windows cannot wait for more."""

_SUFFIXES.update((suffix[1:], "cpp") for suffix in (*HEADERS, *SOURCES))
_SUFFIXES.update((suffix[1:], "interface") for suffix in INTERFACES)
_SUFFIXES.update(dict.fromkeys(("xml", "launch"), "xml"))
_SUFFIXES.update(dict.fromkeys(("yaml", "yml"), "yaml"))
_SUFFIXES.update(dict.fromkeys(("urdf", "xacro", "sdf", "world", "rviz"), "resource"))


_PYTHON_SHEBANG = re.compile(rb"#![^\n]*python")
"""Matches the first line of a Python program, whatever the file name."""

_HIDDEN_FACETS: dict[Kind, Facet] = {
    "manifest": Facet(0),  # without a manifest there is no package
    "program": Facet(0),  # usually not a script
    "config": Facet(0),  # matters only next to setup.py, whose evaluation reports it
    "cpp": Facet.USES | Facet.COMPONENTS,
    "cmake": ALL_FACETS,
    "interface": Facet.USES | Facet.INTERFACES,
    "xml": Facet.USES | Facet.COMPONENTS,
}
"""Aspects of a package that become unknown if a file cannot be read, by kind of file; the default is ``Facet.USES``."""


def collect(text: Text, kind: Kind) -> Collected:
    """Return the facts (all data that ros-lint needs) of a file from its text. No contents of a file cause an exception."""
    # Collectors are imported here so that a workspace without launch files does not load theirs.
    facts: FileFacts | None = None
    launch: LaunchFile | None = None
    commands: ParsedScript | None = None
    if kind in ("python", "xml", "yaml"):
        from ros_lint.collectors.launch import collect as launch_files  # noqa: PLC0415
        from ros_lint.collectors.launch.detect import is_launch_file  # noqa: PLC0415

        if language := is_launch_file(text.path, text.text):
            launch = launch_files.collect(text, language)
    if kind == "cpp":
        from ros_lint.collectors.cpp import collect as cpp  # noqa: PLC0415

        facts = cpp.collect(text)
    elif kind == "python":
        from ros_lint.collectors.python import collect as python  # noqa: PLC0415

        facts = python.collect(text, launch=launch is not None)
        if launch is not None and "moveit_controller_manager" in text.text:
            from ros_lint.collectors.resources.collect import controller_managers  # noqa: PLC0415

            facts = facts._replace(mentions=(*facts.mentions, *controller_managers(text)))
    elif kind == "cmake":
        from ros_lint.collectors.cmake import syntax as cmake_syntax  # noqa: PLC0415

        commands = cmake_syntax.parse(text)
    elif kind == "interface":
        from ros_lint.collectors.interfaces import collect as interfaces  # noqa: PLC0415

        facts = interfaces.collect(text)
    elif kind in ("java", "rust", "cargo", "matlab"):
        from ros_lint.collectors.java_rust_matlab import COLLECTORS  # noqa: PLC0415

        facts = COLLECTORS[kind](text)
    elif launch is None and kind not in ("manifest", "config"):
        from ros_lint.collectors.resources import collect as resources  # noqa: PLC0415

        facts = resources.collect(text)
    # Comments of MATLAB cannot be distinguished from code.
    paths = machine_paths.collect(text) if kind != "matlab" else ()
    return Collected(facts, launch, commands, _suppressions(text), paths)


def _suppressions(text: Text) -> tuple[Suppression, ...]:
    if MARKER not in text.text:
        return ()
    from ros_lint.collectors import suppressions  # noqa: PLC0415  (most files have none)

    return suppressions.collect(text)


def collect_all(
    tree: Tree, paths: Sequence[str], jobs: int, cache: FactCache, tick: Callable[[int], None]
) -> dict[str, Collected]:
    """Return the facts (extracted data) of each file, by path.

    ``jobs`` is the number of processes; 0 means that it depends on the number of files. ``tick`` is called with the number of
    files that are finished.
    """
    files = [(path, kind) for path in paths if (kind := kind_of(path))]
    disk = tree.disk if isinstance(tree, RecordedTree) else tree
    read_files = cache.fetch(tree, disk, [path for path, _ in files])
    tick(len(read_files))
    uncached = [(path, kind) for path, kind in files if path not in read_files]
    fresh: dict[str, ReadFile] = {}
    processes = _processes(jobs, len(uncached))
    chunks: Iterable[dict[str, ReadFile]]
    if processes > 1 and uncached and isinstance(disk, DiskTree):
        chunks = _in_processes(disk, uncached, processes)
    else:
        chunks = (_collect_chunk(disk, uncached[at : at + 100]) for at in range(0, len(uncached), 100))
    with garbage.paused():  # facts have no cycles
        for chunk in chunks:
            fresh.update(chunk)
            tick(len(read_files) + len(fresh))
    cache.store(disk, fresh)
    read_files.update(fresh)
    if isinstance(tree, RecordedTree):
        for path, file in read_files.items():
            tree.note_contents(path, file.digest)
    return {path: read_files[path].collected for path, _ in files}


def _processes(jobs: int, files: int) -> int:
    """Return the number of processes for ``files`` files, at most one for each core; 0 or 1 means to start no process."""
    cores = min(available_cores(), _MAX_PROCESSES)
    return min(jobs, cores) if jobs else min(cores, 8, files // _FILES_PER_PROCESS)


def _in_processes(tree: DiskTree, files: list[tuple[str, Kind]], processes: int) -> Iterator[dict[str, ReadFile]]:
    from concurrent.futures import ProcessPoolExecutor  # noqa: PLC0415

    size = max(20, min(200, len(files) // (processes * 4)))
    chunks = [files[at : at + size] for at in range(0, len(files), size)]
    with ProcessPoolExecutor(min(processes, len(chunks))) as pool:
        yield from pool.map(_collect_chunk, [tree] * len(chunks), chunks)


def _collect_chunk(tree: Tree, files: Sequence[tuple[str, Kind]]) -> dict[str, ReadFile]:
    return {path: _read_and_collect(tree, path, kind) for path, kind in files}


def _read_and_collect(tree: Tree, path: str, kind: Kind) -> ReadFile:
    try:
        data = tree.read(path)
    except OSError as error:
        if kind == "program" and error.errno == errno.EFBIG:
            return ReadFile(NOT_READ, Collected())  # too large for a script: it is a compiled program
        return ReadFile(NOT_READ, _unreadable(path, kind, error.strerror or str(error)))
    return ReadFile(content_digest(data), _collected(path, kind, data))


def _collected(path: str, kind: Kind, data: bytes) -> Collected:
    if kind == "program":
        if not _PYTHON_SHEBANG.match(data):
            return Collected()
        kind = "python"
    if b"\0" in data[:1024] and not data.startswith((b"\xff\xfe", b"\xfe\xff")):
        return _unreadable(path, kind, "binary data")
    try:
        return collect(read(path, data), kind)
    except Exception as error:  # a bug that one file triggers must not hide the findings in the others
        return _unreadable(path, kind, FAILED.format(f"{type(error).__name__}: {error}"))


def _unreadable(path: str, kind: Kind, reason: str) -> Collected:
    hides = _HIDDEN_FACETS.get(kind, Facet.USES)
    facts = FileFacts(opaque=(Opaque(hides, f"the file is not read: {reason}", file_start(path)),)) if hides else None
    return Collected(facts, unreadable=reason)
