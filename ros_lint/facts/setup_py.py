"""Facts about ``setup.py`` and ``setup.cfg``: entry points, and places that a fix can edit."""

from __future__ import annotations

from typing import Literal, NamedTuple

from ros_lint.base.text import Span


class EntryPoint(NamedTuple):
    """An entry point that a setup.py or setup.cfg declares: ``talker = robot.talker:main`` in the group console_scripts."""

    group: str
    """Group of the entry point, such as "console_scripts"."""
    name: str
    """Name of the entry point in its group. For a console script, this is the name of the program."""
    target: str
    """The object that the entry point refers to, as ``module:attribute``."""
    span: Span
    """Place of the entry point in the file."""

    @property
    def module(self) -> str:
        """Dotted name of the module in ``target``."""
        return self.target.partition(":")[0].strip()


class PythonModule(NamedTuple):
    """A module of the package that an entry point refers to."""

    name: str
    """Dotted name of the module."""
    path: str
    """Path of the module's file, relative to the package."""
    names: tuple[str, ...]
    """Names defined or imported at the top level of the module, sorted."""
    open: bool
    """True if the module may define names that are not listed."""


class EditableList(NamedTuple):
    """A list in ``setup.py`` to which a fix can add an element."""

    option: str
    """Name of the option of setup() with the list: ``data_files``, ``packages`` or ``console_scripts``."""
    end: Span
    """Empty span after the last element. If a comma follows the element, the span is after the comma and its comment."""
    comma: bool
    """True if a comma follows the last element."""
    indent: str | None
    """White space before the last element if the element has a line of its own, else None."""
    size: int
    """Number of elements in the list."""
    variable: str = ""
    """Name of the variable of setup.py that contains the package name, "" if there is none."""
    glob: str = ""
    """Name by which setup.py calls glob.glob, "" if setup.py does not import it."""
    quote: str = "'"
    """Quote character of most strings in the list."""
    joins: str = ""
    """How setup.py joins paths: the name of a function, "f" for f-strings, or "" for ``+``."""


class WrittenText(NamedTuple):
    """A place in ``setup.py`` or ``setup.cfg`` where a fix can change a text."""

    kind: Literal["glob", "gap", "section", "option"]
    """Kind of the place.

    * "glob": the pattern of a glob, or the place where the pattern ends.
    * "gap": a place between two strings where a comma is probably missing.
    * "section": a section of ``setup.cfg``, or the last line of the file.
    * "option": an option of ``setup.cfg``.
    """
    text: str
    """Text at the place. For a section, the name of the section ("" for the last line); for an option, ``section.name``."""
    span: Span
    """Place of the text without its quotes, or of the value of an option.

    For a "gap" or "section" it is empty and at the end of the line.
    """
