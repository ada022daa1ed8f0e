"""Input of an evaluation: the scripts and files of a package, files outside of it, and helper packages."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from collections.abc import Set as AbstractSet
from typing import Final, NamedTuple

from ros_lint.collectors.cmake.syntax import ParsedScript
from ros_lint.facts.build import BuildScript

OUTSIDE: Final = ".."
"""The provider of scripts outside of the package, but in the same tree: they run like scripts of the package."""


class OutsideTree(NamedTuple):
    """Access to the files of the tree outside of a package.

    Paths are relative to the base of the tree; nothing outside of it is visible.
    """

    kind: Callable[[str], str] = lambda path: ""
    """Returns "file" or "directory", or "" if the path does not exist or is not visible."""
    below: Callable[[str], Sequence[str]] = lambda folder: ()
    """Lists every file below a folder; empty if some of them are not visible."""
    script: Callable[[str], ParsedScript | None] = lambda path: None
    """Parses a CMake file; None if it does not exist or is not visible."""


class Sources(NamedTuple):
    """The files of a package that its CMake scripts can read, and its metadata."""

    name: str
    """The name in package.xml, or ""."""
    path: str
    """The folder of the package, relative to the base of the run; "" is the base."""
    files: Sequence[str]
    """Every file below the folder, relative to it, sorted."""
    scripts: Mapping[str, ParsedScript]
    """CMakeLists.txt and all ``*.cmake`` and ``*.cmake.in`` files, by path relative to the folder."""
    executables: AbstractSet[str] = frozenset()
    """Files with the executable bit in the whole tree, relative to the folder."""
    version: str = ""
    """The version in package.xml."""
    build_depends: tuple[str, ...] = ()
    """Packages that package.xml declares for the build. ament_auto_find_build_dependencies() finds them."""
    test_depends: tuple[str, ...] = ()
    unlisted_folders: tuple[str, ...] = ()
    """Existing folders below the package, relative to it, whose files are not in ``files``."""
    texts: Mapping[str, str] = {}
    """Contents of files that are read while CMake runs, such as setup.cfg, by path relative to the folder."""
    list_unlisted: Callable[[str], Sequence[str]] = lambda folder: ()
    """Lists the files below one of the ``unlisted_folders``, relative to the package.

    Empty if that is not possible."""
    outside: OutsideTree = OutsideTree()


class Helper(NamedTuple):
    """Another package of the workspace whose CMake code runs in its dependents (CONFIG_EXTRAS)."""

    sources: Sources
    script: BuildScript
