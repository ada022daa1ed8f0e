"""Split Python sources into tokens, with the same result for each version of Python that runs ros-lint.

``tokenize`` of the standard library is not used, because from Python 3.12 on it returns other tokens for f-strings and
raises errors for other sources than before. This module uses the grammar of Python 3.14: f-strings nest (PEP 701), and
t-strings exist (PEP 750). Source: "Lexical analysis" of the language reference.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import cache
from typing import Final, Literal, NamedTuple

from ros_lint.base.python_nesting import STRINGS

Kind = Literal["name", "number", "string", "template", "op", "newline", "comment"]

_PREFIX: Final = r"(?:[bBuU]|[bB][rR]|[rR][bB]?)?"
_ENDS: Final = {'"""': "", "'''": "", '"': r"\r\n", "'": r"\r\n"}
_NAMED: Final = r"\\N\{[^}'\"]*\}|"


@cache
def _token() -> re.Pattern[str]:
    return re.compile(
        rf"""
          (?P<blank>[ \t\f]+|\\(?:\r\n|\r|\n))
        | (?P<comment>\#[^\r\n]*)
        | (?P<newline>\r\n|\r|\n)
        | (?P<string>{_PREFIX}(?:{"|".join(STRINGS)}))
        | (?P<template>(?:[fFtT][rR]?|[rR][fFtT])(?=["']))
        | (?P<name>[^\W\d]\w*)
        | (?P<number>0[xXoObB]\w*|(?:\d[\d_]*\.?[\d_]*|\.\d[\d_]*)(?:[eE][-+]?\d[\d_]*)?[jJ]?)
        | (?P<op>\*\*=?|//=?|>>=?|<<=?|!=|->|:=|\.\.\.|[-+*/%@&|^<>=]=?|[()\[\]{{}},:;.~])
        """,
        re.VERBOSE | re.DOTALL,
    )


@cache
def _literal(quote: str, raw: bool) -> re.Pattern[str]:
    """Return a pattern of the literal text of an f-string, up to the next brace or the closing quote."""
    escape = rf"{'' if raw else _NAMED}\\(?:\r\n|[^{{}}]|(?=[{{}}]))"
    return re.compile(rf"(?:\{{\{{|\}}\}}|{escape}|(?!{quote})[^{{}}\\{_ENDS[quote]}])*", re.DOTALL)


_QUOTE: Final = re.compile(r"\"\"\"|'''|\"|'")
_CLOSES: Final = {"(": ")", "[": "]", "{": "}"}
_DEBUG: Final = re.compile(r"=[ \t\r\n]*(?=[!:}])")
_CONVERSION: Final = re.compile(r"!([a-z]*)([ \t\r\n]*)(?=[:}])")
_MOST_TEMPLATES: Final = 5
"""Maximum nesting of f-strings."""


class Token(NamedTuple):
    """A token with its start and end offset. Blanks, line ends in brackets and line continuations are not tokens."""

    kind: Kind
    start: int
    end: int


class Field(NamedTuple):
    """A replacement field of an f-string or t-string, such as ``{width:>8}``."""

    start: int
    """Offset of the opening brace."""
    expression: tuple[int, int]
    debug: str
    """For a field such as ``{a = }``, the expression with the equals sign, which Python shows before the value. Otherwise ""."""
    conversion: str
    """Letter of the conversion (a, r, s), or ""."""
    format: tuple[Piece, ...] | None
    """Pieces of the format specification (the part after ":"), None if the field has none."""


class Piece(NamedTuple):
    """A part of an f-string or t-string: a field, or literal text."""

    start: int
    end: int
    field: Field | None = None


class Template(NamedTuple):
    """An f-string or a t-string."""

    start: int
    end: int
    quote: str
    raw: bool
    interpolated: bool
    """True for a t-string."""
    pieces: tuple[Piece, ...]
    newer: tuple[str, ...]
    """Names, in the plural, of syntax in the string that requires Python 3.12: "comments in braces"."""


class TokenError(Exception):
    """The source is not valid in any version of Python. ``offset`` is the offset of the error."""

    def __init__(self, message: str, offset: int) -> None:
        super().__init__(message)
        self.message: Final = message
        self.offset: Final = offset


class TemplateDepthError(TokenError):
    """F-strings nest more deeply than this module supports. The source may be valid Python."""


def tokens(text: str) -> Iterator[Token]:
    """Yield the tokens of a source in order. Raises TokenError.

    A token of the kind "newline" ends a logical line.
    """
    at, depth, blank = 0, 0, True
    while at < len(text):
        match = _token().match(text, at)
        if match is None:
            raise _no_token(text, at)
        kind, end = match.lastgroup, match.end()
        if kind == "template":
            end = template(text, at).end
        if kind == "op":
            if match[0] in _CLOSES:
                depth += 1
            elif match[0] in _CLOSES.values():
                depth = max(0, depth - 1)
        if kind == "newline":
            if not depth and not blank:
                yield Token("newline", at, end)
                blank = True
        elif kind != "blank":
            yield Token(kind, at, end)  # type: ignore[arg-type]
            blank = blank and kind == "comment"
        at = end


def template(text: str, start: int) -> Template:
    """Return the f-string or t-string whose prefix begins at the offset ``start``. Raises TokenError."""
    return _TemplateParser(text).template(start, 0)


def _no_token(text: str, at: int) -> TokenError:
    """Return the error for the offset ``at``, at which no token begins.

    Its message is, for example, "this string is not closed".
    """
    match = _QUOTE.match(text, at)
    if match is None and (prefix := re.compile(r"[a-zA-Z]{1,2}(?=[\"'])").match(text, at)):
        match = _QUOTE.match(text, prefix.end())
    if match is not None:
        return TokenError("this string is not closed", at)
    if text[at] == "\\":
        return TokenError("only the end of a line may stand after a backslash", at)
    if "\udc80" <= text[at] <= "\udcff":
        return TokenError("a byte that is not UTF-8", at)
    return TokenError("Python has no such character", at)


class _TemplateParser:
    """Parses the f-strings and t-strings of a text."""

    def __init__(self, text: str) -> None:
        self._text = text
        self._newer: dict[str, None] = {}

    def template(self, start: int, depth: int) -> Template:
        if depth > _MOST_TEMPLATES:
            raise TemplateDepthError(f"f-strings nested more than {_MOST_TEMPLATES} levels deep", start)
        text = self._text
        opening = _QUOTE.search(text, start)
        assert opening is not None
        prefix = text[start : opening.start()].lower()
        quote, at = opening[0], opening.end()
        if len(quote) == 1 and text.startswith(quote, at) and not text.startswith(quote, at + 1):
            return Template(start, at + 1, quote, "r" in prefix, "t" in prefix, (), ())
        outer, self._newer = self._newer, {}
        pieces, at = self._pieces(at, quote, "r" in prefix, depth, 0, start)
        result = Template(start, at + len(quote), quote, "r" in prefix, "t" in prefix, pieces, tuple(self._newer))
        self._newer = outer
        return result

    def _pieces(self, at: int, quote: str, raw: bool, depth: int, level: int, start: int) -> tuple[tuple[Piece, ...], int]:
        """Return the pieces from the offset ``at`` to the end of an f-string, and the offset of the end.

        If ``level`` is 0, the end is the closing ``quote``. Otherwise the pieces are those of a format specification at the
        nesting depth ``level``, and the end is a closing brace. ``start`` is the offset of the f-string, and ``depth`` is
        the number of f-strings around the f-string.
        """
        text, pieces = self._text, list[Piece]()
        literal = _literal(quote, raw)
        while True:
            end = _literal_end(literal, text, at, in_format=level > 0)
            if end > at:
                pieces.append(Piece(at, end))
            at = end
            if level and text.startswith("}", at):
                return tuple(pieces), at
            if not level and text.startswith(quote, at):
                return tuple(pieces), at
            if text.startswith("{", at):
                field, end = self._field(at, quote, raw, depth, level, start)
                pieces.append(Piece(at, end, field))
                at = end
            elif text.startswith("}", at):
                raise TokenError('a single "}" in an f-string', at)
            else:
                raise TokenError("this string is not closed", start)

    def _field(self, start: int, quote: str, raw: bool, depth: int, level: int, string_start: int) -> tuple[Field, int]:
        text = self._text
        end = self._expression_end(start + 1, depth)
        inside = text[start + 1 : end]
        if not inside.strip():
            raise TokenError("an f-string has an empty expression", start)
        at, debug, conversion = end, "", ""
        if match := _DEBUG.match(text, at):
            debug, at = text[start + 1 : match.end()], match.end()
        if text.startswith("!", at):
            match = _CONVERSION.match(text, at)
            if match is None or match[1] not in ("a", "r", "s"):
                raise TokenError("a conversion of an f-string is !a, !r or !s", at)
            if match[2]:
                self._newer["blanks after a conversion"] = None
            conversion, at = match[1], match.end()
        form = None
        if text.startswith(":", at):
            if level >= _MOST_TEMPLATES:
                raise TemplateDepthError(f"f-strings nested more than {_MOST_TEMPLATES} levels deep", at)
            form, at = self._pieces(at + 1, quote, raw, depth, level + 1, string_start)
        if not text.startswith("}", at):
            raise TokenError('the "{" of an f-string is not closed', start)
        if len(quote) == 1 and ("\n" in inside or "\r" in inside):
            self._newer["line breaks in braces"] = None
        if level > 1:
            self._newer["nested format specifications"] = None
        if "\\" in inside:
            self._newer["backslashes in braces"] = None
        if quote in inside:
            self._newer["their own quotes inside"] = None
        return Field(start, (start + 1, end), debug, conversion, form), at + 1

    def _expression_end(self, at: int, depth: int) -> int:
        """Return the offset of the end of the expression in a replacement field. The expression starts at the offset ``at``.

        It ends before a closing brace, a colon, a conversion (``!r``) or the final equals sign.
        """
        text, closing_brackets = self._text, list[str]()
        while at < len(text):
            match = _token().match(text, at)
            if match is None:
                if text[at] == "!" and not closing_brackets:
                    return at
                raise _no_token(text, at)
            kind, symbol = match.lastgroup, match[0]
            if kind == "op":
                if not closing_brackets and (symbol in ("}", ":", ":=") or (symbol == "=" and _DEBUG.match(text, at))):
                    return at
                if symbol in _CLOSES:
                    closing_brackets.append(_CLOSES[symbol])
                elif closing_brackets and symbol == closing_brackets[-1]:
                    closing_brackets.pop()
                elif symbol in _CLOSES.values():
                    raise TokenError(f'"{symbol}" closes nothing', at)
            elif kind == "comment":
                self._newer["comments in braces"] = None
            at = self.template(at, depth + 1).end if kind == "template" else match.end()
        raise TokenError("this string is not closed", at)


def _literal_end(literal: re.Pattern[str], text: str, at: int, *, in_format: bool) -> int:
    """Return the end offset of the literal text that starts at the offset ``at`` of an f-string; ``at`` if there is none.

    ``literal`` is the pattern of literal text. In a format specification (``in_format``), literal text also ends before
    doubled braces, because they are no escape there.
    """
    match = literal.match(text, at)
    end = match.end() if match is not None else at
    if in_format:
        braces = [place for place in (text.find("{", at, end), text.find("}", at, end)) if place >= 0]
        return min(braces, default=end)
    return end
