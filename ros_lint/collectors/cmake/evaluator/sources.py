"""Input of the evaluation of a package's CMake scripts: its files, files outside of it, and other packages with CMake code."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from collections.abc import Set as AbstractSet
from typing import Final, NamedTuple

from ros_lint.collectors.cmake.syntax import ParsedScript
from ros_lint.facts.build import BuildScript

OUTSIDE: Final = ".."
"""The value that replaces the package name for scripts of the workspace outside of the package.

Such scripts run like scripts of the package."""


class OutsideTree(NamedTuple):
    """Access to the files of the workspace outside of a package.

    Paths are relative to the root of the workspace. Files outside of the workspace are treated as missing.
    """

    kind: Callable[[str], str] = lambda path: ""
    """A function that returns "file" or "directory" for a path, "" if the path does not exist or is outside of the workspace."""
    below: Callable[[str], Sequence[str]] = lambda folder: ()
    """A function that lists every file below a folder; the list is empty if some of the files are not accessible."""
    script: Callable[[str], ParsedScript | None] = lambda path: None
    """A function that parses a CMake file; None if the file does not exist or is not accessible."""


class Sources(NamedTuple):
    """The files of a package that CMake scripts of the package can read, and the metadata in its package.xml."""

    name: str
    """The name in package.xml, "" if there is none."""
    path: str
    """The folder of the package, relative to the root of the workspace; "" is the root."""
    files: Sequence[str]
    """Every file below the folder of the package, relative to this folder, sorted."""
    scripts: Mapping[str, ParsedScript]
    """CMakeLists.txt and all ``*.cmake`` and ``*.cmake.in`` files, by path relative to the folder of the package."""
    executables: AbstractSet[str] = frozenset()
    """Files of the workspace with the executable bit, relative to the folder of the package."""
    version: str = ""
    """The version in package.xml, "" if there is none."""
    build_depends: tuple[str, ...] = ()
    """Packages that package.xml declares as dependencies of the build. ament_auto_find_build_dependencies() finds them."""
    test_depends: tuple[str, ...] = ()
    unlisted_folders: tuple[str, ...] = ()
    """Existing folders below the package whose files are not in ``files``, relative to the folder of the package."""
    texts: Mapping[str, str] = {}
    """Contents of the files that CMake reads when it runs, such as setup.cfg, by path relative to the folder of the package."""
    list_unlisted: Callable[[str], Sequence[str]] = lambda folder: ()
    """A function that lists the files below one of the ``unlisted_folders``, relative to the package.

    The list is empty if the files cannot be listed."""
    outside: OutsideTree = OutsideTree()


class Helper(NamedTuple):
    """Another package of the workspace whose CMake code (CONFIG_EXTRAS) runs in the packages that find it."""

    sources: Sources
    script: BuildScript
