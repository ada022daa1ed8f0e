"""Syntax errors that the parser of Python accepts and its compiler reports, such as ``break`` outside of a loop."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from typing import TYPE_CHECKING

from ros_lint.base.text import Span
from ros_lint.facts.visibility import Problem

if TYPE_CHECKING:
    from ros_lint.base.text import Text

_OF_SOME_PYTHONS = ("asynchronous comprehension outside", "cannot assign to __debug__")
"""Beginnings of error messages that Python 3.10 reports, and Python 3.11 does not, or at another position."""
_DEFINITIONS = (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)
_LOOPS = (ast.For, ast.AsyncFor, ast.While)


def misplaced(error: SyntaxError, tree: ast.Module, source: Text) -> Iterator[Problem]:
    """Yield the problem for an error that the compiler of Python raised for ``tree``.

    The message and the position of the problem do not depend on the version of Python. Errors that only some versions of
    Python raise are omitted.
    """
    if error.msg.startswith(_OF_SOME_PYTHONS):
        return
    line, column = error.lineno or 1, error.offset or 1
    if error.msg.startswith(("'break'", "'continue'")) and (jump := _stray_jump(tree)) is not None:
        line, column = jump.lineno, jump.col_offset + 1  # Python 3.10 names the statement around it
    line = min(line, source.line_count)
    column = min(column, len(source.line(line)) + 1)
    yield Problem("syntax", f"not valid Python: {error.msg}", Span(source.path, line, column, line, column))


def _stray_jump(tree: ast.Module) -> ast.Break | ast.Continue | None:
    """Return the first ``break`` or ``continue`` statement that is outside of any loop, None if there is none."""
    waiting: list[tuple[ast.AST, bool]] = [(statement, False) for statement in reversed(tree.body)]
    while waiting:
        node, looped = waiting.pop()
        if isinstance(node, (ast.Break, ast.Continue)) and not looped:
            return node
        looped = looped and not isinstance(node, _DEFINITIONS)
        inner: list[tuple[ast.AST, bool]] = [(each, looped or isinstance(node, _LOOPS)) for each in getattr(node, "body", ())]
        inner += [(each, looped) for name in ("handlers", "cases", "orelse", "finalbody") for each in getattr(node, name, ())]
        waiting += reversed(inner)
    return None
