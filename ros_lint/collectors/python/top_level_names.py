"""The names that a Python module defines or imports at its top level."""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING

from ros_lint.collectors.python.source_errors import NotPythonError
from ros_lint.collectors.python.syntax import parse
from ros_lint.facts.setup_py import PythonModule

if TYPE_CHECKING:
    from ros_lint.base.text import Text


def collect(name: str, path: str, source: Text) -> PythonModule:
    """Return a module with the names that it defines or imports at its top level.

    ``name`` is the dotted name of the module, ``path`` its path relative to the package. The module is marked as open, because
    it may have more names, if it contains ``import *``, ``__getattr__``, ``globals()`` or ``exec()``, or does not parse.
    """
    try:
        tree = parse(source)
    except NotPythonError:
        return PythonModule(name, path, (), True)
    names = set(_names(tree.body))
    if "global " in source.text:
        names.update(name for node in ast.walk(tree) if isinstance(node, ast.Global) for name in node.names)
    wild = {"*", "__getattr__"} & names
    return PythonModule(name, path, tuple(sorted(names)), bool(wild) or "globals()" in source.text or "exec(" in source.text)


def _names(body: Iterable[ast.stmt]) -> Iterator[str]:
    for node in body:
        match node:
            case ast.FunctionDef() | ast.AsyncFunctionDef() | ast.ClassDef():
                yield node.name
            case ast.Import():
                yield from (alias.asname or alias.name.partition(".")[0] for alias in node.names)
            case ast.ImportFrom():
                yield from (alias.asname or alias.name for alias in node.names)
            case ast.Assign():
                yield from (name for target in node.targets for name in _targets(target))
            case ast.AnnAssign() | ast.AugAssign():
                yield from _targets(node.target)
            case ast.For() | ast.AsyncFor():
                yield from _targets(node.target)
                yield from _names([*node.body, *node.orelse])
            case ast.If() | ast.While():
                yield from _names([*node.body, *node.orelse])
            case ast.With() | ast.AsyncWith():
                yield from (name for item in node.items if item.optional_vars for name in _targets(item.optional_vars))
                yield from _names(node.body)
            case ast.Try():
                yield from _names([*node.body, *node.orelse, *node.finalbody])
                yield from (name for handler in node.handlers for name in _names(handler.body))
            case ast.Match():
                yield from (name for case in node.cases for name in _names(case.body))


def _targets(node: ast.expr) -> Iterator[str]:
    match node:
        case ast.Name():
            yield node.id
        case ast.Tuple() | ast.List():
            yield from (name for item in node.elts for name in _targets(item))
        case ast.Starred():
            yield from _targets(node.value)
