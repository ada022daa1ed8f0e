"""The changes of parameter files by ParameterFile (launch_ros), and by RewrittenYaml and ReplaceString (nav2_common)."""

from __future__ import annotations

import ast
from collections.abc import Mapping
from typing import Final

from ros_lint.collectors.launch.python.substitutions import conditions_of, texts
from ros_lint.collectors.launch.python.walker import Walker
from ros_lint.collectors.python.interpreter.alternatives import alternatives, plain
from ros_lint.collectors.python.interpreter.values import (
    LaunchObject,
    Source,
    Value,
)
from ros_lint.facts.launch import FileChange, LaunchValue

_INNERMOST: Final = 8
"""Maximum number of changes of one file."""


def file_changes(walker: Walker, value: Value, node: ast.expr, source: Source) -> tuple[FileChange, ...]:
    """Return the changes of the parameter file ``value``, innermost first, which is the order in which launch makes them."""
    changes: list[FileChange] = []
    for _ in range(_INNERMOST):
        choices = [choice.value for choice in alternatives(value)]
        if isinstance(plain(value), (list, tuple)) and len(plain(value)) == 1:
            value = plain(value)[0]
            continue
        launch_object = choices[0] if len(choices) == 1 else None
        if not isinstance(launch_object, LaunchObject) or launch_object.name not in _SOURCES:
            if len(choices) > 1 and any(isinstance(choice, LaunchObject) and choice.name in _SOURCES for choice in choices):
                changes.append(FileChange("rewrite", complete=False))
            break
        changes += reversed(_changes(walker, launch_object, node, source))
        value = launch_object.get(0, _SOURCES[launch_object.name])
    return tuple(reversed(changes))


_SOURCES: Mapping[str, str] = {"ParameterFile": "param_file", "ReplaceString": "source_file", "RewrittenYaml": "source_file"}
"""The keyword for the changed file, by class."""


def _changes(walker: Walker, launch_object: LaunchObject, node: ast.expr, source: Source) -> list[FileChange]:
    """Return the changes that one object makes, in order."""
    match launch_object.name:
        case "ParameterFile":
            allowed = launch_object.get(-1, "allow_substs")
            return [FileChange("substitute", complete=isinstance(allowed, bool))] if allowed not in (None, False) else []
        case "ReplaceString":
            values = _pairs(walker, launch_object.get(1, "replacements"), node, source)
            condition = launch_object.get(-1, "condition")
            conditions = conditions_of(condition) if condition is not None else ()
            return [FileChange("replace", values or (), complete=values is not None, conditions=conditions)]
    values = _pairs(walker, launch_object.get(1, "param_rewrites"), node, source)
    keys = _pairs(walker, launch_object.get(3, "key_rewrites"), node, source)
    root = launch_object.get(2, "root_key")
    known = values is not None and keys is not None
    rewritten = FileChange(
        "rewrite",
        values or (),
        keys or (),
        walker.text(root, node, source) if root is not None else None,
        known and not launch_object.may_hide("param_rewrites", "root_key", "key_rewrites", "value_rewrites"),
    )
    exchanged = _pairs(walker, launch_object.get(-1, "value_rewrites"), node, source)
    return (
        [rewritten, FileChange("exchange", exchanged or (), complete=exchanged is not None)] if exchanged != () else [rewritten]
    )


def _pairs(walker: Walker, value: Value, node: ast.expr, source: Source) -> tuple[tuple[str, LaunchValue], ...] | None:
    """Return the entries of a dictionary of texts, None if they are not known."""
    entries = plain(value)
    if entries is None:
        return ()
    if not isinstance(entries, dict):
        return None
    names = [texts(key) for key in entries]
    if any(len(name) != 1 for name in names):
        return None
    return tuple(
        [(name[0], walker.text(plain(inner), node, source)) for name, inner in zip(names, entries.values(), strict=True)]
    )
