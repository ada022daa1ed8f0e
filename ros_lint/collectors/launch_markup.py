"""What XML and YAML launch files have in common: from entities to what the file does, and where the front end refuses it.

This follows the ``parse`` methods of ``launch`` and ``launch_ros`` one by one (reference, section G3.4), so that a file is
refused here exactly when the real front end refuses it.
"""

from __future__ import annotations

import shlex
from collections.abc import Callable, Iterable, Mapping
from typing import Any, NamedTuple

from ros_lint.collectors.launch_entity import Entity, Rejected, Type
from ros_lint.collectors.launch_markup_texts import Pieces, package_of, texts
from ros_lint.collectors.launch_references import References
from ros_lint.collectors.launch_tags import EXTENSIONS, SUBSTITUTIONS
from ros_lint.collectors.substitution import Literal, Substitution, SubstitutionError, parse
from ros_lint.facts import LaunchAction, LaunchCondition, LaunchReference, LaunchValue, Opaque, Problem
from ros_lint.text import Span, Text


class Found(NamedTuple):
    """What a launch file refers to, what hides more, what is wrong with it, and what it does."""

    references: tuple[LaunchReference, ...]
    opaque: tuple[Opaque, ...]
    problems: tuple[Problem, ...]
    actions: tuple[LaunchAction, ...]


def read(source: Text, root: Entity) -> Found:
    """Return what the entities of a launch file say."""
    reader = _Reader(source)
    actions: list[LaunchAction] = []
    try:
        if root.tag != "launch":
            raise Rejected("root", "the root must be <launch>", root.span)
        root.get("deprecated")
        children = root.actions()
    except Rejected as error:
        reader.refuse(error)
    else:
        actions = reader.actions(children)
    references = References(actions)
    return Found(
        tuple(sorted(references.found, key=lambda reference: reference.span)),
        tuple(references.opaque),
        tuple(reader.problems),
        tuple(actions),
    )


class _Reader:
    def __init__(self, source: Text) -> None:
        self._source = source
        self._depth = 0
        self.problems: list[Problem] = []

    def refuse(self, error: Rejected) -> None:
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
        rule = _RULES.get(entity.tag)
        if rule is None:
            if entity.tag in EXTENSIONS:
                return []  # its package says what it takes
            raise Rejected("unknown-tag", f"there is no tag <{entity.tag}>", entity.span)
        self._depth += 1
        try:
            action = rule(self, entity)
        finally:
            self._depth -= 1
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


# --- actions of launch ---------------------------------------------------------------------------------------------


def _argument(reader: _Reader, entity: Entity) -> LaunchAction:
    conditions = reader.conditions(entity)
    entity.need("name")
    default = reader.optional(entity, "default")
    entity.get("description")
    choices = tuple(_unescaped(choice.need("value")) for choice in entity.entities("choice"))
    return LaunchAction(
        "argument",
        entity.span,
        target=_plain(entity, "name"),
        value=default,
        package_span=reader.package_span(entity, "default"),
        choices=choices,
        conditions=conditions,
    )


def _plain(entity: Entity, name: str) -> LaunchValue:
    """Return an attribute that is no substitution, whatever it looks like."""
    value = _unescaped(entity.attributes[name].value)
    return LaunchValue((value,), entity.place(name), exact=value == entity.attributes[name].value)


def _unescaped(value: str) -> str:
    import re  # noqa: PLC0415  (hardly ever needed)

    return re.sub(r"\\(.)", r"\1", value) if "\\" in value else value


def _assignment(kind: str, name: str = "name", value: str = "value") -> Rule:
    def rule(reader: _Reader, entity: Entity) -> LaunchAction:
        conditions = reader.conditions(entity)
        target, given = reader.text(entity, name), reader.text(entity, value)
        span = reader.package_span(entity, value)
        return LaunchAction(kind, entity.span, target=target, value=given, package_span=span, conditions=conditions)

    return rule


def _single(kind: str, name: str) -> Rule:
    def rule(reader: _Reader, entity: Entity) -> LaunchAction:
        conditions = reader.conditions(entity)
        value = reader.text(entity, name)
        span = reader.package_span(entity, name)
        return LaunchAction(kind, entity.span, value=value, package_span=span, conditions=conditions)

    return rule


def _append_environment(reader: _Reader, entity: Entity) -> LaunchAction:
    action = _assignment("environment")(reader, entity)
    _needs_truth(reader, entity, "prepend")
    reader.optional(entity, "separator")
    return action


def _needs_truth(reader: _Reader, entity: Entity, name: str) -> None:
    value = reader.typed(entity, name, "bool")
    if isinstance(value, str):
        raise Rejected("wrong-type", f"{name} of <{entity.tag}> is neither true nor false", entity.place(name))


def _unset_environment(reader: _Reader, entity: Entity) -> LaunchAction:
    conditions = reader.conditions(entity)
    reader.text(entity, "name")
    return LaunchAction("other", entity.span, conditions=conditions)


def _bare(reader: _Reader, entity: Entity) -> LaunchAction:
    return LaunchAction("other", entity.span, conditions=reader.conditions(entity))


def _kept(reader: _Reader, entity: Entity) -> tuple[tuple[str, LaunchValue], ...]:
    return tuple((name, value) for name, value in _named(reader, entity, "keep"))


def _reset(reader: _Reader, entity: Entity) -> LaunchAction:
    conditions = reader.conditions(entity)
    return LaunchAction("other", entity.span, arguments=_kept(reader, entity), conditions=conditions)


def _log(reader: _Reader, entity: Entity) -> LaunchAction:
    conditions = reader.conditions(entity)
    message = reader.text(entity, "message")
    return LaunchAction("other", entity.span, arguments=(("", message),), conditions=conditions)


def _shutdown(reader: _Reader, entity: Entity) -> LaunchAction:
    conditions = reader.conditions(entity)
    reader.optional(entity, "reason")
    return LaunchAction("other", entity.span, conditions=conditions)


def _group(reader: _Reader, entity: Entity) -> LaunchAction:
    conditions = reader.conditions(entity)
    scoped = entity.get("scoped", "bool")
    entity.get("forwarding", "bool")
    kept = _kept(reader, entity)
    children = reader.actions(child for child in entity.actions() if child.tag != "keep")
    name = LaunchValue(("unscoped",), entity.span) if scoped is False else None
    return LaunchAction("group", entity.span, name=name, arguments=kept, conditions=conditions, children=tuple(children))


def _timer(reader: _Reader, entity: Entity) -> LaunchAction:
    conditions = reader.conditions(entity)
    entity.need("period", "float")
    period = reader.typed(entity, "period", "float")
    if isinstance(period, str):
        try:
            float(period)
        except ValueError:
            raise Rejected("wrong-type", f"period of <{entity.tag}> is no number", entity.place("period")) from None
    children = reader.actions(entity.actions())
    if entity.tag == "timer":
        _needs_truth(reader, entity, "cancel_on_shutdown")
    return LaunchAction("later", entity.span, conditions=conditions, children=tuple(children))


def _include(reader: _Reader, entity: Entity) -> LaunchAction:
    conditions = reader.conditions(entity)
    target = reader.text(entity, "file")
    arguments = _named(reader, entity, "arg")
    return LaunchAction(
        "include",
        entity.span,
        target=target,
        package_span=reader.package_span(entity, "file"),
        arguments=arguments,
        conditions=conditions,
    )


def _named(
    reader: _Reader, entity: Entity, tag: str, name: str = "name", value: str = "value"
) -> tuple[tuple[str, LaunchValue], ...]:
    """Return children that give a value to a name."""
    found: list[tuple[str, LaunchValue]] = []
    children = entity.entities(tag)
    for child in children:
        given = reader.text(child, value) if child.need(name) is not None else None
        names = reader.text(child, name)
        found += [(one, given) for one in names.texts if given is not None]
    for child in children:
        child.finish()
    return tuple(found)


def _process(reader: _Reader, entity: Entity, kind: str) -> LaunchAction:
    """What nodes and executables share (``ExecuteProcess.parse``)."""
    conditions = reader.conditions(entity)
    given: list[tuple[str, LaunchValue]] = []
    if kind == "process":
        given += reader.words(entity, "cmd", entity.need("cmd"))
    for name in ("cwd", "launch-prefix", "output", "respawn"):
        value = reader.optional(entity, name)
        if value is not None and name in ("cwd", "launch-prefix"):
            given.append(("", value))
    name = reader.optional(entity, "name")
    if entity.get("on_exit") not in (None, "shutdown"):
        raise Rejected("on-exit", f"on_exit of <{entity.tag}> can only be shutdown", entity.place("on_exit"))
    entity.get("respawn_max_retries", "int")
    for limit in ("respawn_delay", "sigkill_timeout", "sigterm_timeout"):
        value = entity.get(limit, "float")
        if value is not None and (isinstance(value, str) or value < 0):
            raise Rejected("wrong-type", f"{limit} of <{entity.tag}> is no number from 0 on", entity.place(limit))
    entity.get("shell", "bool")
    entity.get("emulate_tty", "bool")
    given += [("", value) for _, value in _named(reader, entity, "env")]
    return LaunchAction(
        kind,
        entity.span,
        target=given[0][1] if kind == "process" and given else None,
        name=name,
        arguments=tuple(given),
        package_span=reader.package_span(entity, "cmd", "launch-prefix"),
        conditions=conditions,
    )


def _executable(reader: _Reader, entity: Entity) -> LaunchAction:
    return _process(reader, entity, "process")


# --- actions of launch_ros -----------------------------------------------------------------------------------------


def _node(reader: _Reader, entity: Entity) -> LaunchAction:
    action = _process(reader, entity, "node")
    given = list(action.arguments)
    for name in ("args", "ros_args"):
        value = entity.get(name)
        if value is not None:
            given += reader.words(entity, name, value)
    if entity.get("node-name") is not None:
        raise Rejected("unexpected-attribute", "node-name is no longer known: say name", entity.place("node-name"))
    reader.optional(entity, "exec_name")
    return action._replace(
        package=reader.optional(entity, "pkg"),
        target=reader.text(entity, "exec"),
        namespace=reader.optional(entity, "namespace"),
        remappings=_remappings(reader, entity),
        parameters=_parameters(reader, entity),
        arguments=tuple(given),
        package_span=reader.package_span(entity, "args", "ros_args", "exec") or action.package_span,
    )


def _lifecycle_node(reader: _Reader, entity: Entity) -> LaunchAction:
    _needs_truth(reader, entity, "autostart")
    for name in ("name", "namespace"):
        entity.need(name)
    return _node(reader, entity)


def _container(reader: _Reader, entity: Entity) -> LaunchAction:
    action = _node(reader, entity)
    components = [_component(reader, child) for child in entity.entities("composable_node")]
    for name in ("name", "namespace"):
        entity.need(name)
    return action._replace(children=tuple(components))


def _load(reader: _Reader, entity: Entity) -> LaunchAction:
    conditions = reader.conditions(entity)
    target = reader.text(entity, "target")
    children = entity.entities("composable_node")
    if not children:
        raise Rejected("missing-child", f"<{entity.tag}> needs a <composable_node>", entity.span)
    components = tuple(_component(reader, child) for child in children)
    return LaunchAction("group", entity.span, name=target, conditions=conditions, children=components)


def _component(reader: _Reader, entity: Entity) -> LaunchAction:
    action = LaunchAction(
        "component",
        entity.span,
        package=reader.text(entity, "pkg"),
        target=reader.text(entity, "plugin"),
        name=reader.text(entity, "name"),
        conditions=reader.conditions(entity),
        namespace=reader.optional(entity, "namespace"),
        parameters=_parameters(reader, entity),
        remappings=_remappings(reader, entity),
        arguments=tuple(("", value) for _, value in _named(reader, entity, "extra_arg")),
    )
    entity.finish()
    return action


def _remappings(reader: _Reader, entity: Entity) -> tuple[tuple[LaunchValue, LaunchValue], ...]:
    children = entity.entities("remap")
    found = tuple((reader.text(child, "from"), reader.text(child, "to")) for child in children)
    for child in children:
        child.finish()
    return found


_TYPES: Mapping[str, Type] = {
    "str": "str",
    "bool": "bool",
    "float": "float",
    "int": "int",
    "list_of_str": "strs",
    "list_of_bool": "bools",
    "list_of_float": "floats",
    "list_of_int": "ints",
    "yaml": "any",
}
_SCALARS: Mapping[str, tuple[type, ...]] = {"str": (str,), "bool": (bool,), "float": (float,), "int": (int,)}


def _parameters(reader: _Reader, entity: Entity) -> tuple[tuple[str, LaunchValue], ...]:
    found: list[tuple[str, LaunchValue]] = []
    for param in entity.entities("param"):
        file, name = param.get("from"), param.get("name")
        substituted = param.get("allow_substs", "bool")
        if file is not None and name is not None:
            raise Rejected("parameter", "a <param> has either from or name", param.place("name"))
        if file is not None:
            if isinstance(substituted, str):
                raise Rejected("wrong-type", "allow_substs of <param> is neither true nor false", param.place("allow_substs"))
            param.finish()
            found.append(("", reader.text(param, "from")))
        elif name is None:
            raise Rejected("parameter", "a <param> needs name or from", param.span)
        elif substituted is not None:
            raise Rejected("parameter", "allow_substs goes with from only", param.place("allow_substs"))
        else:
            found += _nested(reader, param, "")
    return tuple(found)


def _nested(reader: _Reader, param: Entity, above: str) -> list[tuple[str, LaunchValue]]:
    names = [f"{above}{one}" for one in reader.text(param, "name").texts]
    wanted = param.get("type", "any")
    if wanted is not None and wanted not in _TYPES:
        raise Rejected("wrong-type", f"there is no parameter type {wanted}", param.place("type"))
    kind: Type = _TYPES[wanted] if wanted is not None else "any"
    value = param.get("value", kind)
    inner = param.entities("param")
    param.finish()
    if value is not None and inner:
        raise Rejected("parameter", "a <param> has either a value or parameters in it", param.place("value"))
    if kind != "any" and inner:
        raise Rejected("parameter", "a <param> with parameters in it has no type", param.place("type"))
    if value is None and not inner:
        raise Rejected("parameter", "a <param> needs a value or parameters in it", param.span)
    if inner:
        return [one for child in inner for name in names for one in _nested(reader, child, f"{name}.")]
    typed = reader.typed(param, "value", kind)
    if isinstance(typed, LaunchValue):
        return [(name, typed) for name in names]
    if kind in _SCALARS and not isinstance(typed, _SCALARS[kind]):
        raise Rejected("wrong-type", f"the value of <param> is no {wanted}", param.place("value"))
    return [(name, LaunchValue((str(typed),), param.place("value"))) for name in names]


Rule = Callable[[_Reader, Entity], LaunchAction]

_RULES: Mapping[str, Rule] = {
    "arg": _argument,
    "let": _assignment("set"),
    "set_env": _assignment("environment"),
    "append_env": _append_environment,
    "unset_env": _unset_environment,
    "reset_env": _bare,
    "reset": _reset,
    "log": _log,
    "shutdown": _shutdown,
    "group": _group,
    "timer": _timer,
    "include": _include,
    "executable": _executable,
    "node": _node,
    "lifecycle_node": _lifecycle_node,
    "node_container": _container,
    "load_composable_node": _load,
    "push_ros_namespace": _single("namespace", "namespace"),
    "push-ros-namespace": _single("namespace", "namespace"),
    "ros_timer": _timer,
    "set_parameter": _assignment("parameter"),
    "set_parameters_from_file": _single("parameter", "filename"),
    "set_remap": _assignment("remap", "from", "to"),
    "set_ros_log_dir": _single("other", "new_log_dir"),
    "set_use_sim_time": _single("other", "value"),
}
