"""Facts about ``setup.py`` and ``setup.cfg``: names in them, and places that a fix can edit."""

from __future__ import annotations

from typing import Literal, NamedTuple

from ros_lint.base.text import Span


class EntryPoint(NamedTuple):
    """An entry point that a setup.py or setup.cfg declares: ``talker = robot.talker:main`` in the group console_scripts."""

    group: str
    """Group, such as "console_scripts"."""
    name: str
    """Name in the group: of a console script, the name of the program."""
    target: str
    """The target as ``module:attribute``."""
    span: Span
    """The place of the entry."""

    @property
    def module(self) -> str:
        """Dotted name of the module."""
        return self.target.partition(":")[0].strip()


class PythonModule(NamedTuple):
    """A module of this package that an entry point names."""

    name: str
    """Dotted name."""
    path: str
    """Path relative to the package."""
    names: tuple[str, ...]
    """Names defined or imported at the top level of the module, sorted."""
    open: bool
    """True if the module may define names that are not listed."""


class EditableList(NamedTuple):
    """A list in ``setup.py`` that a fix can add an element to."""

    option: str
    """Name of the option: ``data_files``, ``packages`` or ``console_scripts``."""
    end: Span
    """The empty span after the last element.

    If a comma follows the element, the span is after the comma and its comment.
    """
    comma: bool
    """True if a comma follows the last element."""
    indent: str | None
    """White space before the last element if the element has a line of its own, else None."""
    size: int
    """Number of elements."""
    variable: str = ""
    """Variable that holds the name of the package, "" if there is none."""
    glob: str = ""
    """Name by which setup.py calls glob.glob, "" if it does not import it."""
    quote: str = "'"
    """Quote character of most texts in the list."""
    joins: str = ""
    """The way in which setup.py joins paths: the name of a function, "f" for f-strings, or "" for ``+``."""


class WrittenText(NamedTuple):
    """A place in ``setup.py`` or ``setup.cfg`` where a fix can change a text."""

    kind: Literal["glob", "gap", "section", "option"]
    """Kind of the place.

    * "glob": the pattern of a glob, or its end.
    * "gap": a place between two texts where a comma is probably missing.
    * "section": a section of ``setup.cfg``, or its last line.
    * "option": an option of ``setup.cfg``.
    """
    text: str
    """Text at the place.

    For a section its name ("" for the last line), for an option ``section.name``.
    """
    span: Span
    """Span of the text without quotes, or of the value of an option.

    For the other kinds it is empty and at the end of the line.
    """
