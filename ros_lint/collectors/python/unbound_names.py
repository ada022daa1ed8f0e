"""Names in a Python source that are used but never bound, and the code in ``try`` blocks, whose exceptions are caught."""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator

from ros_lint.collectors.python.versions import BUILTINS

_ANYWHERE = frozenset({"exec", "eval", "globals", "locals", "vars", "setattr"})
"""Functions that can bind names without an assignment in the source."""
_MODULE = frozenset({"__file__", "__name__", "__doc__", "__package__", "__spec__", "__loader__", "__builtins__", "__path__"})
_KNOWN = _MODULE | BUILTINS | {"copyright", "credits", "exit", "help", "license", "quit", "WindowsError"}
"""Names that Python binds, including names that exist only in interactive sessions or on Windows."""


def unbound(tree: ast.Module, met: Iterable[ast.Name]) -> Iterator[ast.Name]:
    """Yield the uses of names that certainly raise NameError: for each name, the first of these uses in ``met``.

    ``met`` are the uses of names in ``tree`` to be examined.
    """
    names = [node for node in met if node.id not in _KNOWN]
    if not names:
        return
    bound, guarded = set[str](), set[ast.AST]()
    for node in ast.walk(tree):
        if isinstance(node, ast.Name):
            if node.id in _ANYWHERE:
                return
            if not isinstance(node.ctx, ast.Load):
                bound.add(node.id)
        elif isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)):
            bound.add(node.name)
        elif isinstance(node, ast.arg):
            bound.add(node.arg)
        elif isinstance(node, ast.alias):
            if node.name == "*":
                return
            bound.add(node.asname or node.name.partition(".")[0])
        elif isinstance(node, (ast.Global, ast.Nonlocal)):
            bound.update(node.names)
        elif isinstance(node, (ast.ExceptHandler, ast.MatchAs, ast.MatchStar)):
            bound.add(node.name or "")
        elif isinstance(node, ast.MatchMapping):
            bound.add(node.rest or "")
        elif isinstance(node, ast.Try):
            guarded.update(tried(node))
    for node in names:
        if node.id not in bound and node not in guarded:
            bound.add(node.id)  # reported once
            yield node


def tried(node: ast.Try) -> Iterator[ast.AST]:
    """Yield all syntax nodes in the ``try`` block of a try statement, where exceptions may be caught."""
    for statement in node.body:
        yield from ast.walk(statement)
