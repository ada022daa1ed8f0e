"""Data files about released packages: the folders that contain them, and look-ups of their lines by name.

A file is read and split into lines, but only the requested lines are parsed. This takes 1.3 ms for a distribution of
2,300 packages. To parse all lines would take a tenth of the time of a run.
"""

from __future__ import annotations

import os
import re
from bisect import bisect_left
from operator import gt
from typing import TYPE_CHECKING, Generic, TypeVar

from ros_lint.base import files
from ros_lint.errors import UserError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping, Sequence

T = TypeVar("T")

_MOST_BYTES = 1 << 28

SHIPPED = os.path.join(os.path.dirname(os.path.abspath(__file__)), "data")


class KnowledgeError(UserError):
    """A data file cannot be read or is invalid. The message names the file and a remedy."""


def user_directory(environ: Mapping[str, str]) -> str:
    """Return the folder to which ``ros-lint index refresh`` writes data files, by the XDG base directory specification.

    The folder may not exist.
    """
    home = environ.get("HOME") or os.path.expanduser("~")
    base = environ.get("XDG_DATA_HOME", "")
    if not os.path.isabs(base):
        base = os.path.join(home, ".local", "share")
    return os.path.join(base, "ros-lint", "index")


class Store:
    """The folders with data files.

    If several folders have a file, the first one counts; the folder shipped with ros-lint is last.
    """

    __slots__ = ("places",)

    def __init__(self, places: Sequence[str] = ()) -> None:
        self.places = (*places, SHIPPED)

    def find(self, name: str) -> str | None:
        """Return the path of the data file ``name``, None if no folder has it."""
        for place in self.places:
            path = os.path.join(place, name)
            if os.path.isfile(path):
                return path
        return None

    def names(self, suffix: str) -> tuple[str, ...]:
        """Return the names of all data files with a suffix, sorted, with the suffix removed."""
        names: set[str] = set()
        for place in self.places:
            try:
                entries = os.listdir(place)
            except OSError:
                continue
            names.update(entry.removesuffix(suffix) for entry in entries if entry.endswith(suffix))
        return tuple(sorted(names))

    def lines(self, name: str) -> tuple[str, list[str]]:
        """Return the header line of a data file, and a list of its other lines; "" and [] if there is no file.

        Raises KnowledgeError if the file cannot be read, has no header line, or has another number of lines than its
        header states.
        """
        path = self.find(name)
        if path is None:
            return "", []
        try:
            text = files.read(path, _MOST_BYTES).decode("utf-8")
        except (OSError, UnicodeDecodeError) as error:
            raise KnowledgeError(f"{path} cannot be read: {error}; {_advice(path)}") from error
        head, _, body = text.partition("\n")
        if not head.startswith("#"):
            raise KnowledgeError(f"{path} is not a data file of ros-lint, because it has no header line; {_advice(path)}")
        if not body:
            rows = []
        elif body.endswith("\n"):
            rows = body[:-1].split("\n")
        else:
            raise KnowledgeError(f"{path} is truncated in the middle of a line; {_advice(path)}")
        stated = _PACKAGES.search(head)
        if stated and int(stated[1]) != len(rows):
            raise KnowledgeError(f"{path} has {len(rows)} packages, but its header states {stated[1]}; {_advice(path)}")
        return head, rows

    def table(self, name: str) -> tuple[str, Table]:
        """Return the header line of a data file, and a table of its other lines.

        Raises KnowledgeError like :meth:`lines`, and if the lines are not sorted.
        """
        head, rows = self.lines(name)
        if any(map(gt, rows, rows[1:])):
            path = self.find(name) or name
            raise KnowledgeError(f"the lines of {path} are not sorted, so look-ups would fail; {_advice(path)}")
        return head, Table(rows, self.find(name) or "")


_PACKAGES = re.compile(r"\bpackages=(\d+)")


def _advice(path: str) -> str:
    if os.path.dirname(path) == SHIPPED:
        return "reinstall ros-lint"
    return "remove it, or run 'ros-lint index refresh'"


class Table:
    """Lines of tab-separated fields, sorted by their first field, the name. ``path`` is the path of the data file."""

    __slots__ = ("_lines", "path")

    def __init__(self, lines: list[str], path: str = "") -> None:
        self._lines = lines
        self.path = path

    def __len__(self) -> int:
        return len(self._lines)

    def line(self, name: str) -> str | None:
        """Return the line whose first field is ``name``, None if there is none."""
        at = bisect_left(self._lines, name)
        if at < len(self._lines):
            line = self._lines[at]
            if line == name or line.startswith(f"{name}\t"):
                return line
        return None

    def row(self, name: str) -> list[str] | None:
        """Return the fields of the line whose first field is ``name``, None if there is none."""
        line = self.line(name)
        return None if line is None else line.split("\t")

    def __contains__(self, name: str) -> bool:
        return self.line(name) is not None

    def lines(self) -> Iterator[str]:
        """Yield all lines, sorted."""
        return iter(self._lines)

    def names(self) -> Iterator[str]:
        """Yield the first field of every line, sorted."""
        return (line.partition("\t")[0] for line in self._lines)


class Entries(Generic[T]):
    """The lines of a table as parsed objects, by name. ``parse`` gets the fields of a line and may raise ValueError."""

    def __init__(self, table: Table, parse: Callable[[list[str]], T]) -> None:
        self._table = table
        self._parse = parse

    def __len__(self) -> int:
        return len(self._table)

    def __contains__(self, name: str) -> bool:
        return name in self._table

    def names(self) -> Iterator[str]:
        """Yield the name of every entry, sorted."""
        return self._table.names()

    def get(self, name: str) -> T | None:
        """Return the parsed line of ``name``, None if there is none. Raises KnowledgeError if the line is invalid."""
        row = self._table.row(name)
        if row is None:
            return None
        try:
            return self._parse(row)
        except ValueError as error:
            raise KnowledgeError(f"{self._table.path}: the line of '{name}' is invalid: {error}") from error
