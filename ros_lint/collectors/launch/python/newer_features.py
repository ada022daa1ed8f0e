"""Classes and keywords of a Python launch file that some ROS distributions lack."""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING

from ros_lint.collectors.launch.python.import_checks import MODULES_BY_NAME, is_from_launch
from ros_lint.collectors.launch.python.signatures import all_signatures
from ros_lint.collectors.launch.python.walker import span_of
from ros_lint.collectors.python.interpreter.recorder import are_unknown
from ros_lint.collectors.python.string_values import callee
from ros_lint.collectors.python.unbound_names import tried
from ros_lint.facts.visibility import Problem

if TYPE_CHECKING:
    from ros_lint.collectors.python.interpreter.values import LaunchObject, Source


def newer_features(tree: ast.Module, source: Source, launch_objects: Iterable[LaunchObject]) -> Iterator[Problem]:
    """Yield the classes that a launch file imports and the keywords that it passes, if a supported ROS distribution lacks them.

    The ``kind`` of each problem is the first distribution with the feature. ``launch_objects`` are the objects of launch
    classes that the interpretation of the file created. ``try`` blocks are omitted.
    """
    signatures = all_signatures()
    for statement in tree.body:
        if not isinstance(statement, ast.ImportFrom) or statement.level:
            continue
        for alias in statement.names:
            signature = signatures.get(alias.name)
            if signature is not None and signature.since and _is_public(statement, alias.name):
                yield Problem(signature.since, f"{alias.name} in {statement.module}", span_of(alias, source))
    passed = [
        (launch_object.node, keyword, since)
        for launch_object in launch_objects
        if launch_object.source is source and callee(launch_object.node) == launch_object.name
        if launch_object.name in signatures and not are_unknown(launch_object.conditions)
        for keyword in launch_object.node.keywords
        if (since := signatures[launch_object.name].newer.get(keyword.arg or ""))
    ]
    guarded = {inner for node in ast.walk(tree) if isinstance(node, ast.Try) for inner in tried(node)} if passed else set()
    for call, keyword, since in passed:
        if call not in guarded and is_from_launch(tree, call.func):
            yield Problem(since, f"argument '{keyword.arg}=' of {callee(call)}", span_of(keyword, source))


def _is_public(node: ast.ImportFrom, name: str) -> bool:
    return node.module in MODULES_BY_NAME.get(name, ())
