"""Fast checks of Python sources by regular expressions: whether a source is plain, and how deep its expressions nest.

A source is plain if all versions of Python from 3.10 on parse it to the same tree. Nearly all sources are plain. For
other sources, :mod:`ros_lint.collectors.python.newer_syntax` is needed, which is slower.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from functools import cache
from string import ascii_letters, digits
from typing import Final

STRINGS: Final = (
    r'"""[^"\\]*(?:(?:\\.|"(?!""))[^"\\]*)*"""',
    r"'''[^'\\]*(?:(?:\\.|'(?!''))[^'\\]*)*'''",
    r'"(?!"")[^"\\\r\n]*(?:\\(?:\r\n|.)[^"\\\r\n]*)*"',
    r"'(?!'')[^'\\\r\n]*(?:\\(?:\r\n|.)[^'\\\r\n]*)*'",
    r'""(?!")',
    r"''(?!')",
)
"""Patterns of string literals without their prefix, such as ``r``. They need the flag re.DOTALL."""
DEEPEST: Final = 200
"""Maximum nesting of expressions. Published workspaces have up to 52 levels."""

_MOST_BRACKETS: Final = 3
"""Maximum nesting of brackets in a replacement field ``{...}`` of an f-string that the patterns of this module match."""


@cache
def _skipped(*, complete: bool) -> re.Pattern[str]:
    """Return a pattern of comments, strings and simple f-strings, which do not affect how Python parses the rest of a source.

    If ``complete`` is False, the pattern matches only f-strings whose fields are names. This is enough for most sources,
    and such a pattern is compiled in a quarter of the time.
    """
    starts = ('"', "'")
    strings = (f"{quote}(?:{_template(quote, _field(quote) if complete else _NAME_FIELD)}|{_string(quote)})" for quote in starts)
    return re.compile("|".join([r"\#[^\r\n]*", *strings]), re.DOTALL)


_NAME_FIELD: Final = r"\{[\w.]+(?::[\w.]*)?\}"


def _field(quote: str) -> str:
    """Return a pattern of a replacement field such as ``{name!r:>{width}}`` in an f-string with the quote character ``quote``.

    The pattern matches only fields that every version of Python from 3.10 on parses to the same tree.
    """
    other_quote = "'" if quote == '"' else '"'
    string = rf"{other_quote}[^{{}}\"'\\\#\r\n]*{other_quote}"
    inside = rf"(?:[^(){{}}\[\]\"'\\\#\r\n]|{string})*"
    group = r"(?!)"
    for _ in range(_MOST_BRACKETS):
        group = rf"[(\[]{inside}(?:{group}{inside})*[)\]]"
    # No starred expression, generator or tuple, unless in brackets.
    expression = rf"(?![ ]*\*)(?:[^(){{}}\[\],:!f\"'\\\#\r\n]|f(?!or\b)|!=|{string}|{group})*"
    form = rf"[^{{}}{quote}\\\r\n]*(?:\{{[\w.]*\}}[^{{}}{quote}\\\r\n]*)*"
    return rf"\{{{expression}(?:![ars])?(?::{form})?\}}"


def _template(quote: str, field: str) -> str:
    """Return a pattern of an f-string without its prefix and its first quote character.

    ``quote`` is the quote character, and ``field`` the pattern of a replacement field in braces.
    """
    piece = rf"\\[^N{{}}\r\n]|\{{\{{|\}}\}}|{field}"
    before = rf"(?:(?<=[fF]{quote})|(?<=[fF][rR]{quote}))"
    long = rf"{quote}{quote}(?:[^{{}}{quote}\\]|{quote}(?!{quote}{quote})|{piece})*{quote}{quote}{quote}"
    return rf"{before}(?:(?!{quote}{quote})(?:[^{{}}{quote}\\\r\n]|{piece})*{quote}|{long})"


def _string(quote: str) -> str:
    """Return a pattern of a string without its first quote character ``quote``. It does not match f-strings and t-strings."""
    bodies = "|".join(body.removeprefix(quote) for body in STRINGS if body.startswith(quote))
    return rf"(?<![fFtT]{quote})(?<![fFtT][rR]{quote})(?:{bodies})"


def _code(text: str) -> str:
    """Return a source with ``_`` in place of each comment, string and simple f-string."""
    code = _skipped(complete=False).sub("_", text)
    return _skipped(complete=True).sub("_", text) if '"' in code or "'" in code else code


_BLANK: Final = r"(?:[ \t\f]|\\\r?\n)"
_NAME: Final = r"(?!(?:and|as|else|for|if|import|in|is|not|or)\b)[^\W\d]\w*"
_PERHAPS_NEWER: Final = (
    ("type", rf"type{_BLANK}+{_NAME}{_BLANK}*[=\[]"),
    ("def", rf"def{_BLANK}+\w+{_BLANK}*\["),
    ("class", rf"class{_BLANK}+\w+{_BLANK}*\["),
    ("except", rf"except{_BLANK}*\*|except\b[^:(\r\n]*,"),
    ("lazy", rf"lazy{_BLANK}+(?:from|import)\b"),
    ("0", r"0[xXoObB]\w{1000}"),
)
"""Syntax that is newer than Python 3.10 or exceeds a limit: pairs of a word and a pattern. The word occurs in each match."""
_STAR: Final = re.compile(r"\*\*?")
_UNPACKED: Final = re.compile(r"[^,(){}\[\]]*\sfor\b")
_ANNOTATED: Final = re.compile(r"\*\s*\w+\s*:\s*\*")
_LONGEST_SUBSCRIPT: Final = 500


def plain(text: str) -> bool:
    """Return whether all versions of Python from 3.10 on parse a source to the same tree, or reject it."""
    code = _code(text)
    if '"' in code or "'" in code:
        return False
    return not any(word in code and re.search(pattern, code) for word, pattern in _PERHAPS_NEWER) and not _has_newer_star(code)


def _is_in_subscript(before: str) -> bool:
    """Return whether the innermost bracket that is open at the end of ``before`` may begin a subscript, as in ``a[``."""
    closed = 0
    for at in range(len(before) - 1, -1, -1):
        if before[at] in ")]}":
            closed += 1
        elif before[at] in "([{":
            if not closed:
                return before[at] == "[" and re.search(r"[\w)\]]\s*\Z", before[:at]) is not None
            closed -= 1
    return len(before) == _LONGEST_SUBSCRIPT


def _has_newer_star(code: str) -> bool:
    """Return whether ``code`` may have a star that Python 3.10 rejects: ``a[*b]``, ``*args: *Ts`` or ``[*a for a in b]``."""
    for match in _STAR.finditer(code):
        before = code[max(0, match.start() - _LONGEST_SUBSCRIPT) : match.start()].rstrip()
        if before.endswith(("(", "[", "{")) and _UNPACKED.match(code, match.end()):
            return True
        if before.endswith(("[", ",")) and match[0] == "*" and _is_in_subscript(before):
            return True
        if _ANNOTATED.match(code, match.start()):
            return True
    return False


# --- nesting

LAMBDA: Final = "\x01"
"""The symbol in place of the keyword ``lambda``; see :func:`first_too_deep`."""
PREFIX: Final = "~"
"""The symbol in place of keywords before an operand, such as ``not``; see :func:`first_too_deep`."""
SYMBOLS: Final = {**dict.fromkeys(("await", "else", "not", "yield"), PREFIX), "lambda": LAMBDA}
_WORDS: Final = rf"\b(?:{'|'.join(SYMBOLS)})\b"
_UNCOUNTED: Final = dict.fromkeys(map(ord, f"{ascii_letters}{digits}_ \t\f"))
_COUNTED: Final = (*"([{.+-*/%@&|^~<>!", "elif", *SYMBOLS)
_JOINED: Final = r"\\\r?\n"


def may_be_paired(text: str) -> bool:
    """Return whether a source has as many opening as closing brackets of each kind."""
    code = _code(text)
    return all(code.count(opening) == code.count(closing) for opening, closing in ("()", "[]", "{}"))


def most_levels(text: str) -> int:
    """Return an upper bound for the nesting of expressions in a source, 0 for a source that is too short to nest too deeply."""
    return sum(map(text.count, _COUNTED)) if len(text) > DEEPEST else 0


def nests_too_deep(statement: str) -> bool:
    """Return whether the expressions of a statement may nest more deeply than DEEPEST, the maximum of ros-lint.

    All versions of Python from 3.10 on must parse the statement to the same tree.
    """
    code = re.sub(_JOINED, "", _code(statement))
    symbols = re.sub(_WORDS, lambda word: SYMBOLS[word[0]], code).translate(_UNCOUNTED)
    return first_too_deep(symbols) is not None


def first_too_deep(symbols: Iterable[str]) -> int | None:
    """Return the index of the first symbol at which expressions may nest too deeply (more than DEEPEST), None if there is none.

    ``symbols`` are the operators, brackets, commas, colons and line ends of a source, and a symbol for each keyword such
    as ``not`` (see SYMBOLS). Operators and brackets count, because each can make the syntax tree deeper. A comma resets the
    count to the value before its bracket, except in the parameters of a lambda.
    """
    total = count = parameters = 0
    outer_levels: list[tuple[int, int]] = []
    for index, symbol in enumerate(symbols):
        if symbol in ("(", "[", "{"):
            total += 1
            outer_levels.append((count + 1, parameters))
            count = parameters = 0
        elif symbol in (")", "]", "}"):
            total -= count
            count, parameters = outer_levels.pop() if outer_levels else (0, 0)
        elif symbol == ",":
            if not parameters:
                total -= count
                count = 0
        elif symbol in ("\n", "\r", ";"):
            if not outer_levels:
                total = count = parameters = 0
        elif symbol == ":":
            parameters = max(0, parameters - 1)
        elif symbol != "=":
            parameters += symbol == LAMBDA
            count += 1
            total += 1
        if total > DEEPEST:
            return index
    return None
