"""Python sources as syntax trees, and what to make of those that are none."""

from __future__ import annotations

import ast
import re
import warnings
from typing import TYPE_CHECKING

from ros_lint.facts.sight import Problem
from ros_lint.text import Span, from_raw, raw

if TYPE_CHECKING:
    from ros_lint.text import Text

# What only Python 2 reads. One is enough: such a file is not meant for the interpreter that looks at it.
_PYTHON_2 = re.compile(
    r"""^\#!.*\bpython2
    |(?:^|[;:])[ \t]*print(?:[ \t]+(?:["'%\w]|>>)|[ \t]*$)
    |^[ \t]*except[ \t]+[\w.]+[ \t]*,[ \t]*\w+[ \t]*:
    |^[ \t]*except[ \t]*\([^)\n]*\)[ \t]*,[ \t]*\w+[ \t]*:
    |^[ \t]*raise[ \t]+[\w.]+[ \t]*,
    |^[ \t]*exec[ \t]+["'\w]
    |[\w)]\s*<>\s*[\w(]
    |\bur["']
    |[=(,][ \t]*0[0-7]+\b(?![.xob])""",
    re.VERBOSE | re.MULTILINE,
)
_TEMPLATE_NAME = re.compile(r"\.(?:in|em|j2|jinja2?|mako|template|tmpl|tpl)(?:\.py)?\Z|\{\{|\}\}|__[A-Z_]+__\.py\Z")
_TEMPLATE_MARK = re.compile(r"\{\{|\{%|@\{|@\(|@\[|@[A-Za-z_]\w*@|\$\{|<%")

Node = ast.expr | ast.stmt | ast.alias | ast.keyword
"""What stands in a place of its own."""


NO_FILE = ""
"""The file name to compile sources by. For a syntax error CPython opens the file of that name, relative to the current folder."""


class NotPythonError(Exception):
    """A source is no Python for the interpreter that runs."""

    def __init__(self, message: str, line: int, column: int) -> None:
        super().__init__(message)
        self.message = message
        self.line = line
        self.column = column


class TooDeepError(NotPythonError):
    """A source is nested too deeply for this interpreter, perhaps not for another; or no text."""


def parse(source: Text) -> ast.Module:
    """Return the tree of a source. Raises :class:`NotPythonError`, also as :class:`TooDeepError`, and nothing else."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # about escapes in somebody's strings
            try:
                return ast.parse(source.text, NO_FILE)
            except UnicodeEncodeError:  # Python takes bytes that are no UTF-8 in comments of what it imports
                return ast.parse(raw(source.text), NO_FILE)
    except SyntaxError as error:
        raise NotPythonError(error.msg, error.lineno or 1, error.offset or 1) from None
    except (ValueError, RecursionError, MemoryError) as error:
        raise TooDeepError(str(error) or "nested too deeply", 1, 1) from None


def start_of(source: Text, node: Node) -> int:
    """Return the offset at which a node starts. The tree counts columns in bytes of UTF-8."""
    return _offset(source, node.lineno, node.col_offset)


def range_of(source: Text, node: Node) -> tuple[int, int]:
    """Return the offsets between which a node stands."""
    end = _offset(source, node.end_lineno or node.lineno, node.end_col_offset or node.col_offset)
    return start_of(source, node), end


def span_of(source: Text, node: Node) -> Span:
    """Return the place of a node."""
    return source.span(*range_of(source, node))


def _offset(source: Text, line: int, column: int) -> int:
    start = source.offset(line, 1)
    piece = source.text[start : start + column]
    if not piece.isascii():
        piece = from_raw(raw(piece)[:column])
    return start + len(piece)


def syntax_problem(source: Text, error: NotPythonError) -> Problem | None:
    """Return what is wrong with a source, None when that may be the view of one interpreter only.

    No problem are Python 2, templates, and what libcst can read: the source may be newer than the interpreter.
    """
    if _TEMPLATE_NAME.search(source.path) or _TEMPLATE_MARK.search(source.text) or _PYTHON_2.search(source.text):
        return None
    from libcst import ParserSyntaxError, parse_module  # noqa: PLC0415  (costs more than a whole run without it)

    try:
        parse_module(raw(source.text))
    except ParserSyntaxError:
        pass
    except Exception:  # whatever else it does on odd input is no second opinion
        return None
    else:
        return None
    return refusal(source, error.message, error.line, error.column)


def refusal(source: Text, message: str, line: int, column: int) -> Problem:
    """Return what Python says against a source; the place that it names may lie behind the end of the file."""
    line = min(max(line, 1), source.line_count)
    column = min(max(column, 1), len(source.line(line)) + 1)
    return Problem("syntax", f"not valid Python: {message}", Span(source.path, line, column, line, column))
