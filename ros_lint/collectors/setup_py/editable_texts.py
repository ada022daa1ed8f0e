"""Texts in ``setup.py`` that a fix can change: glob patterns, and gaps between strings where a comma is missing."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from typing import TYPE_CHECKING

from ros_lint.collectors.python.source_errors import NotPythonError
from ros_lint.collectors.python.string_values import callee
from ros_lint.collectors.python.syntax import parse, range_of, span_of
from ros_lint.facts.setup_py import WrittenText

if TYPE_CHECKING:
    from ros_lint.base.text import Text


def collect(source: Text) -> tuple[WrittenText, ...]:
    """Return the last string literal of each ``glob()`` pattern, and the gaps between strings where a comma is missing.

    Example of a gap: two entry points ``'a = p.a:main' 'b = p.b:main'`` without a comma between them.
    """
    try:
        tree = parse(source)
    except NotPythonError:
        return ()
    return tuple(_found(source, tree))


def _found(source: Text, tree: ast.Module) -> Iterator[WrittenText]:
    for node in ast.walk(tree):
        if isinstance(node, ast.Call) and node.args and callee(node) == "glob":
            last = _last(node.args[0])
            if isinstance(last, ast.Constant) and isinstance(last.value, str):
                span = span_of(source, last)
                # The literal has quotes of one letter, no escapes and no line break.
                if span.line == span.end_line and span.end_column - span.column == len(last.value) + 2:
                    inner = span._replace(column=span.column + 1, end_column=span.end_column - 1)
                    yield WrittenText("glob", last.value, inner)
        elif isinstance(node, ast.Constant) and isinstance(node.value, str) and node.value.count("=") > 1:
            gaps = list(_gaps(source, node))
            if len(gaps) == node.value.count("=") - 1:
                yield from gaps


def _gaps(source: Text, node: ast.Constant) -> Iterator[WrittenText]:
    """Yield the positions between the adjacent string literals of which a text consists."""
    from ros_lint.base.python_tokens import tokens  # noqa: PLC0415  (few files have such a text)

    start, end = range_of(source, node)
    ends = [start + token.end for token in tokens(source.text[start:end]) if token.kind == "string"]
    yield from (WrittenText("gap", "", source.span(at, at)) for at in ends[:-1])


def _last(pattern: ast.expr) -> ast.expr:
    """Return the last operand or argument of an expression: ``folder + "/*.py"`` -> ``"/*.py"``."""
    while isinstance(pattern, (ast.BinOp, ast.Call)):
        pattern = pattern.right if isinstance(pattern, ast.BinOp) else pattern.args[-1] if pattern.args else pattern.func
    return pattern
