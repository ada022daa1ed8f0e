"""What an evaluation is given: a package's scripts and files, and the helpers among the other packages."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from collections.abc import Set as AbstractSet
from typing import Final, NamedTuple

from ros_lint.collectors.cmake.syntax import Parsed
from ros_lint.facts.build import BuildScript

AROUND: Final = ".."
"""What stands for the provider of scripts that lie in the tree around the package, and are run as if they were its own."""


class Around(NamedTuple):
    """The tree around a package, by paths relative to its base. What lies outside of the tree is not in sight."""

    kind: Callable[[str], str] = lambda path: ""
    """Says "file" or "directory", or "" where there is neither in sight."""
    below: Callable[[str], Sequence[str]] = lambda folder: ()
    """Lists every file below a folder; none where not all of them are in sight."""
    script: Callable[[str], Parsed | None] = lambda path: None
    """Reads a CMake file; None where there is none in sight."""


class Sources(NamedTuple):
    """What a package's CMake scripts can see of it."""

    name: str
    """As package.xml gives it, or ""."""
    path: str
    """The folder of the package, relative to the base of the run; "" is the base."""
    files: Sequence[str]
    """Every file below the folder, relative to it, sorted."""
    scripts: Mapping[str, Parsed]
    """CMakeLists.txt and all ``*.cmake`` and ``*.cmake.in`` files, by path relative to the folder."""
    executables: AbstractSet[str] = frozenset()
    """Those of the files that have the executable bit, and of those around the package, relative to it."""
    version: str = ""
    """As package.xml gives it."""
    build_depends: tuple[str, ...] = ()
    """What ament_auto_find_build_dependencies() finds: declared to build, to build with, or for everything."""
    test_depends: tuple[str, ...] = ()
    unseen: tuple[str, ...] = ()
    """Folders below the package, relative to it, that exist and whose files are not listed."""
    texts: Mapping[str, str] = {}
    """What files hold that are read while CMake runs, such as setup.cfg, by path relative to the folder."""
    look: Callable[[str], Sequence[str]] = lambda folder: ()
    """Lists the files below one of the unseen folders, relative to the package; none when that is not possible."""
    around: Around = Around()


class Helper(NamedTuple):
    """Another package of the workspace whose CMake code runs in those that find it (CONFIG_EXTRAS)."""

    sources: Sources
    script: BuildScript
