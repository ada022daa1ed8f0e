"""The syntax of substitutions in XML and YAML launch files: ``$(name argument ...)``.

It follows ``grammar.lark`` of the launch package: arguments are separated by one space and may be quoted, quotes do not nest,
a backslash escapes, and a dollar sign is literal unless a parenthesis follows.
"""

from __future__ import annotations

import re
from typing import Final, NamedTuple, Union


class SubstitutionError(Exception):
    """A text with substitutions does not match the grammar. ``offset`` is the offset of the error in the text."""

    def __init__(self, message: str, offset: int) -> None:
        super().__init__(message)
        self.message: Final = message
        self.offset: Final = offset


class Literal(NamedTuple):
    """A literal part of a text, or of an argument of a substitution.

    ``text`` is without escapes, ``start`` and ``end`` are the offsets in the whole text.
    """

    text: str
    start: int
    end: int


class Substitution(NamedTuple):
    """A substitution ``$(name argument ...)`` in a text. Each argument consists of literals and substitutions."""

    name: str
    arguments: tuple[tuple[Piece, ...], ...]
    start: int
    end: int


Piece = Union[Literal, Substitution]  # noqa: UP007  (Substitution names it before it is there, on 3.10 too)

_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_-]*")
_ESCAPE = re.compile(r"\\(.)")
_MAX_DEPTH = 50

# The characters that end a literal, by its context: unquoted, quoted, or an argument inside quotes.
_BARE_STOPS = " '\")("
_INNER_STOPS = {"'": " ')(", '"': ' ")('}
_STOPS = {
    stops: re.compile(rf"[\\$(){stops}]" if stops not in ("", "'", '"') else rf"[\\${stops}]")
    for stops in ("", "'", '"', _BARE_STOPS, *_INNER_STOPS.values())
}
"""By the characters that end a literal: the pattern of such a character, a backslash or a dollar sign."""


def parse(text: str) -> tuple[Piece, ...]:
    """Return the literals and substitutions in a text. Raises SubstitutionError if the text does not match the grammar."""
    if "$(" not in text:
        return (Literal(_unescape(text), 0, len(text)),)
    return _Parser(text).template()


def _unescape(text: str) -> str:
    return _ESCAPE.sub(r"\1", text) if "\\" in text else text


class _Parser:
    __slots__ = ("_text",)

    def __init__(self, text: str) -> None:
        self._text = text

    def template(self) -> tuple[Piece, ...]:
        return self._pieces(0, "", "$", 0, "")[0]

    def _pieces(self, at: int, stops: str, escaped: str, depth: int, quote: str) -> tuple[tuple[Piece, ...], int]:
        """Return the literals and substitutions from the offset ``at`` on, and the offset after them.

        Reading stops at a character of ``stops`` or at the end. A backslash escapes the characters in ``escaped``.
        """
        text = self._text
        pieces: list[Piece] = []
        begin = at
        stop = _STOPS[stops]
        while match := stop.search(text, at):
            at = match.start()
            if text[at] == "\\":
                at += 2 if text[at + 1 : at + 2] and text[at + 1] in escaped else 1
            elif text[at] != "$" or text[at] in stops:
                break
            elif text.startswith("(", at + 1):
                if begin < at:
                    pieces.append(Literal(_unescape(text[begin:at]), begin, at))
                substitution = self._substitution(at, depth + 1, quote)
                pieces.append(substitution)
                begin = at = substitution.end
            else:
                at += 1
        else:
            at = len(text)
        if begin < at:
            pieces.append(Literal(_unescape(text[begin:at]), begin, at))
        return tuple(pieces), at

    def _substitution(self, start: int, depth: int, quote: str) -> Substitution:
        text = self._text
        if depth > _MAX_DEPTH:
            raise SubstitutionError("substitutions are nested too deeply", start)
        name = _NAME.match(text, start + 2)
        if not name:
            raise SubstitutionError("$( is not followed by the name of a substitution", start)
        at = name.end()
        arguments: list[tuple[Piece, ...]] = []
        while text.startswith(" ", at):
            pieces, at = self._argument(at + 1, depth, quote)
            arguments.append(pieces)
        if not text.startswith(")", at):
            raise SubstitutionError(f"$({name[0]} is not closed", start)
        return Substitution(name[0], tuple(arguments), start, at + 1)

    def _argument(self, at: int, depth: int, quote: str) -> tuple[tuple[Piece, ...], int]:
        text = self._text
        opening = text[at : at + 1]
        if not quote and opening and opening in "'\"":
            pieces, end = self._pieces(at + 1, opening, f"{opening}$", depth, opening)
            if not text.startswith(opening, end):
                raise SubstitutionError(f"the quote {opening} is not closed", at)
            return pieces, end + 1
        stops, escaped = (_INNER_STOPS[quote], f"{quote}$()") if quote else (_BARE_STOPS, "'\"$()")
        pieces, end = self._pieces(at, stops, escaped, depth, quote)
        if not pieces:
            raise SubstitutionError("arguments are separated by one space", at)
        return pieces, end
