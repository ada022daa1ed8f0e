"""How the attributes of XML and YAML launch files are read, and where the front end refuses them.

This follows the ``parse`` methods of ``launch`` and ``launch_ros`` one by one (reference, section G3.4), so that a file is
refused here exactly when the real front end refuses it.
"""

from __future__ import annotations

import shlex
from collections.abc import Callable, Iterable, Mapping
from typing import Any

from ros_lint.collectors.launch_entity import Entity, Rejected, Type
from ros_lint.collectors.launch_markup_texts import Pieces, package_of, texts
from ros_lint.collectors.launch_tags import EXTENSIONS, SUBSTITUTIONS
from ros_lint.collectors.substitution import Literal, Substitution, SubstitutionError, parse
from ros_lint.facts import LaunchAction, LaunchCondition, LaunchValue, Problem
from ros_lint.text import Span, Text


class Reader:
    """Reads entities by rules, one to a tag, and notes what is refused."""

    def __init__(self, source: Text, rules: Mapping[str, Rule]) -> None:
        self._source = source
        self._rules = rules
        self.problems: list[Problem] = []

    def refuse(self, error: Rejected) -> None:
        """Note that the front end refuses something."""
        self.problems.append(Problem(error.kind, error.message, error.span))

    def actions(self, entities: Iterable[Entity]) -> list[LaunchAction]:
        """Return what entities do. One that is refused is noted, and does nothing."""
        found: list[LaunchAction] = []
        for entity in entities:
            try:
                found += self._action(entity)
            except Rejected as error:
                self.refuse(error)
        return found

    def _action(self, entity: Entity) -> list[LaunchAction]:
        rule = self._rules.get(entity.tag)
        if rule is None:
            if entity.tag in EXTENSIONS:
                return []  # its package says what it takes
            raise Rejected("unknown-tag", f"there is no tag <{entity.tag}>", entity.span)
        action = rule(self, entity)
        entity.finish()
        return [action]

    # --- attributes -----------------------------------------------------------------------------------------------

    def pieces(self, entity: Entity, name: str, value: str) -> Pieces:
        """Return a value as text and substitutions. Raises Rejected."""
        attribute = entity.attributes[name]
        exact = self._source.text[attribute.start : attribute.end] == value
        try:
            found = parse(value) if value else (Literal("", 0, 0),)
        except SubstitutionError as error:
            raise Rejected("substitution", error.message, self._inner(entity, name, exact, error.offset, len(value))) from None
        for piece in _substitutions(found):
            span = self._inner(entity, name, exact, piece.start, piece.end)
            limits = SUBSTITUTIONS.get(piece.name)
            if limits is None:
                raise Rejected("unknown-substitution", f"there is no substitution $({piece.name})", span)
            least, most = limits
            if not least <= len(piece.arguments) <= most:
                wanted = str(least) if least == most else f"{least} to {most}"
                given = len(piece.arguments)
                message = f"$({piece.name}) takes {wanted} argument{'' if wanted == '1' else 's'}, not {given}"
                raise Rejected("substitution-arguments", message, span)
            if piece.name == "eval" and len(piece.arguments) == 2 and isinstance(piece.arguments[1][:1], tuple):
                first = piece.arguments[1][0] if piece.arguments[1] else None
                if isinstance(first, Substitution):
                    raise Rejected("substitution-arguments", "the modules of $(eval) must be written out", span)
        return found

    def _inner(self, entity: Entity, name: str, exact: bool, start: int, end: int) -> Span:
        attribute = entity.attributes[name]
        if not exact:
            return self._source.span(attribute.start, attribute.end)
        return self._source.span(attribute.start + start, attribute.start + end)

    def text(self, entity: Entity, name: str) -> LaunchValue:
        """Return an attribute that must be there as a text. Raises Rejected."""
        return self._value(entity, name, entity.need(name))

    def optional(self, entity: Entity, name: str) -> LaunchValue | None:
        """Return an attribute as a text, None when it is not there. Raises Rejected."""
        value = entity.get(name)
        return None if value is None else self._value(entity, name, value)

    def _value(self, entity: Entity, name: str, value: str) -> LaunchValue:
        if "$" not in value and "\\" not in value:
            attribute = entity.attributes[name]
            span = self._source.span(attribute.start, attribute.end)
            return LaunchValue((value,), span, exact=self._source.text[attribute.start : attribute.end] == value)
        found = texts(self.pieces(entity, name, value))
        span = entity.place(name)
        return LaunchValue(found, span, exact=len(found) == 1 and self._source.slice(span) == found[0])

    def typed(self, entity: Entity, name: str, kind: Type) -> Any:
        """Return an attribute that may be a substitution instead of what is asked for, None when it is not there."""
        value = entity.get(name, kind)
        if isinstance(value, list):
            kinds = {self._kind(entity, name, one) for one in value} - {None}
            if len(kinds) > 1:
                raise Rejected("wrong-type", f"{name} of <{entity.tag}> mixes types in a list", entity.place(name))
            return value
        if isinstance(value, str) and self._kind(entity, name, value) is None:
            return self._value(entity, name, value)
        return value

    def _kind(self, entity: Entity, name: str, value: Any) -> type | None:
        """Return the type of a value, None for a text with substitutions."""
        if not isinstance(value, str):
            return type(value)
        pieces = self.pieces(entity, name, value)
        return str if len(pieces) == 1 and isinstance(pieces[0], Literal) else None

    def package_span(self, entity: Entity, *names: str) -> Span | None:
        """Return where the package is written that the path in an attribute lies in."""
        for name in names:
            attribute = entity.attributes.get(name)
            if attribute is None or not isinstance(attribute.value, str) or "$(" not in attribute.value:
                continue
            argument = package_of(parse(attribute.value))
            if argument:
                exact = self._source.text[attribute.start : attribute.end] == attribute.value
                return self._inner(entity, name, exact, argument[0].start, argument[-1].end)
        return None

    def words(self, entity: Entity, name: str, value: str) -> tuple[tuple[str, LaunchValue], ...]:
        """Return the words of a command line, as the front end splits it: texts in it by the rules of a shell."""
        row: list[list[Literal | Substitution]] = [[]]
        for piece in self.pieces(entity, name, value):
            if isinstance(piece, Substitution):
                row[-1].append(piece)
                continue
            try:
                tokens = shlex.split(piece.text)
            except ValueError:
                raise Rejected("quotes", f"{name} of <{entity.tag}> has an open quote", entity.place(name)) from None
            if piece.text[:1].isspace() and row[-1]:
                row.append([])
            for number, token in enumerate(tokens):
                if number:
                    row.append([])
                row[-1].append(Literal(token, piece.start, piece.end))
            if piece.text[-1:].isspace() and row[-1]:
                row.append([])
        span = entity.place(name)
        return tuple(("", LaunchValue(texts(tuple(word)), span)) for word in row if word)

    def conditions(self, entity: Entity) -> tuple[LaunchCondition, ...]:
        """Return what ``if`` and ``unless`` ask for. Raises Rejected."""
        wanted, unwanted = entity.get("if"), entity.get("unless")
        if wanted is not None and unwanted is not None:
            raise Rejected("conditions", f"<{entity.tag}> has both if and unless", entity.place("unless"))
        if wanted is not None:
            return (LaunchCondition(texts(self.pieces(entity, "if", wanted)), None),)
        if unwanted is not None:
            return (LaunchCondition(texts(self.pieces(entity, "unless", unwanted)), None, wanted=False),)
        return ()


def _substitutions(pieces: Pieces) -> Iterable[Substitution]:
    for piece in pieces:
        if isinstance(piece, Substitution):
            yield piece
            for argument in piece.arguments:
                yield from _substitutions(argument)


Rule = Callable[[Reader, Entity], LaunchAction]
