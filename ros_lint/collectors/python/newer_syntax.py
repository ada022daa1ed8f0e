"""Rewriting of Python syntax newer than 3.10, so that every Python version from 3.10 on creates the same tree of a source.

A construct that was added after Python 3.10 is replaced by an older one in the same place: no token changes its line,
or its column in bytes. If the older construct has another syntax tree, :mod:`ros_lint.collectors.python.restored_tree`
replaces it by the tree of the original construct. Source: "What's New in Python" 3.11 to 3.14, and the PEPs named
below.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from keyword import iskeyword
from typing import Final, NamedTuple

from ros_lint.base.python_nesting import plain
from ros_lint.base.python_tokens import Template, Token, template
from ros_lint.base.text import to_bytes

_CLOSES: Final = {"(": ")", "[": "]", "{": "}"}
_NEWLINE: Final = re.compile(r"\r\n|\r|\n")
_REST: Final = re.compile(r"[ \t\f]*(?:#[^\r\n]*)?(?=[\r\n]|\Z)")


class Newer(NamedTuple):
    """A construct in a source that Python versions before ``version`` reject. ``start`` and ``end`` are its offsets."""

    construct: str
    """The name of the construct, a noun in the plural such as "type statements"."""
    version: tuple[int, int]
    start: int
    end: int


class Rewritten(NamedTuple):
    """A source rewritten without constructs newer than Python 3.10, and the positions of these constructs.

    All offsets are offsets in the original source.
    """

    text: str
    newer: tuple[Newer, ...]
    strings: Mapping[int, tuple[Token, ...]]
    """Groups of adjacent f-strings that are replaced by ``(_)``, by the offset of the bracket."""
    aliases: frozenset[int]
    """Offsets of type statements. ``type X = Y`` is rewritten as ``typ, X = Y``."""
    parameters: Mapping[int, tuple[str, ...]]
    """The names of the removed type parameters, by the offset of the ``def`` or ``class`` statement."""


class _Edit(NamedTuple):
    start: int
    end: int
    text: str


def rewrite(text: str, tokens: Sequence[Token]) -> Rewritten:
    """Return a source rewritten without constructs newer than Python 3.10. Raises TokenError."""
    return _Rewriter(text, [token for token in tokens if token.kind != "comment"]).rewritten()


class _Rewriter:
    def __init__(self, text: str, code: Sequence[Token]) -> None:
        self._text = text
        self._code = code
        self._words = [text[token.start : token.end] if token.kind in ("name", "op") else "" for token in code]
        self._closing = dict(_pairs(self._words))
        self._newer: list[Newer] = []
        self._edits: list[_Edit] = []
        self._strings: dict[int, tuple[Token, ...]] = {}
        self._aliases: set[int] = set()
        self._parameters: dict[int, tuple[str, ...]] = {}

    def rewritten(self) -> Rewritten:
        depth, fresh, index = 0, True, 0
        while index < len(self._code):
            kind, word = self._code[index].kind, self._words[index]
            following = index + 1
            if kind in ("string", "template"):
                following = self._string(index)
            elif kind == "name":
                following = self._name(index, word, fresh=fresh)
            elif word in _CLOSES:
                self._unpacked(index)
                if word == "[":
                    self._subscript(index)
            elif word == "*":
                self._annotation(index)
            depth += (word in _CLOSES) - (word in _CLOSES.values())
            fresh = kind == "newline" or (not depth and word in (";", ":"))
            index = following
        return Rewritten(
            _edited(self._text, self._edits),
            tuple(self._newer),
            self._strings,
            frozenset(self._aliases),
            self._parameters,
        )

    def _word(self, index: int) -> str:
        return self._words[index] if 0 <= index < len(self._words) else ""

    def _is_name(self, index: int) -> bool:
        return index < len(self._code) and self._code[index].kind == "name" and not iskeyword(self._words[index])

    def _add(self, construct: str, version: tuple[int, int], first: int, last: int) -> None:
        self._newer.append(Newer(construct, version, self._code[first].start, self._code[last].end))

    def _name(self, index: int, word: str, *, fresh: bool) -> int:
        """Rewrite the construct that begins with the word at ``index``, if it is newer than Python 3.10.

        Return the index of the next token to process. ``fresh`` is True if a statement may begin at the word.
        """
        if word == "type" and fresh and self._is_name(index + 1):
            return self._alias(index)
        if word in ("def", "class") and self._word(index + 2) == "[":
            return self._type_parameters(index, index + 2, index - (self._word(index - 1) == "async"))
        if word == "except" and fresh:
            self._except(index)
        if word == "lazy" and fresh and self._word(index + 1) in ("from", "import"):
            self._lazy(index)
        return index + 1

    def _lazy(self, index: int) -> None:
        """Rewrite ``lazy import A`` as ``0  ; import A`` (PEP 810)."""
        token = self._code[index]
        self._add("lazy imports", (3, 15), index, index)
        self._edits.append(_Edit(token.start, token.end, "0  ;"))

    def _alias(self, index: int) -> int:
        """Rewrite ``type X[T] = Y`` as ``typ, X    = Y`` (PEP 695). Return the index of the next token to process."""
        sign = index + 2
        if self._word(sign) == "[":
            sign = self._closing.get(sign, len(self._code)) + 1
        if self._word(sign) != "=":
            return index + 1
        start = self._code[index].start
        self._add("type statements", (3, 12), index, index)
        self._edits.append(_Edit(start + 3, start + 4, ","))
        self._aliases.add(start)
        if sign > index + 2:
            self._blank_parameters(index + 2)
        return sign

    def _type_parameters(self, index: int, opening: int, statement: int) -> int:
        """Blank the type parameters in ``def f[T](a)`` or ``class A[T]`` (PEP 695).

        Return the index of the next token to process.
        """
        closing = self._closing.get(opening)
        if closing is None or not self._is_name(index + 1) or self._word(closing + 1) not in ("(", ":"):
            return index + 1
        self._add("type parameter lists", (3, 12), opening, closing)
        self._parameters[self._code[statement].start] = self._blank_parameters(opening)
        return closing + 1

    def _blank_parameters(self, opening: int) -> tuple[str, ...]:
        """Replace a list of type parameters by blanks, and return their names: ``[T, *Ts]`` -> ("T", "Ts").

        A default such as ``[T = int]`` is recorded as another newer construct (PEP 696).
        """
        closing = self._closing[opening]
        names = []
        for index in self._inside(opening):
            before = self._word(index - 1)
            if self._is_name(index) and (before in ("[", ",") or (before in ("*", "**") and self._word(index - 2) in ("[", ","))):
                names.append(self._words[index])
            if self._word(index) == "=":
                self._add("defaults of type parameters", (3, 13), index, index)
        start, end = self._code[opening].start, self._code[closing].end
        self._edits.append(_Edit(start, end, _blanked(self._text[start:end], joined=True)))
        return tuple(names)

    def _inside(self, opening: int) -> Iterator[int]:
        """Yield the indices of the tokens between a bracket and its closing bracket, without tokens in nested brackets."""
        index, closing = opening + 1, self._closing.get(opening, len(self._code))
        while index < closing:
            yield index
            index = self._closing.get(index, index) + 1

    def _except(self, index: int) -> None:
        """Rewrite ``except* A`` (PEP 654) as ``except  A``, and ``except A, B:`` (PEP 758) as ``except(A, B):``."""
        star = self._word(index + 1) == "*" and self._word(index + 2) != ":"
        if star:
            self._add("except* clauses", (3, 11), index, index + 1)
        after = list(self._rest(index + 1))
        colon = next((at for at in after if self._word(at) in (":", "as")), len(self._code))
        commas = [at for at in after if at < colon and self._word(at) == ","]
        room = self._code[index + 1].start if star else self._code[index].end
        if commas and self._word(colon) == ":" and not self._is_of_python_2(commas, colon) and self._text[room] in " \t*":
            end = self._code[colon].end
            rest = _REST.match(self._text, end)
            if rest or self._text[end] in " \t":
                self._add("except clauses with several types and no parentheses", (3, 14), commas[0], commas[0])
                self._edits += [_Edit(room, room + 1, "("), _Edit(end - 1, rest.end() if rest else end + 1, "):")]
                return
        if star:
            self._edits.append(_Edit(room, room + 1, " "))

    def _rest(self, index: int) -> Iterator[int]:
        """Yield the indices of the tokens from ``index`` to the end of the logical line, without tokens in brackets."""
        while index < len(self._code) and self._code[index].kind != "newline":
            yield index
            index = self._closing.get(index, index) + 1

    def _is_of_python_2(self, commas: Sequence[int], colon: int) -> bool:
        """Return whether an except clause is ``except Error, error:`` of Python 2, where ``error`` is a variable."""
        return len(commas) == 1 and colon == commas[0] + 2 and self._word(colon - 1)[:1].islower()

    def _unpacked(self, opening: int) -> None:
        """Blank the stars of a comprehension such as ``[*A for A in B]`` (PEP 798)."""
        if self._word(opening + 1) in ("*", "**"):
            word = next((self._words[at] for at in self._inside(opening) if self._words[at] in (",", ":", "for")), "")
            if word == "for":
                self._add("comprehensions that unpack", (3, 15), opening + 1, opening + 1)
                self._blank(opening + 1)

    def _subscript(self, opening: int) -> None:
        """Blank the stars in a subscript such as ``a[*b]`` (PEP 646)."""
        before = self._word(opening - 1)
        kind = self._code[opening - 1].kind if opening else "newline"
        if before in ("match", "case") or not (before in (")", "]", "}") or kind == "string" or self._is_name(opening - 1)):
            return
        for index in self._inside(opening):
            if self._word(index) == "*" and self._word(index - 1) in ("[", ","):
                self._add("starred expressions in subscripts", (3, 11), index, index)
                self._blank(index)

    def _annotation(self, index: int) -> None:
        """Blank the second star of a parameter such as ``*args: *Ts`` (PEP 646)."""
        if self._word(index - 1) in ("(", ",") and self._is_name(index + 1) and self._words[index + 2 : index + 4] == [":", "*"]:
            self._add("starred annotations", (3, 11), index + 3, index + 3)
            self._blank(index + 3)

    def _blank(self, index: int) -> None:
        token = self._code[index]
        self._edits.append(_Edit(token.start, token.end, " " * (token.end - token.start)))

    def _string(self, index: int) -> int:
        """Replace adjacent strings from ``index`` on by ``(_)`` if Python versions parse them differently (PEP 701, PEP 750).

        Return the index of the next token to process.
        """
        end = index
        while end < len(self._code) and self._code[end].kind in ("string", "template"):
            end += 1
        group = tuple(self._code[index:end])
        if all(token.kind == "string" or plain(self._text[token.start : token.end]) for token in group):
            return end
        for token in group:
            if token.kind == "template":
                self._newer += _newer_in(template(self._text, token.start))
        start, stop = group[0].start, group[-1].end
        self._strings[start] = group
        self._edits.append(_Edit(start, stop, f"(_{_blanked(self._text[start:stop])[2:-1]})"))
        return end


def _newer_in(found: Template) -> Iterator[Newer]:
    if found.interpolated:
        yield Newer("template strings", (3, 14), found.start, found.end)
    else:
        yield from [Newer(f"f-strings with {what}", (3, 12), found.start, found.end) for what in found.newer][:1]


def _pairs(words: Sequence[str]) -> Iterator[tuple[int, int]]:
    """Yield the indices of the opening and the closing bracket of each pair of brackets. ``words`` are the texts of tokens."""
    opened: list[int] = []
    for index, word in enumerate(words):
        if word in _CLOSES:
            opened.append(index)
        elif word in _CLOSES.values() and opened and _CLOSES[words[opened[-1]]] == word:
            yield opened.pop(), index


def _blanked(text: str, *, joined: bool = False) -> str:
    """Return a text in which blanks replace all characters but line ends: one blank for each byte in UTF-8.

    ``joined`` adds a backslash before each line end, for texts that are not in brackets.
    """
    ends = _NEWLINE.findall(text)
    lines = [" " * len(to_bytes(line)) for line in _NEWLINE.split(text)]
    return "".join(line + ("\\" if joined else "") + end for line, end in zip(lines, ends, strict=False)) + lines[-1]


def _edited(text: str, edits: Sequence[_Edit]) -> str:
    """Return a text with edits applied. An edit that begins within another edit is ignored."""
    pieces, at = list[str](), 0
    for edit in sorted(edits):
        if edit.start >= at:
            pieces += [text[at : edit.start], edit.text]
            at = edit.end
    return "".join(pieces) + text[at:]


def brackets(text: str, tokens: Sequence[Token]) -> tuple[str, int] | None:
    """Return the error of the first unpaired bracket of a source, and its offset; None if all brackets are in pairs."""
    opened: list[Token] = []
    for token in tokens:
        word = text[token.start : token.end] if token.kind == "op" else ""
        if word in _CLOSES:
            opened.append(token)
        elif word in _CLOSES.values():
            if not opened:
                return f'"{word}" closes nothing', token.start
            before = text[opened[-1].start]
            if _CLOSES[before] != word:
                return f'"{word}" does not close "{before}"', token.start
            opened.pop()
    return (f'"{text[opened[-1].start]}" is not closed', opened[-1].start) if opened else None
