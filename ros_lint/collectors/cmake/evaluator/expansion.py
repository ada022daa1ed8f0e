"""Expansion of arguments: references to variables and escapes (cmake-language(7), policy CMP0053)."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from typing import Final

from ros_lint.collectors.cmake.evaluator.values import HOLE, LONGEST, MAYBE, certainly_set, flat

Part = str | tuple[str, "Template"]
"""A text, or a reference: its name space ("", "ENV" or "CACHE") and the template of the name."""
Template = tuple[Part, ...]
Compiled = str | Template
"""The template of an argument, or the name of a variable if the argument is just ``${name}``."""
Lookup = Callable[[str, str], str]
"""A function from a name and its name space to the value."""

_PIECE = re.compile(r"([^\\$}]+)|\\(?:([tnr])|(\n)|(;)|([^A-Za-z0-9;])|(.?))|\$(ENV|CACHE|)\{|(\})|(\$)", re.DOTALL)
_LETTERS: Final = {"t": "\t", "n": "\n", "r": "\r"}
_NAME = re.compile(r"[A-Za-z0-9/_.+\-\0-\3]*\Z")
_MARKS = re.compile(f"[{HOLE}{MAYBE}]")
_MOST_TEMPLATES: Final = 20_000
_LONGEST_KEPT: Final = 4096


class ExpansionError(Exception):
    """CMake rejects the argument: an unclosed reference, an invalid escape or an invalid name."""


templates: Final[dict[str, Compiled]] = {}
"""Cached results of :func:`template`."""


def template(text: str) -> Compiled:
    """Return the compiled form of an argument. Raises ExpansionError if CMake rejects it."""
    found = templates.get(text)
    if found is None:
        if len(templates) > _MOST_TEMPLATES:
            templates.clear()
        found = parts = _compile(text)
        if len(parts) == 1 and isinstance(parts[0], tuple):
            where, name = parts[0]
            if not where and len(name) == 1 and isinstance(name[0], str) and not _MARKS.search(name[0]):
                found = name[0]
        if len(text) <= _LONGEST_KEPT:
            templates[text] = found
    return found


def _compile(text: str) -> Template:
    stack: list[tuple[str, list[Part]]] = []
    parts: list[Part] = []
    for match in _PIECE.finditer(text):
        group = match.lastindex
        if group == 1 or group == 9:  # noqa: PLR1714
            if stack and not _NAME.match(match[0]):
                raise ExpansionError(text)
            parts.append(match[0])
        elif group == 7:
            stack.append((match[7], parts))
            parts = []
        elif group == 8:
            if stack:
                where, outer = stack.pop()
                outer.append((where, _joined(parts)))
                parts = outer
            else:
                parts.append("}")
        elif group == 2:
            parts.append(_LETTERS[match[2]])
        elif group == 3:
            pass  # a line continuation
        elif group == 4:
            parts.append(";" if stack else "\\;")
        elif group == 5:
            parts.append(match[5])
        else:
            raise ExpansionError(text)
    if stack:
        raise ExpansionError(text)
    return _joined(parts)


def _joined(parts: list[Part]) -> Template:
    """Return the parts with adjacent texts joined."""
    joined: list[Part] = []
    for part in parts:
        if joined and isinstance(part, str) and isinstance(joined[-1], str):
            joined[-1] += part
        else:
            joined.append(part)
    return tuple(joined)


_SIMPLE = re.compile(r"\$\{(\w+)\}")


def substituted(text: str, values: Mapping[str, str]) -> str:
    """Return an argument in a macro with the references to parameters replaced by their values.

    HOLE if it is too long.
    """
    alone = _SIMPLE.fullmatch(text)
    if alone is not None:
        return values.get(alone[1], text)
    size = len(text)

    def value(reference: re.Match[str]) -> str:
        nonlocal size
        found = flat(values.get(reference[1], reference[0]))
        size += len(found)
        if size > LONGEST:
            raise OverflowError
        return found

    try:
        return _SIMPLE.sub(value, text)
    except OverflowError:
        return HOLE


def expand(parts: Template, lookup: Lookup) -> str:
    """Return the value of an argument.

    An argument that is a single reference keeps the MAYBE marks of its list elements.
    """
    if len(parts) == 1:
        part = parts[0]
        if isinstance(part, str):
            return part
        return _reference(part, lookup)
    pieces = []
    for part in parts:
        if isinstance(part, str):
            pieces.append(part)
            continue
        where, inner = part
        name = inner[0] if inner else ""
        if len(inner) <= 1 and isinstance(name, str) and HOLE not in name and MAYBE not in name:
            pieces.append(lookup(name, where))
        else:
            pieces.append(_reference(part, lookup))
    if sum(map(len, pieces)) > LONGEST:
        return HOLE
    text = "".join(pieces)
    return _marked(pieces) if MAYBE in text else text


def _marked(pieces: list[str]) -> str:
    """Return the pieces joined. Only pieces that are whole list elements keep their MAYBE marks."""
    pieces = [piece for piece in pieces if piece]
    found = []
    for before, piece, after in zip([";", *pieces], pieces, [*pieces[1:], ";"], strict=False):
        # A list that may be empty would leave an empty element, which the marks cannot express.
        alone = before.endswith(";") and after.startswith(";") and certainly_set(piece)
        found.append(piece if alone else flat(piece))
    return "".join(found)


def _reference(part: tuple[str, Template], lookup: Lookup) -> str:
    where, inner = part
    name = inner[0] if len(inner) == 1 and isinstance(inner[0], str) else expand(inner, lookup)
    if HOLE in name or MAYBE in name:
        return HOLE
    return lookup(name, where)
