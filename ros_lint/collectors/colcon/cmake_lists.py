"""A ``CMakeLists.txt`` without a usable manifest, read by the patterns of colcon.

CMake itself is evaluated by :mod:`ros_lint.collectors.cmake`. This module reproduces the patterns of colcon, including
their errors, because they determine the packages and their order. Source: package identification of colcon-cmake.
"""

from __future__ import annotations

import re
from bisect import bisect_right
from typing import TYPE_CHECKING, NamedTuple

from ros_lint.facts.manifest import ColconDepend, Role

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ros_lint.base.text import Span, Text

# colcon searches these words anywhere, so my_project(x) counts as project(x).
_PROJECT = re.compile(r"""project\s*\(\s*("?)([a-zA-Z0-9_-]+)\1(?:\s[^)]*)?\)""", re.IGNORECASE)
_FIND_PACKAGE = re.compile(r"""find_package\s*\(\s*("?)([a-zA-Z0-9_-]+)\1(?:\s[^)]*)?\)""", re.IGNORECASE)
_PKG_CONFIG = re.compile(
    r"""pkg_(?:check_modules|search_module)\s*\(\s*("?)[a-zA-Z0-9_]+\1"""
    r"""(?:\s+(?:(?-i:REQUIRED|QUIET|NO_CMAKE_PATH|NO_CMAKE_ENVIRONMENT_PATH)))*([^)]+)\)""",
    re.IGNORECASE,
)
_SUBDIRECTORY = re.compile(
    r"""\badd_(?:\w+_)?subdirectory\s*\(\s*"?(?:\$\{(?:CMAKE_CURRENT|PROJECT|CMAKE)_(?:SOURCE|LIST)_DIR\}/)?(?:\./)*"""
    r"""(/*[^\s"$)/]+(?:/+[^\s"$)/]+)*|/)/*["\s)]""",
    re.IGNORECASE,
)
_WORD = re.compile(r"\S+")
_PIECE = re.compile(r"""("[^"]*")|(#.*)|([^#"]*)""")
_VERSION = re.compile(r"[<>=]")


class Project(NamedTuple):
    """The data that colcon reads from a ``CMakeLists.txt``."""

    name: str
    """The name in the first project() with a literal name, "" if there is none."""
    toplevel: bool
    """True for the CMakeLists.txt that catkin_make puts into src/, which does not define a package."""


def project(text: Text) -> Project:
    """Return the data that colcon reads from a ``CMakeLists.txt``. The project name is the name of the package."""
    match = _PROJECT.search(_PlainText(text).closed())
    name = match[2] if match else ""
    toplevel = name == "Project" and "catkin_workspace()" in text.text.splitlines()
    return Project(name, toplevel)


def depends(text: Text) -> tuple[ColconDepend, ...]:
    """Return the dependencies by which colcon orders a plain CMake package, read from one CMake file of the package.

    Such a file is ``CMakeLists.txt`` or ``*.cmake``. Dependencies of a package on itself are included.
    """
    if "find_package" not in (lower := text.text.lower()) and "pkg_" not in lower:
        return ()
    bare = _PlainText(text)
    content = bare.closed()
    names = [(match[2], *match.span(2)) for match in _FIND_PACKAGE.finditer(content)]
    names += list(_modules(content))
    return tuple(ColconDepend(name, Role.BUILD | Role.EXEC, bare.span(start, end)) for name, start, end in names)


def subdirectories(text: Text) -> frozenset[str]:
    """Return the folders that a ``CMakeLists.txt`` adds by add_subdirectory() with a literal path, relative to its folder.

    Functions that wrap add_subdirectory() count if a word is inserted into their name: ``add_optional_subdirectory``.
    """
    return frozenset(match[1] for match in _SUBDIRECTORY.finditer(_PlainText(text).content))


def _modules(content: str) -> Iterator[tuple[str, int, int]]:
    for match in _PKG_CONFIG.finditer(content):
        for word in _WORD.finditer(content, *match.span(2)):
            yield _VERSION.split(word[0], 1)[0], *word.span()


class _PlainText:
    """The content of a CMake file without comments and unclosed quotes; converts its offsets to spans of the file."""

    def __init__(self, text: Text) -> None:
        self._text = text
        self._piece_starts: list[int] = []
        self._origins: list[int] = []
        pieces: list[str] = []
        size = offset = 0
        for line in text.text.splitlines(keepends=True):
            body = line.splitlines()[0]
            for piece in _PIECE.finditer(body):
                if piece_text := piece[1] or piece[3]:
                    self._piece_starts.append(size)
                    self._origins.append(offset + piece.start())
                    pieces.append(piece_text)
                    size += len(piece_text)
            pieces.append("\n")
            size += 1
            offset += len(line)
        self.content = "".join(pieces)

    def closed(self) -> str:
        """Return the content up to its last closing parenthesis.

        The rest has no complete command, and each unclosed parenthesis in the rest would cost a search to its end.
        """
        return self.content[: self.content.rfind(")") + 1]

    def span(self, start: int, end: int) -> Span:
        return self._text.span(self._origin(start), self._origin(end - 1) + 1)

    def _origin(self, at: int) -> int:
        index = bisect_right(self._piece_starts, at) - 1
        return self._origins[index] + at - self._piece_starts[index]
