"""What objects of the launch libraries do when they are launched, class by class (reference, section G2)."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping

from ros_lint.collectors.launch_py_methods import items
from ros_lint.collectors.launch_py_objects import (
    PERHAPS,
    Bound,
    Conditions,
    Context,
    FilePath,
    Function,
    Instance,
    Made,
    Source,
    Unknown,
    Value,
    alternatives,
    plain,
)
from ros_lint.collectors.launch_py_run import Machine
from ros_lint.collectors.launch_py_texts import SUBSTITUTIONS, texts
from ros_lint.collectors.launch_py_walk import Rule, Walker, span_of
from ros_lint.collectors.launch_text import UNKNOWN, named_in
from ros_lint.facts.launch import LaunchAction, LaunchValue
from ros_lint.facts.sight import Problem
from ros_lint.text import Span

_REMOVED = {
    "node_executable": "executable",
    "node_name": "name",
    "node_namespace": "namespace",
    "node_plugin": "plugin",
}
"""Keywords that have another name now (reference, section G2.3)."""

_DISTRIBUTION = "$ROS_DISTRO"
"""What a text calls the environment variable that says which distribution runs."""

_MOST_PARAMETERS = 2_000
_NODES = frozenset({"Node", "LifecycleNode", "ComposableNodeContainer"})


def walker(machine: Machine, source: Source) -> Walker:
    """Return what turns the objects of a launch file into actions."""
    return Walker(machine, source, _RULES, _other)


def _span(made: Made) -> Span:
    return span_of(made.node, made.source)


def _note_removed(walker: Walker, made: Made, conditions: Conditions) -> None:
    """Note what is gone, unless the file itself asks for the distribution before it comes here."""
    if any(_DISTRIBUTION in (named_in(text) or ()) for condition in conditions for text in condition.texts):
        return
    for keyword in made.node.keywords:
        now = _REMOVED.get(keyword.arg or "")
        if now is not None:
            message = f"{keyword.arg}= of {made.name} is gone since Galactic: say {now}="
            walker.problems.append(Problem("removed-keyword", message, span_of(keyword, made.source)))


def _node(walker: Walker, made: Made, conditions: Conditions) -> list[LaunchAction]:
    _note_removed(walker, made, conditions)
    children: list[LaunchAction] = []
    if made.name == "ComposableNodeContainer":
        children = walker.actions(made.get(-1, "composable_node_descriptions"), (), _span(made))
    elif made.name not in _NODES:
        children = _nested(walker, made)
    node = LaunchAction(
        "node",
        _span(made),
        package=walker.value(made, -1, "package"),
        target=walker.value(made, -1, "executable", "node_executable"),
        name=walker.value(made, -1, "name", "node_name"),
        namespace=walker.value(made, -1, "namespace", "node_namespace"),
        arguments=_given(walker, made, "arguments", "ros_arguments", "prefix", "additional_env", "env", "cwd"),
        parameters=_parameters(walker, made),
        remappings=_remappings(walker, made),
        conditions=conditions,
        children=tuple(children),
    )
    return [node, *_later(walker, made, "on_exit")]


def _component(walker: Walker, made: Made, conditions: Conditions) -> list[LaunchAction]:
    _note_removed(walker, made, conditions)
    return [
        LaunchAction(
            "component",
            _span(made),
            package=walker.value(made, -1, "package"),
            target=walker.value(made, -1, "plugin", "node_plugin"),
            name=walker.value(made, -1, "name", "node_name"),
            namespace=walker.value(made, -1, "namespace", "node_namespace"),
            parameters=_parameters(walker, made),
            remappings=_remappings(walker, made),
            conditions=conditions,
        )
    ]


def _load(walker: Walker, made: Made, conditions: Conditions) -> list[LaunchAction]:
    children = walker.actions(made.get(0, "composable_node_descriptions"), (), _span(made))
    target = made.get(1, "target_container")
    name = walker.value(made, 1, "target_container") if not isinstance(plain(target), Made) or _is_text(target) else None
    return [LaunchAction("group", _span(made), name=name, conditions=conditions, children=tuple(children))]


def _is_text(value: Value) -> bool:
    made = plain(value)
    return isinstance(made, Made) and made.name in SUBSTITUTIONS


def _include(walker: Walker, made: Made, conditions: Conditions) -> list[LaunchAction]:
    source = plain(made.get(0, "launch_description_source"))
    node, where = made.written(0, "launch_description_source"), made.source
    while isinstance(source, Made) and source.name.endswith("LaunchDescriptionSource"):
        node, where = source.written(0, "launch_file_path", "location", "launch_description"), source.source
        source = plain(source.get(0, "launch_file_path", "location", "launch_description"))
    if isinstance(source, Made) and source.name == "LaunchDescription":
        return walker.actions(source, conditions)
    target = walker.text(source, node, where)
    return [
        LaunchAction(
            "include",
            _span(made),
            target=target,
            package_span=walker.package_span(target),
            arguments=tuple(_pairs(walker, made.get(1, "launch_arguments"), made)),
            conditions=conditions,
        )
    ]


def _pairs(walker: Walker, value: Value, made: Made) -> Iterator[tuple[str, LaunchValue]]:
    node = made.written(1, "launch_arguments")
    given = plain(value)
    if isinstance(given, dict):
        given = list(given.items())
    pairs = items(walker.machine, given) if given is not None else []
    for pair in pairs if pairs is not None else [given]:
        parts = items(walker.machine, pair)
        if parts is None or len(parts) != 2:
            yield UNKNOWN, walker.text(UNKNOWN, node, made.source)
            continue
        for name in texts(parts[0]):
            yield str(name), walker.text(parts[1], node, made.source)


def _declare(walker: Walker, made: Made, conditions: Conditions) -> list[LaunchAction]:
    choices = items(walker.machine, made.get(-1, "choices")) if made.get(-1, "choices") is not None else None
    default = walker.value(made, 1, "default_value")
    return [
        LaunchAction(
            "argument",
            _span(made),
            target=walker.value(made, 0, "name"),
            value=default,
            package_span=walker.package_span(default),
            choices=tuple(str(text) for choice in choices or () for text in texts(choice)),
            conditions=conditions,
        )
    ]


def _assigns(kind: str, *names: tuple[str, ...]) -> Rule:
    def rule(walker: Walker, made: Made, conditions: Conditions) -> list[LaunchAction]:
        value = walker.value(made, 1, *names[1])
        target = walker.value(made, 0, *names[0])
        span = walker.package_span(value)
        return [LaunchAction(kind, _span(made), target=target, value=value, package_span=span, conditions=conditions)]

    return rule


def _append(walker: Walker, made: Made, conditions: Conditions) -> list[LaunchAction]:
    (action,) = _assigns("environment", ("name",), ("value",))(walker, made, conditions)
    return [action._replace(name=LaunchValue(("append",), _span(made)))]


def _one_value(kind: str, *names: str) -> Rule:
    def rule(walker: Walker, made: Made, conditions: Conditions) -> list[LaunchAction]:
        value = walker.value(made, 0, *names)
        return [LaunchAction(kind, _span(made), value=value, package_span=walker.package_span(value), conditions=conditions)]

    return rule


def _group(walker: Walker, made: Made, conditions: Conditions) -> list[LaunchAction]:
    children = walker.actions(made.get(0, "actions"), (), _span(made))
    scoped = plain(made.get(-1, "scoped")) is not False
    passed = tuple(_group_configurations(walker, made))
    name = None if scoped else LaunchValue(("unscoped",), _span(made))
    return [LaunchAction("group", _span(made), name=name, arguments=passed, conditions=conditions, children=tuple(children))]


def _group_configurations(walker: Walker, made: Made) -> Iterator[tuple[str, LaunchValue]]:
    given = plain(made.get(-1, "launch_configurations"))
    if isinstance(given, dict):
        for name, value in given.items():
            yield str(name), walker.text(value, made.written(-1, "launch_configurations"), made.source)


def _timer(walker: Walker, made: Made, conditions: Conditions) -> list[LaunchAction]:
    children = walker.actions(made.get(-1, "actions"), (), _span(made))
    return [LaunchAction("later", _span(made), conditions=conditions, children=tuple(children))]


def _event(walker: Walker, made: Made, conditions: Conditions) -> list[LaunchAction]:
    """What a handler does when its event comes: actions, or what its function returns."""
    found: list[LaunchAction] = []
    for one in alternatives(made.get(0, "event_handler")):
        handler = one.value
        if isinstance(handler, Instance):
            handler = handler.made
        if isinstance(handler, Made):
            found += _handled(walker, handler)
    return [LaunchAction("later", _span(made), conditions=conditions, children=tuple(found))] if found else []


def _handled(walker: Walker, handler: Made) -> list[LaunchAction]:
    handler.seen = True
    found: list[LaunchAction] = []
    targets = {"target_action", "matcher", "handle_once", "target_lifecycle_node", "start_state", "goal_state", "transition"}
    for name, given in [*[("", one) for one in handler.arguments[1:]], *handler.keywords.items()]:
        if name in targets:
            continue
        for one in alternatives(given):
            value = one.value
            if isinstance(value, (Function, Bound)):
                value = walker.run(value, [Unknown("an event"), Context()], {}, handler)
            found += walker.actions(value, one.conditions, _span(handler))
    return found


def _later(walker: Walker, made: Made, *names: str) -> list[LaunchAction]:
    found: list[LaunchAction] = []
    for name in names:
        for one in alternatives(made.get(-1, name)) if name in made.keywords else ():
            value = one.value
            if isinstance(value, (Function, Bound)):
                value = walker.run(value, [Unknown("an event"), Context()], {}, made)
            if value is not None and not isinstance(value, Unknown):
                found += walker.actions(value, one.conditions, _span(made))
    return [LaunchAction("later", _span(made), children=tuple(found))] if found else []


def _opaque_function(walker: Walker, made: Made, conditions: Conditions) -> list[LaunchAction]:
    arguments = items(walker.machine, made.get(-1, "args")) if made.get(-1, "args") is not None else []
    keywords = plain(made.get(-1, "kwargs"))
    before = walker.machine.conditions
    walker.machine.conditions = ()
    try:
        result = walker.run(
            made.get(0, "function"),
            [Context(), *(arguments or [])],
            {str(k): v for k, v in keywords.items()} if isinstance(keywords, dict) else {},
            made,
        )
    finally:
        walker.machine.conditions = before
    return walker.actions(result, conditions, _span(made)) if result is not None else []


def _for_each(walker: Walker, made: Made, conditions: Conditions) -> list[LaunchAction]:
    result = walker.run(made.get(1, "function"), [Unknown("a value of ForEach")] * 3, {}, made)
    return walker.actions(result, (*conditions, PERHAPS), _span(made))


def _process(walker: Walker, made: Made, conditions: Conditions) -> list[LaunchAction]:
    command = made.get(0, "cmd")
    words = items(walker.machine, command) if command is not None else None
    node = made.written(0, "cmd")
    arguments = [("", walker.text(word, node, made.source)) for word in words or ()]
    target = arguments[0][1] if arguments else None
    process = LaunchAction(
        "process",
        _span(made),
        target=target,
        arguments=(*arguments, *_given(walker, made, "additional_env", "env", "cwd", "prefix")),
        package_span=next((span for _, one in arguments if (span := walker.package_span(one))), None),
        conditions=conditions,
    )
    return [process, *_later(walker, made, "on_exit")]


def _given(walker: Walker, made: Made, *names: str) -> tuple[tuple[str, LaunchValue], ...]:
    """Return texts of arguments that are lists or dictionaries of texts."""
    found: list[tuple[str, LaunchValue]] = []
    for name in names:
        if name not in made.keywords:
            continue
        given = plain(made.keywords[name])
        node = made.written(-1, name)
        if isinstance(given, dict):
            found += [(f"${_key(key)}", walker.text(plain(value), node, made.source)) for key, value in given.items()]
            continue
        word = "" if name in ("arguments", "ros_arguments") else name
        values = items(walker.machine, given) or [given]
        found += [(word, walker.text(plain(value), node, made.source)) for value in values]
    return tuple(found)


def _parameters(walker: Walker, made: Made) -> tuple[tuple[str, LaunchValue], ...]:
    found: list[tuple[str, LaunchValue]] = []
    if "parameters" not in made.keywords:
        return ()
    node = made.written(-1, "parameters")
    for given in items(walker.machine, made.keywords["parameters"]) or [made.keywords["parameters"]]:
        for one in alternatives(given):
            _parameter(walker, one.value, node, made, found)
    return tuple(found)


def _parameter(walker: Walker, value: Value, node: ast.expr, made: Made, found: list[tuple[str, LaunchValue]]) -> None:
    waiting = [("", value)]
    for _ in range(_MOST_PARAMETERS):
        if not waiting:
            break
        name, one = waiting.pop(0)
        if isinstance(one, dict):
            inner = [(f"{name}.{key}" if name else _key(key), plain(inner)) for key, inner in one.items()]
            waiting = [*inner, *waiting]
        elif isinstance(one, (list, tuple)) and not name and not all(_names_file(plain(part)) for part in one):
            waiting = [*[("", plain(inner)) for inner in one], *waiting]
        elif name:
            found.append((name, walker.text(_list(one), node, made.source)))
        else:
            # What is not known is mostly a dictionary of parameters, and no file.
            known = isinstance(one, (list, tuple)) or _names_file(one)
            found.append(("" if known else UNKNOWN, walker.text(one, node, made.source)))


def _names_file(value: Value) -> bool:
    """Return whether a value is a path or a part of one."""
    return isinstance(value, (str, FilePath)) or _is_text(value)


def _list(value: Value) -> Value:
    """Return a list of texts as YAML has it, and anything else as it is."""
    if not isinstance(value, (list, tuple)) or not all(isinstance(one, (str, int, float)) for one in value):
        return value
    return f"[{', '.join(map(str, value))}]"


def _key(key: Value) -> str:
    return str(texts(key)[0]) or "?"


def _remappings(walker: Walker, made: Made) -> tuple[tuple[LaunchValue, LaunchValue], ...]:
    found: list[tuple[LaunchValue, LaunchValue]] = []
    if "remappings" in made.keywords:
        node = made.written(-1, "remappings")
        for pair in items(walker.machine, made.keywords["remappings"]) or ():
            parts = items(walker.machine, pair)
            if parts is not None and len(parts) == 2:
                found.append((walker.text(parts[0], node, made.source), walker.text(parts[1], node, made.source)))
            elif parts is not None or isinstance(plain(pair), str):
                walker.problems.append(Problem("remapping", "a remapping is a pair of names", span_of(node, made.source)))
    return tuple(found)


def _nested(walker: Walker, made: Made) -> list[LaunchAction]:
    """Return the actions among the arguments of something that is not known."""
    found: list[LaunchAction] = []
    for value in (*made.arguments, *made.keywords.values()):
        for one in alternatives(value):
            inner = one.value if isinstance(one.value, (list, tuple)) else [one.value]
            found += [
                action
                for each in inner
                if isinstance(plain(each), Made) and not _is_text(each)
                for action in walker.actions(each, (*one.conditions, PERHAPS), _span(made))
            ]
    return found


def _other(walker: Walker, made: Made, conditions: Conditions) -> list[LaunchAction]:
    if "package" in made.keywords and ("executable" in made.keywords or "node_executable" in made.keywords):
        return _node(walker, made, conditions)
    if made.name in SUBSTITUTIONS:
        return []
    given: list[tuple[str, LaunchValue]] = []
    for position, value in enumerate(made.arguments):
        given += [("", walker.text(one, made.written(position), made.source)) for one in _texts_in(value)]
    for name, value in made.keywords.items():
        given += [("", walker.text(one, made.written(-1, name), made.source)) for one in _texts_in(value)]
    return [
        LaunchAction(
            "other",
            _span(made),
            name=LaunchValue((made.name,), _span(made)),
            arguments=tuple(given),
            conditions=conditions,
            children=tuple(_nested(walker, made)),
        )
    ]


def _texts_in(value: Value) -> list[Value]:
    """Return the texts in a value: itself, or those in a list or dictionary."""
    found: list[Value] = []
    waiting = [value]
    for _ in range(_MOST_PARAMETERS):
        if not waiting:
            break
        one = plain(waiting.pop(0))
        if isinstance(one, dict):
            waiting += one.values()
        elif isinstance(one, (list, tuple)):
            waiting += one
        elif isinstance(one, str) or _is_text(one):
            found.append(one)
    return found


def _silent(walker: Walker, made: Made, conditions: Conditions) -> list[LaunchAction]:  # noqa: ARG001
    return []


_RULES: Mapping[str, Rule] = {
    "Node": _node,
    "LifecycleNode": _node,
    "ComposableNodeContainer": _node,
    "ComposableNode": _component,
    "ComposableLifecycleNode": _component,
    "LoadComposableNodes": _load,
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
    "TimerAction": _timer,
    "ROSTimer": _timer,
    "RosTimer": _timer,
    "RegisterEventHandler": _event,
    "OpaqueFunction": _opaque_function,
    "ForEach": _for_each,
    "ExecuteProcess": _process,
    "ExecuteLocal": _process,
    "LogInfo": _silent,
    "Shutdown": _silent,
    "EmitEvent": _silent,
    "UnsetEnvironmentVariable": _silent,
    "UnsetLaunchConfiguration": _silent,
    "SetUseSimTime": _silent,
    "ReadyToTest": _silent,
}

LAUNCHED = frozenset(_RULES) - {"LaunchDescription"}
"""Classes whose objects do something when they are launched."""
