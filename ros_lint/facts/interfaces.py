"""What a definition of a message, service or action says."""

from __future__ import annotations

from typing import NamedTuple

from ros_lint.base.text import Span


class InterfaceProblem(NamedTuple):
    """A place in a definition that rosidl refuses, or makes code of that no compiler takes."""

    message: str
    span: Span
    instead: str | None = None
    """What has to stand there for sure, None where somebody has to decide."""


class InterfaceFile(NamedTuple):
    """A .msg, .srv or .action file as rosidl_adapter reads it."""

    path: str
    types: tuple[tuple[str, Span], ...] = ()
    """Messages that its fields are made of, as written: ``Type`` of the same package, or ``package/Type``."""
    problems: tuple[InterfaceProblem, ...] = ()
