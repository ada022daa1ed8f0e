"""Scans of Python code without strings and comments: whether a source is plain, and its nesting depth.

Nearly every source is plain: each Python from 3.10 on builds the same tree. All others are processed by
:mod:`ros_lint.collectors.python.newer_syntax`.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from string import ascii_letters, digits
from typing import Final

from ros_lint.base.python_tokens import STRINGS

DEEPEST: Final = 200
"""The maximum nesting depth of expressions. Published workspaces have up to 52."""


_MOST_GROUPS: Final = 3
"""The maximum nesting depth of brackets in a field of a simple f-string."""


def _simple_template(quote: str) -> str:
    """Return a pattern for an f-string after its first quote, if every Python builds the same tree of it."""
    other = "'" if quote == '"' else '"'
    string = rf"{other}[^{{}}\"'\\\#\r\n]*{other}"
    inside = rf"(?:[^(){{}}\[\]\"'\\\#\r\n]|{string})*"
    group = r"(?!)"
    for _ in range(_MOST_GROUPS):
        group = rf"[(\[]{inside}(?:{group}{inside})*[)\]]"
    # No starred expression, generator or tuple, unless in brackets.
    expression = rf"(?![ ]*\*)(?:[^(){{}}\[\],:!f\"'\\\#\r\n]|f(?!or\b)|!=|{string}|{group})*"
    form = rf"[^{{}}{quote}\\\r\n]*(?:\{{[\w.]*\}}[^{{}}{quote}\\\r\n]*)*"
    piece = rf"\\[^N{{}}\r\n]|\{{\{{|\}}\}}|\{{{expression}(?:![ars])?(?::{form})?\}}"
    before = rf"(?:(?<=[fF]{quote})|(?<=[fF][rR]{quote}))"
    long = rf"{quote}{quote}(?:[^{{}}{quote}\\]|{quote}(?!{quote}{quote})|{piece})*{quote}{quote}{quote}"
    return rf"{before}(?:(?!{quote}{quote})(?:[^{{}}{quote}\\\r\n]|{piece})*{quote}|{long})"


def _plain_string(quote: str) -> str:
    """Return a pattern for a string after its first quote, unless it is an f-string or a t-string."""
    bodies = "|".join(body.removeprefix(quote) for body in STRINGS if body.startswith(quote))
    return rf"(?<![fFtT]{quote})(?<![fFtT][rR]{quote})(?:{bodies})"


_SPARED: Final = re.compile(
    r"\#[^\r\n]*|" + "|".join(f"{quote}(?:{_simple_template(quote)}|{_plain_string(quote)})" for quote in ('"', "'")), re.DOTALL
)
_BLANK: Final = r"(?:[ \t\f]|\\\r?\n)"
_PERHAPS_NEWER: Final = (
    ("type", re.compile(rf"type{_BLANK}+(?!(?:and|as|else|for|if|import|in|is|not|or)\b)[^\W\d]\w*{_BLANK}*[=\[]")),
    ("def", re.compile(rf"def{_BLANK}+\w+{_BLANK}*\[")),
    ("class", re.compile(rf"class{_BLANK}+\w+{_BLANK}*\[")),
    ("except", re.compile(rf"except{_BLANK}*\*|except\b[^:(\r\n]*,")),
    ("lazy", re.compile(rf"lazy{_BLANK}+(?:from|import)\b")),
    ("*", re.compile(r"[(\[{]\s*\*[^,(){}\[\]]*\sfor\b")),
    ("*", re.compile(r"[\w\])]\s*\[(?:[^\[\](){}:=]*,)?\s*\*(?!\*)|\*\s*\w+\s*:\s*\*")),
)
"""A keyword, and the pattern of the construct that was added after Python 3.10."""
LONG_NUMBER: Final = re.compile(r"[0-9]\w{1000}")


def plain(text: str) -> bool:
    """Return whether each Python from 3.10 on builds the same tree of a source, or rejects it."""
    code = _SPARED.sub("0", text)
    if '"' in code or "'" in code or LONG_NUMBER.search(code):
        return False
    return not any(word in code and pattern.search(code) for word, pattern in _PERHAPS_NEWER)


# --- nesting

LAMBDA: Final = "\x01"
"""The symbol of the keyword ``lambda``."""
PREFIX: Final = "~"
"""The symbol of the words that begin a larger expression, such as ``not``."""
SYMBOLS: Final = {**dict.fromkeys(("await", "else", "not", "yield"), PREFIX), "lambda": LAMBDA}
_WORDS: Final = re.compile(rf"\b(?:{'|'.join(SYMBOLS)})\b")
_UNCOUNTED: Final = dict.fromkeys(map(ord, f"{ascii_letters}{digits}_ \t\f"))
_JOINED: Final = re.compile(r"\\\r?\n")


def nests_too_deep(statement: str) -> bool:
    """Return whether the expressions of a plain statement nest too deeply."""
    code = _JOINED.sub("", _SPARED.sub("0", statement))
    symbols = _WORDS.sub(lambda word: SYMBOLS[word[0]], code).translate(_UNCOUNTED)
    return first_too_deep(symbols) is not None


def first_too_deep(symbols: Iterable[str]) -> int | None:
    """Return the index of the first symbol at which expressions nest too deeply, None if there is none.

    The symbols are all operators, brackets, commas, colons and line ends, and some words. Operators and brackets up
    to the next comma are counted, with those before each open bracket, because they can make the syntax tree deeper.
    Commas in the parameters of a lambda do not end the count.
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
        else:
            parameters += symbol == LAMBDA
            count += 1
            total += 1
        if total > DEEPEST:
            return index
    return None
