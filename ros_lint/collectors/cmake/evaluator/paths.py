"""The current directory of a CMake run, and the conversion of path arguments to paths relative to the package."""

from __future__ import annotations

import posixpath
import re
from bisect import bisect_left
from collections.abc import Sequence
from functools import lru_cache

from ros_lint.base.paths import is_outside, relative, resolve, strip_folder
from ros_lint.base.paths import join as join_path
from ros_lint.base.wildcards import LONGEST
from ros_lint.collectors.cmake.evaluator.sources import Sources
from ros_lint.collectors.cmake.evaluator.values import ATOM, BINARY, HOLE, MAYBE, PREFIX, TREE
from ros_lint.collectors.cmake.released_macros import VARIABLES
from ros_lint.collectors.cmake.syntax import ParsedScript

_OF_BUILD = "$<BUILD_INTERFACE:"


class Paths:
    """The files of the package, the current directory, and the conversion of path arguments to paths relative to the package."""

    def __init__(self, sources: Sources, places: dict[str, str]) -> None:
        self.sources = sources
        self.files = frozenset(sources.files)
        self.generated: set[str] = set()
        """Files in the package that the build generates. A slash at the end marks a folder with unknown files."""
        self.configured: dict[str, bool] = {}
        """Files below the build folder that configure_file() writes, each with whether this is certain."""
        self.directories: list[tuple[str, str]] = [("", BINARY)]
        """The current source directories, outermost first: each relative to the package, with its build folder."""
        self._places = places
        self._places.update(dict.fromkeys(("CMAKE_SOURCE_DIR", "PROJECT_SOURCE_DIR"), self.absolute("")))
        self._place_directory()

    @property
    def directory(self) -> str:
        return self.directories[-1][0]

    def absolute(self, path: str) -> str:
        """Return the absolute path of a file or folder, given its path relative to the package.

        The absolute path starts with the placeholder of the workspace folder (``TREE``).
        """
        place = self.tree_path(path)
        return f"{TREE}/{place}" if place else TREE

    def tree_path(self, path: str) -> str:
        """Return the path of a file or folder relative to the root of the workspace, given its path relative to the package."""
        if is_outside(path):
            path = resolve(self.sources.path, path)
            return "" if path == "." else path
        return join_path(self.sources.path, path) if path else self.sources.path

    def relative(self, value: str) -> str | None:
        """Return the path argument ``value`` as a path relative to the package, such as ``src/a.cpp`` or ``../other/a.txt``.

        The result is None if the path is outside of the workspace or unknown.
        """
        return _relative_to(self.sources.path, self.directories[-1][0], value) if len(value) <= LONGEST else None

    def source(self, value: str) -> str | None:
        """Return the path argument ``value`` as a path relative to the package; None for a path outside, or an unknown path."""
        path = self.relative(value)
        return None if path is None or is_outside(path) else path

    def outside(self, value: str) -> str | None:
        """Return the path argument ``value`` as a path relative to the package if it exists outside of the package, else None.

        Files outside of the workspace count as missing.
        """
        path = self.relative(value)
        return path if path is not None and is_outside(path) and self.sources.outside.kind(self.tree_path(path)) else None

    def source_or_outside(self, value: str) -> str | None:
        """Return the result of :meth:`source`, or of :meth:`outside` if the result of :meth:`source` is None."""
        path = self.source(value)
        return self.outside(value) if path is None else path

    def script(self, path: str) -> ParsedScript | None:
        """Return the parsed CMake file at a path relative to the package; None if the workspace has no such file."""
        return self.sources.outside.script(self.tree_path(path)) if is_outside(path) else self.sources.scripts.get(path)

    def is_outside_source(self, value: str) -> bool:
        """Return whether a path argument is a source folder outside of the package.

        A prefix ``$<BUILD_INTERFACE:`` of the argument is ignored.
        """
        plain = value.lstrip(MAYBE).removeprefix(_OF_BUILD)
        if HOLE in plain or plain.startswith("$<") or (plain[:1] == "/" and not plain.startswith(TREE)):
            return False
        path = self.relative(plain)
        return ".." in plain if path is None else is_outside(path)

    def destination(self, value: str) -> str | None:
        """Return an install destination relative to the install prefix: ``${CMAKE_INSTALL_PREFIX}/lib`` -> ``lib``.

        The result is None if the destination is unknown or outside of the install prefix.
        """
        return _destination(value) if len(value) <= LONGEST else None

    def build_path(self, value: str) -> str | None:
        """Return the path argument ``value`` as a path relative to the build folder of the package.

        The result is None if the path is outside of the build folder or unknown.
        """
        if HOLE in value or len(value) > LONGEST or not (value.startswith(f"{BINARY}/") or value == BINARY):
            return None
        path = posixpath.normpath(value[len(BINARY) :].lstrip("/"))
        return None if path.startswith("..") or ATOM in path else path.removeprefix(".")

    def normalized(self, path: str) -> str:
        """Return the normalized path of a file, relative to the package: ``../package/file`` -> ``file``.

        The result is "" if the path is in the package but no such file exists.
        """
        path = relative(self.sources.path, self.tree_path(path)) if is_outside(path) else path
        return path if path in self.files or is_outside(path) else ""

    def is_folder(self, path: str) -> bool:
        """Return whether a folder exists. A folder in the package exists only if it contains a file."""
        if is_outside(path):
            return self.sources.outside.kind(self.tree_path(path)) == "directory"
        return not path or bool(self.files_below(path)) or self.is_unlisted(path)

    def is_file(self, path: str) -> bool:
        """Return whether a file exists."""
        return self.sources.outside.kind(self.tree_path(path)) == "file" if is_outside(path) else path in self.files

    def is_unlisted(self, path: str) -> bool:
        """Return whether a path is in a nested package or in a folder with a COLCON_IGNORE.

        Files there do not belong to the package, so its list of files does not have them.
        """
        return any(path == folder or path.startswith(f"{folder}/") for folder in self.sources.unlisted_folders)

    def files_below(self, path: str) -> Sequence[str]:
        """Return the files below a folder, sorted. ``path`` and the results are relative to the package.

        The result is empty for a folder outside of the package if only some of its files are known.
        """
        if is_outside(path):
            place = self.tree_path(path)
            return [f"{path}/{strip_folder(place, file)}" for file in self.sources.outside.below(place)]
        files = self.sources.files
        if not path:
            return files
        start = bisect_left(files, f"{path}/")
        return files[start : bisect_left(files, f"{path}0", start)]  # "0" is the character after "/"

    def enter_directory(self, path: str, build: str) -> None:
        """Make a folder the current directory. ``path`` is relative to the package, ``build`` is the build folder of ``path``."""
        self.directories.append((path, build))
        self._place_directory()

    def leave_directory(self) -> None:
        self.directories.pop()
        self._place_directory()

    def _place_directory(self) -> None:
        directory, build = self.directories[-1]
        self._places["CMAKE_CURRENT_SOURCE_DIR"] = self.absolute(directory)
        self._places["CMAKE_CURRENT_BINARY_DIR"] = build


@lru_cache(maxsize=4096)
def _relative_to(package: str, directory: str, value: str) -> str | None:
    """Return the path argument ``value`` of a command as a path relative to ``package``.

    ``directory`` is the folder of the script with the argument, relative to the package. The result is None if the path is
    outside of the workspace or unknown.
    """
    if HOLE in value:
        return None
    if value.startswith(TREE):
        below = value[len(TREE) :]
        if below and not below.startswith("/"):
            return None
        path = below.lstrip("/")
    elif value.startswith(("/", "$<")) or not value:
        return None
    else:
        path = join_path(package, join_path(directory, value))
    if ATOM in path:
        return None  # before ".." is resolved, because the unknown part may be several folders or a place elsewhere
    path = posixpath.normpath(path)
    if is_outside(path) and package:
        return f"{'../' * (package.count('/') + 1)}{path}"
    path = relative(package, path) if package and not path.startswith(f"{package}/") else strip_folder(package, path)
    return "" if path == "." else path


@lru_cache(maxsize=1024)
def _destination(value: str) -> str | None:
    """Return an install destination relative to the install prefix: ``${CMAKE_INSTALL_PREFIX}/lib`` -> ``lib``.

    The result is None if the destination is unknown or outside of the install prefix.
    """
    if value.startswith(PREFIX):
        value = value[len(PREFIX) :].lstrip("/")
    value = _MODULES.sub(VARIABLES["PYTHON_INSTALL_DIR"], value)
    if HOLE in value or MAYBE in value or "\1" in value or value.startswith("/") or "$<" in value:
        return None
    path = posixpath.normpath(value) if value else ""
    return "" if path == "." else path


_MODULES = re.compile(rf"\Alib/python(?=[^/]*[{HOLE}{ATOM}])[^/]*/(?:site|dist)-packages(?=/|\Z)")
"""The start of an install path: a folder of Python modules whose Python version is unknown."""
