"""Python sources that are not plain: bounded, rewritten, parsed and set right again."""

from __future__ import annotations

import ast
from collections.abc import Iterable, Sequence

from ros_lint.collectors import python_ast
from ros_lint.collectors import python_syntax as syntax
from ros_lint.collectors.python_code import DEEPEST, LONG_NUMBER, SYMBOLS, first_too_deep
from ros_lint.collectors.python_newer import brackets, rewrite
from ros_lint.collectors.python_restored import place_of, restore
from ros_lint.collectors.python_syntax import NotPythonError, Parsed, TooDeepError
from ros_lint.facts.sight import NewerSyntax
from ros_lint.python_tokens import TemplateDepthError, Token, TokenError, tokens
from ros_lint.text import Text


def read(source: Text) -> Parsed:
    """Return the tree of a source and what is newer than Python 3.10 in it. Raises NotPythonError, also as TooDeepError."""
    try:
        found = list(tokens(source.text))
        if brackets(source.text, found) is not None:
            raise NotPythonError
        if (deep := too_deep(source.text, found)) is not None:
            raise _too_deep(source, *deep)
        rewritten = rewrite(source.text, found)
        tree = python_ast.module(rewritten.text)
        inner: list[NewerSyntax] = []
        restore(tree, source, rewritten, lambda text, offset: _expression(text, offset, source, inner))
    except TemplateDepthError as error:
        raise _too_deep(source, error.message, error.offset) from None
    except (TokenError, SyntaxError):
        raise NotPythonError from None
    except python_ast.TooDeepForPythonError:
        raise _too_deep(source, "nested too deeply", 0) from None
    newer = [NewerSyntax(one.construct, one.version, source.span(one.start, one.end)) for one in rewritten.newer]
    return Parsed(tree, tuple(sorted([*newer, *inner], key=lambda one: one.span)))


def too_deep(text: str, found: Sequence[Token]) -> tuple[str, int] | None:
    """Return why and where the code of a source exceeds a bound, None where it does not."""
    counted = [(token, _symbol(text, token)) for token in found]
    counted = [(token, symbol) for token, symbol in counted if symbol]
    index = first_too_deep([symbol for _, symbol in counted])
    if index is not None:
        return f"expressions nested more than {DEEPEST} levels deep", counted[index][0].start
    if (number := LONG_NUMBER.search(text)) and any(
        token.kind == "number" and token.start <= number.start() < token.end for token in found
    ):
        return "a number of more than 1,000 digits", number.start()
    return _branches(text, found)


def _symbol(text: str, token: Token) -> str:
    if token.kind == "op":
        return text[token.start : token.end]
    if token.kind == "newline":
        return "\n"
    return SYMBOLS.get(text[token.start : token.end], "") if token.kind == "name" else ""


def _branches(text: str, found: Iterable[Token]) -> tuple[str, int] | None:
    """Return why and where branches in a row exceed the bound, None where they do not."""
    counts: dict[int, int] = {}
    fresh = True
    for token in found:
        if fresh and token.kind == "name":
            width = token.start - max(text.rfind("\n", 0, token.start), text.rfind("\r", 0, token.start))
            word = text[token.start : token.end]
            counts = {column: count for column, count in counts.items() if column <= width}
            if word == "elif":
                counts[width] = counts.get(width, 0) + 1
                if counts[width] > DEEPEST:
                    return f"more than {DEEPEST} branches in a row", token.start
            elif word != "else":
                counts.pop(width, None)
        fresh = token.kind in ("newline", "comment")
    return None


def _too_deep(source: Text, message: str, offset: int) -> TooDeepError:
    return TooDeepError(message, source.span(offset, offset))


def _expression(text: str, offset: int, source: Text, newer: list[NewerSyntax]) -> ast.expr:
    """Return the tree of an expression in brackets that begins at an offset of a source."""
    parsed = syntax.read(Text(source.path, text))
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
