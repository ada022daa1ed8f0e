"""Errors that Python and the launch libraries raise when a launch file runs.

- A name that is not defined.
- A substitution used as a text.
- A number where launch takes texts.
- A function where launch takes a condition.
"""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator, Mapping
from typing import TYPE_CHECKING

from ros_lint.collectors.launch.python.import_checks import ACTIONS
from ros_lint.collectors.launch.python.substitutions import is_text
from ros_lint.collectors.launch.python.walker import span_of
from ros_lint.collectors.python.interpreter.recorder import are_unknown
from ros_lint.collectors.python.interpreter.values import Function, LaunchObject
from ros_lint.collectors.python.string_values import callee
from ros_lint.collectors.python.unbound_names import tried, unbound
from ros_lint.facts.visibility import Problem

if TYPE_CHECKING:
    from ros_lint.collectors.python.interpreter.recorder import How, Misused
    from ros_lint.collectors.python.interpreter.values import Source, Value


def undefined(tree: ast.Module, source: Source, met: Iterable[tuple[ast.Name, Source]]) -> Iterator[Problem]:
    """Yield those of the unbound names that certainly raise NameError."""
    for node in unbound(tree, [node for node, where in met if where is source]):
        yield Problem("undefined-name", f"'{node.id}' is not defined", span_of(node, source))


_SAY: Mapping[How, tuple[str, str]] = {
    "added": ("substitution-refused", "a {name} cannot be added to a string; write a list of both, [a, b]"),
    "joined": ("substitution-refused", "os.path.join() does not accept a {name}; use PathJoinSubstitution([a, b])"),
    "formatted": (
        "substitution-as-text",
        "a {name} has no value before launch, so it cannot be formatted here; write a list, ['a', {name}(...)]",
    ),
    "compared": ("substitution-as-text", "a {name} never equals a string; use EqualsSubstitution(a, b) or perform(context)"),
    "tested": ("substitution-as-text", "a {name} is always true in Python; use IfCondition(a) or perform(context)"),
    "combined": ("substitution-as-text", "Python uses only one of the two conditions here; write {way}"),
}
_JOINED = "Python uses only one of the two substitutions here; write {joined}Substitution(a, b)"
_DECIDED = "a {name} is always true in Python; pass it to condition=, or use evaluate(context)"
_TELLS = frozenset({"print", "debug", "info", "warning", "warn", "error", "LogInfo"})
"""Calls whose texts only humans read."""


def misused(tree: ast.Module, source: Source, noted: Iterable[Misused]) -> Iterator[Problem]:
    """Yield the problems of misused substitutions in a module, at most one for each line."""
    noted = [one for one in noted if one.source is source]
    if not noted:
        return
    spared, functions, compared = _spared(tree), _functions(tree), _compared(tree)
    combined = [node for node in ast.walk(tree) if isinstance(node, ast.BoolOp)]
    decided = {inner for node in ast.walk(tree) if isinstance(node, (ast.If, ast.IfExp)) for inner in ast.walk(node.test)}
    joined = {value: "Or" if isinstance(node.op, ast.Or) else "And" for node in combined for value in node.values}
    reported: set[int] = set()
    for one in noted:
        if one.node in spared or one.node.lineno in reported:
            continue
        # A function that receives a substitution may test whether it is None.
        if one.how in ("tested", "combined") and not _same_function(one, functions):
            continue
        reported.add(one.node.lineno)
        kind, message = _SAY["compared" if one.how == "formatted" and one.node in compared else one.how]
        if one.how == "combined" and one.node in decided:
            message = _DECIDED
        elif one.how == "tested" and one.node in joined and one.node not in decided:
            message = _JOINED
        said = message.format(name=one.made.name, way=_way(one, combined), joined=joined.get(one.node, ""))
        yield Problem(kind, said, span_of(one.node, source))


def _way(one: Misused, combined: Iterable[ast.BoolOp]) -> str:
    """Return the replacement for ``and`` or ``or`` of two conditions, according to the kinds of both."""
    both = next((node for node in combined if one.node in node.values), None)
    kinds = [callee(value) if isinstance(value, ast.Call) else "" for value in both.values[:2]] if both else []
    either = both is not None and isinstance(both.op, ast.Or)
    if kinds == ["UnlessCondition"] * 2:
        return f"UnlessCondition({'And' if either else 'Or'}Substitution(a, b))"
    words = [f"NotSubstitution({word})" if kind == "UnlessCondition" else word for kind, word in zip(kinds, "ab", strict=False)]
    return f"IfCondition({'Or' if either else 'And'}Substitution({', '.join(words or 'ab')}))"


def _spared(tree: ast.Module) -> set[ast.AST]:
    """Return the nodes where an error is caught, or where it only changes a message for humans."""
    found: set[ast.AST] = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Try):
            found.update(tried(node))
        elif isinstance(node, ast.Call) and callee(node) in _TELLS:
            found.update(ast.walk(node))
    return found


def _compared(tree: ast.Module) -> set[ast.AST]:
    """Return all nodes in comparisons: a text that is compared is not launched."""
    compares = (node for node in ast.walk(tree) if isinstance(node, ast.Compare))
    return {inner for node in compares for inner in ast.walk(node)}


def _functions(tree: ast.Module) -> list[ast.FunctionDef | ast.AsyncFunctionDef]:
    return [node for node in ast.walk(tree) if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef))]


def _same_function(one: Misused, functions: Iterable[ast.FunctionDef | ast.AsyncFunctionDef]) -> bool:
    """Return whether a substitution is created in the body of the function that tests it."""
    if one.made.source is not one.source:
        return False
    return all(_holds(function, one.node) == _holds(function, one.made.node) for function in functions)


def _holds(function: ast.FunctionDef | ast.AsyncFunctionDef, node: ast.expr) -> bool:
    last = function.body[-1]
    return function.body[0].lineno <= node.lineno <= (last.end_lineno or last.lineno)


_WHERE: Mapping[str, tuple[tuple[int, str], ...]] = {
    **dict.fromkeys(("IfCondition", "UnlessCondition"), ((0, "predicate_expression"),)),
    **dict.fromkeys(("SetLaunchConfiguration", "SetEnvironmentVariable", "AppendEnvironmentVariable"), ((1, "value"),)),
    **dict.fromkeys(("Node", "LifecycleNode"), ((-1, "arguments"), (-1, "ros_arguments"), (-1, "remappings"))),
    "DeclareLaunchArgument": ((-1, "default_value"),),
    "ExecuteProcess": ((-1, "cmd"),),
    "IncludeLaunchDescription": ((1, "launch_arguments"),),
    "LaunchConfiguration": ((0, "variable_name"),),
    "PathJoinSubstitution": ((0, "substitutions"),),
    "PythonExpression": ((0, "expression"),),
    "PushRosNamespace": ((0, "namespace"),),
}
"""The arguments that must be texts or substitutions (``normalize_to_list_of_substitutions``)."""


def not_text(tree: ast.Module, source: Source, made: Iterable[LaunchObject]) -> Iterator[Problem]:
    """Yield numbers, booleans and actions given as a text, and launch_arguments given as a dictionary."""
    found: list[tuple[str, ast.expr]] = []
    for one in made:
        for position, name in _WHERE.get(one.name, ()) if one.source is source and not are_unknown(one.conditions) else ():
            value = one.get(position, name)
            if name == "launch_arguments" and not one.seen:
                continue  # the arguments are evaluated only if the include is launched
            if name == "launch_arguments" and isinstance(value, dict):
                found.append(("launch_arguments must be pairs; write .items()", one.written(position, name)))
            elif (odd := _odd_in(value)) is not None:
                message = f"'{name}' of {one.name} must consist of strings and substitutions{_instead(odd, one)}"
                found.append((message, one.written(position, name)))
    spared = _spared(tree) if found else set()
    for message, node in found:
        if node not in spared:
            yield Problem("no-text", message, span_of(node, source))


def not_condition(tree: ast.Module, source: Source, made: Iterable[LaunchObject]) -> Iterator[Problem]:
    """Yield values given as a condition that have no evaluate(), which launch calls."""
    found: list[tuple[str, ast.expr]] = []
    for one in made:
        if one.name not in ACTIONS or one.source is not source or not one.seen or are_unknown(one.conditions):
            continue
        given = one.get(-1, "condition")
        if isinstance(given, Function):
            found.append(("a function; use IfCondition(...) or Condition(predicate=...)", one.written(-1, "condition")))
        elif isinstance(given, LaunchObject) and is_text(given):
            found.append((f"a {given.name}; use IfCondition(...)", one.written(-1, "condition")))
        elif isinstance(given, (bool, str)):
            found.append((f"{given!r}; use IfCondition('{given}')", one.written(-1, "condition")))
    spared = _spared(tree) if found else set()
    for message, node in found:
        if node not in spared:
            yield Problem("no-condition", f"'condition' cannot be {message}", span_of(node, source))


def _odd_in(value: Value) -> bool | int | float | LaunchObject | None:
    """Return the first number or action that is the value or is in its lists."""
    waiting = [value]
    for _ in range(_MOST_ITEMS):
        if not waiting:
            break
        one = waiting.pop()
        if isinstance(one, (bool, int, float)) or (isinstance(one, LaunchObject) and one.name in ACTIONS):
            return one
        if isinstance(one, (list, tuple)):
            waiting += one
    return None


def _instead(odd: bool | int | float | LaunchObject, taken: LaunchObject) -> str:
    """Return the end of the message about a value that is not a text."""
    if not isinstance(odd, LaunchObject):
        return f"; write '{odd}' instead of {odd}"
    name = odd.get(0, "name") if odd.name == "DeclareLaunchArgument" else None
    if not isinstance(name, str):
        return f", not {odd.name}"
    return f", not {odd.name}; write " + (
        f"'{name}'" if taken.name == "LaunchConfiguration" else f"LaunchConfiguration('{name}')"
    )


_MOST_ITEMS = 200
