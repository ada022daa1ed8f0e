"""The syntax trees of Python sources, and the reasons why a source cannot be parsed."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from functools import lru_cache
from typing import NamedTuple, TypeVar

from ros_lint.base import python_parser as python_ast
from ros_lint.base.python_nesting import DEEPEST, most_levels, nests_too_deep, plain
from ros_lint.base.text import Span, Text, from_bytes, to_bytes
from ros_lint.collectors.python.source_errors import NotPythonError, Parsed, TooDeepError
from ros_lint.facts.visibility import Facet, Opaque, Problem

# Syntax that only Python 2 accepts. One match suffices, because such a file is not meant for Python 3.
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

_Tree = TypeVar("_Tree", bound=ast.AST)

Node = ast.expr | ast.stmt | ast.alias | ast.keyword
"""A syntax node that has a position."""


class Refusal(NamedTuple):
    """The reason why a source has no syntax tree: it is not valid Python, or exceeds a limit of ros-lint."""

    message: str
    """The reason as a clause, such as "this line is indented too far"."""
    span: Span
    known: bool
    """True if the text is certainly not Python of any version. If False, the file counts as not checked."""

    def problem(self) -> Problem:
        return Problem("syntax", f"not valid Python: {self.message}", self.span)

    def opaque(self, hides: Facet) -> Opaque:
        """Return an Opaque for the source, that is, a place that could not be evaluated.

        Because of this place, the parts ``hides`` of the package may contain more than is known. The place is marked as
        unchecked if the source exceeds a limit of ros-lint.
        """
        reason = "the source is not valid Python 3" if self.known else self.message
        return Opaque(hides, reason, self.span, unchecked=not self.known)


def parse(source: Text) -> ast.Module:
    """Return the syntax tree of a source. No caller may change it, because it is shared.

    Raises :class:`NotPythonError`; it is a :class:`TooDeepError` if the source exceeds a limit of ros-lint.
    """
    return read(source).tree


def read(source: Text) -> Parsed:
    """Return the syntax tree of a source, and its constructs that are newer than Python 3.10.

    The result does not depend on the version of Python that runs ros-lint. No caller may change the tree, because it is
    shared. Raises the exceptions of :func:`parse`.
    """
    found = _outcome(source.path, source.text)
    if isinstance(found, Refusal):
        raise TooDeepError(found.message, found.span)
    if found is None:
        raise NotPythonError
    return found


@lru_cache(maxsize=2)  # several collectors ask for the tree of one source, one after the other
def _outcome(path: str, text: str) -> Parsed | Refusal | None:
    """Return the parsed source, a Refusal if it exceeds a limit of ros-lint, None if it is not valid Python."""
    source = Text(path, text)
    try:
        return read_anew(source)
    except TooDeepError as error:
        return Refusal(error.message, error.span, known=False)
    except NotPythonError:
        return None


def read_anew(source: Text) -> Parsed:
    """Return the result of :func:`read` with a new syntax tree, which is not shared, so that the caller may change it."""
    levels = most_levels(source.text)
    if plain(source.text) and not (levels > _MOST_LEVELS and nests_too_deep(source.text)):
        try:
            tree = python_ast.module(source.text)
        except SyntaxError:
            raise NotPythonError from None
        except python_ast.TooDeepForPythonError:
            pass
        else:
            if levels <= DEEPEST or not any(map(nests_too_deep, _long_statements(source, tree))):
                return Parsed(tree, ())
    from ros_lint.collectors.python import rewritten_source as python_reread  # noqa: PLC0415  (one source of two hundred)

    return python_reread.read(source, read_anew)


_MOST_LEVELS = 10_000
"""Maximum nesting depth of sources for Python's own parser. Python 3.10 overflows its stack at about ten times this depth."""


def read_expression(text: str) -> ast.expr:
    """Return the syntax tree of the text of an expression. Raises :class:`NotPythonError`.

    The result does not depend on the version of Python that runs ros-lint.
    """
    source = Text("", text)
    if plain(text) and not nests_too_deep(text):
        try:
            return python_ast.expression(text)
        except (SyntaxError, python_ast.TooDeepForPythonError):
            raise NotPythonError from None
    body = parse(source).body
    if len(body) != 1 or not isinstance(body[0], ast.Expr):
        raise NotPythonError
    return body[0].value


def _long_statements(source: Text, tree: ast.Module) -> Iterator[str]:
    """Yield the texts of statements that may nest too deeply. The text of a compound statement is its head, ``if a:``.

    Raises :class:`TooDeepError` if an if statement has too many ``elif`` branches, because the tree nests each of them in
    the branch before.
    """
    waiting: list[tuple[_Part, int]] = [(statement, 0) for statement in tree.body]
    while waiting:
        part, branches = waiting.pop()
        inner: list[_Part] = []
        if part.__class__ not in _SIMPLE:
            inner = [each for name in _BODIES for each in getattr(part, name, ())]
            waiting += [(each, 0) for each in inner]
            if isinstance(part, ast.If) and len(part.orelse) == 1 and isinstance(part.orelse[0], ast.If):
                if branches == DEEPEST:
                    raise TooDeepError(f"more than {DEEPEST} branches in a row", span_of(source, part.orelse[0]).start())
                waiting[-1] = part.orelse[0], branches + 1
        first = part.pattern if isinstance(part, ast.match_case) else part
        line, column = _beginning(first)
        if inner:
            end_line, end_column = _beginning(inner[0].pattern if isinstance(inner[0], ast.match_case) else inner[0])
        else:
            end_line, end_column = first.end_lineno or line, first.end_col_offset or column
        if end_line > line or end_column - column > DEEPEST:
            statement = source.text[_offset(source, line, column) : _offset(source, end_line, end_column)]
            if most_levels(statement) > DEEPEST:
                yield statement


_SIMPLE = frozenset({ast.AnnAssign, ast.Assign, ast.AugAssign, ast.Expr, ast.Import, ast.ImportFrom, ast.Pass, ast.Return})
"""The most frequent kinds of statements without a body."""
_BODIES = ("body", "handlers", "cases", "orelse", "finalbody")
_Part = ast.stmt | ast.ExceptHandler | ast.match_case


def _beginning(node: ast.stmt | ast.ExceptHandler | ast.pattern) -> tuple[int, int]:
    """Return line and column where a node begins. A decorated function or class begins with its first decorator."""
    decorators = getattr(node, "decorator_list", None)
    return (decorators[0].lineno, decorators[0].col_offset) if decorators else (node.lineno, node.col_offset)


def start_of(source: Text, node: Node) -> int:
    """Return the offset in the source, in characters, at which a node begins. The tree counts columns in bytes of UTF-8."""
    return _offset(source, node.lineno, node.col_offset)


def range_of(source: Text, node: Node) -> tuple[int, int]:
    """Return the offsets in the source, in characters, at which a node begins and ends."""
    end = _offset(source, node.end_lineno or node.lineno, node.end_col_offset or node.col_offset)
    return start_of(source, node), end


def span_of(source: Text, node: Node) -> Span:
    """Return the span of a node in the source."""
    return source.span(*range_of(source, node))


def _offset(source: Text, line: int, column: int) -> int:
    start = source.offset(line, 1)
    piece = source.text[start : start + column]
    if not piece.isascii():
        piece = from_bytes(to_bytes(piece)[:column])
    return start + len(piece)


def refusal(source: Text, error: NotPythonError) -> Refusal:
    """Return why a source has no syntax tree; ``error`` is the exception of :func:`parse`."""
    if isinstance(error, TooDeepError):
        return Refusal(error.message, error.span, known=False)
    from ros_lint.collectors.python.syntax_errors import reason  # noqa: PLC0415  (few sources are no Python)

    offset, message, known = reason(source.text, read_expression)
    return Refusal(message, source.span(offset, offset), known)


def is_of_others(source: Text) -> bool:
    """Return whether a source is a template of a Python file, or written for Python 2."""
    return bool(_TEMPLATE_NAME.search(source.path) or _TEMPLATE_MARK.search(source.text) or _PYTHON_2.search(source.text))


def placed(node: _Tree, at: ast.AST) -> _Tree:
    """Return a copy of a syntax tree in which all nodes have the position of ``at``.

    Text constants become f-strings, because a finding or fix for a text constant would assume that the text is at its position.
    """
    copy = type(node)(**{name: _placed_field(value, at) for name, value in ast.iter_fields(node)})
    return ast.copy_location(copy, at)


def _placed_field(value: object, at: ast.AST) -> object:
    if isinstance(value, ast.Constant) and isinstance(value.value, str):
        return ast.copy_location(ast.JoinedStr([value]), at)
    if isinstance(value, ast.JoinedStr):  # placed() was applied to it before
        return ast.copy_location(ast.JoinedStr(value.values), at)
    if isinstance(value, ast.AST):
        return placed(value, at)
    return [_placed_field(item, at) for item in value] if isinstance(value, list) else value
