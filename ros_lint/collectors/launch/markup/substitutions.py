"""Symbolic texts of the substitutions in XML and YAML launch files."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping

from ros_lint.collectors import symbolic_text as launch_text
from ros_lint.collectors.launch.markup.substitution_syntax import Literal, Piece, Substitution
from ros_lint.collectors.launch.markup.tags import SUBSTITUTIONS
from ros_lint.collectors.symbolic_text import OWN_FOLDER, UNKNOWN, joined, quoted

Pieces = tuple[Piece, ...]
Texts = tuple[str, ...]


def texts(pieces: Pieces) -> Texts:
    """Return the alternative texts of a value when the launch file runs."""
    if len(pieces) == 1:
        return _one(pieces[0])
    rows = [_one(piece) for piece in pieces]
    if all(len(row) == 1 for row in rows):
        text = "".join([row[0] for row in rows])
        return (text if len(text) <= launch_text.LONGEST else UNKNOWN,)
    return joined(rows, "".join)


# A substitution without quotes, escapes or nesting, as nearly all are.
_SIMPLE = re.compile(r"""\$\(([A-Za-z][A-Za-z0-9_-]*)((?:[ ][^ '"\\$()]+)*)\)""")


def simple_text(value: str) -> str | None:
    """Return the text of a value with only simple and valid substitutions, None if it needs the parser."""
    if "\\" in value:
        return None
    parts_made: list[str] = []
    parts = _SIMPLE.split(value)
    for at in range(0, len(parts) - 1, 3):
        literal, name, rest = parts[at : at + 3]
        arguments = rest.split(" ")[1:]
        least, most = SUBSTITUTIONS.get(name, (1, 0))
        if "$(" in literal or not least <= len(arguments) <= most:
            return None
        rule = _RULES.get(name)
        made = rule([(argument,) for argument in arguments]) if rule is not None else (UNKNOWN,)
        if len(made) != 1:
            return None
        parts_made += (literal, made[0])
    if "$(" in parts[-1]:
        return None
    parts_made.append(parts[-1])
    text = "".join(parts_made)
    return text if len(text) <= launch_text.LONGEST or len(parts_made) == 1 else UNKNOWN


def package_of(pieces: Pieces) -> Pieces:
    """Return the argument of the first package look-up, () if there is none."""
    for piece in pieces:
        if isinstance(piece, Substitution):
            if piece.name in ("find-pkg-share", "find-pkg-prefix") and piece.arguments:
                return piece.arguments[0]
            if piece.name == "exec-in-pkg" and len(piece.arguments) == 2:
                return piece.arguments[1]
            for argument in piece.arguments:
                if found := package_of(argument):
                    return found
    return ()


def _one(piece: Piece) -> Texts:
    if isinstance(piece, Literal):
        return (piece.text,)
    rule = _RULES.get(piece.name)
    if rule is None:
        return (UNKNOWN,)
    return rule([texts(argument) for argument in piece.arguments])


Rule = Callable[[list[Texts]], Texts]


def _of_one(function: Callable[[str], str]) -> Rule:
    return lambda rows: tuple(function(text) for text in rows[0]) if rows else (UNKNOWN,)


def _or_default(function: Callable[[str, str | None], str]) -> Rule:
    def rule(rows: list[Texts]) -> Texts:
        if not rows:
            return (UNKNOWN,)
        defaults: tuple[str | None, ...] = rows[1] if len(rows) > 1 else (None,)
        return tuple(function(name, default) for name in rows[0] for default in defaults)

    return rule


def _environment(name: str, default: str | None) -> str:
    return launch_text.configuration(f"${name}", default)


def _in_package(rows: list[Texts]) -> Texts:
    return (
        joined([rows[1], rows[0]], lambda row: f"{launch_text.prefix(row[0])}/lib/{row[0]}/{row[1]}")
        if len(rows) == 2
        else (UNKNOWN,)
    )


def _logic(name: str) -> Rule:
    return lambda rows: joined(rows, lambda row: launch_text.expression(f"{name}({', '.join(quoted(one) for one in row)})"))


def _choice(rows: list[Texts]) -> Texts:
    if len(rows) < 2:
        return (UNKNOWN,)
    return joined(
        [rows[0], rows[1], rows[2] if len(rows) > 2 else ("",)],
        lambda row: launch_text.expression(f"_if({', '.join(quoted(one) for one in row)})"),
    )


_RULES: Mapping[str, Rule] = {
    "var": _or_default(launch_text.configuration),
    "env": _or_default(_environment),
    "find-pkg-share": _of_one(launch_text.share),
    "find-pkg-prefix": _of_one(launch_text.prefix),
    "exec-in-pkg": _in_package,
    "find-exec": _of_one(str),
    "dirname": lambda rows: (OWN_FOLDER,),
    "filename": lambda rows: (f"{OWN_FOLDER}/{UNKNOWN}",),
    "eval": _of_one(launch_text.expression),
    "command": _of_one(launch_text.command),
    "if": _choice,
    "equals": _logic("_equals"),
    "not-equals": _logic("_not_equals"),
    "not": _logic("_not"),
    "and": _logic("_and"),
    "or": _logic("_or"),
    "all": _logic("_and"),
    "any": _logic("_or"),
}
