"""The result of parsing a Python source, and the exceptions that parsing raises."""

from __future__ import annotations

import ast
from typing import NamedTuple

from ros_lint.base.text import Span
from ros_lint.facts.visibility import NewerSyntax


class NotPythonError(Exception):
    """A source is not valid Python of any version. :func:`ros_lint.collectors.python.syntax.refusal` returns the reason."""


class TooDeepError(NotPythonError):
    """A source exceeds a limit of ros-lint, such as the depth of nested expressions. It may be valid Python."""

    def __init__(self, message: str, span: Span) -> None:
        super().__init__(message)
        self.message = message
        self.span = span


class Parsed(NamedTuple):
    """The syntax tree of a source, which is valid in some version of Python, and the constructs newer than Python 3.10."""

    tree: ast.Module
    newer: tuple[NewerSyntax, ...]
    """Constructs that were added after Python 3.10, in order of position."""
