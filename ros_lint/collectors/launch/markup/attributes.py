"""Reading of attributes in XML and YAML launch files, with the errors of ``launch.frontend``.

The functions follow the ``parse`` methods of ``launch`` and ``launch_ros`` one by one, so that ros-lint rejects a file
exactly if launch rejects it.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping
from functools import lru_cache
from typing import Any, NamedTuple, NoReturn

from ros_lint.base.text import Span, Text
from ros_lint.collectors.conditional_text import joined
from ros_lint.collectors.launch.markup.entity import Entity, Rejected, Type
from ros_lint.collectors.launch.markup.substitution_syntax import Literal, Substitution, SubstitutionError, parse
from ros_lint.collectors.launch.markup.substitutions import Pieces, package_of, simple_text, texts
from ros_lint.collectors.launch.markup.tags import EXTENSIONS, ROS_1, SINCE, SUBSTITUTIONS
from ros_lint.facts.launch import LaunchAction, LaunchCondition, LaunchValue
from ros_lint.facts.visibility import Problem

_make = tuple.__new__  # takes half the time of the constructor


class Reader:
    """Converts the elements of a launch file to actions, and records each error that launch would raise.

    Each tag has a function in ``readers`` that converts its elements.
    """

    def __init__(self, source: Text, readers: Mapping[str, TagReader]) -> None:
        self._source = source
        self._readers = readers
        self.problems: list[Problem] = []
        self.newer: dict[Problem, None] = {}
        """Features that some supported ROS distributions lack.

        The ``kind`` of each is the first distribution with the feature."""

    def note_newer(self, feature: str, span: Span) -> None:
        """Record that the file uses a tag, attribute or substitution that some supported ROS distributions lack."""
        self.newer[Problem(SINCE[feature], feature, span)] = None

    def note_rejection(self, error: Rejected) -> None:
        """Record an error that makes launch reject the file."""
        self.problems.append(error.problem)

    def actions(self, entities: Iterable[Entity]) -> list[LaunchAction]:
        """Return the actions of elements. An element that launch rejects is recorded as a problem, and gives no action."""
        actions: list[LaunchAction] = []
        for entity in entities:
            try:
                actions += self._action(entity)
            except Rejected as error:
                self.note_rejection(error)
        return actions

    def _action(self, entity: Entity) -> list[LaunchAction]:
        reader = self._readers.get(entity.tag)
        if reader is None:
            if entity.tag in EXTENSIONS:
                # Another package defines its attributes and what it starts.
                return [LaunchAction("other", entity.span, name=LaunchValue((f"<{entity.tag}>",), entity.span))]
            raise Rejected("unknown-tag", f"there is no tag <{entity.tag}>", entity.span, ROS_1.get(f"<{entity.tag}>", ""))
        if entity.tag in _NEWER_TAGS:
            self.note_newer(f"<{entity.tag}>", entity.span)
        action = reader(self, entity)
        entity.finish()
        return [action]

    # --- attributes -----------------------------------------------------------------------------------------------

    def _texts(self, entity: Entity, name: str, value: str) -> tuple[str, ...]:
        """Return the possible texts of the value of an attribute. Raises Rejected if a substitution is invalid."""
        texts_or_mistake = read_value(value)
        if _NEWER.search(value):
            self._note_substitutions(entity, name, value)
        return self._reject(entity, name, value, texts_or_mistake) if isinstance(texts_or_mistake, Mistake) else texts_or_mistake

    def _pieces(self, entity: Entity, name: str, value: str) -> Pieces:
        """Return the literals and substitutions in an attribute value. Raises Rejected if a substitution is invalid."""
        pieces = _pieces(value)
        if _NEWER.search(value):
            self._note_substitutions(entity, name, value)
        return self._reject(entity, name, value, pieces) if isinstance(pieces, Mistake) else pieces

    def _note_substitutions(self, entity: Entity, name: str, value: str) -> None:
        pieces = _pieces(value)
        for piece in () if isinstance(pieces, Mistake) else _substitutions(pieces):
            feature = "$(eval) with modules" if piece.name == "eval" and len(piece.arguments) > 1 else f"$({piece.name})"
            if feature in SINCE:
                self.note_newer(feature, self._inner(entity, name, value, piece.start, piece.end))

    def _reject(self, entity: Entity, name: str, value: str, mistake: Mistake) -> NoReturn:
        raise Rejected(
            mistake.kind, mistake.message, self._inner(entity, name, value, mistake.start, mistake.end), mistake.instead
        )

    def _inner(self, entity: Entity, name: str, value: str, start: int, end: int) -> Span:
        """Return the span of the part of an attribute value between the offsets ``start`` and ``end``.

        It is the span of the whole value if the source does not contain the value literally, for example because of escapes.
        """
        span, plain = entity.written(name)
        if not plain or entity.attributes[name] != value:
            return span
        if span.line == span.end_line:
            return Span(span.path, span.line, span.column + start, span.line, span.column + end)
        first = self._source.offset(span.line, span.column)
        return self._source.span(first + start, first + end)

    def text(self, entity: Entity, name: str) -> LaunchValue:
        """Return the value of a required attribute. Raises Rejected if the attribute is missing or invalid."""
        return self.optional(entity, name) or self._value(entity, name, entity.need(name))

    def optional(self, entity: Entity, name: str) -> LaunchValue | None:
        """Return the value of an optional attribute, None if it is missing. Raises Rejected if the value is invalid."""
        if entity.simple:
            value = entity.attributes.get(name)
            if value is None:
                return None
            entity.read.add(name)
        else:
            value = entity.get(name)
        return None if value is None else self._value(entity, name, value)

    def _value(self, entity: Entity, name: str, value: str) -> LaunchValue:
        texts = (value,) if "$" not in value and "\\" not in value else self._texts(entity, name, value)
        span, plain = entity.written(name)
        return _make(LaunchValue, (texts, span, plain and len(texts) == 1 and texts[0] == value, (), (), ()))

    def typed(self, entity: Entity, name: str, kind: Type) -> Any:
        """Return the value of an attribute converted to the type ``kind``, None if the attribute is missing.

        A value with substitutions is returned as a LaunchValue. Raises Rejected if the value has another type.
        """
        value = entity.get(name, kind)
        if isinstance(value, list):
            kinds = {self._kind(entity, name, item) for item in value} - {None}
            if len(kinds) > 1:
                raise Rejected("wrong-type", f"'{name}' of <{entity.tag}> mixes types in a list", entity.place(name))
            return value
        if isinstance(value, str) and self._kind(entity, name, value) is None:
            return self._value(entity, name, value)
        return value

    def listed(self, entity: Entity, name: str, values: list[Any]) -> LaunchValue:
        """Return the elements of the list in an attribute as one text in YAML notation: ``[1, 2]``."""
        rows = [self._texts(entity, name, item) if isinstance(item, str) else (str(item),) for item in values]
        return LaunchValue(joined(rows, _as_yaml), entity.place(name))

    def _kind(self, entity: Entity, name: str, value: Any) -> type | None:
        """Return the type of ``value``, an attribute or an element of a list; None if it is a text with substitutions."""
        if not isinstance(value, str):
            return type(value)
        pieces = self._pieces(entity, name, value)
        return str if len(pieces) == 1 and isinstance(pieces[0], Literal) else None

    def package_span(self, entity: Entity, *names: str) -> Span | None:
        """Return the span of the package name in the first package look-up in the attributes ``names``.

        A look-up is for example ``$(find-pkg-share robot)``. The result is None if there is none.
        """
        for name in names:
            value = entity.attributes.get(name)
            if not isinstance(value, str) or "-pkg" not in value:
                continue
            self._texts(entity, name, value)
            place = _package_place(value)
            if place is not None:
                return self._inner(entity, name, value, *place)
        return None

    def words(self, entity: Entity, name: str, value: str) -> tuple[tuple[str, LaunchValue], ...]:
        """Return the words of a command line in an attribute. Literals are split by the rules of a shell, as launch does."""
        row: list[list[Literal | Substitution]] = [[]]
        for piece in self._pieces(entity, name, value):
            if isinstance(piece, Substitution):
                row[-1].append(piece)
                continue
            try:
                import shlex  # noqa: PLC0415  (few files have command lines)

                tokens = shlex.split(piece.text)
            except ValueError:
                raise Rejected("quotes", f"'{name}' of <{entity.tag}> has an unclosed quote", entity.place(name)) from None
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

    def need_truth(self, entity: Entity, name: str) -> None:
        """Raise Rejected if the value of an attribute is a text that is neither true nor false."""
        value = self.typed(entity, name, "bool")
        if isinstance(value, str):
            raise Rejected("wrong-type", f"'{name}' of <{entity.tag}> is neither true nor false", entity.place(name))

    def named(self, entity: Entity, tag: str) -> tuple[tuple[str, LaunchValue], ...]:
        """Return the attributes ``name`` and ``value`` of each child ``<tag>``: ("a", "b") for ``<arg name="a" value="b"/>``."""
        pairs: list[tuple[str, LaunchValue]] = []
        children = entity.entities(tag)
        for child in children:
            if not child.simple or "name" not in child.attributes:
                child.need("name")
            value = self.text(child, "value")
            pairs += [(name, value) for name in self.text(child, "name").texts]
        for child in children:
            child.finish()
        return tuple(pairs)

    def conditions(self, entity: Entity) -> tuple[LaunchCondition, ...]:
        """Return the condition in the attribute ``if`` or ``unless`` of an element, () if the element has neither.

        Raises Rejected if the element has both attributes, or the value is invalid.
        """
        if entity.simple and "if" not in entity.attributes and "unless" not in entity.attributes:
            return ()
        if_text, unless_text = entity.get("if"), entity.get("unless")
        if if_text is not None and unless_text is not None:
            raise Rejected("conditions", f"<{entity.tag}> has both 'if' and 'unless'", entity.place("unless"))
        if if_text is not None:
            return (LaunchCondition(self._texts(entity, "if", if_text), None),)
        if unless_text is not None:
            return (LaunchCondition(self._texts(entity, "unless", unless_text), None, wanted=False),)
        return ()


class Mistake(NamedTuple):
    """The reason why launch rejects the value of an attribute, and the offsets of the error in the value."""

    kind: str
    message: str
    start: int
    end: int
    instead: str = ""
    """The text that replaces the wrong part (as :attr:`Problem.instead`), "" if none is known."""


def _as_yaml(row: tuple[str, ...]) -> str:
    return f"[{', '.join(repr(item) if ',' in item else item for item in row)}]"


@lru_cache(maxsize=4_096)
def read_value(value: str) -> tuple[str, ...] | Mistake:
    """Return the possible texts of an attribute value, or a Mistake. The result is cached, because values recur."""
    simple = simple_text(value)
    if simple is not None:
        return (simple,)
    pieces = _pieces(value)
    return pieces if isinstance(pieces, Mistake) else texts(pieces)


@lru_cache(maxsize=4_096)
def _pieces(value: str) -> Pieces | Mistake:
    try:
        pieces = parse(value) if value else (Literal("", 0, 0),)
    except SubstitutionError as error:
        return Mistake("substitution", error.message, error.offset, len(value))
    for piece in _substitutions(pieces):
        argument_error = _argument_error(piece)
        if argument_error is not None:
            return Mistake(*argument_error, piece.start, piece.end, ROS_1.get(f"$({piece.name})", ""))
    return pieces


@lru_cache(maxsize=4_096)
def _package_place(value: str) -> tuple[int, int] | None:
    """Return the start and end offset of the package name in the first package look-up of a valid value.

    A look-up is for example ``$(find-pkg-share robot)``. The result is None if the value has none.
    """
    if "exec-in-pkg" not in value and simple_text(value) is not None:
        match = _LOOK_UP.search(value)
        return match.span(1) if match else None
    argument = package_of(parse(value))
    return (argument[0].start, argument[-1].end) if argument else None


_NEWER_TAGS = frozenset([feature[1:-1] for feature in SINCE if re.fullmatch(r"<\w+>", feature)])
_NEWER = re.compile(
    r"\$\((?:eval|" + "|".join([feature[2:-1] for feature in SINCE if re.fullmatch(r"\$\(.*\)", feature)]) + r")[ )]"
)
"""Pattern of substitutions that some supported ROS distributions lack, entirely or in some of their arguments."""
_LOOK_UP = re.compile(r"\$\(find-pkg-(?:share|prefix) ([^)]*)\)")


def _argument_error(piece: Substitution) -> tuple[str, str] | None:
    """Return the kind and the message of the error in the arguments of a substitution, None if they are valid."""
    limits = SUBSTITUTIONS.get(piece.name)
    if limits is None:
        return "unknown-substitution", f"there is no substitution $({piece.name})"
    least, most = limits
    if not least <= len(piece.arguments) <= most:
        expected = str(least) if least == most else f"{least} to {most}"
        count = len(piece.arguments)
        message = f"$({piece.name}) takes {expected} argument{'' if expected == '1' else 's'}, not {count}"
        return "substitution-arguments", message
    if (
        piece.name == "eval"
        and len(piece.arguments) == 2
        and any(isinstance(part, Substitution) for part in piece.arguments[1][:1])
    ):
        return "substitution-arguments", "the modules of $(eval) must be literal"
    return None


def _substitutions(pieces: Pieces) -> Iterable[Substitution]:
    for piece in pieces:
        if isinstance(piece, Substitution):
            yield piece
            for argument in piece.arguments:
                yield from _substitutions(argument)


TagReader = Callable[[Reader, Entity], LaunchAction]
