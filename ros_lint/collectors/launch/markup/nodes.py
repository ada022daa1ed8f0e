"""Functions that convert the tags of nodes, components and processes in XML and YAML launch files to actions."""

from __future__ import annotations

from collections.abc import Mapping

from ros_lint.collectors.launch.markup.attributes import Reader, TagReader
from ros_lint.collectors.launch.markup.entity import Entity, Rejected, Type
from ros_lint.collectors.launch.markup.tags import SINCE
from ros_lint.facts.launch import FileChange, LaunchAction, LaunchValue


def _process(reader: Reader, entity: Entity, kind: str) -> LaunchAction:
    """Return the action of a node or executable with the attributes that both tags have (``ExecuteProcess.parse``)."""
    conditions = reader.conditions(entity)
    arguments: list[tuple[str, LaunchValue]] = []
    if kind == "process":
        arguments += reader.words(entity, "cmd", entity.need("cmd"))
    for attribute in () if entity.has_none_of(_SURROUNDINGS) else _SURROUNDINGS:
        value = reader.optional(entity, attribute)
        if value is not None and attribute in ("cwd", "launch-prefix"):
            arguments.append((attribute.removeprefix("launch-"), value))
    name = reader.optional(entity, "name")
    if entity.get("on_exit") not in (None, "shutdown"):
        raise Rejected("on-exit", f"'on_exit' of <{entity.tag}> can only be 'shutdown'", entity.place("on_exit"))
    if not entity.has_none_of(_LIMITS):
        _limits(reader, entity)
    entity.get("shell", "bool")
    entity.get("emulate_tty", "bool")
    arguments += [(f"${variable}", value) for variable, value in reader.named(entity, "env")]
    return LaunchAction(
        kind,
        entity.span,
        target=arguments[0][1] if kind == "process" and arguments else None,
        name=name,
        arguments=tuple(arguments),
        package_span=reader.package_span(entity, "cmd", "launch-prefix"),
        conditions=conditions,
    )


_SURROUNDINGS = ("cwd", "launch-prefix", "output", "respawn")
_SECONDS = ("respawn_delay", "sigkill_timeout", "sigterm_timeout")
_LIMITS = ("respawn_max_retries", *_SECONDS)


def _limits(reader: Reader, entity: Entity) -> None:
    for name in entity.attributes:
        if f"attribute '{name}'" in SINCE:
            reader.note_newer(f"attribute '{name}'", entity.place(name))
    entity.get("respawn_max_retries", "int")
    for limit in _SECONDS:
        seconds = entity.get(limit, "float")
        if seconds is not None and (isinstance(seconds, str) or seconds < 0):
            raise Rejected("wrong-type", f"'{limit}' of <{entity.tag}> is not a number of at least 0", entity.place(limit))


def _executable(reader: Reader, entity: Entity) -> LaunchAction:
    return _process(reader, entity, "process")


def _node(reader: Reader, entity: Entity) -> LaunchAction:
    action = _process(reader, entity, "node")
    arguments = list(action.arguments)
    for name in ("args", "ros_args"):
        value = entity.get(name)
        if value is not None:
            arguments += reader.words(entity, name, value)
    if entity.get("node-name") is not None:
        raise Rejected("unexpected-attribute", "the attribute 'node-name' was removed; use 'name'", entity.place("node-name"))
    reader.optional(entity, "exec_name")
    return action._replace(
        package=reader.optional(entity, "pkg"),
        target=reader.text(entity, "exec"),
        namespace=reader.optional(entity, "namespace"),
        remappings=_remappings(reader, entity),
        parameters=_parameters(reader, entity),
        arguments=tuple(arguments),
        package_span=reader.package_span(entity, "args", "ros_args", "exec") or action.package_span,
    )


def _lifecycle_node(reader: Reader, entity: Entity) -> LaunchAction:
    reader.need_truth(entity, "autostart")
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
        raise Rejected("missing-child", f"<{entity.tag}> requires a <composable_node>", entity.span)
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
        arguments=tuple(("", value) for _, value in reader.named(entity, "extra_arg")),
    )
    entity.finish()
    return action


def _remappings(reader: Reader, entity: Entity) -> tuple[tuple[LaunchValue, LaunchValue], ...]:
    children = entity.entities("remap")
    pairs = tuple((reader.text(child, "from"), reader.text(child, "to")) for child in children)
    for child in children:
        child.finish()
    return pairs


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
    parameters: list[tuple[str, LaunchValue]] = []
    for param in entity.entities("param"):
        file, name = param.get("from"), param.get("name")
        substituted = param.get("allow_substs", "bool")
        if file is not None and name is not None:
            raise Rejected("parameter", "<param> cannot have both 'from' and 'name'", param.place("name"))
        if file is not None:
            if isinstance(substituted, str):
                raise Rejected("wrong-type", "'allow_substs' of <param> is neither true nor false", param.place("allow_substs"))
            param.finish()
            changes = (FileChange("substitute"),) if substituted else ()
            parameters.append(("", reader.text(param, "from")._replace(changes=changes)))
        elif name is None:
            raise Rejected("parameter", "<param> requires 'name' or 'from'", param.span)
        elif substituted is not None:
            raise Rejected("parameter", "'allow_substs' is only valid together with 'from'", param.place("allow_substs"))
        else:
            parameters += _nested(reader, param, "")
    return tuple(parameters)


def _nested(reader: Reader, param: Entity, prefix: str) -> list[tuple[str, LaunchValue]]:
    names = [f"{prefix}{parameter}" for parameter in reader.text(param, "name").texts]
    type_name = param.get("type", "any")
    if type_name is not None and type_name not in _TYPES:
        raise Rejected(
            "wrong-type", f"there is no parameter type '{type_name}'; expected {', '.join(_TYPES)}", param.place("type")
        )
    kind: Type = _TYPES[type_name] if type_name is not None else "any"
    value = param.get("value", kind)
    inner = param.entities("param")
    param.finish()
    if value is not None and inner:
        raise Rejected("parameter", "<param> cannot have both a value and nested parameters", param.place("value"))
    if kind != "any" and inner:
        raise Rejected("parameter", "<param> with nested parameters cannot have a type", param.place("type"))
    if value is None and not inner:
        raise Rejected("parameter", "<param> requires a value or nested parameters", param.span)
    if inner:
        return [parameter for child in inner for name in names for parameter in _nested(reader, child, f"{name}.")]
    typed = reader.typed(param, "value", kind)
    if isinstance(typed, list):
        typed = reader.listed(param, "value", typed)
    if isinstance(typed, LaunchValue):
        return [(name, typed) for name in names]
    if kind in _SCALARS and not isinstance(typed, _SCALARS[kind]):
        raise Rejected("wrong-type", f"the value of <param> is not of type '{type_name}'", param.place("value"))
    return [(name, LaunchValue((str(typed),), param.place("value"))) for name in names]


TAG_READERS: Mapping[str, TagReader] = {
    "executable": _executable,
    "node": _node,
    "lifecycle_node": _lifecycle_node,
    "node_container": _container,
    "load_composable_node": _load,
}
