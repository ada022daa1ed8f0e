"""Headers that are installed with a target: file sets (FILE_SET), and the property PUBLIC_HEADER."""

from __future__ import annotations

import posixpath
from collections.abc import Iterator
from typing import Final

from ros_lint.base.paths import join as join_path
from ros_lint.base.text import Span
from ros_lint.collectors.cmake.evaluator.arguments import sections
from ros_lint.collectors.cmake.evaluator.run import Run
from ros_lint.collectors.cmake.evaluator.state import Properties
from ros_lint.collectors.cmake.evaluator.values import elements, join, strip_mark
from ros_lint.collectors.cmake.released_macros import VISIBILITY
from ros_lint.facts.build import InstalledFile
from ros_lint.facts.visibility import Facet, Opaque

FILE_SET: Final = "FILE_SET "
"""Prefix of the keys of file sets among the artifacts of install(TARGETS): ``FILE_SET name``."""
DESTINATION: Final = "include"
"""Install destination of headers without a DESTINATION in install()."""
_WORDS: Final = {"FILE_SET": 1, "TYPE": 1, "BASE_DIRS": -1, "FILES": -1}


def file_sets(run: Run, target: Properties, args: list[str]) -> list[str]:
    """Record the file sets of a target_sources() call, and return all sources in the call."""
    sources: list[str] = []
    starts = [index for index, arg in enumerate(args) if arg in VISIBILITY or arg == "FILE_SET"]
    for start, end in zip([0, *starts], [*starts, len(args)], strict=True):
        parts = sections([arg for arg in args[start:end] if arg not in VISIBILITY], _WORDS)
        files = [*parts[""], *parts.get("FILES", [])]
        sources += files
        for name in parts.get("FILE_SET", []):
            for key, values in ((f"HEADER_SET_{name}", files), (f"HEADER_DIRS_{name}", parts.get("BASE_DIRS", []))):
                paths = [run.paths.source(strip_mark(value)[0]) for value in values]
                marked = [path if path is not None else "?" for path in paths]
                run.put(target, key, join([*elements(target.get(key, "")), *marked]))
    return sources


def installed_headers(
    run: Run, name: str, target: Properties, places: tuple[tuple[str, str | None], ...], unsure: bool, span: Span
) -> Iterator[InstalledFile]:
    """Yield the headers that install(TARGETS) installs, given the destination of each artifact (such as PUBLIC_HEADER).

    If a file set or a destination is unknown, the libraries of the package are recorded as incompletely known.
    """
    for artifact, destination in places:
        if artifact.startswith(FILE_SET):
            of_set = artifact.removeprefix(FILE_SET)
            files = elements(target.get(f"HEADER_SET_{of_set}", "?"))
            folders = elements(target.get(f"HEADER_DIRS_{of_set}", "")) or [run.paths.source(".") or ""]
        else:
            files, folders = [run.paths.source(strip_mark(file)[0]) or "?" for file in elements(target.get(artifact, ""))], []
        for file in files:
            ends = [
                file[len(folder) + 1 :] if folder else file for folder in folders if not folder or file.startswith(f"{folder}/")
            ]
            end = min(ends, key=len, default=posixpath.basename(file))
            if file == "?" or destination is None:
                run.results.opaques.setdefault(Opaque(Facet.LIBRARIES, f"the headers of the target '{name}' are unknown", span))
            else:
                yield InstalledFile(join_path(destination, end), file, False, unsure, span, name)
