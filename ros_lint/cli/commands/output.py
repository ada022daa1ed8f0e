"""Functions for the output of several commands: JSON documents, a place in JSON, a text in a Mermaid flow chart."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Mapping

    from ros_lint.base.text import Span

SCHEMA_VERSION = 1
"""Version of the JSON documents of all commands except ``check``. It increases if a key changes its meaning or is removed."""


def document(content: Mapping[str, Any]) -> str:
    """Return a JSON document as text: the version of the schema, then the content. See ``commands.schema.json``."""
    import json  # noqa: PLC0415  (only for this format)

    from ros_lint.base.json_text import harmless  # noqa: PLC0415

    return harmless(json.dumps({"schema_version": SCHEMA_VERSION, **content}, indent=2, ensure_ascii=False) + "\n")


def where(span: Span) -> dict[str, object]:
    """Return the start of a span for JSON: path, line and column."""
    return {"path": span.path, "line": span.line, "column": span.column}


def label(text: str) -> str:
    """Return a text escaped for a label in a Mermaid flow chart."""
    return "".join(letter if letter.isalnum() or letter in "_-. /" else f"#{ord(letter)};" for letter in text)
