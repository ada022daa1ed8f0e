"""The code of a Python source without its strings and comments: whether it is plain, and how deep it nests.

Nearly every source is plain: each Python from 3.10 on makes the same tree of it. All others take the long way through
:mod:`ros_lint.collectors.python.newer_syntax`.
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
"""Patterns of strings without their prefix, with the flag DOTALL."""
DEEPEST: Final = 200
"""How many expressions may stand in one another. Published workspaces have up to 52."""


_MOST_GROUPS: Final = 3
"""How many brackets may stand in one another in a field of a simple f-string."""


@cache
def _spared(*, every: bool) -> re.Pattern[str]:
    """Return a pattern of comments, strings and simple f-strings: ``every`` one of these, or those with names in their fields.

    The second is enough for most sources, and made in a quarter of the time.
    """
    starts = ('"', "'")
    strings = (f"{quote}(?:{_template(quote, _field(quote) if every else _NAMES)}|{_string(quote)})" for quote in starts)
    return re.compile("|".join([r"\#[^\r\n]*", *strings]), re.DOTALL)


_NAMES: Final = r"\{[\w.]+(?::[\w.]*)?\}"


def _field(quote: str) -> str:
    """Return a pattern of the fields of f-strings with a quote of which every Python makes the same tree."""
    other = "'" if quote == '"' else '"'
    string = rf"{other}[^{{}}\"'\\\#\r\n]*{other}"
    inside = rf"(?:[^(){{}}\[\]\"'\\\#\r\n]|{string})*"
    group = r"(?!)"
    for _ in range(_MOST_GROUPS):
        group = rf"[(\[]{inside}(?:{group}{inside})*[)\]]"
    # No starred expression, generator or tuple, unless in brackets.
    expression = rf"(?![ ]*\*)(?:[^(){{}}\[\],:!f\"'\\\#\r\n]|f(?!or\b)|!=|{string}|{group})*"
    form = rf"[^{{}}{quote}\\\r\n]*(?:\{{[\w.]*\}}[^{{}}{quote}\\\r\n]*)*"
    return rf"\{{{expression}(?:![ars])?(?::{form})?\}}"


def _template(quote: str, field: str) -> str:
    """Return a pattern of the rest of an f-string, behind its first quote."""
    piece = rf"\\[^N{{}}\r\n]|\{{\{{|\}}\}}|{field}"
    before = rf"(?:(?<=[fF]{quote})|(?<=[fF][rR]{quote}))"
    long = rf"{quote}{quote}(?:[^{{}}{quote}\\]|{quote}(?!{quote}{quote})|{piece})*{quote}{quote}{quote}"
    return rf"{before}(?:(?!{quote}{quote})(?:[^{{}}{quote}\\\r\n]|{piece})*{quote}|{long})"


def _string(quote: str) -> str:
    """Return a pattern of the rest of a string, behind the first quote: neither an f-string nor a t-string."""
    bodies = "|".join(body.removeprefix(quote) for body in STRINGS if body.startswith(quote))
    return rf"(?<![fFtT]{quote})(?<![fFtT][rR]{quote})(?:{bodies})"


def _code(text: str) -> str:
    """Return a source without its comments, and with a name for each string, but those that are not simple."""
    code = _spared(every=False).sub("_", text)
    return _spared(every=True).sub("_", text) if '"' in code or "'" in code else code


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
"""A word and the pattern of something with it that came after Python 3.10, or is beyond a bound."""
_STAR: Final = re.compile(r"\*\*?")
_UNPACKED: Final = re.compile(r"[^,(){}\[\]]*\sfor\b")
_ANNOTATED: Final = re.compile(r"\*\s*\w+\s*:\s*\*")
_LONGEST_SUBSCRIPT: Final = 500


def plain(text: str) -> bool:
    """Return whether each Python from 3.10 on makes the same tree of a source, or refuses it."""
    code = _code(text)
    if '"' in code or "'" in code:
        return False
    return not any(word in code and re.search(pattern, code) for word, pattern in _PERHAPS_NEWER) and not _has_newer_star(code)


def _is_in_subscript(before: str) -> bool:
    """Return whether the innermost bracket that is open at the end of a text may be one of a subscript."""
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
    """Return whether a star may stand in a subscript, before an annotation, or at the start of a comprehension."""
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
"""The symbol of the word."""
PREFIX: Final = "~"
"""The symbol of the words in front of an expression that it becomes part of."""
SYMBOLS: Final = {**dict.fromkeys(("await", "else", "not", "yield"), PREFIX), "lambda": LAMBDA}
_WORDS: Final = rf"\b(?:{'|'.join(SYMBOLS)})\b"
_UNCOUNTED: Final = dict.fromkeys(map(ord, f"{ascii_letters}{digits}_ \t\f"))
_COUNTED: Final = (*"([{.+-*/%@&|^~<>!", "elif", *SYMBOLS)
_JOINED: Final = r"\\\r?\n"


def may_be_paired(text: str) -> bool:
    """Return whether there are as many opening brackets as closing ones."""
    code = _code(text)
    return all(code.count(opening) == code.count(closing) for opening, closing in ("()", "[]", "{}"))


def most_levels(text: str) -> int:
    """Return a number that is no smaller than how deep the code of a source nests."""
    return sum(map(text.count, _COUNTED)) if len(text) > DEEPEST else 0


def nests_too_deep(statement: str) -> bool:
    """Return whether expressions of a plain statement nest too deeply."""
    code = re.sub(_JOINED, "", _code(statement))
    symbols = re.sub(_WORDS, lambda word: SYMBOLS[word[0]], code).translate(_UNCOUNTED)
    return first_too_deep(symbols) is not None


def first_too_deep(symbols: Iterable[str]) -> int | None:
    """Return the index of the first symbol at which expressions nest too deeply, None where they do not.

    The symbols are those of all operators, brackets, commas, colons and line ends, and of some words. Counted is what can
    make the syntax tree deeper: operators and brackets up to the next comma, and those before each bracket that is open.
    Commas in the parameters of a lambda end nothing.
    """
    total = count = parameters = 0
    opened: list[tuple[int, int]] = []
    for index, symbol in enumerate(symbols):
        if symbol in ("(", "[", "{"):
            total += 1
            opened.append((count + 1, parameters))
            count = parameters = 0
        elif symbol in (")", "]", "}"):
            total -= count
            count, parameters = opened.pop() if opened else (0, 0)
        elif symbol == ",":
            if not parameters:
                total -= count
                count = 0
        elif symbol in ("\n", "\r", ";"):
            if not opened:
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
