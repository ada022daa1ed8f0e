"""Measure how long the language server takes to check a workspace again after one edit of each kind.

``python bench/edits.py WORKSPACE ...`` opens each workspace as the server does, without a cache, and changes one file at a time
in memory. It prints the CPU time of the first check in milliseconds, and for each kind of edit the median and the largest CPU
time, with the ratio of the median to the first check. No file is written.
"""

from __future__ import annotations

import re
import statistics
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Mapping
from typing import NamedTuple

from ros_lint.cli.commands.lsp.project import Project, Snapshot

_PLACES = 5
"""Number of files that are changed for each kind of edit, evenly spread over the workspace."""


class Edit(NamedTuple):
    """A kind of edit: the names of the files that it changes, and the function that changes their contents."""

    name: str
    files: re.Pattern[str]
    change: Callable[[bytes], bytes]


def _replaced(pattern: bytes, by: bytes) -> Callable[[bytes], bytes]:
    return lambda data: re.sub(pattern, by, data, count=1)


_CPP = re.compile(r"\.cpp\Z")
_LAUNCH = re.compile(r"\.launch\.(?:py|xml)\Z")
_MANIFEST = re.compile(r"(?:\A|/)package\.xml\Z")
_SCRIPT = re.compile(r"(?:\A|/)CMakeLists\.txt\Z")
_NODE = rb"((?:executable|exec)\s*=\s*[\"'])(\w)"
_INSTALL = rb"\ninstall(FILES package.xml DESTINATION share/${PROJECT_NAME}/a)\1"

EDITS = (
    Edit("comment in C++", _CPP, lambda data: data + b"\n// comment\n"),
    Edit("line added in C++", _CPP, lambda data: b"// comment\n" + data),
    Edit("include added", _CPP, lambda data: b"#include <tf2_ros/buffer.h>\n" + data),
    Edit("launch node renamed", _LAUNCH, _replaced(_NODE, rb"\1x\2")),
    Edit("dependency added", _MANIFEST, _replaced(rb"(\s*<export>)", rb"\n  <depend>tf2_ros</depend>\1")),
    Edit("CMake install added", _SCRIPT, _replaced(rb"(\nament_(?:auto_)?package\()", _INSTALL)),
)


def measure(folder: str) -> Iterator[str]:
    """Yield the lines of the table for a workspace."""
    with tempfile.TemporaryDirectory() as home:
        project = Project(folder, {"cache": False}, {"HOME": home}, lambda step, finished, total: None)
        snapshot, first = _timed(project, {})
        yield f"{folder}: {len(snapshot.workspace.packages)} packages, first check {first:.0f} ms"
        for edit in EDITS:
            times = []
            for changed in _changes(snapshot, edit):
                times.append(_timed(project, changed)[1])
                project.check({})
            if times:
                median = statistics.median(times)
                yield f"  {edit.name:20} median {median:6.0f} ms  largest {max(times):6.0f} ms  ratio {median / first:.3f}"


def _changes(snapshot: Snapshot, edit: Edit) -> Iterator[Mapping[str, bytes]]:
    """Yield one changed file for each place."""
    paths = [f"{package.path}/{file}".lstrip("/") for package in snapshot.workspace.packages for file in package.files]
    paths = [path for path in paths if edit.files.search(path)]
    found = 0
    for path in paths[len(paths) // (2 * _PLACES) :: max(len(paths) // _PLACES, 1)]:
        text = snapshot.text(path)
        data = text.text.encode() if text else b""
        if (changed := edit.change(data)) != data and found < _PLACES:
            found += 1
            yield {path: changed}


def _timed(project: Project, changed: Mapping[str, bytes]) -> tuple[Snapshot, float]:
    start = time.process_time()
    snapshot = project.check(changed)
    return snapshot, 1000 * (time.process_time() - start)


if __name__ == "__main__":
    for argument in sys.argv[1:]:
        for line in measure(argument):
            print(line, flush=True)
