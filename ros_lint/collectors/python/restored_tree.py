"""Changes the syntax tree of a source that was rewritten without newer syntax into the syntax tree of the original source."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, Final

from ros_lint.base.python_parser import literal
from ros_lint.base.python_tokens import Piece, Template, Token, TokenError, template
from ros_lint.base.text import to_bytes

if TYPE_CHECKING:
    from collections.abc import Callable

    from ros_lint.base.text import Text
    from ros_lint.collectors.python.newer_syntax import Rewritten

Place = tuple[int, int]
"""A line from 1 and a column from 0 in bytes, as in syntax trees of Python."""

_QUOTED: Final = re.compile(r"\\.|\"", re.DOTALL)
_CONVERSIONS: Final = {"": -1, "a": 97, "r": 114, "s": 115}


def restore(tree: ast.Module, source: Text, rewritten: Rewritten, expression: Callable[[str, int], ast.expr]) -> None:
    """Change the tree of a rewritten source so that it becomes the tree of the original source. Raises TokenError.

    ``expression(text, offset)`` returns the tree of ``text``, an expression in brackets at ``offset`` in the source. Exceptions
    of this function are passed on.
    """
    restorer = _Restorer(source, rewritten, expression)
    for node in ast.walk(tree):
        restorer.visit(node)


def place_of(source: Text, offset: int) -> Place:
    """Return line and column of an offset, as in syntax trees."""
    line, column = source.position(offset)
    return line, len(to_bytes(source.text[offset - column + 1 : offset]))


class _Restorer:
    def __init__(self, source: Text, rewritten: Rewritten, expression: Callable[[str, int], ast.expr]) -> None:
        self._source = source
        self._expression = expression
        self._strings = {place_of(source, start): group for start, group in rewritten.strings.items()}
        self._aliases = {place_of(source, start) for start in rewritten.aliases}
        self._parameters = {place_of(source, start): names for start, names in rewritten.parameters.items()}

    def visit(self, node: ast.AST) -> None:
        """Replace the direct children of a node that stand for rewritten constructs by the trees of the original constructs."""
        for name, value in ast.iter_fields(node):
            if isinstance(value, ast.Name):
                setattr(node, name, self._name(value))
            elif isinstance(value, list) and value:
                setattr(node, name, [inner for item in value for inner in self._item(item)])

    def _item(self, item: object) -> Iterator[object]:
        if isinstance(item, ast.Name):
            yield self._name(item)
        elif isinstance(item, ast.stmt):
            place = item.lineno, item.col_offset
            for name in self._parameters.get(place, ()):
                yield _bound(ast.Name(name, ast.Store()), item)
            if place in self._aliases and isinstance(item, ast.Assign) and isinstance(item.targets[0], ast.Tuple):
                yield _bound(item.targets[0].elts[-1], item)
            else:
                yield item
        else:
            yield item

    def _name(self, node: ast.Name) -> ast.expr:
        """Return the f-string that the name ``node`` replaces, the name itself if it does not replace an f-string."""
        group = self._strings.get((node.lineno, node.col_offset - 1))
        if group is None or node.id != "_":
            return node
        if not isinstance(node.ctx, ast.Load):
            raise TokenError("nothing can be given to a string", group[0].start)
        start, end = place_of(self._source, group[0].start), place_of(self._source, group[-1].end)
        joined = ast.JoinedStr(list(_merged(self._parts(group))))
        for part in ast.walk(joined):
            if not hasattr(part, "lineno") and isinstance(part, ast.expr):
                part.lineno, part.col_offset = start
                part.end_lineno, part.end_col_offset = end
        return joined

    def _parts(self, group: Sequence[Token]) -> Iterator[ast.expr]:
        for token in group:
            written = self._source.text[token.start : token.end]
            if token.kind == "template":
                parsed = template(self._source.text, token.start)
                yield from self._pieces(parsed.pieces, parsed)
            else:
                yield ast.Constant(_evaluated(written, token.start))

    def _pieces(self, pieces: Iterable[Piece], around: Template) -> Iterator[ast.expr]:
        text = self._source.text
        for piece in pieces:
            field = piece.field
            if field is None:
                yield ast.Constant(_literal(text[piece.start : piece.end], around, piece.start))
                continue
            start, end = field.expression
            value = self._expression(f"({text[start:end]})", field.start)
            form = None if field.format is None else ast.JoinedStr(list(_merged(self._pieces(field.format, around))))
            conversion = field.conversion
            if field.debug:
                yield ast.Constant(field.debug)
                conversion = conversion or ("" if form else "r")
            yield ast.FormattedValue(value, _CONVERSIONS[conversion], form)


def _bound(target: ast.expr, at: ast.stmt) -> ast.stmt:
    """Return an assignment of None to ``target``, with the position of ``at``.

    The assignment represents a construct that binds a name, such as a type statement.
    """
    statement = ast.Assign([target], ast.Constant(None))
    ast.copy_location(statement, at)
    return ast.fix_missing_locations(statement)


def _merged(parts: Iterable[ast.expr]) -> Iterator[ast.expr]:
    """Yield the parts of an f-string. Adjacent constant texts become one constant, empty texts are omitted."""
    text: list[str] = []
    for part in parts:
        if isinstance(part, ast.Constant):
            text.append(str(part.value))
            continue
        if any(text):
            yield ast.Constant("".join(text))
        text = []
        yield part
    if any(text):
        yield ast.Constant("".join(text))


def _literal(text: str, around: Template, start: int) -> str:
    """Return the value of a part of an f-string between its fields: escapes are replaced, and ``{{`` becomes ``{``."""
    text = text.replace("{{", "{").replace("}}", "}")
    if around.raw:
        return text.replace("\r\n", "\n").replace("\r", "\n")
    return _evaluated('"""' + _QUOTED.sub(lambda found: '\\"' if found[0] == '"' else found[0], text) + '"""', start)


def _evaluated(written: str, start: int) -> str:
    try:
        value = literal(written)
    except ValueError:
        raise TokenError("an escape in this string is invalid", start) from None
    if not isinstance(value, str):
        raise TokenError("a bytes literal cannot be next to a string literal", start)
    return value
