"""What XML and YAML launch files have in common: entities with attributes, and what those refer to."""

from __future__ import annotations

import shlex
from collections.abc import Iterable, Iterator, Mapping
from typing import Literal as OneOf
from typing import NamedTuple

from ros_lint.collectors.launch_text import UNKNOWN, installed, prefix, share
from ros_lint.collectors.substitution import Literal, Piece, Substitution, SubstitutionError, parse
from ros_lint.facts import Facet, LaunchReference, Opaque, Problem
from ros_lint.text import Span, Text


class Attribute(NamedTuple):
    """The value of an attribute, and the offsets of where it is written."""

    value: str
    start: int
    end: int


class Entity(NamedTuple):
    """An element of a launch file. ``start`` and ``end`` are the offsets of its start tag or key."""

    tag: str
    attributes: Mapping[str, Attribute]
    children: tuple[Entity, ...]
    start: int
    end: int


class Found(NamedTuple):
    """What a launch file refers to, what hides more, and what is wrong with it."""

    references: tuple[LaunchReference, ...]
    opaque: tuple[Opaque, ...]
    problems: tuple[Problem, ...]


def read(source: Text, root: Entity) -> Found:
    """Return what the entities of a launch file refer to."""
    reader = _Reader(source)
    waiting = [(root, False)]
    while waiting:
        entity, conditional = waiting.pop()
        conditional = conditional or "if" in entity.attributes or "unless" in entity.attributes
        reader.entity(entity, conditional)
        waiting += [(child, conditional) for child in reversed(entity.children)]
    return Found(tuple(reader.references), tuple(reader.opaque), tuple(reader.problems))


Kind = OneOf["node", "component", "include", "file", "package"]

_PROGRAMS: Mapping[str, tuple[str, Kind]] = {
    "node": ("exec", "node"),
    "lifecycle_node": ("exec", "node"),
    "node_container": ("exec", "node"),
    "composable_node": ("plugin", "component"),
    "composable_lifecycle_node": ("plugin", "component"),
}
_LOOK_UPS = ("find-pkg-share", "find-pkg-prefix")


class _Reader:
    __slots__ = ("_source", "opaque", "problems", "references")

    def __init__(self, source: Text) -> None:
        self._source = source
        self.references: list[LaunchReference] = []
        self.opaque: list[Opaque] = []
        self.problems: list[Problem] = []

    def entity(self, entity: Entity, conditional: bool) -> None:
        rows: dict[str, tuple[Piece, ...]] = {}
        for name, attribute in entity.attributes.items():
            pieces = self._pieces(attribute)
            if pieces is not None:
                rows[name] = pieces
        if entity.tag in _PROGRAMS and "pkg" in rows:
            self._program(entity, rows, conditional)
        if entity.tag == "executable" and "cmd" in rows:
            self._command(entity.attributes["cmd"], rows["cmd"], conditional)
        for name, pieces in rows.items():
            if any(isinstance(piece, Substitution) for piece in pieces):
                include = entity.tag == "include" and name == "file"
                self._paths(entity.attributes[name], pieces, conditional, include)

    def _pieces(self, attribute: Attribute) -> tuple[Piece, ...] | None:
        try:
            return parse(attribute.value)
        except SubstitutionError as error:
            span = self._span(attribute, error.offset, len(attribute.value))
            self.problems.append(Problem("substitution", error.message, span))
            return None

    def _program(self, entity: Entity, rows: Mapping[str, tuple[Piece, ...]], conditional: bool) -> None:
        attribute, kind = _PROGRAMS[entity.tag]
        package_span = self._span(entity.attributes["pkg"])
        package = _text(rows["pkg"])
        if UNKNOWN in package:
            self._hidden(f"the package of a <{entity.tag}> is {entity.attributes['pkg'].value}", package_span)
            return
        name = _text(rows[attribute]) if attribute in rows else UNKNOWN
        if UNKNOWN in name:
            self._add("package", package, "", package_span, package_span, conditional)
        else:
            self._add(kind, package, name, self._span(entity.attributes[attribute]), package_span, conditional)

    def _command(self, attribute: Attribute, pieces: tuple[Piece, ...], conditional: bool) -> None:
        """``ros2 run package executable`` and ``ros2 launch package file`` (reference, section E2.19)."""
        try:
            words = shlex.split(_text(pieces))
        except ValueError:
            return
        if words[:2] not in (["ros2", "run"], ["ros2", "launch"]):
            return
        names = [word for word in words[2:] if not word.startswith("-")][:2]
        span = self._span(attribute)
        if not names or UNKNOWN in names[0]:
            self._hidden("the command of an <executable> is not known whole", span)
        elif words[1] == "run" and len(names) == 2 and UNKNOWN not in names[1]:
            self._add("node", names[0], names[1], span, span, conditional)
        elif "/" not in names[0] and not names[0].endswith((".py", ".xml", ".yaml")):
            self._add("package", names[0], "", span, span, conditional)

    def _paths(self, attribute: Attribute, pieces: tuple[Piece, ...], conditional: bool, include: bool) -> None:
        spans: dict[str, Span] = {}
        for substitution in _substitutions(pieces):
            if substitution.name in _LOOK_UPS and len(substitution.arguments) == 1:
                argument = substitution.arguments[0]
                package = _text(argument)
                span = self._span(attribute, argument[0].start, argument[-1].end) if argument else self._span(attribute)
                if UNKNOWN in package or not package:
                    self._hidden(f"the package of $({substitution.name}) is computed", span)
                else:
                    spans.setdefault(package, span)
            elif substitution.name == "exec-in-pkg" and len(substitution.arguments) == 2:
                self._executable_in_package(attribute, substitution, conditional)
            elif substitution.name == "command":
                self._xacro(attribute, substitution, conditional)
        text = _text(pieces)
        for place in installed(text):
            if place.package not in spans:
                continue
            package_span = spans[place.package]
            if place.share:
                whole = include and text == f"{share(place.package)}/{place.share}"
                # The path is written behind the look-up, if nothing else is in between.
                at = attribute.value.rfind(place.share)
                end = at + len(place.share)
                span = self._span(attribute, at, end) if at >= 0 else self._span(attribute)
                self._add("include" if whole else "file", place.package, place.share, span, package_span, conditional)
            elif place.executable:
                self._add("node", place.package, place.executable, self._span(attribute), package_span, conditional)
            else:
                self._add("package", place.package, "", package_span, package_span, conditional)

    def _executable_in_package(self, attribute: Attribute, substitution: Substitution, conditional: bool) -> None:
        name, package = (_text(argument) for argument in substitution.arguments)
        name_span, package_span = (
            self._span(attribute, argument[0].start, argument[-1].end) if argument else self._span(attribute)
            for argument in substitution.arguments
        )
        if UNKNOWN in package:
            self._hidden("the package of $(exec-in-pkg) is computed", package_span)
        elif UNKNOWN in name:
            self._add("package", package, "", package_span, package_span, conditional)
        else:
            self._add("node", package, name, name_span, package_span, conditional)

    def _xacro(self, attribute: Attribute, substitution: Substitution, conditional: bool) -> None:
        if substitution.arguments and _text(substitution.arguments[0]).split()[:1] == ["xacro"]:
            start = substitution.arguments[0][0].start
            at = attribute.value.find("xacro", start)
            span = self._span(attribute, at, at + len("xacro")) if at >= 0 else self._span(attribute)
            self._add("package", "xacro", "", span, span, conditional)

    def _add(self, kind: Kind, package: str, name: str, span: Span, package_span: Span, conditional: bool) -> None:
        exact = self._source.slice(span) == (name or package)
        package_exact = self._source.slice(package_span) == package
        self.references.append(LaunchReference(kind, package, name, span, package_span, conditional, exact, package_exact))

    def _is_written(self, attribute: Attribute) -> bool:
        """Whether the file has the value as it is, so that offsets in it are offsets in the file."""
        return self._source.text[attribute.start : attribute.end] == attribute.value

    def _span(self, attribute: Attribute, start: int | None = None, end: int = 0) -> Span:
        if start is None or not self._is_written(attribute):
            return self._source.span(attribute.start, attribute.end)
        return self._source.span(attribute.start + start, attribute.start + end)

    def _hidden(self, reason: str, span: Span) -> None:
        self.opaque.append(Opaque(Facet.USES, reason, span))


def _substitutions(pieces: Iterable[Piece]) -> Iterator[Substitution]:
    for piece in pieces:
        if isinstance(piece, Substitution):
            yield piece
            for argument in piece.arguments:
                yield from _substitutions(argument)


def _text(pieces: Iterable[Piece]) -> str:
    """Return what the pieces make when the launch file runs, as far as it is known."""
    return "".join(piece.text if isinstance(piece, Literal) else _value(piece) for piece in pieces)


def _value(substitution: Substitution) -> str:
    arguments = [_text(argument) for argument in substitution.arguments]
    if len(arguments) == 1 and arguments[0]:
        if substitution.name == "find-pkg-share":
            return share(arguments[0])
        if substitution.name == "find-pkg-prefix":
            return prefix(arguments[0])
    if substitution.name in ("command", "eval"):
        # Its output is not known; the paths in it are looked up all the same.
        return UNKNOWN + " ".join(arguments) + UNKNOWN
    return UNKNOWN
