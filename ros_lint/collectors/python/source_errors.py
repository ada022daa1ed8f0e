"""The exceptions and the result of parsing Python sources."""

from __future__ import annotations

import ast
from typing import NamedTuple

from ros_lint.base.text import Span
from ros_lint.facts.visibility import NewerSyntax


class NotPythonError(Exception):
    """A source is not valid Python of any version. :func:`refusal` returns the reason."""


class TooDeepError(NotPythonError):
    """A source exceeds a limit of ros-lint. It may still be valid Python."""

    def __init__(self, message: str, span: Span) -> None:
        super().__init__(message)
        self.message = message
        self.span = span


class Parsed(NamedTuple):
    """A source that some version of Python accepts."""

    tree: ast.Module
    newer: tuple[NewerSyntax, ...]
    """Constructs that were added after Python 3.10, in order."""
