"""Functions that convert the tags of XML and YAML launch files to actions, except the tags of nodes and processes."""

from __future__ import annotations

import re
from collections.abc import Mapping

from ros_lint.collectors.launch.groups import group
from ros_lint.collectors.launch.markup.attributes import Reader, TagReader
from ros_lint.collectors.launch.markup.entity import Entity, Rejected
from ros_lint.collectors.symbolic_text import UNKNOWN
from ros_lint.facts.launch import TIMER, UNSCOPED, LaunchAction, LaunchCondition, LaunchValue


def _argument(reader: Reader, entity: Entity) -> LaunchAction:
    conditions = reader.conditions(entity)
    entity.need("name")
    default = reader.optional(entity, "default")
    description = entity.get("description")
    choices = tuple(_unescaped(choice.need("value")) for choice in entity.entities("choice"))
    return LaunchAction(
        "argument",
        entity.span,
        target=_plain(entity, "name"),
        value=default,
        package_span=reader.package_span(entity, "default"),
        choices=choices,
        description=description if isinstance(description, str) else "",
        conditions=conditions,
    )


def _boolean_argument(reader: Reader, entity: Entity) -> LaunchAction:
    action = _argument(reader, entity)
    if action.choices:
        raise Rejected("unexpected-child", "<bool_arg> cannot have a <choice>", entity.span)
    return action._replace(choices=_TRUTH_VALUES)


_TRUTH_VALUES = ("true", "false", "True", "False", "TRUE", "FALSE")
"""The values that DeclareBooleanLaunchArgument accepts."""


def _plain(entity: Entity, name: str) -> LaunchValue:
    """Return the value of an attribute without expanding its substitutions."""
    value = _unescaped(entity.attributes[name])
    span, plain = entity.written(name)
    return LaunchValue((value,), span, plain and value == entity.attributes[name])


def _unescaped(value: str) -> str:
    return re.sub(r"\\(.)", r"\1", value) if "\\" in value else value


def _assignment(kind: str, name: str = "name", value: str = "value") -> TagReader:
    def read(reader: Reader, entity: Entity) -> LaunchAction:
        conditions = reader.conditions(entity)
        target, assigned = reader.text(entity, name), reader.text(entity, value)
        span = reader.package_span(entity, value)
        return LaunchAction(kind, entity.span, target=target, value=assigned, package_span=span, conditions=conditions)

    return read


def _single(kind: str, name: str) -> TagReader:
    def read(reader: Reader, entity: Entity) -> LaunchAction:
        conditions = reader.conditions(entity)
        value = reader.text(entity, name)
        span = reader.package_span(entity, name)
        return LaunchAction(kind, entity.span, value=value, package_span=span, conditions=conditions)

    return read


def _append_environment(reader: Reader, entity: Entity) -> LaunchAction:
    action = _assignment("environment")(reader, entity)
    reader.need_truth(entity, "prepend")
    prepends = reader.typed(entity, "prepend", "bool") is True
    separator = reader.optional(entity, "separator")
    return action._replace(
        name=LaunchValue(("prepend" if prepends else "append",), entity.span),
        arguments=(("separator", separator),) if separator else (),
    )


def _unset_environment(reader: Reader, entity: Entity) -> LaunchAction:
    conditions = reader.conditions(entity)
    return LaunchAction("unset_environment", entity.span, target=reader.text(entity, "name"), conditions=conditions)


def _reset_environment(reader: Reader, entity: Entity) -> LaunchAction:
    return LaunchAction("reset_environment", entity.span, conditions=reader.conditions(entity))


def _replace_environment(reader: Reader, entity: Entity) -> LaunchAction:
    conditions = reader.conditions(entity)
    return LaunchAction("other", entity.span, arguments=reader.named(entity, "env"), conditions=conditions)


def _bare(reader: Reader, entity: Entity) -> LaunchAction:
    return LaunchAction("other", entity.span, conditions=reader.conditions(entity))


def _reset(reader: Reader, entity: Entity) -> LaunchAction:
    conditions = reader.conditions(entity)
    return LaunchAction("reset", entity.span, arguments=reader.named(entity, "keep"), conditions=conditions)


def _log(reader: Reader, entity: Entity) -> LaunchAction:
    conditions = reader.conditions(entity)
    message = reader.text(entity, "message")
    if entity.tag == "log" and reader.optional(entity, "level") is not None:
        reader.note_newer("attribute 'level' of <log>", entity.place("level"))
    return LaunchAction("other", entity.span, arguments=(("", message),), conditions=conditions)


def _shutdown(reader: Reader, entity: Entity) -> LaunchAction:
    conditions = reader.conditions(entity)
    reader.optional(entity, "reason")
    return LaunchAction("other", entity.span, conditions=conditions)


def _group(reader: Reader, entity: Entity) -> LaunchAction:
    conditions = reader.conditions(entity)
    scoped = entity.get("scoped", "bool") is not False
    forwarding = entity.get("forwarding", "bool") is not False
    configurations = reader.named(entity, "keep")
    children = reader.actions(child for child in entity.actions() if child.tag != "keep")
    return group(entity.span, children, configurations, conditions, scoped=scoped, forwarding=forwarding)


def _timer(reader: Reader, entity: Entity) -> LaunchAction:
    conditions = reader.conditions(entity)
    entity.need("period", "float")
    period = reader.typed(entity, "period", "float")
    if isinstance(period, str):
        try:
            float(period)
        except ValueError:
            raise Rejected("wrong-type", f"'period' of <{entity.tag}> is not a number", entity.place("period")) from None
    children = reader.actions(entity.actions())
    if entity.tag == "timer":
        reader.need_truth(entity, "cancel_on_shutdown")
    trigger = LaunchValue((TIMER,), entity.span)
    return LaunchAction(
        "later", entity.span, name=trigger, value=reader.text(entity, "period"), conditions=conditions, children=tuple(children)
    )


def _loop(reader: Reader, entity: Entity) -> LaunchAction:
    """Return the actions in a loop such as ``<for_each>`` as a group with an unknown condition: the loop may run 0 times."""
    conditions = reader.conditions(entity)
    for attribute in ("values",) if entity.tag == "for_each" else ("len", "name"):
        reader.text(entity, attribute)
    children = reader.actions(entity.actions())
    unknown = LaunchCondition((UNKNOWN,), None)
    unscoped = LaunchValue((UNSCOPED,), entity.span)
    return LaunchAction("group", entity.span, name=unscoped, conditions=(*conditions, unknown), children=tuple(children))


def _include(reader: Reader, entity: Entity) -> LaunchAction:
    conditions = reader.conditions(entity)
    target = reader.text(entity, "file")
    arguments = reader.named(entity, "arg")
    if any(child.tag == "let" for child in entity.children):
        arguments += reader.named(entity, "let")
        reader.note_newer("<let> in <include>", next(child.span for child in entity.children if child.tag == "let"))
    spans = [child.place("name") for tag in ("arg", "let") for child in entity.children if child.tag == tag]
    return LaunchAction(
        "include",
        entity.span,
        target=target,
        package_span=reader.package_span(entity, "file"),
        arguments=arguments,
        argument_spans=tuple(spans) if len(spans) == len(arguments) else (),
        conditions=conditions,
    )


TAG_READERS: Mapping[str, TagReader] = {
    "arg": _argument,
    "bool_arg": _boolean_argument,
    "let": _assignment("set"),
    "set_env": _assignment("environment"),
    "append_env": _append_environment,
    "unset_env": _unset_environment,
    "rep_env": _replace_environment,
    "reset_env": _reset_environment,
    "reset": _reset,
    "for": _loop,
    "for_each": _loop,
    **dict.fromkeys(("log", "log_debug", "log_error", "log_info", "log_warning"), _log),
    "shutdown": _shutdown,
    "group": _group,
    "timer": _timer,
    "include": _include,
    "push_ros_namespace": _single("namespace", "namespace"),
    "push-ros-namespace": _single("namespace", "namespace"),
    "ros_timer": _timer,
    "set_parameter": _assignment("parameter"),
    "set_parameters_from_file": _single("parameter", "filename"),
    "set_remap": _assignment("remap", "from", "to"),
    "set_ros_log_dir": _single("other", "new_log_dir"),
    "set_use_sim_time": _single("other", "value"),
}
