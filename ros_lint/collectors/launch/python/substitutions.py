"""Conversion of the substitutions in Python launch files to symbolic texts.

In a symbolic text, special characters stand for the parts that are known only when the launch file runs.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from ros_lint.base.budget import Budget
from ros_lint.collectors import symbolic_text
from ros_lint.collectors.conditional_text import distinct, joined
from ros_lint.collectors.python.interpreter.alternatives import alternatives, plain, under
from ros_lint.collectors.python.interpreter.values import (
    PERHAPS,
    Conditions,
    FilePath,
    Guarded,
    Instance,
    LaunchObject,
    Union,
    Value,
    environment,
)
from ros_lint.collectors.symbolic_text import OWN_FOLDER, UNKNOWN, join_path, quoted
from ros_lint.facts.launch import LaunchCondition

_MAX_DEPTH = 60
_MAX_STEPS = 2_000


class TextEvaluation:
    """The depth, remaining steps and known results of one evaluation of a value to its possible texts.

    Depth and steps are limited, because objects can contain each other or occur many times.
    """

    __slots__ = ("budget", "depth", "of_file", "results")

    def __init__(self, of_file: Budget | None = None) -> None:
        """Start an evaluation. Its steps are also charged to the budget ``of_file``, which may raise BudgetExceeded."""
        self.depth = 0
        self.budget = Budget(_MAX_STEPS)
        self.of_file = of_file
        self.results: dict[int, tuple[Value, tuple[str, ...]]] = {}


def texts(value: Value, evaluation: TextEvaluation | None = None) -> tuple[str, ...]:
    """Return every text that a value can have after launch performs its substitutions. Lists are concatenated.

    Special characters in the texts stand for the parts that are known only when the launch file runs.
    """
    if isinstance(value, str):
        return (str(value),)  # a plain str, so that facts contain no objects of the interpreter
    if evaluation is None:
        evaluation = TextEvaluation()
    cached = evaluation.results.get(id(value))
    if cached is not None:
        return cached[1]
    if evaluation.depth > _MAX_DEPTH or not evaluation.budget.affords():
        return (UNKNOWN,)
    if evaluation.of_file is not None:
        evaluation.of_file.step(3)
    evaluation.depth += 1
    result = _evaluate(value, evaluation)
    evaluation.depth -= 1
    evaluation.results[id(value)] = (value, result)
    return result


def _evaluate(value: Value, evaluation: TextEvaluation) -> tuple[str, ...]:
    if not isinstance(value, (Union, Guarded)):
        single = _evaluate_single(value, evaluation)
        if len(single) == 1:
            return single
    result = distinct(
        text for choice in alternatives(value) for text in under(_evaluate_single(choice.value, evaluation), choice.conditions)
    )
    return result if 0 < len(result) <= symbolic_text.MOST else (UNKNOWN,)


def _evaluate_single(value: Value, evaluation: TextEvaluation) -> tuple[str, ...]:
    if isinstance(value, str):
        return (str(value),)
    if isinstance(value, FilePath):
        return (value.text,)
    if value is None or isinstance(value, (bool, int, float)):
        return (str(value),)
    if isinstance(value, (list, tuple)):
        return joined([texts(part, evaluation) for part in value], "".join)
    if isinstance(value, Instance):
        value = value.made
    if isinstance(value, LaunchObject):
        reader = _READERS.get(value.name)
        if reader is not None:
            return reader(value, evaluation)
        if value.name.endswith("LaunchDescriptionSource"):
            return texts(value.get(0, "launch_file_path", "location", "launch_description"), evaluation)
    return (UNKNOWN,)


def _configuration(launch_object: LaunchObject, evaluation: TextEvaluation) -> tuple[str, ...]:
    names = texts(launch_object.get(0, "variable_name"), evaluation)
    default = launch_object.get(1, "default")
    defaults: tuple[str | None, ...] = (None,) if default is None else texts(default, evaluation)
    return tuple(symbolic_text.configuration(name, value) for name in names for value in defaults)


def _environment(launch_object: LaunchObject, evaluation: TextEvaluation) -> tuple[str, ...]:
    names = texts(launch_object.get(0, "name"), evaluation)
    default = launch_object.get(1, "default_value")
    defaults: tuple[str | None, ...] = (None,) if default is None else texts(default, evaluation)
    return tuple(environment(name, value) for name in names for value in defaults)


def _path(launch_object: LaunchObject, evaluation: TextEvaluation) -> tuple[str, ...]:
    parts = plain(launch_object.get(0, "substitutions", "path"))
    if not isinstance(parts, (list, tuple)):
        return texts(parts, evaluation)
    return joined([texts(part, evaluation) for part in parts], join_path)


def _share(launch_object: LaunchObject, evaluation: TextEvaluation) -> tuple[str, ...]:
    return joined([texts(launch_object.get(0, "package"), evaluation)], lambda row: symbolic_text.share(row[0]))


def _prefix(launch_object: LaunchObject, evaluation: TextEvaluation) -> tuple[str, ...]:
    return joined([texts(launch_object.get(0, "package"), evaluation)], lambda row: symbolic_text.prefix(row[0]))


def _in_package(launch_object: LaunchObject, evaluation: TextEvaluation) -> tuple[str, ...]:
    names = texts(launch_object.get(0, "executable"), evaluation)
    packages = texts(launch_object.get(1, "package"), evaluation)
    return joined([packages, names], lambda row: f"{symbolic_text.prefix(row[0])}/lib/{row[0]}/{row[1]}")


def _inner(*names: str) -> Callable[[LaunchObject, TextEvaluation], tuple[str, ...]]:
    return lambda launch_object, evaluation: texts(launch_object.get(0, *names), evaluation)


def _expression(launch_object: LaunchObject, evaluation: TextEvaluation) -> tuple[str, ...]:
    return joined([texts(launch_object.get(0, "expression"), evaluation)], lambda row: symbolic_text.expression(row[0]))


def _command(launch_object: LaunchObject, evaluation: TextEvaluation) -> tuple[str, ...]:
    return joined([texts(launch_object.get(0, "command"), evaluation)], lambda row: symbolic_text.command(row[0]))


def _choice(launch_object: LaunchObject, evaluation: TextEvaluation) -> tuple[str, ...]:
    parts = (launch_object.get(0, "condition"), launch_object.get(1, "if_value") or "", launch_object.get(2, "else_value") or "")
    return joined(
        [texts(part, evaluation) for part in parts],
        lambda row: symbolic_text.expression(f"_if({', '.join(quoted(text) for text in row)})"),
    )


def _join(launch_object: LaunchObject, evaluation: TextEvaluation) -> tuple[str, ...]:
    parts = plain(launch_object.get(0, "substitutions"))
    delimiter = launch_object.get(1, "delimiter")
    if not isinstance(parts, (list, tuple)):
        return (UNKNOWN,)
    rows = [texts(delimiter or "", evaluation), *[texts(part, evaluation) for part in parts]]
    return joined(rows, lambda row: row[0].join(row[1:]))


def _logic(name: str) -> Callable[[LaunchObject, TextEvaluation], tuple[str, ...]]:
    """Return the function that converts a logical substitution, such as AndSubstitution, to its possible texts.

    Each text is a call of the function ``name`` in ``ros_lint.collectors.launch.expressions``, such as ``_and(a, b)``.
    """

    def read(launch_object: LaunchObject, evaluation: TextEvaluation) -> tuple[str, ...]:
        parts: list[Any] = [*launch_object.arguments, *launch_object.keywords.values()]
        return joined(
            [texts(part, evaluation) for part in parts],
            lambda row: symbolic_text.expression(f"{name}({', '.join(quoted(text) for text in row)})"),
        )

    return read


_READERS: Mapping[str, Callable[[LaunchObject, TextEvaluation], tuple[str, ...]]] = {
    "LaunchConfiguration": _configuration,
    "LaunchConfigAsBool": _configuration,
    "EnvironmentVariable": _environment,
    "PathJoinSubstitution": _path,
    "PathSubstitution": _path,
    "FindPackageShare": _share,
    "FindPackagePrefix": _prefix,
    "FindPackage": _prefix,
    "ExecutableInPackage": _in_package,
    "ThisLaunchFileDir": lambda launch_object, evaluation: (OWN_FOLDER,),
    "ThisLaunchFile": lambda launch_object, evaluation: (f"{OWN_FOLDER}/{UNKNOWN}",),
    "TextSubstitution": _inner("text"),
    "PythonExpression": _expression,
    "Command": _command,
    "FindExecutable": _inner("name"),
    "IfElseSubstitution": _choice,
    "StringJoinSubstitution": _join,
    "EqualsSubstitution": _logic("_equals"),
    "NotEqualsSubstitution": _logic("_not_equals"),
    "NotSubstitution": _logic("_not"),
    "AndSubstitution": _logic("_and"),
    "OrSubstitution": _logic("_or"),
    "AllSubstitution": _logic("_and"),
    "AnySubstitution": _logic("_or"),
    "ParameterFile": _inner("param_file"),
    "ParameterValue": _inner("value"),
    "RewrittenYaml": _inner("source_file"),
    "ReplaceString": _inner("source_file"),
}

SUBSTITUTIONS = frozenset(_READERS) | {"AnonName", "Parameter", "FileContent", "LocalSubstitution", "LaunchLogDir"}
"""Names of the classes whose objects represent a text."""


def is_text(value: Value) -> bool:
    """Return whether a value is an object of a substitution class."""
    launch_object = plain(value)
    return isinstance(launch_object, LaunchObject) and launch_object.name in SUBSTITUTIONS


_PREDICATE_CONDITIONS = frozenset({"IfCondition", "UnlessCondition"})
_COMPARISON_CONDITIONS = frozenset({"LaunchConfigurationEquals", "LaunchConfigurationNotEquals"})
CONDITIONS = _PREDICATE_CONDITIONS | _COMPARISON_CONDITIONS
"""Names of the classes whose objects are conditions."""


def conditions_of(value: Value, evaluation: TextEvaluation | None = None) -> Conditions:
    """Return the conditions that the value of an action's argument ``condition`` represents.

    The value is an IfCondition, UnlessCondition, LaunchConfigurationEquals or LaunchConfigurationNotEquals. Any other value
    represents an unknown condition.
    """
    conditions: list[LaunchCondition] = []
    for alternative in alternatives(value):
        launch_object = alternative.value
        if isinstance(launch_object, LaunchObject) and launch_object.name in _PREDICATE_CONDITIONS:
            predicates = tuple(map(str, texts(launch_object.get(0, "predicate_expression"), evaluation)))
            conditions.append(LaunchCondition(predicates, None, launch_object.name == "IfCondition"))
        elif isinstance(launch_object, LaunchObject) and launch_object.name in _COMPARISON_CONDITIONS:
            names = texts(launch_object.get(0, "launch_configuration_name"), evaluation)
            values = texts(launch_object.get(1, "expected_value"), evaluation)
            if len(names) != 1 or len(values) != 1:
                return (PERHAPS,)
            equal = launch_object.name == "LaunchConfigurationEquals"
            conditions.append(LaunchCondition((symbolic_text.configuration(names[0]),), str(values[0]), equal))
        else:
            return (PERHAPS,)
    return tuple(conditions) if len(conditions) == 1 else (PERHAPS,)
