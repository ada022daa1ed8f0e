"""Parses unusual Python sources: sources with syntax newer than Python 3.10, and sources that nest deeply.

A source that exceeds a limit of ros-lint, such as the depth of nested expressions, is rejected before it is parsed.
"""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterable, Iterator

from ros_lint.base import python_parser as python_ast
from ros_lint.base.python_nesting import DEEPEST, SYMBOLS, first_too_deep, may_be_paired
from ros_lint.base.python_tokens import TemplateDepthError, Token, TokenError, tokens
from ros_lint.base.text import Text
from ros_lint.collectors.python.newer_syntax import brackets, rewrite
from ros_lint.collectors.python.restored_tree import place_of, restore
from ros_lint.collectors.python.source_errors import NotPythonError, Parsed, TooDeepError
from ros_lint.facts.visibility import NewerSyntax

_MOST_DIGITS = 1_000


def read(source: Text, read_inner: Callable[[Text], Parsed]) -> Parsed:
    """Return the syntax tree of a source, and its constructs that are newer than Python 3.10.

    ``read_inner`` parses the text of an expression in an f-string as a separate source. Raises NotPythonError, or its subclass
    TooDeepError if the source exceeds a limit of ros-lint.
    """
    try:
        paired = may_be_paired(source.text)
        found = [] if paired else list(tokens(source.text))
        if not paired and brackets(source.text, found) is not None:
            raise NotPythonError
        # If all brackets are in pairs, tokens are read only up to the place that nests too deeply.
        if (deep := too_deep(source.text, _kept(tokens(source.text), found) if paired else found)) is not None:
            raise _too_deep(source, *deep)
        rewritten = rewrite(source.text, found)
        tree = python_ast.module(rewritten.text)
        inner: list[NewerSyntax] = []
        restore(
            tree,
            source,
            rewritten,
            lambda text, offset: _expression(_inner(text, offset, source, read_inner), offset, source, inner),
        )
    except TemplateDepthError as error:
        raise _too_deep(source, error.message, error.offset) from None
    except (TokenError, SyntaxError):
        raise NotPythonError from None
    except python_ast.TooDeepForPythonError:
        raise _too_deep(source, "nested too deeply", 0) from None
    newer = [NewerSyntax(one.construct, one.version, source.span(one.start, one.end)) for one in rewritten.newer]
    return Parsed(tree, tuple(sorted([*newer, *inner], key=lambda one: one.span)))


def too_deep(text: str, found: Iterable[Token]) -> tuple[str, int] | None:
    """Return which limit of ros-lint a source exceeds and at which offset, None if it exceeds no limit.

    ``found`` are the tokens of the source. The limits are for nested expressions, ``elif`` branches, and digits of a number.
    """
    branches = _Branches(text)
    token = Token("newline", 0, 0)
    wrong = ""

    def symbols() -> Iterator[str]:
        nonlocal token, wrong
        for token in found:
            if token.kind == "number" and token.end - token.start > _MOST_DIGITS:
                wrong = f"a number of more than {_MOST_DIGITS:,} digits"
            elif branches.are_too_many(token):
                wrong = f"more than {DEEPEST} branches in a row"
            if wrong:
                return
            if symbol := _symbol(text, token):
                yield symbol

    if first_too_deep(symbols()) is not None:
        wrong = f"expressions nested more than {DEEPEST} levels deep"
    return (wrong, token.start) if wrong else None


def _kept(found: Iterable[Token], into: list[Token]) -> Iterator[Token]:
    """Yield tokens, and append each of them to the list ``into``."""
    for token in found:
        into.append(token)
        yield token


def _symbol(text: str, token: Token) -> str:
    if token.kind == "op":
        return text[token.start : token.end]
    if token.kind == "newline":
        return "\n"
    return SYMBOLS.get(text[token.start : token.end], "") if token.kind == "name" else ""


class _Branches:
    """Counts the ``elif`` branches of each if statement. :meth:`are_too_many` must be called for all tokens in order."""

    def __init__(self, text: str) -> None:
        self._text = text
        self._counts: dict[int, int] = {}
        self._fresh = True

    def are_too_many(self, token: Token) -> bool:
        """Return whether a token begins an ``elif`` branch beyond the maximum number of branches."""
        text, fresh = self._text, self._fresh
        self._fresh = token.kind in ("newline", "comment")
        if not fresh or token.kind != "name":
            return False
        column = token.start - max(text.rfind("\n", 0, token.start), text.rfind("\r", 0, token.start))
        word = text[token.start : token.end]
        self._counts = {one: count for one, count in self._counts.items() if one <= column}
        if word == "elif":
            self._counts[column] = self._counts.get(column, 0) + 1
        elif word != "else":
            self._counts.pop(column, None)
        return self._counts.get(column, 0) > DEEPEST


def _too_deep(source: Text, message: str, offset: int) -> TooDeepError:
    return TooDeepError(message, source.span(offset, offset))


def _inner(text: str, offset: int, source: Text, read_inner: Callable[[Text], Parsed]) -> Parsed:
    try:
        return read_inner(Text(source.path, text))
    except TooDeepError as error:
        raise _too_deep(source, error.message, offset) from None


def _expression(parsed: Parsed, offset: int, source: Text, newer: list[NewerSyntax]) -> ast.expr:
    """Return the tree of an expression in an f-string, with the positions that the expression has in the source.

    ``parsed`` is the result of parsing the expression as a separate source. ``offset`` is the offset of the expression in
    ``source``. Constructs in the expression that are newer than Python 3.10 are appended to ``newer``.
    """
    body = parsed.tree.body
    if len(body) != 1 or not isinstance(body[0], ast.Expr):
        raise NotPythonError
    line, column = place_of(source, offset)
    for node in ast.walk(body[0]):
        if isinstance(node, (ast.expr, ast.keyword, ast.arg)):
            node.col_offset += column if node.lineno == 1 else 0
            node.end_col_offset = (node.end_col_offset or 0) + (column if node.end_lineno == 1 else 0)
            node.lineno += line - 1
            node.end_lineno = (node.end_lineno or 1) + line - 1
    newer += [one._replace(span=source.span(offset, offset)) for one in parsed.newer]
    return body[0].value
