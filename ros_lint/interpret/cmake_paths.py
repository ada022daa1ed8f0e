"""Where a CMake run is, and what paths mean there."""

from __future__ import annotations

import posixpath
import re
from bisect import bisect_left
from collections.abc import Sequence
from functools import lru_cache

from ros_lint.interpret.cmake_sources import Sources
from ros_lint.interpret.cmake_state import Frame, State
from ros_lint.interpret.cmake_values import ATOM, BINARY, HOLE, MAYBE, PREFIX, SOURCE
from ros_lint.knowledge.cmake_commands import VARIABLES
from ros_lint.tree import join as join_path

_OF_BUILD = "$<BUILD_INTERFACE:"


class Paths(State):
    """A state that knows the files of the package, and which folder and which file is being run."""

    def __init__(self, sources: Sources) -> None:
        super().__init__()
        self.sources = sources
        self.files = frozenset(sources.files)
        self.frames: list[Frame] = []
        self.directories: list[str] = [""]
        """The folder whose CMakeLists.txt runs, relative to the package; outer ones before it."""
        self.places: dict[str, str] = {}
        """Variables that follow the directory and the file that is being run."""

    def at_home(self) -> bool:
        """Return whether the current command stands in a file of the package."""
        return self.frames[-1].own

    @property
    def directory(self) -> str:
        return self.directories[-1]

    def source(self, value: str) -> str | None:
        """Return a path relative to the package, or None for one that lies elsewhere or is not known."""
        return _source(self.directories[-1], value)

    def leads_out(self, value: str) -> bool:
        """Return whether a path that may be given to a build lies among the sources, but outside of the package."""
        plain = value.lstrip(MAYBE).removeprefix(_OF_BUILD)
        if HOLE in plain or plain.startswith("$<"):
            return False
        below = plain.removeprefix(SOURCE)
        if below == plain:
            below = join_path(self.directories[-1], plain) if plain[:1] != "/" else ""
        return posixpath.normpath(below.lstrip("/")).startswith("../")

    def destination(self, value: str) -> str | None:
        """Return an install destination relative to the prefix, or None when it is not known or lies elsewhere."""
        return _destination(value)

    def build(self, value: str) -> str | None:
        """Return a path relative to the build folder of the package, None for one that lies elsewhere or is not known."""
        if HOLE in value or not (value.startswith(f"{BINARY}/") or value == BINARY):
            return None
        path = posixpath.normpath(value[len(BINARY) :].lstrip("/"))
        return None if path.startswith("..") or ATOM in path else path.removeprefix(".")

    def is_folder(self, path: str) -> bool:
        """Return whether the package has such a folder, with a file in it."""
        return not path or bool(self.below(path)) or self.is_unseen(path)

    def is_unseen(self, path: str) -> bool:
        """Return whether a path lies in a folder whose files are not listed."""
        return any(path == folder or path.startswith(f"{folder}/") for folder in self.sources.unseen)

    def below(self, path: str) -> Sequence[str]:
        """Return the files below a folder, sorted."""
        files = self.sources.files
        if not path:
            return files
        start = bisect_left(files, f"{path}/")
        return files[start : bisect_left(files, f"{path}0", start)]  # the character after the slash is the zero

    def enter_directory(self, path: str) -> None:
        """Make a folder of the package the current one."""
        self.directories.append(path)
        self._place_directory()

    def leave_directory(self) -> None:
        self.directories.pop()
        self._place_directory()

    def _place_directory(self) -> None:
        self.places["CMAKE_CURRENT_SOURCE_DIR"] = join_path(SOURCE, self.directory).rstrip("/")
        self.places["CMAKE_CURRENT_BINARY_DIR"] = join_path(BINARY, self.directory).rstrip("/")

    def enter_file(self, frame: Frame) -> None:
        """Run a file from now on."""
        self.frames.append(frame)
        self.place_file()

    def place_file(self) -> None:
        """Set the variables that name the file that is being run."""
        for frame in reversed(self.frames):
            if frame.procedure is None:
                self.places["CMAKE_CURRENT_LIST_FILE"] = frame.file
                self.places["CMAKE_CURRENT_LIST_DIR"] = frame.folder
                break


@lru_cache(maxsize=4096)
def _source(directory: str, value: str) -> str | None:
    """Return a path relative to the package, given the folder whose script names it."""
    if HOLE in value:
        return None
    if value.startswith(SOURCE):
        rest = value[len(SOURCE) :]
        if rest and not rest.startswith("/"):
            return None
        path = rest.lstrip("/")
    elif value.startswith(("/", "$<")) or not value:
        return None
    else:
        path = join_path(directory, value)
    if ATOM in path:
        return None  # before ".." is followed: what is not known may be several folders, or lie elsewhere
    path = posixpath.normpath(path)
    if path.startswith("../") or path == "..":
        return None
    return "" if path == "." else path


@lru_cache(maxsize=1024)
def _destination(value: str) -> str | None:
    """Return an install destination relative to the prefix."""
    if value.startswith(PREFIX):
        value = value[len(PREFIX) :].lstrip("/")
    value = _MODULES.sub(VARIABLES["PYTHON_INSTALL_DIR"], value)
    if HOLE in value or MAYBE in value or "\1" in value or value.startswith("/") or "$<" in value:
        return None
    path = posixpath.normpath(value) if value else ""
    return "" if path == "." else path


_MODULES = re.compile(rf"\Alib/python(?=[^/]*[{HOLE}{ATOM}])[^/]*/(?:site|dist)-packages(?=/|\Z)")
"""Where Python looks for modules, of a version that is not known."""
