"""Facts about definitions of messages, services and actions."""

from __future__ import annotations

from typing import NamedTuple

from ros_lint.base.text import Span


class InterfaceProblem(NamedTuple):
    """A place in a definition because of which rosidl fails, or the generated code does not compile."""

    message: str
    """Text in lower case without a final full stop."""
    span: Span
    """The place."""
    instead: str | None = None
    """The text to write there, None if the correct text is not certain."""


class InterfaceFile(NamedTuple):
    """A .msg, .srv or .action file as rosidl_adapter reads it."""

    path: str
    """Path of the file, relative to the base of the run."""
    types: tuple[tuple[str, Span], ...] = ()
    """Types of the fields, as written: ``Type`` of the same package, or ``package/Type``."""
    problems: tuple[InterfaceProblem, ...] = ()
    """Places that rosidl rejects."""
