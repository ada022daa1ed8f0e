"""Actions of the objects of the launch libraries, as ``launch`` and ``launch_ros`` execute them."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

from ros_lint.base.text import Span
from ros_lint.collectors import symbolic_text as launch_text
from ros_lint.collectors.launch.expressions import means_true
from ros_lint.collectors.launch.groups import group
from ros_lint.collectors.launch.python import events as launch_py_events
from ros_lint.collectors.launch.python import nodes as launch_py_nodes
from ros_lint.collectors.launch.python.nodes import nested, started_node
from ros_lint.collectors.launch.python.substitutions import SUBSTITUTIONS, is_text, texts
from ros_lint.collectors.launch.python.walker import Rule, Walker, place_of
from ros_lint.collectors.python.interpreter.methods import items
from ros_lint.collectors.python.interpreter.protocol import Interpreter
from ros_lint.collectors.python.interpreter.values import Conditions, LaunchObject, Source, Value, alternatives, plain
from ros_lint.collectors.symbolic_text import UNKNOWN
from ros_lint.facts.launch import LaunchAction, LaunchValue

_MOST_TEXTS = 2_000


def walker(machine: Interpreter, source: Source) -> Walker:
    """Return the walker that turns the objects of a launch file into actions."""
    return Walker(machine, source, _RULES, _other)


def _include(walker: Walker, made: LaunchObject, conditions: Conditions) -> list[LaunchAction]:
    source_argument = made.get(0, "launch_description_source")
    node, where = made.written(0, "launch_description_source"), made.source
    while isinstance(source := plain(source_argument), LaunchObject) and source.name.endswith("LaunchDescriptionSource"):
        node, where = source.written(0, "launch_file_path", "location", "launch_description"), source.source
        source_argument = source.get(0, "launch_file_path", "location", "launch_description")
    if isinstance(source, LaunchObject) and source.name == "LaunchDescription":
        return walker.actions(source, conditions)
    target = walker.text(source, node, where)
    passed = list(_pairs(walker, made.get(1, "launch_arguments"), made))
    include = LaunchAction(
        "include",
        place_of(made),
        target=target,
        package_span=walker.package_span(target),
        conditions=conditions,
        builtin_model=made.source.lent,
    )
    return [_given(action, passed) for action in walker.apart(include, source_argument)]


def _given(include: LaunchAction, passed: Sequence[_Passed]) -> LaunchAction:
    """Return an include with its arguments. Those of a branch that excludes the include are omitted."""
    together = [argument for argument in passed if launch_text.are_consistent((*include.conditions, *argument.conditions))]
    return include._replace(
        arguments=tuple([(argument.name, argument.value) for argument in together]),
        argument_spans=tuple([argument.span for argument in together]),
        conditional_arguments=_perhaps(together),
    )


class _Passed(NamedTuple):
    """An argument of an included file."""

    name: str
    span: Span
    """The place of the name."""
    value: LaunchValue
    conditions: Conditions
    """The conditions under which it is passed; () if there are several alternatives."""
    perhaps: bool
    """True if it is unknown whether the argument is passed."""


def _pairs(walker: Walker, value: Value, made: LaunchObject) -> Iterator[_Passed]:
    node = made.written(1, "launch_arguments")
    passed = plain(value)
    if isinstance(passed, dict):
        passed = list(passed.items())
    pairs = items(walker.machine, passed) if passed is not None else []
    for pair in pairs if pairs is not None else [passed]:
        parts = items(walker.machine, pair)
        if parts is None or len(parts) != 2:
            unknown = walker.text(UNKNOWN, node, made.source)
            yield _Passed(UNKNOWN, unknown.span, unknown, (), perhaps=True)
            continue
        place = walker.text(parts[0], node, made.source).span
        ways = [alternative.conditions for alternative in alternatives(pair)]
        perhaps = any(UNKNOWN in text for way in ways for condition in way for text in condition.texts)
        for name in texts(parts[0]):
            what = walker.text(parts[1], node, made.source)
            yield _Passed(str(name), place, what, ways[0] if len(ways) == 1 else (), perhaps)


def _perhaps(passed: Sequence[_Passed]) -> tuple[str, ...]:
    """Return the arguments that may not be passed. Those that both sides of a branch pass are certain."""
    sides = Counter([argument.name for argument in passed])
    return tuple([argument.name for argument in passed if argument.perhaps and sides[argument.name] == 1])


def _declare(walker: Walker, made: LaunchObject, conditions: Conditions) -> list[LaunchAction]:
    options = made.get(-1, "choices")
    # For a text, launch tests whether the value is a substring of it.
    choices = items(walker.machine, options) if options is not None and not isinstance(plain(options), str) else None
    default = walker.value(made, 1, "default_value")
    return [
        LaunchAction(
            "argument",
            place_of(made),
            target=walker.value(made, 0, "name"),
            value=default,
            package_span=walker.package_span(default),
            choices=tuple(str(text) for choice in choices or () for text in texts(choice)),
            conditions=conditions,
        )
    ]


def _assigns(kind: str, *names: tuple[str, ...]) -> Rule:
    def rule(walker: Walker, made: LaunchObject, conditions: Conditions) -> list[LaunchAction]:
        value = walker.value(made, 1, *names[1])
        target = walker.value(made, 0, *names[0])
        span = walker.package_span(value)
        return [LaunchAction(kind, place_of(made), target=target, value=value, package_span=span, conditions=conditions)]

    return rule


def _append(walker: Walker, made: LaunchObject, conditions: Conditions) -> list[LaunchAction]:
    (action,) = _assigns("environment", ("name",), ("value",))(walker, made, conditions)
    first = made.get(2, "prepend")
    before = plain(first) is True or (isinstance(first, str) and means_true(first) is True)
    separator = walker.value(made, 3, "separator")
    return [
        action._replace(
            name=LaunchValue(("prepend" if before else "append",), place_of(made)),
            arguments=(("separator", separator),) if separator else (),
        )
    ]


def _one_value(kind: str, *names: str) -> Rule:
    def rule(walker: Walker, made: LaunchObject, conditions: Conditions) -> list[LaunchAction]:
        value = walker.value(made, 0, *names)
        return [LaunchAction(kind, place_of(made), value=value, package_span=walker.package_span(value), conditions=conditions)]

    return rule


def _group(walker: Walker, made: LaunchObject, conditions: Conditions) -> list[LaunchAction]:
    children = walker.actions(made.get(0, "actions"), (), place_of(made))
    configurations = tuple(_configurations(walker, made, -1))
    scoped = plain(made.get(-1, "scoped")) is not False
    forwarding = plain(made.get(-1, "forwarding")) is not False
    return [group(place_of(made), children, configurations, conditions, scoped=scoped, forwarding=forwarding)]


def _configurations(walker: Walker, made: LaunchObject, position: int) -> Iterator[tuple[str, LaunchValue]]:
    configurations = plain(made.get(position, "launch_configurations"))
    if isinstance(configurations, dict):
        for name, value in configurations.items():
            yield str(name), walker.text(value, made.written(position, "launch_configurations"), made.source)


def _reset(walker: Walker, made: LaunchObject, conditions: Conditions) -> list[LaunchAction]:
    kept = tuple(_configurations(walker, made, 0))
    return [LaunchAction("reset", place_of(made), arguments=kept, conditions=conditions)]


def _unset(kind: str) -> Rule:
    def rule(walker: Walker, made: LaunchObject, conditions: Conditions) -> list[LaunchAction]:
        return [LaunchAction(kind, place_of(made), target=walker.value(made, 0, "name"), conditions=conditions)]

    return rule


def _bare(kind: str) -> Rule:
    def rule(walker: Walker, made: LaunchObject, conditions: Conditions) -> list[LaunchAction]:  # noqa: ARG001
        return [LaunchAction(kind, place_of(made), conditions=conditions)]

    return rule


def _other(walker: Walker, made: LaunchObject, conditions: Conditions) -> list[LaunchAction]:
    if "package" in made.keywords and ("executable" in made.keywords or "node_executable" in made.keywords):
        return started_node(walker, made, conditions)
    if made.name in SUBSTITUTIONS:
        return []
    if made.name.endswith("LaunchDescription"):  # judging by the name, a function that returns one
        walker.blind.append((f"{made.name}() cannot be followed", place_of(made)))
    if _DECLARES.match(made.name):
        (action,) = _declare(walker, made, conditions)
        unknown = LaunchValue((UNKNOWN,), place_of(made))  # it may have a default in its own class, which is not read
        return [action._replace(value=action.value or unknown)] if action.target else []
    arguments: list[tuple[str, LaunchValue]] = []
    for position, value in enumerate(made.arguments):
        arguments += [("", walker.text(text, made.written(position), made.source)) for text in _texts_in(value)]
    for name, value in made.keywords.items():
        arguments += [("", walker.text(text, made.written(-1, name), made.source)) for text in _texts_in(value)]
    return [
        LaunchAction(
            "other",
            place_of(made),
            name=LaunchValue((made.name,), place_of(made)),
            arguments=tuple(arguments),
            conditions=conditions,
            children=tuple(nested(walker, made)),
        )
    ]


def _texts_in(value: Value) -> list[Value]:
    """Return the texts in a value: itself, or those in a list or dictionary."""
    text_values: list[Value] = []
    waiting = [value]
    for _ in range(_MOST_TEXTS):
        if not waiting:
            break
        item = plain(waiting.pop(0))
        if isinstance(item, dict):
            waiting += item.values()
        elif isinstance(item, (list, tuple)):
            waiting += item
        elif isinstance(item, str) or is_text(item):
            text_values.append(item)
    return text_values


def _silent(walker: Walker, made: LaunchObject, conditions: Conditions) -> list[LaunchAction]:  # noqa: ARG001
    return []


_DECLARES = re.compile(r"Declare\w*Arg(?:ument)?\Z")
"""Classes that declare an argument, as ``DeclareBooleanLaunchArg`` of moveit_configs_utils does."""

_RULES: Mapping[str, Rule] = {
    **launch_py_nodes.RULES,
    **launch_py_events.RULES,
    "IncludeLaunchDescription": _include,
    "DeclareLaunchArgument": _declare,
    "SetLaunchConfiguration": _assigns("set", ("name",), ("value",)),
    "SetEnvironmentVariable": _assigns("environment", ("name",), ("value",)),
    "AppendEnvironmentVariable": _append,
    "SetParameter": _assigns("parameter", ("name",), ("value",)),
    "SetRemap": _assigns("remap", ("src",), ("dst",)),
    "SetParametersFromFile": _one_value("parameter", "filename"),
    "PushRosNamespace": _one_value("namespace", "namespace"),
    "PushROSNamespace": _one_value("namespace", "namespace"),
    "GroupAction": _group,
    "LogInfo": _silent,
    "Shutdown": _silent,
    "EmitEvent": _silent,
    "UnsetEnvironmentVariable": _unset("unset_environment"),
    "UnsetLaunchConfiguration": _unset("unset"),
    "ResetEnvironment": _bare("reset_environment"),
    "ResetLaunchConfigurations": _reset,
    "SetUseSimTime": _silent,
    "ReadyToTest": _silent,
}

LAUNCHED = frozenset(_RULES) - {"LaunchDescription"}
"""Classes whose objects have an effect when they are launched."""
