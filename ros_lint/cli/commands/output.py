"""Functions for the output of several commands: a place in JSON, a text in a Mermaid flow chart."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ros_lint.base.text import Span


def where(span: Span) -> dict[str, object]:
    """Return the start of a span for JSON: path, line and column."""
    return {"path": span.path, "line": span.line, "column": span.column}


def label(text: str) -> str:
    """Return a text escaped for a label in a Mermaid flow chart."""
    return "".join(letter if letter.isalnum() or letter in "_-. /" else f"#{ord(letter)};" for letter in text)
