"""Conversion of objects such as IncludeLaunchDescription or GroupAction in Python launch files to actions.

The functions follow the ``execute`` methods of ``launch`` and ``launch_ros``.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

from ros_lint.base.text import Span
from ros_lint.collectors import conditional_text
from ros_lint.collectors.launch.expressions import means_true
from ros_lint.collectors.launch.groups import group
from ros_lint.collectors.launch.python import events, nodes
from ros_lint.collectors.launch.python.file_changes import file_changes
from ros_lint.collectors.launch.python.nodes import nested, started_node
from ros_lint.collectors.launch.python.substitutions import SUBSTITUTIONS, is_text, texts
from ros_lint.collectors.launch.python.walker import ActionBuilder, Walker, place_of
from ros_lint.collectors.python.interpreter.alternatives import alternatives, plain
from ros_lint.collectors.python.interpreter.methods import items
from ros_lint.collectors.python.interpreter.protocol import Interpreter
from ros_lint.collectors.python.interpreter.values import (
    Conditions,
    LaunchObject,
    Source,
    Value,
)
from ros_lint.collectors.symbolic_text import UNKNOWN
from ros_lint.facts.launch import LaunchAction, LaunchValue

_MAX_TEXTS = 2_000


def walker(machine: Interpreter, source: Source) -> Walker:
    """Return the object that converts the launch objects (objects of launch classes) of a Python launch file to actions."""
    return Walker(machine, source, _BUILDERS, _other)


def _include(walker: Walker, launch_object: LaunchObject, conditions: Conditions) -> list[LaunchAction]:
    source_argument = launch_object.get(0, "launch_description_source")
    node, module = launch_object.written(0, "launch_description_source"), launch_object.source
    while isinstance(description_source := plain(source_argument), LaunchObject) and description_source.name.endswith(
        "LaunchDescriptionSource"
    ):
        node, module = (
            description_source.written(0, "launch_file_path", "location", "launch_description"),
            description_source.source,
        )
        source_argument = description_source.get(0, "launch_file_path", "location", "launch_description")
    if isinstance(description_source, LaunchObject) and description_source.name == "LaunchDescription":
        return walker.actions(description_source, conditions)
    target = walker.text(description_source, node, module)
    arguments = list(_passed_arguments(walker, launch_object.get(1, "launch_arguments"), launch_object))
    include = LaunchAction(
        "include",
        place_of(launch_object),
        target=target,
        package_span=walker.package_span(target),
        conditions=conditions,
        builtin_model=launch_object.source.lent,
    )
    return [_with_arguments(action, arguments) for action in walker.split_by_conditions(include, source_argument)]


def _with_arguments(include: LaunchAction, arguments: Sequence[_PassedArgument]) -> LaunchAction:
    """Return an include with the arguments that it passes to the included file.

    Arguments whose conditions contradict the conditions of the include are omitted.
    """
    consistent = [
        argument for argument in arguments if conditional_text.are_consistent((*include.conditions, *argument.conditions))
    ]
    return include._replace(
        arguments=tuple([(argument.name, argument.value) for argument in consistent]),
        argument_spans=tuple([argument.span for argument in consistent]),
        conditional_arguments=_uncertain_names(consistent),
    )


class _PassedArgument(NamedTuple):
    """A launch argument that an include passes to the included file."""

    name: str
    span: Span
    """The place of the argument's name."""
    value: LaunchValue
    conditions: Conditions
    """The conditions under which the argument is passed; () if the argument has several alternative values."""
    uncertain: bool
    """True if the argument may not be passed."""


def _passed_arguments(walker: Walker, launch_arguments: Value, launch_object: LaunchObject) -> Iterator[_PassedArgument]:
    node = launch_object.written(1, "launch_arguments")
    pairs_value = plain(launch_arguments)
    if isinstance(pairs_value, dict):
        pairs_value = list(pairs_value.items())
    pairs = items(walker.machine, pairs_value) if pairs_value is not None else []
    for pair in pairs if pairs is not None else [pairs_value]:
        parts = items(walker.machine, pair)
        if parts is None or len(parts) != 2:
            unknown = walker.text(UNKNOWN, node, launch_object.source)
            yield _PassedArgument(UNKNOWN, unknown.span, unknown, (), uncertain=True)
            continue
        place = walker.text(parts[0], node, launch_object.source).span
        condition_sets = [alternative.conditions for alternative in alternatives(pair)]
        is_uncertain = any(
            UNKNOWN in text for conditions in condition_sets for condition in conditions for text in condition.texts
        )
        for name in texts(parts[0]):
            value = walker.text(parts[1], node, launch_object.source)
            yield _PassedArgument(str(name), place, value, condition_sets[0] if len(condition_sets) == 1 else (), is_uncertain)


def _uncertain_names(arguments: Sequence[_PassedArgument]) -> tuple[str, ...]:
    """Return the names of arguments that may not be passed.

    An argument that is passed in both branches of an ``if`` is certain.
    """
    counts = Counter([argument.name for argument in arguments])
    return tuple([argument.name for argument in arguments if argument.uncertain and counts[argument.name] == 1])


def _declare(walker: Walker, launch_object: LaunchObject, conditions: Conditions) -> list[LaunchAction]:
    options = launch_object.get(-1, "choices")
    # For a text, launch tests whether the value is a substring of it.
    choices = items(walker.machine, options) if options is not None and not isinstance(plain(options), str) else None
    default = walker.value(launch_object, 1, "default_value")
    description = plain(launch_object.get(-1, "description"))
    return [
        LaunchAction(
            "argument",
            place_of(launch_object),
            target=walker.value(launch_object, 0, "name"),
            value=default,
            package_span=walker.package_span(default),
            choices=tuple(str(text) for choice in choices or () for text in texts(choice)),
            description=description if isinstance(description, str) else "",
            conditions=conditions,
        )
    ]


def _assignment(kind: str, *names: tuple[str, ...]) -> ActionBuilder:
    def build(walker: Walker, launch_object: LaunchObject, conditions: Conditions) -> list[LaunchAction]:
        value = walker.value(launch_object, 1, *names[1])
        target = walker.value(launch_object, 0, *names[0])
        span = walker.package_span(value)
        return [LaunchAction(kind, place_of(launch_object), target=target, value=value, package_span=span, conditions=conditions)]

    return build


def _append(walker: Walker, launch_object: LaunchObject, conditions: Conditions) -> list[LaunchAction]:
    (action,) = _assignment("environment", ("name",), ("value",))(walker, launch_object, conditions)
    first = launch_object.get(2, "prepend")
    prepends = plain(first) is True or (isinstance(first, str) and means_true(first) is True)
    separator = walker.value(launch_object, 3, "separator")
    return [
        action._replace(
            name=LaunchValue(("prepend" if prepends else "append",), place_of(launch_object)),
            arguments=(("separator", separator),) if separator else (),
        )
    ]


def _single_value(kind: str, *names: str) -> ActionBuilder:
    def build(walker: Walker, launch_object: LaunchObject, conditions: Conditions) -> list[LaunchAction]:
        value = walker.value(launch_object, 0, *names)
        return [
            LaunchAction(
                kind, place_of(launch_object), value=value, package_span=walker.package_span(value), conditions=conditions
            )
        ]

    return build


def _parameter_file(walker: Walker, launch_object: LaunchObject, conditions: Conditions) -> list[LaunchAction]:
    (action,) = _single_value("parameter", "filename")(walker, launch_object, conditions)
    if action.value is None:
        return [action]
    node = launch_object.written(0, "filename")
    changes = file_changes(walker, launch_object.get(0, "filename"), node, launch_object.source)
    return [action._replace(value=action.value._replace(changes=changes))]


def _group(walker: Walker, launch_object: LaunchObject, conditions: Conditions) -> list[LaunchAction]:
    children = walker.actions(launch_object.get(0, "actions"), (), place_of(launch_object))
    configurations = tuple(_configurations(walker, launch_object, -1))
    scoped = plain(launch_object.get(-1, "scoped")) is not False
    forwarding = plain(launch_object.get(-1, "forwarding")) is not False
    return [group(place_of(launch_object), children, configurations, conditions, scoped=scoped, forwarding=forwarding)]


def _configurations(walker: Walker, launch_object: LaunchObject, position: int) -> Iterator[tuple[str, LaunchValue]]:
    configurations = plain(launch_object.get(position, "launch_configurations"))
    if isinstance(configurations, dict):
        for name, value in configurations.items():
            yield str(name), walker.text(value, launch_object.written(position, "launch_configurations"), launch_object.source)


def _reset(walker: Walker, launch_object: LaunchObject, conditions: Conditions) -> list[LaunchAction]:
    configurations = tuple(_configurations(walker, launch_object, 0))
    return [LaunchAction("reset", place_of(launch_object), arguments=configurations, conditions=conditions)]


def _unset(kind: str) -> ActionBuilder:
    def build(walker: Walker, launch_object: LaunchObject, conditions: Conditions) -> list[LaunchAction]:
        return [LaunchAction(kind, place_of(launch_object), target=walker.value(launch_object, 0, "name"), conditions=conditions)]

    return build


def _plain_action(kind: str) -> ActionBuilder:
    def build(walker: Walker, launch_object: LaunchObject, conditions: Conditions) -> list[LaunchAction]:  # noqa: ARG001
        return [LaunchAction(kind, place_of(launch_object), conditions=conditions)]

    return build


def _other(walker: Walker, launch_object: LaunchObject, conditions: Conditions) -> list[LaunchAction]:
    if "package" in launch_object.keywords and (
        "executable" in launch_object.keywords or "node_executable" in launch_object.keywords
    ):
        return started_node(walker, launch_object, conditions)
    if launch_object.name in SUBSTITUTIONS:
        return []
    if launch_object.name.endswith("LaunchDescription"):  # the name suggests a function that returns a LaunchDescription
        walker.unknown_launches.append((f"{launch_object.name}() cannot be followed", place_of(launch_object)))
    if _DECLARES.match(launch_object.name):
        (action,) = _declare(walker, launch_object, conditions)
        unknown = LaunchValue((UNKNOWN,), place_of(launch_object))  # its class, which is not read, may have a default
        return [action._replace(value=action.value or unknown)] if action.target else []
    arguments: list[tuple[str, LaunchValue]] = []
    for position, value in enumerate(launch_object.arguments):
        arguments += [("", walker.text(text, launch_object.written(position), launch_object.source)) for text in _texts_in(value)]
    for name, value in launch_object.keywords.items():
        arguments += [("", walker.text(text, launch_object.written(-1, name), launch_object.source)) for text in _texts_in(value)]
    return [
        LaunchAction(
            "other",
            place_of(launch_object),
            name=LaunchValue((launch_object.name,), place_of(launch_object)),
            arguments=tuple(arguments),
            conditions=conditions,
            children=tuple(nested(walker, launch_object)),
        )
    ]


def _texts_in(value: Value) -> list[Value]:
    """Return the texts and substitutions in a value: the value itself, or the elements of a list or dictionary."""
    text_values: list[Value] = []
    pending = [value]
    for _ in range(_MAX_TEXTS):
        if not pending:
            break
        item = plain(pending.pop(0))
        if isinstance(item, dict):
            pending += item.values()
        elif isinstance(item, (list, tuple)):
            pending += item
        elif isinstance(item, str) or is_text(item):
            text_values.append(item)
    return text_values


def _no_action(walker: Walker, launch_object: LaunchObject, conditions: Conditions) -> list[LaunchAction]:  # noqa: ARG001
    return []


_DECLARES = re.compile(r"Declare\w*Arg(?:ument)?\Z")
"""Pattern of the classes that declare an argument, such as ``DeclareBooleanLaunchArg`` of moveit_configs_utils."""

_BUILDERS: Mapping[str, ActionBuilder] = {
    **nodes.BUILDERS,
    **events.BUILDERS,
    "IncludeLaunchDescription": _include,
    "DeclareLaunchArgument": _declare,
    "SetLaunchConfiguration": _assignment("set", ("name",), ("value",)),
    "SetEnvironmentVariable": _assignment("environment", ("name",), ("value",)),
    "AppendEnvironmentVariable": _append,
    "SetParameter": _assignment("parameter", ("name",), ("value",)),
    "SetRemap": _assignment("remap", ("src",), ("dst",)),
    "SetParametersFromFile": _parameter_file,
    "PushRosNamespace": _single_value("namespace", "namespace"),
    "PushROSNamespace": _single_value("namespace", "namespace"),
    "GroupAction": _group,
    "LogInfo": _no_action,
    "Shutdown": _no_action,
    "EmitEvent": _no_action,
    "UnsetEnvironmentVariable": _unset("unset_environment"),
    "UnsetLaunchConfiguration": _unset("unset"),
    "ResetEnvironment": _plain_action("reset_environment"),
    "ResetLaunchConfigurations": _reset,
    "SetUseSimTime": _no_action,
    "ReadyToTest": _no_action,
}

LAUNCHED = frozenset(_BUILDERS) - {"LaunchDescription"}
"""Names of the classes whose objects have an effect when they are launched."""
