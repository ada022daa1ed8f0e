"""Decide whether a Python script does something when it is started, or only defines names for other files."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence

from ros_lint.base.text import Text
from ros_lint.collectors.python.source_errors import NotPythonError
from ros_lint.collectors.python.syntax import parse

_SETTINGS = ("sys.path.", "warnings.", "logging.", "os.environ.", "locale.", "matplotlib.", "gi.")
"""Beginnings of the names of functions that modules call to prepare their own imports and output."""


def runs_when_started(source: Text, *, is_program: bool) -> bool:
    """Return whether a script does something when it is started.

    True if the script has a ``__main__`` guard, or if a statement outside of functions and classes calls a function or
    class of the script itself, or a function of ``rclpy``. If the file is marked as a program (``is_program``), a call of any
    function suffices, except calls that prepare the imports or the output of a module, such as ``sys.path.append()``.
    """
    if "__main__" in source.text:
        return True
    try:
        body = parse(source).body
    except NotPythonError:
        return False
    own_names = {node.name for node in body if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef))}
    callees = {ast.unparse(call.func) for call in _calls(body)}
    return any(
        name in own_names or name.startswith("rclpy.") or (is_program and not name.startswith(_SETTINGS)) for name in callees
    )


def _calls(body: Sequence[ast.stmt]) -> Iterator[ast.Call]:
    """Yield the calls in statements that run when a module is imported, except in assignments and calls of ``setattr()``."""
    for statement in body:
        if isinstance(statement, ast.Expr) and not _is_setattr(statement.value):
            yield from (node for node in ast.walk(statement) if isinstance(node, ast.Call))
        elif isinstance(statement, (ast.If, ast.For, ast.While)):
            yield from _calls([*statement.body, *statement.orelse])
        elif isinstance(statement, ast.With):
            yield from _calls(statement.body)
        elif isinstance(statement, ast.Try):
            yield from _calls([*statement.body, *statement.orelse, *statement.finalbody])


def _is_setattr(node: ast.expr) -> bool:
    return isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "setattr"
