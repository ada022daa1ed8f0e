"""The parser of the running Python, without its warnings.

:mod:`ros_lint.collectors.python.syntax` limits the texts that it gets.
"""

from __future__ import annotations

import ast
import warnings

from ros_lint.base.text import to_bytes


class TooDeepForPythonError(Exception):
    """The parser exceeded the limits of stack or memory."""


def module(text: str) -> ast.Module:
    """Return the syntax tree of a module. Raises SyntaxError and TooDeepForPythonError."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # about invalid escapes in strings
        try:
            return _module(text)
        except ValueError as error:  # a null character, or an integer with too many digits
            raise SyntaxError(str(error)) from None
        except (RecursionError, MemoryError) as error:
            raise TooDeepForPythonError from error


def _module(text: str) -> ast.Module:
    try:
        return ast.parse(text, "")
    except UnicodeEncodeError:  # Python accepts bytes other than UTF-8 in comments of imported modules
        return ast.parse(to_bytes(text), "")


def expression(text: str) -> ast.expr:
    """Return the syntax tree of an expression. Raises SyntaxError and TooDeepForPythonError."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            return ast.parse(text, "", mode="eval").body
        except ValueError as error:
            raise SyntaxError(str(error)) from None
        except (RecursionError, MemoryError) as error:
            raise TooDeepForPythonError from error


def literal(text: str) -> object:
    """Return the value of a literal. Raises ValueError."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            found: object = ast.literal_eval(text)
        except (SyntaxError, TypeError, RecursionError, MemoryError) as error:
            raise ValueError(str(error)) from None
        return found


def compiled(tree: ast.Module) -> SyntaxError | None:
    """Return the compiler's error for a tree, or None. Nothing is executed.

    None also if the compiler exceeds its stack. The file name is empty because the compiler opens the named file to
    quote an erroneous line.
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
