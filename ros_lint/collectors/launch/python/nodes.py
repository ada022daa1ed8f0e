"""Conversion of nodes, components and processes in Python launch files to actions."""

from __future__ import annotations

import ast
from collections.abc import Collection, Mapping
from typing import Literal

from ros_lint.base.suggestions import ask_if_meant, similar_names
from ros_lint.collectors.launch.python.events import later
from ros_lint.collectors.launch.python.file_changes import file_changes
from ros_lint.collectors.launch.python.substitutions import is_text, texts
from ros_lint.collectors.launch.python.walker import ActionBuilder, Walker, place_of, span_of
from ros_lint.collectors.python.interpreter.alternatives import alternatives, around, plain, union
from ros_lint.collectors.python.interpreter.methods import items
from ros_lint.collectors.python.interpreter.values import (
    PERHAPS,
    Conditions,
    FilePath,
    Guarded,
    LaunchObject,
    Value,
    Written,
)
from ros_lint.collectors.python.string_values import callee
from ros_lint.collectors.symbolic_text import UNKNOWN, named_in
from ros_lint.facts.launch import LaunchAction, LaunchValue
from ros_lint.facts.visibility import Problem

_REMOVED = {
    "node_executable": "executable",
    "node_name": "name",
    "node_namespace": "namespace",
    "node_plugin": "plugin",
}
"""Keywords of launch_ros that were renamed in Galactic, with their new names."""
_NODE_KEYWORDS = frozenset({"name", "namespace", "package", "parameters", "remappings"})
_COMPONENT_KEYWORDS = _NODE_KEYWORDS | {"condition", "extra_arguments", "plugin"}
_PROCESS_KEYWORDS = _NODE_KEYWORDS | {
    "additional_env", "arguments", "autostart", "cached_output", "composable_node_descriptions", "condition", "cwd",
    "emulate_tty", "env", "exec_name", "executable", "log_cmd", "on_exit", "output", "output_format", "prefix", "respawn",
    "respawn_delay", "respawn_max_retries", "ros_arguments", "shell", "sigkill_timeout", "sigterm_timeout",
}  # fmt: skip
"""The keywords of nodes and containers in any ROS distribution (launch_ros and launch)."""
_ROS_DISTRO = "$ROS_DISTRO"
"""The name of the environment variable with the ROS distribution, with the ``$`` of environment variables in texts."""
_MAX_PARAMETERS = 2_000
_STEPS_PER_PARAMETER = 10
_NODES = frozenset({"Node", "LifecycleNode", "ComposableNodeContainer"})
_CLASSES = _NODES | {"ComposableNode"}


def _note_rejected_keywords(
    walker: Walker, launch_object: LaunchObject, conditions: Conditions, keywords: Collection[str]
) -> None:
    """Record removed and unknown keyword arguments of a node as problems. ``keywords`` are the valid keywords.

    Nothing is recorded under a condition on ROS_DISTRO.
    """
    if any(_ROS_DISTRO in (named_in(text) or ()) for condition in conditions for text in condition.texts):
        return
    callee_name = callee(launch_object.node)
    is_launch_class = callee_name == launch_object.name and callee_name in _CLASSES
    for keyword in launch_object.node.keywords:
        name = keyword.arg
        if name is None or name not in launch_object.keywords or name in keywords:
            continue
        place = span_of(keyword, launch_object.source)
        if name in _REMOVED:
            message = f"{launch_object.name}({name}=) was removed in Galactic; use {_REMOVED[name]}="
            word = place._replace(end_line=place.line, end_column=place.column + len(name))
            walker.problems.append(Problem("removed-keyword", message, word, subject=_REMOVED[name]))
        elif is_launch_class:  # other classes, of a package or of the file, may have keywords of their own
            suggestion = _similar_keyword(name, keywords)
            kind = "misspelt-keyword" if suggestion else "unexpected-keyword"
            question = ask_if_meant([f"{suggestion}="]) if suggestion else ""
            walker.problems.append(Problem(kind, f"{launch_object.name} has no keyword argument '{name}='{question}", place))


def _similar_keyword(name: str, keywords: Collection[str]) -> str:
    return next(iter(similar_names(name, sorted(keywords), 1, 0.75)), "")


def started_node(walker: Walker, launch_object: LaunchObject, conditions: Conditions) -> list[LaunchAction]:
    """Return the action of a node, and the actions that its argument ``on_exit`` starts."""
    _note_rejected_keywords(walker, launch_object, conditions, _PROCESS_KEYWORDS)
    children: list[LaunchAction] = []
    if launch_object.name == "ComposableNodeContainer":
        children = walker.actions(launch_object.get(-1, "composable_node_descriptions"), (), place_of(launch_object))
    elif launch_object.name not in _NODES:
        children = nested(walker, launch_object)
    node = _started("node", "executable", walker, launch_object, conditions)._replace(
        arguments=_argument_texts(walker, launch_object, "arguments", "ros_arguments", "additional_env", "env"),
        children=tuple(children),
    )
    return [*_split("executable", walker, launch_object, node), *later(walker, launch_object, "on_exit")]


def _component(walker: Walker, launch_object: LaunchObject, conditions: Conditions) -> list[LaunchAction]:
    _note_rejected_keywords(walker, launch_object, conditions, _COMPONENT_KEYWORDS)
    return _split("plugin", walker, launch_object, _started("component", "plugin", walker, launch_object, conditions))


def _started(
    kind: Literal["node", "component"], target: str, walker: Walker, launch_object: LaunchObject, conditions: Conditions
) -> LaunchAction:
    """Return the action of a node or component, with the fields that are common to nodes and components.

    The former keywords, such as ``node_name``, count, too. ``target`` is the keyword of the executable or plugin.
    """
    return LaunchAction(
        kind,
        place_of(launch_object),
        package=walker.value(launch_object, -1, "package"),
        target=walker.value(launch_object, -1, target, f"node_{target}"),
        name=walker.value(launch_object, -1, "name", "node_name", absent=""),
        namespace=walker.value(launch_object, -1, "namespace", "node_namespace", absent=""),
        parameters=_parameters(walker, launch_object),
        remappings=_remappings(walker, launch_object),
        conditions=conditions,
        builtin_model=launch_object.source.lent and not _is_passed_by_caller(launch_object.get(-1, "package")),
    )


def _is_passed_by_caller(value: Value) -> bool:
    """Return whether the launch file passed a text to a helper function.

    Otherwise, the text comes from ros-lint's model of the helper function.
    """
    return all(
        isinstance(alternative.value, Written) and not alternative.value.source.lent for alternative in alternatives(value)
    )


def _split(target: str, walker: Walker, launch_object: LaunchObject, action: LaunchAction) -> list[LaunchAction]:
    return walker.split_by_conditions(action, launch_object.get(-1, target, f"node_{target}"), launch_object.get(-1, "package"))


def _load(walker: Walker, launch_object: LaunchObject, conditions: Conditions) -> list[LaunchAction]:
    children = walker.actions(launch_object.get(0, "composable_node_descriptions"), (), place_of(launch_object))
    target = launch_object.get(1, "target_container")
    name = (
        walker.value(launch_object, 1, "target_container")
        if not isinstance(plain(target), LaunchObject) or is_text(target)
        else None
    )
    return [LaunchAction("group", place_of(launch_object), name=name, conditions=conditions, children=tuple(children))]


def _process(walker: Walker, launch_object: LaunchObject, conditions: Conditions) -> list[LaunchAction]:
    command = launch_object.get(0, "cmd")
    words = items(walker.machine, command) if command is not None else None
    places = _elements(launch_object.written(0, "cmd"), len(words or ()))
    arguments = [("", _word(walker, word, node, launch_object)) for word, node in zip(words or (), places, strict=True)]
    target = arguments[0][1] if arguments else None
    process = LaunchAction(
        "process",
        place_of(launch_object),
        target=target,
        arguments=(*arguments, *_argument_texts(walker, launch_object, "additional_env", "env")),
        package_span=next((span for _, argument in arguments if (span := walker.package_span(argument))), None),
        conditions=conditions,
    )
    return [process, *later(walker, launch_object, "on_exit")]


def _test_process(*words: str) -> ActionBuilder:
    """Return the builder of the process of a class or function of launch_testing, with ``words`` before the argument ``path``."""

    def build(walker: Walker, launch_object: LaunchObject, conditions: Conditions) -> list[LaunchAction]:
        place, path = place_of(launch_object), walker.value(launch_object, -1, "path")
        values = (*[LaunchValue((word,), place) for word in words], *([path] if path else ()))
        arguments = tuple([("", value) for value in values])
        return [LaunchAction("process", place, target=values[0] if values else None, arguments=arguments, conditions=conditions)]

    return build


def _argument_texts(walker: Walker, launch_object: LaunchObject, *names: str) -> tuple[tuple[str, LaunchValue], ...]:
    """Return the texts that the Python arguments ``*names`` of a node contain, and those of ``prefix`` and ``cwd``.

    The arguments ``*names``, such as ``arguments`` and ``additional_env``, are lists or dictionaries.

    Each text is paired with a name: "" in ``arguments`` and ``ros_arguments``, the variable (``$A``) in a dictionary of
    environment variables, else the name of the argument.
    """
    result: list[tuple[str, LaunchValue]] = []
    for name in names:
        if name not in launch_object.keywords:
            continue
        argument = plain(launch_object.keywords[name])
        node = launch_object.written(-1, name)
        if isinstance(argument, dict):
            pairs = [(f"${_key(key)}", value) for key, value in argument.items()]
        else:
            word = "" if name in ("arguments", "ros_arguments") else name
            pairs = [(word, value) for value in items(walker.machine, argument) or [argument]]
        places = _elements(node, len(pairs))
        result += [(word, _word(walker, value, at, launch_object)) for (word, value), at in zip(pairs, places, strict=True)]
    given = [name for name in ("prefix", "cwd") if name in launch_object.keywords]
    single_values = [(name, walker.value(launch_object, -1, name)) for name in given]
    return (*result, *[(name, value) for name, value in single_values if value is not None])


def _word(walker: Walker, value: Value, node: ast.expr, launch_object: LaunchObject) -> LaunchValue:
    """Return the possible texts of a word of a command line, with the conditions under which the word is present."""
    words = list(alternatives(value))
    changes = file_changes(walker, value, node, launch_object.source)
    if len(words) != 1:
        return walker.text(value, node, launch_object.source)._replace(changes=changes)
    return walker.text(words[0].value, node, launch_object.source)._replace(conditions=words[0].conditions, changes=changes)


def _parameters(walker: Walker, launch_object: LaunchObject) -> tuple[tuple[str, LaunchValue], ...]:
    result: list[tuple[str, LaunchValue]] = []
    if launch_object.may_hide("parameters"):
        return ((UNKNOWN, walker.unknown(launch_object)),)
    if "parameters" not in launch_object.keywords:
        return ()
    parameters_value = launch_object.keywords["parameters"]
    entries = items(walker.machine, parameters_value)
    if entries is None:
        entries = [parameters_value]
    for entry, node in zip(entries, _elements(launch_object.written(-1, "parameters"), len(entries)), strict=True):
        for alternative in alternatives(entry):
            parameters = _parameter(walker, alternative.value, node, launch_object)
            if alternative.conditions:
                conditions = alternative.conditions
                parameters = [(name, value._replace(conditions=(*conditions, *value.conditions))) for name, value in parameters]
            result += parameters
    return tuple(result)


def _parameter(walker: Walker, value: Value, node: ast.expr, launch_object: LaunchObject) -> list[tuple[str, LaunchValue]]:
    result: list[tuple[str, LaunchValue]] = []
    pending: list[tuple[str, Value, ast.expr, Conditions]] = [("", value, node, ())]
    for _ in range(_MAX_PARAMETERS):
        if not pending:
            break
        walker.machine.budget.step(_STEPS_PER_PARAMETER)
        name, item, place, conditions = pending.pop()
        if isinstance(item, dict):
            walker.machine.budget.step(len(item))
            names = [f"{name}.{key}" if name else _key(key) for key in item]
            rows = zip(names, item.values(), _elements(place, len(item)), strict=True)
            pending += reversed([(key, plain(inner), at, (*conditions, *around(inner))) for key, inner, at in rows])
        elif isinstance(item, (list, tuple)) and not name and not all(_names_file(plain(part)) for part in item):
            walker.machine.budget.step(len(item))
            places = _elements(place, len(item))
            pending += reversed(
                [("", plain(inner), at, (*conditions, *around(inner))) for inner, at in zip(item, places, strict=True)]
            )
        elif name:
            text = walker.text(_list(item), place, launch_object.source)
            result.append((name, text._replace(conditions=(*conditions, *text.conditions))))
        else:
            # An unknown value is usually a dictionary of parameters, not a file.
            is_file = isinstance(item, (list, tuple)) or _names_file(item)
            name = "" if is_file else UNKNOWN
            separate = walker.each_text(item, place, launch_object.source)
            changes = file_changes(walker, item, place, launch_object.source) if is_file else ()
            result += [(name, text._replace(conditions=(*conditions, *text.conditions), changes=changes)) for text in separate]
    return result


def _elements(node: ast.expr, count: int) -> list[ast.expr]:
    """Return the expressions of the ``count`` items of a list or dictionary.

    If ``node`` is not a literal with ``count`` items, the result has ``node`` itself for each item.
    """
    expressions: list[ast.expr] = []
    if isinstance(node, (ast.List, ast.Tuple)):
        expressions = [element if not isinstance(element, ast.Starred) else node for element in node.elts]
    elif isinstance(node, ast.Dict) and None not in node.keys:
        expressions = node.values
    return expressions if len(expressions) == count else [node] * count


def _names_file(value: Value) -> bool:
    """Return whether a parameter value may be a file name, that is, a text, a path or a substitution."""
    return isinstance(value, (str, FilePath)) or is_text(value)


def _list(value: Value) -> Value:
    """Return a list of texts and numbers as one text in YAML notation: ``[1, 2]``. Any other value is returned unchanged."""
    if not isinstance(value, (list, tuple)) or not all(isinstance(item, (str, int, float)) for item in value):
        return value
    return f"[{', '.join(map(str, value))}]"


def _key(key: Value) -> str:
    return str(texts(key)[0]) or "?"


def _remappings(walker: Walker, launch_object: LaunchObject) -> tuple[tuple[LaunchValue, LaunchValue], ...]:
    result: list[tuple[LaunchValue, LaunchValue]] = []
    if launch_object.may_hide("remappings"):
        result.append((walker.unknown(launch_object), walker.unknown(launch_object)))
    elif "remappings" in launch_object.keywords:
        node = launch_object.written(-1, "remappings")
        for pair in items(walker.machine, launch_object.keywords["remappings"]) or ():
            choices = [(items(walker.machine, alternative.value), alternative) for alternative in alternatives(pair)]
            pairs = [(parts, alternative.conditions) for parts, alternative in choices if parts is not None and len(parts) == 2]
            if pairs and len(pairs) == len(choices):
                first, second = (union(Guarded(parts[at], conditions) for parts, conditions in pairs) for at in (0, 1))
                result.append((walker.text(first, node, launch_object.source), walker.text(second, node, launch_object.source)))
            elif any(isinstance(alternative.value, str) if parts is None else len(parts) != 2 for parts, alternative in choices):
                walker.problems.append(
                    Problem(
                        "remapping",
                        "a remapping must be a pair of names; write ('from', 'to')",
                        span_of(node, launch_object.source),
                    )
                )
    return tuple(result)


def nested(walker: Walker, launch_object: LaunchObject) -> list[LaunchAction]:
    """Return the actions in the arguments of a call of an unknown class or function.

    The actions are under an unknown condition, because the class or function may not start them.
    """
    result: list[LaunchAction] = []
    for value in (*launch_object.arguments, *launch_object.keywords.values()):
        for alternative in alternatives(value):
            inner = alternative.value if isinstance(alternative.value, (list, tuple)) else [alternative.value]
            result += [
                action
                for item in inner
                if isinstance(plain(item), LaunchObject) and not is_text(item)
                for action in walker.actions(item, (*alternative.conditions, PERHAPS), place_of(launch_object))
            ]
    return result


BUILDERS: Mapping[str, ActionBuilder] = {
    "Node": started_node,
    "LifecycleNode": started_node,
    "ComposableNodeContainer": started_node,
    "ComposableNode": _component,
    "ComposableLifecycleNode": _component,
    "LoadComposableNodes": _load,
    "ExecuteProcess": _process,
    "ExecuteLocal": _process,
    "GTest": _test_process(),
    "KeepAliveProc": _test_process(UNKNOWN, "-c", UNKNOWN),
    "PyTest": _test_process(UNKNOWN, "-m", "pytest"),
}
