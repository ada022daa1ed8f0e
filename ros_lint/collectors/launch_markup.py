"""What XML and YAML launch files do, tag by tag.

This follows the ``parse`` methods of ``launch`` and ``launch_ros`` one by one (reference, section G3.4), so that a file is
refused here exactly when the real front end refuses it.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from operator import attrgetter
from typing import NamedTuple

from ros_lint.collectors.launch_entity import Entity, Rejected, Type
from ros_lint.collectors.launch_markup_read import Reader, Rule
from ros_lint.collectors.launch_references import References
from ros_lint.collectors.launch_tags import SINCE
from ros_lint.collectors.launch_text import UNKNOWN
from ros_lint.facts.launch import LaunchAction, LaunchCondition, LaunchReference, LaunchValue
from ros_lint.facts.sight import Opaque, Problem
from ros_lint.text import Text


class Found(NamedTuple):
    """What a launch file refers to, what hides more, what is wrong with it, and what it does."""

    references: tuple[LaunchReference, ...]
    opaque: tuple[Opaque, ...]
    problems: tuple[Problem, ...]
    actions: tuple[LaunchAction, ...]
    newer: tuple[Problem, ...]
    """What not every distribution takes; ``kind`` is the first that does."""


def read(source: Text, root: Entity) -> Found:
    """Return what the entities of a launch file say."""
    reader = Reader(source, _RULES)
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
        tuple(sorted(references.found, key=attrgetter("span"))),
        tuple(references.opaque),
        tuple(reader.problems),
        tuple(actions),
        tuple(reader.newer),
    )


_COMMENT = re.compile(r"<!--.*?-->", re.DOTALL)
_ASKED = re.compile(r"\$\(var[ ]+[\"']?(\$\(|[^\s()\"']+)")


def asks(text: str) -> tuple[str, ...]:
    """Return the launch configurations that a text asks for anywhere, sorted, UNKNOWN among them if a name is computed."""
    if "$(var" not in text:
        return ()
    names = set(_ASKED.findall(_COMMENT.sub("", text) if "<!--" in text else text))
    return tuple(sorted(UNKNOWN if name == "$(" else name for name in names))


# --- actions of launch ---------------------------------------------------------------------------------------------


def _argument(reader: Reader, entity: Entity) -> LaunchAction:
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
    value = _unescaped(entity.attributes[name])
    span, plain = entity.written(name)
    return LaunchValue((value,), span, plain and value == entity.attributes[name])


def _unescaped(value: str) -> str:
    return re.sub(r"\\(.)", r"\1", value) if "\\" in value else value


def _assignment(kind: str, name: str = "name", value: str = "value") -> Rule:
    def rule(reader: Reader, entity: Entity) -> LaunchAction:
        conditions = reader.conditions(entity)
        target, given = reader.text(entity, name), reader.text(entity, value)
        span = reader.package_span(entity, value)
        return LaunchAction(kind, entity.span, target=target, value=given, package_span=span, conditions=conditions)

    return rule


def _single(kind: str, name: str) -> Rule:
    def rule(reader: Reader, entity: Entity) -> LaunchAction:
        conditions = reader.conditions(entity)
        value = reader.text(entity, name)
        span = reader.package_span(entity, name)
        return LaunchAction(kind, entity.span, value=value, package_span=span, conditions=conditions)

    return rule


def _append_environment(reader: Reader, entity: Entity) -> LaunchAction:
    action = _assignment("environment")(reader, entity)
    _needs_truth(reader, entity, "prepend")
    reader.optional(entity, "separator")
    return action._replace(name=LaunchValue(("append",), entity.span))


def _needs_truth(reader: Reader, entity: Entity, name: str) -> None:
    value = reader.typed(entity, name, "bool")
    if isinstance(value, str):
        raise Rejected("wrong-type", f"{name} of <{entity.tag}> is neither true nor false", entity.place(name))


def _unset_environment(reader: Reader, entity: Entity) -> LaunchAction:
    conditions = reader.conditions(entity)
    reader.text(entity, "name")
    return LaunchAction("other", entity.span, conditions=conditions)


def _bare(reader: Reader, entity: Entity) -> LaunchAction:
    return LaunchAction("other", entity.span, conditions=reader.conditions(entity))


def _kept(reader: Reader, entity: Entity) -> tuple[tuple[str, LaunchValue], ...]:
    return tuple((name, value) for name, value in _named(reader, entity, "keep"))


def _reset(reader: Reader, entity: Entity) -> LaunchAction:
    conditions = reader.conditions(entity)
    return LaunchAction("other", entity.span, arguments=_kept(reader, entity), conditions=conditions)


def _log(reader: Reader, entity: Entity) -> LaunchAction:
    conditions = reader.conditions(entity)
    message = reader.text(entity, "message")
    return LaunchAction("other", entity.span, arguments=(("", message),), conditions=conditions)


def _shutdown(reader: Reader, entity: Entity) -> LaunchAction:
    conditions = reader.conditions(entity)
    reader.optional(entity, "reason")
    return LaunchAction("other", entity.span, conditions=conditions)


def _group(reader: Reader, entity: Entity) -> LaunchAction:
    conditions = reader.conditions(entity)
    scoped = entity.get("scoped", "bool")
    entity.get("forwarding", "bool")
    kept = _kept(reader, entity)
    children = reader.actions(child for child in entity.actions() if child.tag != "keep")
    name = LaunchValue(("unscoped",), entity.span) if scoped is False else None
    return LaunchAction("group", entity.span, name=name, arguments=kept, conditions=conditions, children=tuple(children))


def _timer(reader: Reader, entity: Entity) -> LaunchAction:
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


def _loop(reader: Reader, entity: Entity) -> LaunchAction:
    """Return what is done for each of some values, how many there are: perhaps never."""
    conditions = reader.conditions(entity)
    for attribute in ("values",) if entity.tag == "for_each" else ("len", "name"):
        reader.text(entity, attribute)
    children = reader.actions(entity.actions())
    perhaps = LaunchCondition((UNKNOWN,), None)
    unscoped = LaunchValue(("unscoped",), entity.span)
    return LaunchAction("group", entity.span, name=unscoped, conditions=(*conditions, perhaps), children=tuple(children))


def _include(reader: Reader, entity: Entity) -> LaunchAction:
    conditions = reader.conditions(entity)
    target = reader.text(entity, "file")
    arguments = _named(reader, entity, "arg")
    if any(child.tag == "let" for child in entity.children):
        arguments += _named(reader, entity, "let")
        reader.note_newer("<let> in <include>", next(child.span for child in entity.children if child.tag == "let"))
    return LaunchAction(
        "include",
        entity.span,
        target=target,
        package_span=reader.package_span(entity, "file"),
        arguments=arguments,
        conditions=conditions,
    )


def _named(
    reader: Reader, entity: Entity, tag: str, name: str = "name", value: str = "value"
) -> tuple[tuple[str, LaunchValue], ...]:
    """Return children that give a value to a name."""
    found: list[tuple[str, LaunchValue]] = []
    children = entity.entities(tag)
    for child in children:
        if not child.simple or name not in child.attributes:
            child.need(name)
        given = reader.text(child, value)
        found += [(one, given) for one in reader.text(child, name).texts]
    for child in children:
        child.finish()
    return tuple(found)


def _process(reader: Reader, entity: Entity, kind: str) -> LaunchAction:
    """What nodes and executables share (``ExecuteProcess.parse``)."""
    conditions = reader.conditions(entity)
    given: list[tuple[str, LaunchValue]] = []
    if kind == "process":
        given += reader.words(entity, "cmd", entity.need("cmd"))
    for attribute in () if entity.lacks(_SURROUNDINGS) else ("cwd", "launch-prefix", "output", "respawn"):
        value = reader.optional(entity, attribute)
        if value is not None and attribute in ("cwd", "launch-prefix"):
            given.append((attribute, value))
    name = reader.optional(entity, "name")
    if entity.get("on_exit") not in (None, "shutdown"):
        raise Rejected("on-exit", f"on_exit of <{entity.tag}> can only be shutdown", entity.place("on_exit"))
    if not entity.lacks(_LIMITS):
        _limits(reader, entity)
    entity.get("shell", "bool")
    entity.get("emulate_tty", "bool")
    given += [(f"${variable}", value) for variable, value in _named(reader, entity, "env")]
    return LaunchAction(
        kind,
        entity.span,
        target=given[0][1] if kind == "process" and given else None,
        name=name,
        arguments=tuple(given),
        package_span=reader.package_span(entity, "cmd", "launch-prefix"),
        conditions=conditions,
    )


_SURROUNDINGS = frozenset({"cwd", "launch-prefix", "output", "respawn"})
_LIMITS = frozenset({"respawn_max_retries", "respawn_delay", "sigkill_timeout", "sigterm_timeout"})


def _limits(reader: Reader, entity: Entity) -> None:
    for name in entity.attributes:
        if f"attribute {name}" in SINCE:
            reader.note_newer(f"attribute {name}", entity.place(name))
    entity.get("respawn_max_retries", "int")
    for limit in ("respawn_delay", "sigkill_timeout", "sigterm_timeout"):
        seconds = entity.get(limit, "float")
        if seconds is not None and (isinstance(seconds, str) or seconds < 0):
            raise Rejected("wrong-type", f"{limit} of <{entity.tag}> is no number from 0 on", entity.place(limit))


def _executable(reader: Reader, entity: Entity) -> LaunchAction:
    return _process(reader, entity, "process")


# --- actions of launch_ros -----------------------------------------------------------------------------------------


def _node(reader: Reader, entity: Entity) -> LaunchAction:
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


def _lifecycle_node(reader: Reader, entity: Entity) -> LaunchAction:
    _needs_truth(reader, entity, "autostart")
    for name in ("name", "namespace"):
        entity.need(name)
    return _node(reader, entity)


def _container(reader: Reader, entity: Entity) -> LaunchAction:
    action = _node(reader, entity)
    components = _components(reader, entity)
    for name in ("name", "namespace"):
        entity.need(name)
    return action._replace(children=tuple(components))


def _load(reader: Reader, entity: Entity) -> LaunchAction:
    conditions = reader.conditions(entity)
    target = reader.text(entity, "target")
    components = tuple(_components(reader, entity))
    if not components:
        raise Rejected("missing-child", f"<{entity.tag}> needs a <composable_node>", entity.span)
    return LaunchAction("group", entity.span, name=target, conditions=conditions, children=components)


def _components(reader: Reader, entity: Entity) -> list[LaunchAction]:
    components = [_component(reader, child) for child in entity.entities("composable_node")]
    if any(child.tag == "composable_lifecycle_node" for child in entity.children):
        for child in entity.entities("composable_lifecycle_node"):
            reader.note_newer("<composable_lifecycle_node>", child.span)
            reader.typed(child, "autostart", "bool")
            components.append(_component(reader, child))
    return components


def _component(reader: Reader, entity: Entity) -> LaunchAction:
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


def _remappings(reader: Reader, entity: Entity) -> tuple[tuple[LaunchValue, LaunchValue], ...]:
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


def _parameters(reader: Reader, entity: Entity) -> tuple[tuple[str, LaunchValue], ...]:
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


def _nested(reader: Reader, param: Entity, above: str) -> list[tuple[str, LaunchValue]]:
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
    if isinstance(typed, list):
        typed = reader.listed(param, "value", typed)
    if isinstance(typed, LaunchValue):
        return [(name, typed) for name in names]
    if kind in _SCALARS and not isinstance(typed, _SCALARS[kind]):
        raise Rejected("wrong-type", f"the value of <param> is no {wanted}", param.place("value"))
    return [(name, LaunchValue((str(typed),), param.place("value"))) for name in names]


_RULES: Mapping[str, Rule] = {
    "arg": _argument,
    "let": _assignment("set"),
    "set_env": _assignment("environment"),
    "append_env": _append_environment,
    "unset_env": _unset_environment,
    "reset_env": _bare,
    "reset": _reset,
    "for": _loop,
    "for_each": _loop,
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
