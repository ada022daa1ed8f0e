"""Parse texts with the parser of the running Python, without its warnings.

The parser can overflow the stack of the process for deeply nested texts, so :mod:`ros_lint.collectors.python.syntax`
rejects such texts before.
"""

from __future__ import annotations

import ast
import warnings

from ros_lint.base.text import to_bytes


class TooDeepForPythonError(Exception):
    """The parser of Python exceeded its limits of stack or memory."""


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
    """Return the value of a literal of Python, such as a string or a list. Raises ValueError for any other text."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            value: object = ast.literal_eval(text)
        except (SyntaxError, TypeError, RecursionError, MemoryError) as error:
            raise ValueError(str(error)) from None
        return value


def compile_error(tree: ast.Module) -> SyntaxError | None:
    """Return the error that Python's compiler reports for a syntax tree; None if there is none or the compiler's stack overflows.

    No code is executed. The file name is empty, because the compiler would open the named file to quote a line.
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
