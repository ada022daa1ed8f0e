"""What Python itself refuses in a launch file: at once, or when it comes to a name that nothing binds."""

from __future__ import annotations

import ast
import builtins
import warnings
from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING

from ros_lint.collectors.launch_py_walk import span_of
from ros_lint.collectors.python_syntax import refusal
from ros_lint.facts.sight import Problem

if TYPE_CHECKING:
    from ros_lint.collectors.launch_py_objects import Source
    from ros_lint.text import Text

_ANYWHERE = frozenset({"exec", "eval", "globals", "locals", "vars", "setattr"})
"""What can bind names that are not written."""
_MODULE = frozenset({"__file__", "__name__", "__doc__", "__package__", "__spec__", "__loader__", "__builtins__", "__path__"})


def misplaced(tree: ast.Module, source: Text) -> Iterator[Problem]:
    """Yield what the parser takes and the compiler does not, such as a keyword that is given twice."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            compile(tree, source.path, "exec", dont_inherit=True)  # nothing is run
    except SyntaxError as error:
        yield refusal(source, error.msg, error.lineno or 1, error.offset or 1)
    except (ValueError, RecursionError, MemoryError):
        return  # too deep for this Python, perhaps not for another


def undefined(tree: ast.Module, source: Source, met: Iterable[tuple[ast.Name, Source]]) -> Iterator[Problem]:
    """Yield those names that were met, bound by nothing, of which it is sure that Python stops there."""
    names = [node for node, where in met if where is source and node.id not in _KNOWN]
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
            guarded.update(inner for statement in node.body for inner in ast.walk(statement))
    for node in names:
        if node.id not in bound and node not in guarded:
            bound.add(node.id)  # once is enough
            yield Problem("undefined-name", f"{node.id} is not defined", span_of(node, source))


_KNOWN = _MODULE | set(dir(builtins)) | {"copyright", "credits", "exit", "help", "license", "quit", "WindowsError"}
"""What Python binds, with what it does so only when it starts as people start it, or elsewhere."""
