"""Errors and the result of parsing Python sources."""

from __future__ import annotations

import ast
from typing import NamedTuple

from ros_lint.base.text import Span
from ros_lint.facts.visibility import NewerSyntax


class NotPythonError(Exception):
    """A source is no Python of any version. :func:`refusal` says why."""


class TooDeepError(NotPythonError):
    """A source exceeds a bound of ros-lint. It may be Python all the same."""

    def __init__(self, message: str, span: Span) -> None:
        super().__init__(message)
        self.message = message
        self.span = span


class Parsed(NamedTuple):
    """A source that some version of Python reads."""

    tree: ast.Module
    newer: tuple[NewerSyntax, ...]
    """What came later than Python 3.10, in order."""
