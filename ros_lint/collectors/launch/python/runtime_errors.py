"""Errors that Python and the launch libraries raise when a Python launch file runs.

- A name that is not defined.
- A substitution that is used as a text.
- A text that is divided by a text, as if it were a path of pathlib.
- A number where launch accepts only texts.
- A function where launch expects a condition.
"""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator, Mapping
from typing import TYPE_CHECKING

from ros_lint.collectors.launch.python.import_checks import ACTIONS
from ros_lint.collectors.launch.python.signatures import all_signatures
from ros_lint.collectors.launch.python.substitutions import CONDITIONS, is_text
from ros_lint.collectors.launch.python.walker import span_of
from ros_lint.collectors.python.interpreter.recorder import are_unknown
from ros_lint.collectors.python.interpreter.values import Function, LaunchObject
from ros_lint.collectors.python.string_values import callee
from ros_lint.collectors.python.unbound_names import tried, unbound
from ros_lint.facts.visibility import Problem

if TYPE_CHECKING:
    from ros_lint.collectors.python.interpreter.recorder import How, Misused
    from ros_lint.collectors.python.interpreter.values import Source, Value


def undefined_names(tree: ast.Module, source: Source, names: Iterable[tuple[ast.Name, Source]]) -> Iterator[Problem]:
    """Yield a problem for each of ``names`` that certainly raises NameError.

    ``names`` are the names without a value in the interpretation of the file.
    """
    for node in unbound(tree, [node for node, module in names if module is source]):
        yield Problem("undefined-name", f"'{node.id}' is not defined", span_of(node, source))


_MESSAGES: Mapping[How, tuple[str, str]] = {
    "added": ("substitution-refused", "a {name} cannot be added to a string; write a list of both, [a, b]"),
    "joined": ("substitution-refused", "os.path.join() does not accept a {name}; use PathJoinSubstitution([a, b])"),
    "formatted": (
        "substitution-as-text",
        "a {name} has no value before launch, so it cannot be formatted here; write a list, ['a', {name}(...)]",
    ),
    "compared": (
        "substitution-as-text",
        "a {name} never equals a string; compare with EqualsSubstitution(a, b), or get its value with perform(context)",
    ),
    "tested": (
        "substitution-as-text",
        "a {name} is always true in Python; pass an IfCondition to condition=, or get its value with perform(context)",
    ),
    "combined": (
        "substitution-as-text",
        "Python uses only the {used} of the conditions joined by '{word}', so the others are ignored; write {way}",
    ),
}
_JOINED_MESSAGE = (
    "Python uses only the {used} of the substitutions joined by '{word}', so the others are ignored; "
    "write {joined}Substitution(a, b)"
)
_DECIDED_MESSAGE = "a {name} is always true in Python; pass it to condition=, or get its value with evaluate(context)"
_LOGGING_CALLS = frozenset({"print", "debug", "info", "warning", "warn", "error", "LogInfo"})
"""Names of functions that print or log their arguments."""


def misused_substitutions(tree: ast.Module, source: Source, misuses: Iterable[Misused]) -> Iterator[Problem]:
    """Yield a problem for each substitution or condition that a module uses as a string or truth value.

    At most one problem is reported for each line. Uses in ``try`` blocks and in arguments of logging calls are omitted.
    """
    misuses = [misuse for misuse in misuses if misuse.source is source]
    if not misuses:
        return
    ignored, functions, compared = _ignored_nodes(tree), _functions(tree), _compared(tree)
    combined = [node for node in ast.walk(tree) if isinstance(node, ast.BoolOp)]
    in_condition = {inner for node in ast.walk(tree) if isinstance(node, (ast.If, ast.IfExp)) for inner in ast.walk(node.test)}
    operators = {value: "Or" if isinstance(node.op, ast.Or) else "And" for node in combined for value in node.values}
    reported: set[int] = set()
    for misuse in misuses:
        if misuse.node in ignored or misuse.node.lineno in reported:
            continue
        # A function that receives a substitution may test whether it is None.
        if misuse.how in ("tested", "combined") and not _same_function(misuse, functions):
            continue
        reported.add(misuse.node.lineno)
        kind, message = _MESSAGES["compared" if misuse.how == "formatted" and misuse.node in compared else misuse.how]
        if misuse.how == "combined" and misuse.node in in_condition:
            message = _DECIDED_MESSAGE
        elif misuse.how == "tested" and misuse.node in operators and misuse.node not in in_condition:
            message = _JOINED_MESSAGE
        joined = operators.get(misuse.node, "")
        text = message.format(
            name=misuse.made.name,
            way=_replacement(misuse, combined),
            joined=joined,
            word=joined.lower(),
            used="first" if joined == "Or" else "last",
        )
        yield Problem(kind, text, span_of(misuse.node, source))


_TEXT_PATHS: Mapping[str, str] = {
    "get_package_share_directory": "get_package_share_path()",
    "get_package_prefix": "Path(get_package_prefix(...))",
}
"""Functions of ament_index_python that return a path as a string, each with an expression that is a path of pathlib."""


def divided_texts(tree: ast.Module, source: Source, divisions: Iterable[tuple[ast.expr, Source]]) -> Iterator[Problem]:
    """Yield a problem for each operation ``text / text`` of a module, which raises TypeError."""
    nodes = dict.fromkeys(node for node, module in divisions if module is source)
    ignored = _ignored_nodes(tree) if nodes else set()
    for node in nodes:
        left = node.left if isinstance(node, ast.BinOp) else None
        name = callee(left) if isinstance(left, ast.Call) else ""
        if node in ignored:
            continue
        if name in _TEXT_PATHS:
            message = f"{name}() returns a string, and a string has no operator '/'; use {_TEXT_PATHS[name]}"
        else:
            message = "a string has no operator '/'; use Path(a) / b or os.path.join(a, b)"
        yield Problem("text-divided", message, span_of(node, source))


def _replacement(misuse: Misused, combined: Iterable[ast.BoolOp]) -> str:
    """Return the correct code for two conditions that are joined by ``and`` or ``or``.

    ``IfCondition(a) and IfCondition(b)`` -> ``IfCondition(AndSubstitution(a, b))``
    """
    junction = next((node for node in combined if misuse.node in node.values), None)
    kinds = [callee(value) if isinstance(value, ast.Call) else "" for value in junction.values[:2]] if junction else []
    is_or = junction is not None and isinstance(junction.op, ast.Or)
    if kinds == ["UnlessCondition"] * 2:
        return f"UnlessCondition({'And' if is_or else 'Or'}Substitution(a, b))"
    words = [f"NotSubstitution({word})" if kind == "UnlessCondition" else word for kind, word in zip(kinds, "ab", strict=False)]
    return f"IfCondition({'Or' if is_or else 'And'}Substitution({', '.join(words or 'ab')}))"


def _ignored_nodes(tree: ast.Module, calls: frozenset[str] = _LOGGING_CALLS) -> set[ast.AST]:
    """Return the syntax nodes in ``try`` blocks, where errors are caught, and in the arguments of logging calls."""
    result: set[ast.AST] = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Try):
            result.update(tried(node))
        elif isinstance(node, ast.Call) and callee(node) in calls:
            result.update(ast.walk(node))
    return result


def _compared(tree: ast.Module) -> set[ast.AST]:
    """Return all syntax nodes in comparisons.

    A substitution that is formatted in a comparison is only compared, and not launched.
    """
    compares = (node for node in ast.walk(tree) if isinstance(node, ast.Compare))
    return {inner for node in compares for inner in ast.walk(node)}


def _functions(tree: ast.Module) -> list[ast.FunctionDef | ast.AsyncFunctionDef]:
    return [node for node in ast.walk(tree) if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef))]


def _same_function(misuse: Misused, functions: Iterable[ast.FunctionDef | ast.AsyncFunctionDef]) -> bool:
    """Return whether a substitution is created and used as a truth value in one function, or entirely outside of functions."""
    if misuse.made.source is not misuse.source:
        return False
    return all(_contains(function, misuse.node) == _contains(function, misuse.made.node) for function in functions)


def _contains(function: ast.FunctionDef | ast.AsyncFunctionDef, node: ast.expr) -> bool:
    last = function.body[-1]
    return function.body[0].lineno <= node.lineno <= (last.end_lineno or last.lineno)


_TEXT_ARGUMENTS: Mapping[str, tuple[tuple[int, str], ...]] = {
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
"""By class: the arguments (position and name) that must be texts (``normalize_to_list_of_substitutions``).

The position is -1 for a keyword-only argument.
"""


_ACCEPTED = frozenset(
    {"deprecated_reason", "description", "goal_state", "launch_configuration_name", "location", "method"}
    | {"output_format", "reason", "start_state", "transition"}
)
"""Arguments that are annotated as texts, but accept other values, or are not evaluated when the file is launched."""
_UNCHECKED = frozenset({("DeclareBooleanLaunchArgument", "name"), ("DeclareLaunchArgument", "name"), ("ForLoop", "name")})
"""Classes and arguments that are annotated as texts, but accept other values."""


def _text_arguments(launch_object: LaunchObject) -> Iterable[tuple[int, str]]:
    """Return the arguments of a launch object that must be texts: position (-1 for keyword-only arguments) and name.

    A launch object is an object of a launch class.
    """
    signature = all_signatures().get(launch_object.name)
    pairs = list(_TEXT_ARGUMENTS.get(launch_object.name, ()))
    for name, kind in signature.kinds.items() if signature is not None else ():
        if kind == "text" and name not in _ACCEPTED and (launch_object.name, name) not in _UNCHECKED:
            pairs.append((signature.position(name) if signature is not None else -1, name))
    return dict.fromkeys(pairs)


def wrong_texts(tree: ast.Module, source: Source, launch_objects: Iterable[LaunchObject]) -> Iterator[Problem]:
    """Yield a problem for each number, boolean, action, condition or parameter in an argument that must be a text.

    A dictionary as ``launch_arguments`` is a problem, too.
    """
    errors: list[tuple[str, ast.expr]] = []
    for launch_object in launch_objects:
        for position, name in (
            _text_arguments(launch_object) if launch_object.source is source and not are_unknown(launch_object.conditions) else ()
        ):
            value = launch_object.get(position, name)
            if name == "launch_arguments" and not launch_object.seen:
                continue  # the arguments are evaluated only if the include is launched
            if name == "launch_arguments" and isinstance(value, dict):
                errors.append(("'launch_arguments' must be pairs; write .items()", launch_object.written(position, name)))
            elif (wrong_item := _first_wrong_item(value)) is not None:
                hint = _replacement_hint(wrong_item, launch_object)
                message = f"'{name}' of {launch_object.name} must consist of strings and substitutions{hint}"
                errors.append((message, launch_object.written(position, name)))
    ignored = _ignored_nodes(tree, _LOGGING_CALLS - {"LogInfo"}) if errors else set()
    for message, node in errors:
        if node not in ignored:
            yield Problem("no-text", message, span_of(node, source))


def wrong_conditions(tree: ast.Module, source: Source, launch_objects: Iterable[LaunchObject]) -> Iterator[Problem]:
    """Yield a problem for each argument ``condition`` that has no method evaluate(), because launch calls this method."""
    errors: list[tuple[str, ast.expr]] = []
    for launch_object in launch_objects:
        if (
            launch_object.name not in ACTIONS
            or launch_object.source is not source
            or not launch_object.seen
            or are_unknown(launch_object.conditions)
        ):
            continue
        condition = launch_object.get(-1, "condition")
        if isinstance(condition, Function):
            errors.append(
                ("a function; use IfCondition(...) or Condition(predicate=...)", launch_object.written(-1, "condition"))
            )
        elif isinstance(condition, LaunchObject) and is_text(condition):
            errors.append((f"a {condition.name}; use IfCondition(...)", launch_object.written(-1, "condition")))
        elif isinstance(condition, (bool, str)):
            errors.append((f"{condition!r}; use IfCondition('{condition}')", launch_object.written(-1, "condition")))
    ignored = _ignored_nodes(tree) if errors else set()
    for message, node in errors:
        if node not in ignored:
            yield Problem("no-condition", f"'condition' cannot be {message}", span_of(node, source))


_NO_TEXTS = ACTIONS | CONDITIONS | {"ComposableNode", "ParameterFile", "ParameterValue"}
"""Classes of the launch libraries whose objects are no substitutions."""


def _first_wrong_item(value: Value) -> bool | int | float | LaunchObject | None:
    """Return an item that is no text in an argument that must be a text, or in its nested lists, None if there is none."""
    pending = [value]
    for _ in range(_MAX_ITEMS):
        if not pending:
            break
        item = pending.pop()
        if isinstance(item, (bool, int, float)) or (isinstance(item, LaunchObject) and item.name in _NO_TEXTS):
            return item
        if isinstance(item, (list, tuple)):
            pending += item
    return None


def _replacement_hint(wrong_item: bool | int | float | LaunchObject, receiver: LaunchObject) -> str:
    """Return the end of the message about a value that must be a text: the correct code."""
    if not isinstance(wrong_item, LaunchObject):
        return f"; write '{wrong_item}' instead of {wrong_item}"
    name = wrong_item.get(0, "name") if wrong_item.name == "DeclareLaunchArgument" else None
    if not isinstance(name, str):
        return f", not {wrong_item.name}"
    return f", not {wrong_item.name}; write " + (
        f"'{name}'" if receiver.name == "LaunchConfiguration" else f"LaunchConfiguration('{name}')"
    )


_MAX_ITEMS = 200
