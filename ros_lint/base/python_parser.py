"""The parser of the Python that runs, with its warnings off. :mod:`ros_lint.collectors.python.syntax` bounds what it is given."""

from __future__ import annotations

import ast
import warnings

from ros_lint.base.text import to_bytes


class TooDeepForPythonError(Exception):
    """The parser has run out of stack or memory."""


def module(text: str) -> ast.Module:
    """Return the tree of a module. Raises SyntaxError and TooDeepForPythonError."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # about escapes in somebody's strings
        try:
            return _module(text)
        except ValueError as error:  # a null character, or an integer of too many digits
            raise SyntaxError(str(error)) from None
        except (RecursionError, MemoryError) as error:
            raise TooDeepForPythonError from error


def _module(text: str) -> ast.Module:
    try:
        return ast.parse(text, "")
    except UnicodeEncodeError:  # Python takes bytes that are no UTF-8 in comments of what it imports
        return ast.parse(to_bytes(text), "")


def expression(text: str) -> ast.expr:
    """Return the tree of an expression. Raises SyntaxError and TooDeepForPythonError."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            return ast.parse(text, "", mode="eval").body
        except ValueError as error:
            raise SyntaxError(str(error)) from None
        except (RecursionError, MemoryError) as error:
            raise TooDeepForPythonError from error


def literal(text: str) -> object:
    """Return what a literal stands for. Raises ValueError."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            found: object = ast.literal_eval(text)
        except (SyntaxError, TypeError, RecursionError, MemoryError) as error:
            raise ValueError(str(error)) from None
        return found


def compiled(tree: ast.Module) -> SyntaxError | None:
    """Return what the compiler refuses in a tree, None where there is nothing, or where it runs out of stack. Nothing is run.

    The compiler opens the file that it is told to come from when it finds an error. No file has the name it is told here.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            compile(tree, "", "exec", dont_inherit=True)
        except SyntaxError as error:
            return error
        except (ValueError, RecursionError, MemoryError):
            return None
    return None
