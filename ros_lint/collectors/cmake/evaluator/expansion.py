"""Expansion of CMake arguments: variable references and escape sequences are replaced (cmake-language(7), policy CMP0053)."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from typing import Final

from ros_lint.collectors.cmake.evaluator.values import HOLE, LONGEST, MAYBE, certainly_set, embeddable

Part = str | tuple[str, "Template"]
"""A part of an argument: a text, or a variable reference.

A reference is its name space ("", "ENV" or "CACHE") and the parsed name, which may contain further references."""
Template = tuple[Part, ...]
Compiled = str | Template
"""A parsed argument: its parts, or only the name of a variable if the argument is just ``${name}``."""
Lookup = Callable[[str, str], str]
"""A function that returns the value of a variable, given the name and the name space ("", "ENV" or "CACHE")."""

_PIECE = re.compile(r"([^\\$}]+)|\\(?:([tnr])|(\n)|(;)|([^A-Za-z0-9;])|(.?))|\$(ENV|CACHE|)\{|(\})|(\$)", re.DOTALL)
_LETTERS: Final = {"t": "\t", "n": "\n", "r": "\r"}
_NAME = re.compile(r"[A-Za-z0-9/_.+\-\0-\3]*\Z")
_MARKS = re.compile(f"[{HOLE}{MAYBE}]")
_MOST_TEMPLATES: Final = 20_000
_LONGEST_KEPT: Final = 4096


class ExpansionError(Exception):
    """CMake rejects an argument: it has an unclosed reference, an invalid escape sequence or an invalid variable name."""


templates: Final[dict[str, Compiled]] = {}
"""Cached results of :func:`template`."""


def template(text: str) -> Compiled:
    """Return the parts of an argument, which are texts and variable references; for an argument ``${name}`` just "name".

    Raises ExpansionError if CMake rejects the argument.
    """
    compiled = templates.get(text)
    if compiled is None:
        if len(templates) > _MOST_TEMPLATES:
            templates.clear()
        compiled = parts = _compile(text)
        if len(parts) == 1 and isinstance(parts[0], tuple):
            space, name = parts[0]
            if not space and len(name) == 1 and isinstance(name[0], str) and not _MARKS.search(name[0]):
                compiled = name[0]
        if len(text) <= _LONGEST_KEPT:
            templates[text] = compiled
    return compiled


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
                space, outer_parts = stack.pop()
                outer_parts.append((space, _joined(parts)))
                parts = outer_parts
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
    """Return the parts of an argument after adjacent texts are joined: ``"a", "b", reference`` -> ``"ab", reference``."""
    texts: list[Part] = []
    for part in parts:
        if texts and isinstance(part, str) and isinstance(texts[-1], str):
            texts[-1] += part
        else:
            texts.append(part)
    return tuple(texts)


_SIMPLE = re.compile(r"\$\{(\w+)\}")


def substituted(text: str, values: Mapping[str, str]) -> str:
    """Return an argument in a macro body with the references to parameters of the macro replaced by the values.

    The result is HOLE, which means an unknown value, if it would be too long.
    """
    match = _SIMPLE.fullmatch(text)
    if match is not None:
        return values.get(match[1], text)
    size = len(text)

    def value(reference: re.Match[str]) -> str:
        nonlocal size
        replacement = embeddable(values.get(reference[1], reference[0]))
        size += len(replacement)
        if size > LONGEST:
            raise OverflowError
        return replacement

    try:
        return _SIMPLE.sub(value, text)
    except OverflowError:
        return HOLE


def expand(parts: Template, lookup: Lookup) -> str:
    """Return the value of an argument, given its parts and a function that returns the values of variables.

    The result is HOLE, which means an unknown value, if it would be too long. List elements keep their MAYBE markers (they
    may be missing) only if the argument is a single reference such as ``${NAMES}``.
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
        space, name_template = part
        name = name_template[0] if name_template else ""
        if len(name_template) <= 1 and isinstance(name, str) and HOLE not in name and MAYBE not in name:
            pieces.append(lookup(name, space))
        else:
            pieces.append(_reference(part, lookup))
    if sum(map(len, pieces)) > LONGEST:
        return HOLE
    text = "".join(pieces)
    return _marked(pieces) if MAYBE in text else text


def _marked(pieces: list[str]) -> str:
    """Return the pieces of a value as one text.

    Only pieces that are whole list elements keep the marker of elements that may be missing (MAYBE). Other pieces with the
    marker become unknown.
    """
    pieces = [piece for piece in pieces if piece]
    texts = []
    for previous, piece, following in zip([";", *pieces], pieces, [*pieces[1:], ";"], strict=False):
        # A list that may be empty would leave an empty element, which MAYBE cannot express.
        is_element = previous.endswith(";") and following.startswith(";") and certainly_set(piece)
        texts.append(piece if is_element else embeddable(piece))
    return "".join(texts)


def _reference(part: tuple[str, Template], lookup: Lookup) -> str:
    space, name_template = part
    name = name_template[0] if len(name_template) == 1 and isinstance(name_template[0], str) else expand(name_template, lookup)
    if HOLE in name or MAYBE in name:
        return HOLE
    return lookup(name, space)
