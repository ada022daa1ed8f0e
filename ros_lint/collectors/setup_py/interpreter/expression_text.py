"""Short texts of expressions, for the messages about unknown values."""

from __future__ import annotations

import ast
from typing import Any


def at(node: ast.AST | None) -> str:
    """Return the source of an expression, shortened to 40 characters for a message; "it" for None."""
    text = ast.unparse(_shown(node, _DEEPEST)) if node is not None else "it"
    return text if len(text) <= 40 else text[:37] + "..."


_DEEPEST = 30
"""Maximum nesting depth of an expression in a message. Parts that are nested deeper are replaced by ``...``."""


def _shown(node: ast.AST, levels: int) -> ast.AST:
    """Return a simplified copy of a syntax tree for ``ast.unparse()``.

    F-strings are replaced, because ast.unparse() writes them differently in each version of Python. Nodes that are nested too
    deeply become ``...``.
    """
    if isinstance(node, (ast.JoinedStr, ast.FormattedValue)):
        return ast.Name(_template(node))
    if levels <= 0 and isinstance(node, ast.expr):
        return ast.Name("...")
    return type(node)(**{name: _shown_in(value, levels - 1) for name, value in ast.iter_fields(node)})


def _shown_in(value: Any, levels: int) -> Any:
    if isinstance(value, list):
        return [_shown_in(item, levels) for item in value]
    return _shown(value, levels) if isinstance(value, ast.AST) else value


def _template(node: ast.JoinedStr | ast.FormattedValue) -> str:
    """Return the source of an f-string, written in the same way by each version of Python."""
    parts = []
    pieces: list[ast.expr] = node.values if isinstance(node, ast.JoinedStr) else [node]
    for part in pieces:
        if isinstance(part, ast.FormattedValue):
            parts.append(f"{{{at(part.value)}}}")
        else:
            parts.append(str(getattr(part, "value", "")))
    return f"f{''.join(parts)!r}"
