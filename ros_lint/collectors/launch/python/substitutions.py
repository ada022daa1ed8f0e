"""The symbolic texts of substitutions in Python launch files."""

from __future__ import annotations

import posixpath
from collections.abc import Callable, Mapping
from typing import Any

from ros_lint.collectors import symbolic_text as launch_text
from ros_lint.collectors.python.interpreter.values import (
    PERHAPS,
    Conditions,
    FilePath,
    Guarded,
    Instance,
    LaunchObject,
    Union,
    Value,
    alternatives,
    environment,
    plain,
    under,
)
from ros_lint.collectors.symbolic_text import OWN_FOLDER, UNKNOWN, distinct, joined, quoted
from ros_lint.facts.launch import LaunchCondition

_DEEPEST = 60
_MOST_STEPS = 2_000


class Within:
    """The state of one computation of texts.

    Its depth and steps are limited, because objects can contain each other or occur in one many times.
    """

    __slots__ = ("depth", "known", "left", "spend")

    def __init__(self, spend: Callable[[int], None] = lambda steps: None) -> None:
        """Start a computation. ``spend`` is called with the number of steps, and may raise."""
        self.depth = 0
        self.left = _MOST_STEPS
        self.known: dict[int, tuple[Value, tuple[str, ...]]] = {}
        self.spend = spend


def texts(value: Value, within: Within | None = None) -> tuple[str, ...]:
    """Return every text that a value can become when launch performs it; a list is concatenated."""
    if isinstance(value, str):
        return (str(value),)  # a plain str, so that facts contain no objects of the interpreter
    if within is None:
        within = Within()
    known = within.known.get(id(value))
    if known is not None:
        return known[1]
    if within.depth > _DEEPEST or within.left <= 0:
        return (UNKNOWN,)
    within.left -= 1
    within.spend(3)
    within.depth += 1
    result = _found(value, within)
    within.depth -= 1
    within.known[id(value)] = (value, result)
    return result


def _found(value: Value, within: Within) -> tuple[str, ...]:
    if not isinstance(value, (Union, Guarded)):
        only = _one(value, within)
        if len(only) == 1:
            return only
    result = distinct(text for choice in alternatives(value) for text in under(_one(choice.value, within), choice.conditions))
    return result if 0 < len(result) <= launch_text.MOST else (UNKNOWN,)


def _one(value: Value, within: Within) -> tuple[str, ...]:
    if isinstance(value, str):
        return (str(value),)
    if isinstance(value, FilePath):
        return (value.text,)
    if value is None or isinstance(value, (bool, int, float)):
        return (str(value),)
    if isinstance(value, (list, tuple)):
        return joined([texts(part, within) for part in value], "".join)
    if isinstance(value, Instance):
        value = value.made
    if isinstance(value, LaunchObject):
        rule = _RULES.get(value.name)
        if rule is not None:
            return rule(value, within)
        if value.name.endswith("LaunchDescriptionSource"):
            return texts(value.get(0, "launch_file_path", "location", "launch_description"), within)
    return (UNKNOWN,)


def _configuration(made: LaunchObject, within: Within) -> tuple[str, ...]:
    names = texts(made.get(0, "variable_name"), within)
    default = made.get(1, "default")
    defaults: tuple[str | None, ...] = (None,) if default is None else texts(default, within)
    return tuple(launch_text.configuration(name, value) for name in names for value in defaults)


def _environment(made: LaunchObject, within: Within) -> tuple[str, ...]:
    names = texts(made.get(0, "name"), within)
    default = made.get(1, "default_value")
    defaults: tuple[str | None, ...] = (None,) if default is None else texts(default, within)
    return tuple(environment(name, value) for name in names for value in defaults)


def _path(made: LaunchObject, within: Within) -> tuple[str, ...]:
    parts = plain(made.get(0, "substitutions", "path"))
    if not isinstance(parts, (list, tuple)):
        return texts(parts, within)
    return joined([texts(part, within) for part in parts], lambda row: posixpath.join("", *row))


def _share(made: LaunchObject, within: Within) -> tuple[str, ...]:
    return joined([texts(made.get(0, "package"), within)], lambda row: launch_text.share(row[0]))


def _prefix(made: LaunchObject, within: Within) -> tuple[str, ...]:
    return joined([texts(made.get(0, "package"), within)], lambda row: launch_text.prefix(row[0]))


def _in_package(made: LaunchObject, within: Within) -> tuple[str, ...]:
    names = texts(made.get(0, "executable"), within)
    packages = texts(made.get(1, "package"), within)
    return joined([packages, names], lambda row: f"{launch_text.prefix(row[0])}/lib/{row[0]}/{row[1]}")


def _inner(*names: str) -> Callable[[LaunchObject, Within], tuple[str, ...]]:
    return lambda made, within: texts(made.get(0, *names), within)


def _expression(made: LaunchObject, within: Within) -> tuple[str, ...]:
    return joined([texts(made.get(0, "expression"), within)], lambda row: launch_text.expression(row[0]))


def _command(made: LaunchObject, within: Within) -> tuple[str, ...]:
    return joined([texts(made.get(0, "command"), within)], lambda row: launch_text.command(row[0]))


def _choice(made: LaunchObject, within: Within) -> tuple[str, ...]:
    parts = (made.get(0, "condition"), made.get(1, "if_value") or "", made.get(2, "else_value") or "")
    return joined(
        [texts(part, within) for part in parts],
        lambda row: launch_text.expression(f"_if({', '.join(quoted(one) for one in row)})"),
    )


def _join(made: LaunchObject, within: Within) -> tuple[str, ...]:
    parts = plain(made.get(0, "substitutions"))
    delimiter = made.get(1, "delimiter")
    if not isinstance(parts, (list, tuple)):
        return (UNKNOWN,)
    rows = [texts(delimiter or "", within), *[texts(part, within) for part in parts]]
    return joined(rows, lambda row: row[0].join(row[1:]))


def _logic(name: str) -> Callable[[LaunchObject, Within], tuple[str, ...]]:
    """Return the reader of a substitution that compares, as an expression for ``launch/expressions.py``."""

    def rule(made: LaunchObject, within: Within) -> tuple[str, ...]:
        parts: list[Any] = [*made.arguments, *made.keywords.values()]
        return joined(
            [texts(part, within) for part in parts],
            lambda row: launch_text.expression(f"{name}({', '.join(quoted(one) for one in row)})"),
        )

    return rule


_RULES: Mapping[str, Callable[[LaunchObject, Within], tuple[str, ...]]] = {
    "LaunchConfiguration": _configuration,
    "LaunchConfigAsBool": _configuration,
    "EnvironmentVariable": _environment,
    "PathJoinSubstitution": _path,
    "PathSubstitution": _path,
    "FindPackageShare": _share,
    "FindPackagePrefix": _prefix,
    "FindPackage": _prefix,
    "ExecutableInPackage": _in_package,
    "ThisLaunchFileDir": lambda made, within: (OWN_FOLDER,),
    "ThisLaunchFile": lambda made, within: (f"{OWN_FOLDER}/{UNKNOWN}",),
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

SUBSTITUTIONS = frozenset(_RULES) | {"AnonName", "Parameter", "FileContent", "LocalSubstitution", "LaunchLogDir"}
"""Classes whose objects represent a text."""


def is_text(value: Value) -> bool:
    """Return whether a value is a substitution."""
    made = plain(value)
    return isinstance(made, LaunchObject) and made.name in SUBSTITUTIONS


_ASKING = frozenset({"IfCondition", "UnlessCondition"})
_COMPARING = frozenset({"LaunchConfigurationEquals", "LaunchConfigurationNotEquals"})
CONDITIONS = _ASKING | _COMPARING
"""Classes whose objects are conditions."""


def conditions_of(value: Value, within: Within | None = None) -> Conditions:
    """Return the conditions of an IfCondition, UnlessCondition or comparison of a configuration.

    Any other value gives an unknown condition.
    """
    conditions: list[LaunchCondition] = []
    for alternative in alternatives(value):
        made = alternative.value
        if isinstance(made, LaunchObject) and made.name in _ASKING:
            predicates = tuple(map(str, texts(made.get(0, "predicate_expression"), within)))
            conditions.append(LaunchCondition(predicates, None, made.name == "IfCondition"))
        elif isinstance(made, LaunchObject) and made.name in _COMPARING:
            names = texts(made.get(0, "launch_configuration_name"), within)
            wanted = texts(made.get(1, "expected_value"), within)
            if len(names) != 1 or len(wanted) != 1:
                return (PERHAPS,)
            equal = made.name == "LaunchConfigurationEquals"
            conditions.append(LaunchCondition((launch_text.configuration(names[0]),), str(wanted[0]), equal))
        else:
            return (PERHAPS,)
    return tuple(conditions) if len(conditions) == 1 else (PERHAPS,)
