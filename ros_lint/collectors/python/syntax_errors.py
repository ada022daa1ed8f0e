"""The reason why a source is not valid Python, and its position, independent of the Python version that runs ros-lint.

The messages and positions of Python's own parser change from version to version. Therefore, this module checks strings,
brackets and indentation by their tokens. For all other errors the parser of libcst gives the position, because it has
one grammar for all versions.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Callable, Iterator, Sequence
from itertools import pairwise
from keyword import iskeyword
from typing import Final, NamedTuple

from ros_lint.base import python_parser as python_ast
from ros_lint.base.python_tokens import TemplateDepthError, Token, TokenError, template, tokens
from ros_lint.collectors.python.newer_syntax import brackets, rewrite
from ros_lint.collectors.python.rewritten_source import too_deep
from ros_lint.collectors.python.source_errors import NotPythonError


class SyntaxReason(NamedTuple):
    """The reason why a source is not valid Python, and the offset of the error."""

    offset: int
    message: str
    """The reason as a clause, such as "this line is indented too far"."""
    known: bool = True
    """False if a limit of ros-lint is exceeded or no error is found. Then another Python version may accept the source."""


_CONFLICT: Final = re.compile(r"^(?:<{7}|>{7}) ", re.MULTILINE)
_PLACE: Final = re.compile(r"error at (\d+):(\d+)")
_LINE: Final = re.compile(r"[^\r\n]*(?:\r\n|\r|\n)|[^\r\n]+\Z")
_OF_PYTHON_2: Final = re.compile(r"^[ \t]*except\b[^,:\r\n]*(,)[ \t]*([a-z_]\w*)[ \t]*:", re.MULTILINE)
_CONTINUED: Final = frozenset({"elif", "else", "except", "finally"})
_COMPOUND: Final = _CONTINUED | frozenset({"async", "class", "def", "for", "if", "try", "while", "with"})
_LONGEST: Final = 100_000
"""Maximum number of characters of a statement for libcst, which parses such a statement for more than a second."""
_LONGEST_TEXT: Final = 500_000
_LEVELS: Final = 100
"""Maximum number of levels of indentation in Python."""
_LONGEST_WORD: Final = 40


def reason(text: str, read_expression: Callable[[str], ast.expr]) -> SyntaxReason:
    """Return why ``text`` is not valid Python. The parser of Python must have rejected the text before.

    ``read_expression`` raises NotPythonError for a text that is not an expression.
    """
    if len(text) > _LONGEST_TEXT:
        return SyntaxReason(0, "Python rejects the file, and it is too long to determine the reason", known=False)
    found, reasons = list[Token](), list[SyntaxReason]()
    try:
        for token in tokens(text):
            found.append(token)
    except TokenError as error:
        reasons.append(SyntaxReason(error.offset, error.message, not isinstance(error, TemplateDepthError)))
    else:
        if (unpaired := brackets(text, found)) is not None:
            reasons.append(SyntaxReason(*unpaired[::-1]))
    if "\0" in text:
        reasons.append(SyntaxReason(text.index("\0"), "Python has no such character"))
    if conflict := _CONFLICT.search(text):
        reasons.append(SyntaxReason(conflict.start(), "this merge conflict is not resolved"))
    if indentation := next(_indentation(text, found), None):
        reasons.append(indentation)
    if reasons:
        return min(reasons)
    if (deep := too_deep(text, found)) is not None:
        return SyntaxReason(deep[1], deep[0], known=False)
    return next(
        _in_statements(text, found, read_expression),
        SyntaxReason(0, "Python rejects the file for an unknown reason", known=False),
    )


# --- indentation


def _logical_lines(found: Sequence[Token]) -> Iterator[tuple[Token, Token]]:
    """Yield the first and the last token of each logical line."""
    first, last = None, None
    for token in found:
        if token.kind == "newline":
            if first is not None and last is not None:
                yield first, last
            first = None
        elif token.kind != "comment":
            first, last = first or token, token
    if first is not None and last is not None:
        yield first, last


def _indentation(text: str, found: Sequence[Token]) -> Iterator[SyntaxReason]:
    """Yield the errors in the indentation of a source, in order.

    Each indentation is measured twice, with a tab as eight columns and as one column. If the comparison with other lines
    gives different results, tabs and blanks are mixed.
    """
    levels = [(0, 0)]
    word, line, end, opens = "", "", 0, False
    for first, last in _logical_lines(found):
        start = max(text.rfind("\n", 0, first.start), text.rfind("\r", 0, first.start)) + 1
        blanks = text[start : first.start].rpartition("\f")[2]
        level = len(blanks.expandtabs(8)), len(blanks)
        if level[0] > levels[-1][0]:
            if word in _COMPOUND and ":" not in line:
                yield SyntaxReason(end, '":" is missing at the end of the line')
            elif not opens:
                yield SyntaxReason(first.start, "this line is indented too far")
            elif level[1] <= levels[-1][1]:
                yield SyntaxReason(first.start, "tabs and blanks are mixed in the indentation")
            elif len(levels) == _LEVELS:
                yield SyntaxReason(first.start, f"more than {_LEVELS} levels of indentation")
            levels.append(level)
        elif opens and word in _COMPOUND:
            yield SyntaxReason(first.start, f'an indented block is missing after this "{word}"')
        while levels[-1][0] > level[0]:
            levels.pop()
        if levels[-1][0] != level[0]:
            yield SyntaxReason(first.start, "the indentation does not match any line above")
        elif levels[-1] != level:
            yield SyntaxReason(first.start, "tabs and blanks are mixed in the indentation")
        word, line, end = text[first.start : first.end], text[first.start : last.end], last.end
        opens = text[last.start : last.end] == ":"
    if opens and word in _COMPOUND:
        yield SyntaxReason(end, f'an indented block is missing after this "{word}"')


# --- statements


def _in_statements(text: str, found: Sequence[Token], read_expression: Callable[[str], ast.expr]) -> Iterator[SyntaxReason]:
    """Yield the errors in the first top-level statement that Python rejects. Only the first error is reliable."""
    try:
        code = rewrite(text, found).text
    except TokenError as error:
        yield SyntaxReason(error.offset, error.message)
        return
    lines = [match.span() for match in _LINE.finditer(code)]
    starts = [match.start() for match in _LINE.finditer(text)]
    for first, behind in pairwise([*_statements(text, found, starts), len(lines)]):
        statement = code[lines[first][0] : lines[behind - 1][1]]
        try:
            python_ast.module(statement)
        except (SyntaxError, python_ast.TooDeepForPythonError):
            end = starts[behind] if behind < len(starts) else len(text)
            inside = [token for token in found if starts[first] <= token.start < end and token.kind != "comment"]
            if old := _OF_PYTHON_2.search(statement):
                yield SyntaxReason(starts[first] + old.start(1), f'this is Python 2; write "as {old[2]}"')
            yield from _literals(text, inside, read_expression)
            place = _place(statement)
            if place is not None:
                line, column = place
                at = min(starts[first + line - 1] + column, end) if first + line <= len(starts) else end
                yield _word(text, inside, at) if line else SyntaxReason(starts[first], "this statement cannot be read")
            return


def _statements(text: str, found: Sequence[Token], lines: Sequence[int]) -> Iterator[int]:
    """Yield the number of the first line of each top-level statement, from 0. ``lines`` are the offsets of all lines."""
    yield 0
    line, decorated = 0, False
    for first, _ in _logical_lines(found):
        while line + 1 < len(lines) and lines[line + 1] <= first.start:
            line += 1
        if first.start == lines[line]:
            word = text[first.start : first.end]
            if line and word not in _CONTINUED and not decorated:
                yield line
            decorated = word == "@"


def _place(statement: str) -> tuple[int, int] | None:
    """Return where libcst finds an error in a statement: line from 1 and column from 0.

    The result is (0, 0) if the position of the error is unknown, None if libcst finds no error.
    """
    if len(statement) > _LONGEST:
        return 0, 0
    from libcst import ParserSyntaxError, parse_module  # noqa: PLC0415  (costs more than a whole run without it)

    try:
        parse_module(statement.encode("utf-8", "replace").decode())
    except ParserSyntaxError as error:
        place = _PLACE.search(error.message)
        return (int(place[1]), int(place[2])) if place else (0, 0)
    except Exception:  # libcst may fail in other ways on unusual input
        return None
    return None


def _word(text: str, code: Sequence[Token], at: int) -> SyntaxReason:
    """Return the error message about the last token before the offset ``at``: "... is not expected here"."""
    if code[-1].kind != "newline":
        code = [*code, Token("newline", len(text), len(text))]
    index = max((index for index, token in enumerate(code) if token.start < at), default=0)
    token, before = code[index], code[index - 1] if index else None
    if token.kind == "newline" and before is not None:
        return SyntaxReason(before.end, "the line ends too early")
    shown = _shown(text[token.start : token.end])
    hint = ""
    if before is not None and _ends_value(text, before) and _begins_value(text, token):
        of_python_2 = text[before.start : before.end] == "print"
        hint = "; print is a function" if of_python_2 else "; is a comma or an operator missing before it?"
    shown = shown if token.kind in ("string", "template") else f'"{shown}"'
    return SyntaxReason(token.start, f"{shown} is not expected here{hint}")


def _shown(written: str) -> str:
    """Return the first line of a piece of a source for a message, shortened if it is long."""
    line = written.strip().splitlines()[0]
    return line if len(line) <= _LONGEST_WORD else line[: _LONGEST_WORD - 3] + "..."


def _ends_value(text: str, token: Token) -> bool:
    return text[token.start : token.end] in (")", "]", "}") or _is_value(text, token)


def _begins_value(text: str, token: Token) -> bool:
    return text[token.start : token.end] == "{" or _is_value(text, token)


def _is_value(text: str, token: Token) -> bool:
    is_name = token.kind == "name" and not iskeyword(text[token.start : token.end])
    return is_name or token.kind in ("number", "string", "template")


def _literals(text: str, code: Sequence[Token], read_expression: Callable[[str], ast.expr]) -> Iterator[SyntaxReason]:
    """Yield the errors in the strings and numbers of a source."""
    for before, token in pairwise([Token("newline", 0, 0), *code]):
        written = text[token.start : token.end]
        if token.kind == "number" and not _is_literal(written):
            yield SyntaxReason(token.start, "this is no number")
        elif token.kind == "name" and before.kind == "number" and before.end == token.start and not iskeyword(written):
            yield SyntaxReason(before.start, "this is no number")
        elif token.kind == "string" and not _is_literal(written):
            yield SyntaxReason(token.start, _why_no_string(written))
        elif token.kind == "string" and _are_unlike(text, before, token):
            yield SyntaxReason(token.start, "a bytes literal cannot be next to a string literal")
        elif token.kind == "template":
            yield from _wrong_fields(text, token, read_expression)


def _are_unlike(text: str, before: Token, token: Token) -> bool:
    """Return whether ``token`` is a string next to a string ``before``, and only one of them is a bytes literal."""
    return before.kind in ("string", "template") and len({_is_bytes(text[one.start : one.end]) for one in (before, token)}) == 2


def _is_literal(written: str) -> bool:
    try:
        python_ast.literal(written)
    except ValueError:
        return False
    return True


def _is_bytes(written: str) -> bool:
    return "b" in re.split("[\"']", written, maxsplit=1)[0].lower()


def _why_no_string(written: str) -> str:
    if any("\udc80" <= letter <= "\udcff" for letter in written):
        return "a byte of this string is not valid UTF-8"
    if _is_bytes(written):
        return "bytes have letters of ASCII only"
    return "an escape in this string is invalid"


def _wrong_fields(text: str, token: Token, read_expression: Callable[[str], ast.expr]) -> Iterator[SyntaxReason]:
    for piece in template(text, token.start).pieces:
        if piece.field is not None:
            start, end = piece.field.expression
            try:
                read_expression(f"({text[start:end]})")
            except NotPythonError:
                yield SyntaxReason(start, f"{_shown(text[start:end])} is not an expression")
