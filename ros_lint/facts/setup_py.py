"""What ``setup.py`` and ``setup.cfg`` name, and where a fix can change them."""

from __future__ import annotations

from typing import Literal, NamedTuple

from ros_lint.base.text import Span


class EntryPoint(NamedTuple):
    """An entry point of a Python distribution."""

    group: str
    name: str
    target: str
    """``module:attribute``."""
    span: Span

    @property
    def module(self) -> str:
        """The dotted name of the module."""
        return self.target.partition(":")[0].strip()


class PythonModule(NamedTuple):
    """A module of the package's own that an entry point names."""

    name: str
    """Dotted."""
    path: str
    """Relative to the package."""
    names: tuple[str, ...]
    """What it defines or imports at its top level, sorted."""
    open: bool
    """Whether it may have further names."""


class EditableList(NamedTuple):
    """A list in ``setup.py`` that a fix can add an element to."""

    option: str
    """``data_files``, ``packages`` or ``console_scripts``."""
    end: Span
    """The empty span after the last element, and after the comma behind it and its comment if there is a comma."""
    comma: bool
    """Whether there is one."""
    indent: str | None
    """The white space before the last element where it stands on a line of its own, else None."""
    size: int
    """How many elements there are."""
    variable: str = ""
    """A variable that holds the name of the package, if setup.py has one."""
    glob: str = ""
    """By which name setup.py calls glob.glob, "" if it does not import it."""
    quote: str = "'"
    """What stands around most texts in the list."""
    joins: str = ""
    """How folders are put together there: by this function, by f-strings ("f") or by ``+`` ("")."""


class WrittenText(NamedTuple):
    """A place in ``setup.py`` or ``setup.cfg`` that a fix can change a text at."""

    kind: Literal["glob", "gap", "section", "option"]
    """The pattern of a glob, or what it ends with; where a comma between two texts is missing, most likely; a section of
    ``setup.cfg``, or its last line; or an option."""
    text: str
    """The name of a section, "" for the last line; ``section.name`` of an option."""
    span: Span
    """Of the text without its quotes; of the value of an option; of others, empty, and at the end of the line."""
