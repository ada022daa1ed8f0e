"""Actions that a Python launch file starts at events, and actions that its functions return during the launch."""

from __future__ import annotations

import ast
from collections.abc import Iterable, Mapping

from ros_lint.collectors.launch.python.walker import ActionBuilder, Walker, place_of, span_of
from ros_lint.collectors.python.interpreter.alternatives import alternatives, plain
from ros_lint.collectors.python.interpreter.methods import items
from ros_lint.collectors.python.interpreter.values import (
    PERHAPS,
    Bound,
    Conditions,
    Context,
    Function,
    Instance,
    LaunchObject,
    Source,
    Unknown,
)
from ros_lint.collectors.symbolic_text import UNKNOWN, configuration
from ros_lint.facts.launch import OPENED, TIMER, LaunchAction, LaunchValue


def _timer(walker: Walker, launch_object: LaunchObject, conditions: Conditions) -> list[LaunchAction]:
    place, read = place_of(launch_object), _values_read(walker, launch_object)
    children = walker.actions(launch_object.get(-1, "actions"), (), place)
    period = walker.value(launch_object, -1, "period")
    trigger = LaunchValue((TIMER,), place)
    return [
        LaunchAction("later", place, name=trigger, value=period, arguments=read, conditions=conditions, children=tuple(children))
    ]


def _values_read(walker: Walker, launch_object: LaunchObject) -> tuple[tuple[str, LaunchValue], ...]:
    """Return the launch configurations that functions have read so far; their values may be in the actions of an event."""
    place = place_of(launch_object)
    return tuple([(name, LaunchValue((configuration(name),), place)) for name in walker.machine.read])


def _event(walker: Walker, launch_object: LaunchObject, conditions: Conditions) -> list[LaunchAction]:
    """Return the actions that a RegisterEventHandler starts: those in its handler, or the result of the handler's function."""
    actions: list[LaunchAction] = []
    read = _values_read(walker, launch_object)
    for alternative in alternatives(launch_object.get(0, "event_handler")):
        handler = alternative.value
        if isinstance(handler, Instance):
            handler = handler.made
        if isinstance(handler, LaunchObject):
            actions += _handler_actions(walker, handler)
    if not actions:
        return []
    place, handler = place_of(launch_object), plain(launch_object.get(0, "event_handler"))
    trigger = LaunchValue((handler.name if isinstance(handler, LaunchObject) else UNKNOWN,), place)
    return [LaunchAction("later", place, name=trigger, arguments=read, conditions=conditions, children=tuple(actions))]


def _handler_actions(walker: Walker, handler: LaunchObject) -> list[LaunchAction]:
    handler.seen = True
    actions: list[LaunchAction] = []
    targets = {"target_action", "matcher", "handle_once", "target_lifecycle_node", "start_state", "goal_state", "transition"}
    for name, argument in [*[("", alternative) for alternative in handler.arguments[1:]], *handler.keywords.items()]:
        if name in targets:
            continue
        for alternative in alternatives(argument):
            value = alternative.value
            if isinstance(value, (Function, Bound)):
                value = walker.run(value, [Unknown("an event"), Context()], {}, handler)
            actions += walker.actions(value, alternative.conditions, place_of(handler))
    return actions


def later(walker: Walker, launch_object: LaunchObject, *names: str) -> list[LaunchAction]:
    """Return the actions in the arguments ``names`` of an object such as a Node, which run at an event: ``on_exit=[action]``.

    Each argument may also be a function that returns the actions.
    """
    actions: list[LaunchAction] = []
    read = _values_read(walker, launch_object)
    for name in names:
        for alternative in alternatives(launch_object.get(-1, name)) if name in launch_object.keywords else ():
            value = alternative.value
            if isinstance(value, (Function, Bound)):
                value = walker.run(value, [Unknown("an event"), Context()], {}, launch_object)
            if value is not None and not isinstance(value, Unknown):
                actions += walker.actions(value, alternative.conditions, place_of(launch_object))
    place = place_of(launch_object)
    trigger = LaunchValue((names[0],), place)
    return [LaunchAction("later", place, name=trigger, arguments=read, children=tuple(actions))] if actions else []


def _opaque_function(walker: Walker, launch_object: LaunchObject, conditions: Conditions) -> list[LaunchAction]:
    arguments = items(walker.machine, launch_object.get(-1, "args")) if launch_object.get(-1, "args") is not None else []
    keywords = plain(launch_object.get(-1, "kwargs"))
    outer_conditions, variables = walker.machine.conditions, walker.machine.variables
    walker.machine.conditions, walker.machine.variables = (), []
    known_raises, known_reads, known_files = (len(walker.machine.raises), len(walker.machine.reads), len(walker.machine.opened))
    try:
        result = walker.run(
            launch_object.get(0, "function"),
            [Context(), *(arguments or [])],
            {str(k): v for k, v in keywords.items()} if isinstance(keywords, dict) else {},
            launch_object,
        )
    finally:
        walker.machine.conditions, assignments = outer_conditions, walker.machine.variables
        walker.machine.variables = variables
    # Its assignments may depend on arguments that are declared before it, not on later ones.
    actions = walker.actions(assignments, conditions, place_of(launch_object))
    actions += readings(walker.machine.reads[known_reads:], conditions)
    actions += readings(walker.machine.opened[known_files:], conditions, OPENED)
    actions += [
        LaunchAction("raise", span_of(node, source), description=_message(node), conditions=(*conditions, *inner))
        for node, source, inner in walker.machine.raises[known_raises:]
    ]
    return [*actions, *walker.actions(result, conditions, place_of(launch_object))] if result is not None else actions


def readings(
    reads: Iterable[tuple[str, ast.expr, Source, Conditions]], conditions: Conditions, what: str = ""
) -> list[LaunchAction]:
    """Return an action for each text that a program reads under ``conditions``: the path of a file if ``what`` is OPENED."""
    actions: dict[LaunchAction, None] = {}
    for text, node, source, inner in reads:
        if UNKNOWN in text:
            continue
        place = span_of(node, source)
        value = LaunchValue((str(text),), place)
        actions[LaunchAction("read", place, value=value, conditions=(*conditions, *inner), description=what)] = None
    return list(actions)[:_MOST_READINGS]


_MOST_READINGS = 200
"""The maximum number of launch configurations or files that a function reads. Real functions read up to 60."""


def _message(node: ast.Raise) -> str:
    """Return the message of the exception that a raise statement raises, "" if it is computed."""
    arguments = node.exc.args if isinstance(node.exc, ast.Call) else []
    return str(arguments[0].value) if len(arguments) == 1 and isinstance(arguments[0], ast.Constant) else ""


def _for_each(walker: Walker, launch_object: LaunchObject, conditions: Conditions) -> list[LaunchAction]:
    """Return the actions that the function of a ForEach returns. launch calls the function for each set of keyword values.

    The keyword values are unknown. The actions are under an unknown condition, because there may be no set at all.
    """
    function = plain(launch_object.get(1, "function"))
    spec = function.node.args if isinstance(function, Function) else None
    names = [argument.arg for argument in (*spec.args, *spec.kwonlyargs)] if spec else []
    result = walker.run(
        function, [], dict.fromkeys([*names, UNKNOWN], Unknown(f"a value of {launch_object.name}")), launch_object
    )
    return walker.actions(result, (*conditions, PERHAPS), place_of(launch_object))


BUILDERS: Mapping[str, ActionBuilder] = {
    "TimerAction": _timer,
    "ROSTimer": _timer,
    "RosTimer": _timer,
    "RegisterEventHandler": _event,
    "OpaqueFunction": _opaque_function,
    "ForEach": _for_each,
    "ForLoop": _for_each,
}
