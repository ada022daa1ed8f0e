"""Conversion of values with substitutions in XML and YAML launch files to symbolic texts.

In a symbolic text, special characters stand for the parts that are known only when the launch file runs.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping

from ros_lint.collectors import symbolic_text
from ros_lint.collectors.conditional_text import joined
from ros_lint.collectors.launch.markup.substitution_syntax import Literal, Piece, Substitution, SubstitutionError, parse
from ros_lint.collectors.launch.markup.tags import SUBSTITUTIONS
from ros_lint.collectors.symbolic_text import OWN_FOLDER, UNKNOWN, join_path, quoted

Pieces = tuple[Piece, ...]
Texts = tuple[str, ...]


def texts(pieces: Pieces) -> Texts:
    """Return the possible texts of a value, with special characters for the parts that are known only at launch."""
    if len(pieces) == 1:
        return _texts_of_piece(pieces[0])
    rows = [_texts_of_piece(piece) for piece in pieces]
    if all(len(row) == 1 for row in rows):
        text = "".join([row[0] for row in rows])
        return (text if len(text) <= symbolic_text.LONGEST else UNKNOWN,)
    return joined(rows, "".join)


# Nearly all substitutions have no quotes, escapes or nesting.
_SIMPLE = re.compile(r"""\$\(([A-Za-z][A-Za-z0-9_-]*)((?:[ ][^ '"\\$()]+)*)\)""")


def simple_text(value: str) -> str | None:
    """Return the text of a value with simple and valid substitutions, None if the value needs the full parser.

    Special characters in the text stand for the parts that are known only at launch.
    """
    if "\\" in value:
        return None
    output: list[str] = []
    parts = _SIMPLE.split(value)
    for at in range(0, len(parts) - 1, 3):
        literal, name, argument_text = parts[at : at + 3]
        arguments = argument_text.split(" ")[1:]
        least, most = SUBSTITUTIONS.get(name, (1, 0))
        if "$(" in literal or not least <= len(arguments) <= most:
            return None
        reader = _READERS.get(name)
        alternatives = reader([(argument,) for argument in arguments]) if reader is not None else (UNKNOWN,)
        if len(alternatives) != 1:
            return None
        output += (literal, alternatives[0])
    if "$(" in parts[-1]:
        return None
    output.append(parts[-1])
    text = "".join(output)
    return text if len(text) <= symbolic_text.LONGEST or len(output) == 1 else UNKNOWN


def symbolic(text: str) -> Texts:
    """Return the possible texts of a text with substitutions; UNKNOWN if the substitutions are not valid."""
    simple = simple_text(text)
    if simple is not None:
        return (simple,)
    try:
        return texts(parse(text))
    except SubstitutionError:
        return (UNKNOWN,)


def package_of(pieces: Pieces) -> Pieces:
    """Return the argument of the first package look-up in a value, such as ``a`` in ``$(find-pkg-share a)``.

    The result is () if the value has no package look-up.
    """
    for piece in pieces:
        if isinstance(piece, Substitution):
            if piece.name in ("find-pkg-share", "find-pkg-prefix") and piece.arguments:
                return piece.arguments[0]
            if piece.name == "exec-in-pkg" and len(piece.arguments) == 2:
                return piece.arguments[1]
            for argument in piece.arguments:
                if package := package_of(argument):
                    return package
    return ()


def _texts_of_piece(piece: Piece) -> Texts:
    if isinstance(piece, Literal):
        return (piece.text,)
    reader = _READERS.get(piece.name)
    if reader is None:
        return (UNKNOWN,)
    return reader([texts(argument) for argument in piece.arguments])


SubstitutionReader = Callable[[list[Texts]], Texts]


def _of_first(function: Callable[[str], str]) -> SubstitutionReader:
    return lambda rows: tuple(function(text) for text in rows[0]) if rows else (UNKNOWN,)


def _or_default(function: Callable[[str, str | None], str]) -> SubstitutionReader:
    def read(rows: list[Texts]) -> Texts:
        if not rows:
            return (UNKNOWN,)
        defaults: tuple[str | None, ...] = rows[1] if len(rows) > 1 else (None,)
        return tuple(function(name, default) for name in rows[0] for default in defaults)

    return read


def _environment(name: str, default: str | None) -> str:
    return symbolic_text.configuration(f"${name}", default)


def _in_package(rows: list[Texts]) -> Texts:
    return (
        joined([rows[1], rows[0]], lambda row: f"{symbolic_text.prefix(row[0])}/lib/{row[0]}/{row[1]}")
        if len(rows) == 2
        else (UNKNOWN,)
    )


def _logic(name: str) -> SubstitutionReader:
    return lambda rows: joined(rows, lambda row: symbolic_text.expression(f"{name}({', '.join(quoted(text) for text in row)})"))


def _choice(rows: list[Texts]) -> Texts:
    if len(rows) < 2:
        return (UNKNOWN,)
    return joined(
        [rows[0], rows[1], rows[2] if len(rows) > 2 else ("",)],
        lambda row: symbolic_text.expression(f"_if({', '.join(quoted(text) for text in row)})"),
    )


_READERS: Mapping[str, SubstitutionReader] = {
    "var": _or_default(symbolic_text.configuration),
    "env": _or_default(_environment),
    "find-pkg-share": _of_first(symbolic_text.share),
    "find-pkg-prefix": _of_first(symbolic_text.prefix),
    "exec-in-pkg": _in_package,
    "find-exec": _of_first(str),
    "dirname": lambda rows: (OWN_FOLDER,),
    "filename": lambda rows: (f"{OWN_FOLDER}/{UNKNOWN}",),
    "eval": _of_first(symbolic_text.expression),
    "command": _of_first(symbolic_text.command),
    "path-join": lambda rows: joined(rows, join_path),
    "string-join": lambda rows: joined(rows, lambda row: row[0].join(row[1:])),
    "if": _choice,
    "equals": _logic("_equals"),
    "not-equals": _logic("_not_equals"),
    "not": _logic("_not"),
    "and": _logic("_and"),
    "or": _logic("_or"),
    "all": _logic("_and"),
    "any": _logic("_or"),
}
