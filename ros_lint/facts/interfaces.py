"""Facts about definition files of messages, services and actions."""

from __future__ import annotations

from typing import NamedTuple

from ros_lint.base.text import Span


class InterfaceProblem(NamedTuple):
    """An error in an interface definition: rosidl rejects the definition, or the generated code does not compile."""

    message: str
    """Text of the error in lower case without a final full stop."""
    span: Span
    """Place of the error."""
    instead: str | None = None
    """The text that corrects the error if it replaces the text at ``span``; None if the correct text is not certain."""


class InterfaceFile(NamedTuple):
    """The contents of a .msg, .srv or .action file, read as rosidl_adapter reads it."""

    path: str
    """Path of the file, relative to the base folder of the run."""
    types: tuple[tuple[str, Span], ...] = ()
    """Types of the fields, as written, with their places: ``Type`` of the same package, or ``package/Type``."""
    problems: tuple[InterfaceProblem, ...] = ()
    """Errors in the definition."""
