"""Search for the handler of a try statement that catches a raised exception of a builtin class."""

from __future__ import annotations

import ast
import builtins


def kind_raised(node: ast.Raise) -> str:
    """Return the name of the builtin exception class that a ``raise`` statement raises: ``raise OSError("a")`` -> ``OSError``.

    The result is "" for any other class, and for ``raise`` alone.
    """
    made = node.exc.func if isinstance(node.exc, ast.Call) else node.exc
    return made.id if isinstance(made, ast.Name) and hasattr(builtins, made.id) else ""


def catching(node: ast.Try, kind: str) -> ast.ExceptHandler | None:
    """Return the first handler of a try statement that may catch an exception, None if no handler can catch it.

    ``kind`` is the name of the builtin class of the exception, "" if the class is unknown.
    """
    return next((handler for handler in node.handlers if _may_catch(handler, kind)), None)


def _may_catch(handler: ast.ExceptHandler, kind: str) -> bool:
    raised = getattr(builtins, kind, None) if kind else None
    if handler.type is None or not isinstance(raised, type):
        return True
    caught = handler.type.elts if isinstance(handler.type, ast.Tuple) else [handler.type]
    return any(_is_above(node, raised) for node in caught)


def _is_above(node: ast.expr, raised: type) -> bool:
    if not isinstance(node, (ast.Name, ast.Attribute)):
        return True
    above = getattr(builtins, node.id if isinstance(node, ast.Name) else node.attr, None)
    return isinstance(above, type) and issubclass(raised, above)
