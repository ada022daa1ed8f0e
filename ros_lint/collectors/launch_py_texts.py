"""What substitutions of Python launch files become (reference, section G2)."""

from __future__ import annotations

import posixpath
from collections.abc import Callable, Mapping
from typing import Any

from ros_lint.collectors import launch_text
from ros_lint.collectors.launch_py_objects import (
    PERHAPS,
    Conditions,
    FilePath,
    Guarded,
    Instance,
    Made,
    Union,
    Value,
    alternatives,
    environment,
    plain,
    under,
)
from ros_lint.collectors.launch_text import OWN_FOLDER, UNKNOWN, distinct, joined, quoted
from ros_lint.facts import LaunchCondition

_DEEPEST = 60


def texts(value: Value, depth: int = 0) -> tuple[str, ...]:
    """Return every text that a value can become when launch performs it; a list is concatenated."""
    if isinstance(value, str):
        return (str(value),)  # facts keep nothing of the program
    if depth > _DEEPEST:
        return (UNKNOWN,)
    if not isinstance(value, (Union, Guarded)):
        only = _one(value, depth)
        if len(only) == 1:
            return only
    found = distinct(text for one in alternatives(value) for text in under(_one(one.value, depth), one.conditions))
    return found if 0 < len(found) <= launch_text.MOST else (UNKNOWN,)


def _one(value: Value, depth: int) -> tuple[str, ...]:
    if isinstance(value, str):
        return (str(value),)
    if isinstance(value, FilePath):
        return (value.text,)
    if value is None or isinstance(value, (bool, int, float)):
        return (str(value),)
    if isinstance(value, (list, tuple)):
        return joined([texts(part, depth + 1) for part in value], "".join)
    if isinstance(value, Instance):
        value = value.made
    if isinstance(value, Made):
        rule = _RULES.get(value.name)
        if rule is not None:
            return rule(value, depth + 1)
        if value.name.endswith("LaunchDescriptionSource"):
            return texts(value.get(0, "launch_file_path", "location", "launch_description"), depth + 1)
    return (UNKNOWN,)


def _configuration(made: Made, depth: int) -> tuple[str, ...]:
    names = texts(made.get(0, "variable_name"), depth)
    default = made.get(1, "default")
    defaults: tuple[str | None, ...] = (None,) if default is None else texts(default, depth)
    return tuple(launch_text.configuration(name, one) for name in names for one in defaults)


def _environment(made: Made, depth: int) -> tuple[str, ...]:
    names = texts(made.get(0, "name"), depth)
    default = made.get(1, "default_value")
    defaults: tuple[str | None, ...] = (None,) if default is None else texts(default, depth)
    return tuple(environment(name, one) for name in names for one in defaults)


def _path(made: Made, depth: int) -> tuple[str, ...]:
    parts = plain(made.get(0, "substitutions", "path"))
    if not isinstance(parts, (list, tuple)):
        return texts(parts, depth)
    return joined([texts(part, depth) for part in parts], lambda row: posixpath.join("", *row))


def _share(made: Made, depth: int) -> tuple[str, ...]:
    return joined([texts(made.get(0, "package"), depth)], lambda row: launch_text.share(row[0]))


def _prefix(made: Made, depth: int) -> tuple[str, ...]:
    return joined([texts(made.get(0, "package"), depth)], lambda row: launch_text.prefix(row[0]))


def _in_package(made: Made, depth: int) -> tuple[str, ...]:
    names = texts(made.get(0, "executable"), depth)
    packages = texts(made.get(1, "package"), depth)
    return joined([packages, names], lambda row: f"{launch_text.prefix(row[0])}/lib/{row[0]}/{row[1]}")


def _inner(*names: str) -> Callable[[Made, int], tuple[str, ...]]:
    return lambda made, depth: texts(made.get(0, *names), depth)


def _expression(made: Made, depth: int) -> tuple[str, ...]:
    return joined([texts(made.get(0, "expression"), depth)], lambda row: launch_text.expression(row[0]))


def _command(made: Made, depth: int) -> tuple[str, ...]:
    return joined([texts(made.get(0, "command"), depth)], lambda row: launch_text.command(row[0]))


def _choice(made: Made, depth: int) -> tuple[str, ...]:
    parts = (made.get(0, "condition"), made.get(1, "if_value"), made.get(2, "else_value") or "")
    return joined(
        [texts(part, depth) for part in parts],
        lambda row: launch_text.expression(f"_if({', '.join(quoted(one) for one in row)})"),
    )


def _join(made: Made, depth: int) -> tuple[str, ...]:
    parts = plain(made.get(0, "substitutions"))
    delimiter = made.get(1, "delimiter")
    if not isinstance(parts, (list, tuple)):
        return (UNKNOWN,)
    rows = [texts(delimiter or "", depth), *[texts(part, depth) for part in parts]]
    return joined(rows, lambda row: row[0].join(row[1:]))


def _logic(name: str) -> Callable[[Made, int], tuple[str, ...]]:
    """Substitutions that compare are written as expressions, which :mod:`launch_expression` evaluates."""

    def rule(made: Made, depth: int) -> tuple[str, ...]:
        parts: list[Any] = [*made.arguments, *made.keywords.values()]
        return joined(
            [texts(part, depth) for part in parts],
            lambda row: launch_text.expression(f"{name}({', '.join(quoted(one) for one in row)})"),
        )

    return rule


_RULES: Mapping[str, Callable[[Made, int], tuple[str, ...]]] = {
    "LaunchConfiguration": _configuration,
    "LaunchConfigAsBool": _configuration,
    "EnvironmentVariable": _environment,
    "PathJoinSubstitution": _path,
    "PathSubstitution": _path,
    "FindPackageShare": _share,
    "FindPackagePrefix": _prefix,
    "FindPackage": _prefix,
    "ExecutableInPackage": _in_package,
    "ThisLaunchFileDir": lambda made, depth: (OWN_FOLDER,),
    "ThisLaunchFile": lambda made, depth: (f"{OWN_FOLDER}/{UNKNOWN}",),
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
"""Classes whose objects stand for a text."""


def conditions_of(value: Value) -> Conditions:
    """Return what a condition of launch asks for: IfCondition, UnlessCondition and the two that compare a configuration."""
    found: list[LaunchCondition] = []
    for one in alternatives(value):
        made = one.value
        if isinstance(made, Made) and made.name in ("IfCondition", "UnlessCondition"):
            asked = tuple(map(str, texts(made.get(0, "predicate_expression"))))
            found.append(LaunchCondition(asked, None, made.name == "IfCondition"))
        elif isinstance(made, Made) and made.name in ("LaunchConfigurationEquals", "LaunchConfigurationNotEquals"):
            names = texts(made.get(0, "launch_configuration_name"))
            wanted = texts(made.get(1, "expected_value"))
            if len(names) != 1 or len(wanted) != 1:
                return (PERHAPS,)
            equal = made.name == "LaunchConfigurationEquals"
            found.append(LaunchCondition((launch_text.configuration(names[0]),), str(wanted[0]), equal))
        else:
            return (PERHAPS,)
    return tuple(found) if len(found) == 1 else (PERHAPS,)
