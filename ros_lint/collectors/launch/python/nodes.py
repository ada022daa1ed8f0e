"""The nodes, components and processes that Python launch files start, with their arguments."""

from __future__ import annotations

import ast
from collections.abc import Collection, Mapping
from typing import Literal

from ros_lint.base.suggestions import ask_if_meant, similar_names
from ros_lint.collectors.launch.python.events import later
from ros_lint.collectors.launch.python.substitutions import is_text, texts
from ros_lint.collectors.launch.python.walker import Rule, Walker, place_of, span_of
from ros_lint.collectors.python.interpreter.methods import items
from ros_lint.collectors.python.interpreter.values import (
    PERHAPS,
    Conditions,
    FilePath,
    Guarded,
    LaunchObject,
    Value,
    Written,
    alternatives,
    plain,
    union,
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
_OF_NODES = frozenset({"name", "namespace", "package", "parameters", "remappings"})
_OF_COMPONENTS = _OF_NODES | {"condition", "extra_arguments", "plugin"}
_OF_PROCESSES = _OF_NODES | {
    "additional_env", "arguments", "autostart", "cached_output", "composable_node_descriptions", "condition", "cwd",
    "emulate_tty", "env", "exec_name", "executable", "log_cmd", "on_exit", "output", "output_format", "prefix", "respawn",
    "respawn_delay", "respawn_max_retries", "ros_arguments", "shell", "sigkill_timeout", "sigterm_timeout",
}  # fmt: skip
"""The keywords of nodes and components in any distribution (launch_ros and launch)."""
_DISTRIBUTION = "$ROS_DISTRO"
"""The name of the environment variable with the running distribution, as it occurs in symbolic texts."""
_MOST_PARAMETERS = 2_000
_STEPS_A_PARAMETER = 10
_NODES = frozenset({"Node", "LifecycleNode", "ComposableNodeContainer"})
_CLASSES = _NODES | {"ComposableNode"}


def _note_refused(walker: Walker, made: LaunchObject, conditions: Conditions, known: Collection[str]) -> None:
    """Note removed and unknown keywords, unless a condition on ROS_DISTRO guards the call."""
    if any(_DISTRIBUTION in (named_in(text) or ()) for condition in conditions for text in condition.texts):
        return
    written = callee(made.node)
    itself = written == made.name and written in _CLASSES
    for keyword in made.node.keywords:
        name = keyword.arg
        if name is None or name not in made.keywords or name in known:
            continue
        place = span_of(keyword, made.source)
        if name in _REMOVED:
            message = f"{made.name}({name}=) was removed in Galactic; use {_REMOVED[name]}="
            word = place._replace(end_line=place.line, end_column=place.column + len(name))
            walker.problems.append(Problem("removed-keyword", message, word, subject=_REMOVED[name]))
        elif itself:  # other classes, of a package or of the file, may have keywords of their own
            near = _near(name, known)
            kind = "misspelt-keyword" if near else "unexpected-keyword"
            meant = ask_if_meant([f"{near}="]) if near else ""
            walker.problems.append(Problem(kind, f"{made.name} has no keyword argument '{name}='{meant}", place))


def _near(name: str, known: Collection[str]) -> str:
    return next(iter(similar_names(name, sorted(known), 1, 0.75)), "")


def started_node(walker: Walker, made: LaunchObject, conditions: Conditions) -> list[LaunchAction]:
    """Return a node with its arguments, and the actions that run when it ends."""
    _note_refused(walker, made, conditions, _OF_PROCESSES)
    children: list[LaunchAction] = []
    if made.name == "ComposableNodeContainer":
        children = walker.actions(made.get(-1, "composable_node_descriptions"), (), place_of(made))
    elif made.name not in _NODES:
        children = nested(walker, made)
    node = _started("node", "executable", walker, made, conditions)._replace(
        arguments=_given(walker, made, "arguments", "ros_arguments", "additional_env", "env"),
        children=tuple(children),
    )
    return [*_apart("executable", walker, made, node), *later(walker, made, "on_exit")]


def _component(walker: Walker, made: LaunchObject, conditions: Conditions) -> list[LaunchAction]:
    _note_refused(walker, made, conditions, _OF_COMPONENTS)
    return _apart("plugin", walker, made, _started("component", "plugin", walker, made, conditions))


def _started(
    kind: Literal["node", "component"], target: str, walker: Walker, made: LaunchObject, conditions: Conditions
) -> LaunchAction:
    """Return the fields that nodes and components share, by their current and their former keywords."""
    return LaunchAction(
        kind,
        place_of(made),
        package=walker.value(made, -1, "package"),
        target=walker.value(made, -1, target, f"node_{target}"),
        name=walker.value(made, -1, "name", "node_name"),
        namespace=walker.value(made, -1, "namespace", "node_namespace"),
        parameters=_parameters(walker, made),
        remappings=_remappings(walker, made),
        conditions=conditions,
        builtin_model=made.source.lent and not _is_handed(made.get(-1, "package")),
    )


def _is_handed(value: Value) -> bool:
    """Return whether the caller of a built-in helper passes the text, so that its place is in the caller."""
    return all(isinstance(one.value, Written) and not one.value.source.lent for one in alternatives(value))


def _apart(target: str, walker: Walker, made: LaunchObject, action: LaunchAction) -> list[LaunchAction]:
    return walker.apart(action, made.get(-1, target, f"node_{target}"), made.get(-1, "package"))


def _load(walker: Walker, made: LaunchObject, conditions: Conditions) -> list[LaunchAction]:
    children = walker.actions(made.get(0, "composable_node_descriptions"), (), place_of(made))
    target = made.get(1, "target_container")
    name = walker.value(made, 1, "target_container") if not isinstance(plain(target), LaunchObject) or is_text(target) else None
    return [LaunchAction("group", place_of(made), name=name, conditions=conditions, children=tuple(children))]


def _process(walker: Walker, made: LaunchObject, conditions: Conditions) -> list[LaunchAction]:
    command = made.get(0, "cmd")
    words = items(walker.machine, command) if command is not None else None
    places = _elements(made.written(0, "cmd"), len(words or ()))
    arguments = [("", walker.text(word, node, made.source)) for word, node in zip(words or (), places, strict=True)]
    target = arguments[0][1] if arguments else None
    process = LaunchAction(
        "process",
        place_of(made),
        target=target,
        arguments=(*arguments, *_given(walker, made, "additional_env", "env")),
        package_span=next((span for _, one in arguments if (span := walker.package_span(one))), None),
        conditions=conditions,
    )
    return [process, *later(walker, made, "on_exit")]


def _given(walker: Walker, made: LaunchObject, *names: str) -> tuple[tuple[str, LaunchValue], ...]:
    """Return the texts of some arguments, each a list or dictionary, and of ``prefix`` and ``cwd``."""
    found: list[tuple[str, LaunchValue]] = []
    for name in names:
        if name not in made.keywords:
            continue
        given = plain(made.keywords[name])
        node = made.written(-1, name)
        if isinstance(given, dict):
            pairs = [(f"${_key(key)}", value) for key, value in given.items()]
        else:
            word = "" if name in ("arguments", "ros_arguments") else name
            pairs = [(word, value) for value in items(walker.machine, given) or [given]]
        places = _elements(node, len(pairs))
        found += [(word, walker.text(plain(value), at, made.source)) for (word, value), at in zip(pairs, places, strict=True)]
    whole = [(name, value) for name in ("prefix", "cwd") if (value := walker.value(made, -1, name)) is not None]
    return (*found, *whole)


def _parameters(walker: Walker, made: LaunchObject) -> tuple[tuple[str, LaunchValue], ...]:
    found: list[tuple[str, LaunchValue]] = []
    if "parameters" not in made.keywords:
        return ()
    every = items(walker.machine, made.keywords["parameters"]) or [made.keywords["parameters"]]
    for given, node in zip(every, _elements(made.written(-1, "parameters"), len(every)), strict=True):
        for one in alternatives(given):
            parameters = _parameter(walker, one.value, node, made)
            if one.conditions:
                held = one.conditions
                parameters = [(name, value._replace(conditions=(*held, *value.conditions))) for name, value in parameters]
            found += parameters
    return tuple(found)


def _parameter(walker: Walker, value: Value, node: ast.expr, made: LaunchObject) -> list[tuple[str, LaunchValue]]:
    found: list[tuple[str, LaunchValue]] = []
    waiting = [("", value, node)]
    for _ in range(_MOST_PARAMETERS):
        if not waiting:
            break
        walker.machine.spend(_STEPS_A_PARAMETER)
        name, one, place = waiting.pop()
        if isinstance(one, dict):
            walker.machine.spend(len(one))
            names = [f"{name}.{key}" if name else _key(key) for key in one]
            waiting += reversed(list(zip(names, map(plain, one.values()), _elements(place, len(one)), strict=True)))
        elif isinstance(one, (list, tuple)) and not name and not all(_names_file(plain(part)) for part in one):
            walker.machine.spend(len(one))
            waiting += reversed([("", plain(inner), at) for inner, at in zip(one, _elements(place, len(one)), strict=True)])
        elif name:
            found.append((name, walker.text(_list(one), place, made.source)))
        else:
            # An unknown value is mostly a dictionary of parameters, and not a file.
            known = isinstance(one, (list, tuple)) or _names_file(one)
            name = "" if known else UNKNOWN
            found += [(name, value) for value in walker.each_text(one, place, made.source)]
    return found


def _elements(node: ast.expr, count: int) -> list[ast.expr]:
    """Return the expression of each item of a list or dictionary, ``node`` for each if not literal."""
    written: list[ast.expr] = []
    if isinstance(node, (ast.List, ast.Tuple)):
        written = [element if not isinstance(element, ast.Starred) else node for element in node.elts]
    elif isinstance(node, ast.Dict) and None not in node.keys:
        written = node.values
    return written if len(written) == count else [node] * count


def _names_file(value: Value) -> bool:
    """Return whether a value is a path or a part of one."""
    return isinstance(value, (str, FilePath)) or is_text(value)


def _list(value: Value) -> Value:
    """Return a list of texts in YAML notation, and any other value unchanged."""
    if not isinstance(value, (list, tuple)) or not all(isinstance(one, (str, int, float)) for one in value):
        return value
    return f"[{', '.join(map(str, value))}]"


def _key(key: Value) -> str:
    return str(texts(key)[0]) or "?"


def _remappings(walker: Walker, made: LaunchObject) -> tuple[tuple[LaunchValue, LaunchValue], ...]:
    found: list[tuple[LaunchValue, LaunchValue]] = []
    if "remappings" in made.keywords:
        node = made.written(-1, "remappings")
        for pair in items(walker.machine, made.keywords["remappings"]) or ():
            choices = [(items(walker.machine, one.value), one) for one in alternatives(pair)]
            pairs = [(parts, one.conditions) for parts, one in choices if parts is not None and len(parts) == 2]
            if pairs and len(pairs) == len(choices):
                first, second = (union(Guarded(parts[at], conditions) for parts, conditions in pairs) for at in (0, 1))
                found.append((walker.text(first, node, made.source), walker.text(second, node, made.source)))
            elif any(isinstance(one.value, str) if parts is None else len(parts) != 2 for parts, one in choices):
                walker.problems.append(Problem("remapping", "a remapping must be a pair of names", span_of(node, made.source)))
    return tuple(found)


def nested(walker: Walker, made: LaunchObject) -> list[LaunchAction]:
    """Return the actions among the arguments of an unknown class or function."""
    found: list[LaunchAction] = []
    for value in (*made.arguments, *made.keywords.values()):
        for one in alternatives(value):
            inner = one.value if isinstance(one.value, (list, tuple)) else [one.value]
            found += [
                action
                for each in inner
                if isinstance(plain(each), LaunchObject) and not is_text(each)
                for action in walker.actions(each, (*one.conditions, PERHAPS), place_of(made))
            ]
    return found


RULES: Mapping[str, Rule] = {
    "Node": started_node,
    "LifecycleNode": started_node,
    "ComposableNodeContainer": started_node,
    "ComposableNode": _component,
    "ComposableLifecycleNode": _component,
    "LoadComposableNodes": _load,
    "ExecuteProcess": _process,
    "ExecuteLocal": _process,
}
