"""Mistakes in the use of the launch description itself, for which the file is rejected or raises an error when it is launched."""

from __future__ import annotations

import ast
import re
from collections import Counter
from collections.abc import Iterator
from typing import TYPE_CHECKING

from ros_lint.base.suggestions import similar_names
from ros_lint.collectors.launch.python.import_checks import is_from_launch
from ros_lint.collectors.launch.python.walker import span_of
from ros_lint.collectors.python.string_values import callee
from ros_lint.facts.visibility import Problem

if TYPE_CHECKING:
    from ros_lint.collectors.python.interpreter.values import Source

_METHODS = frozenset({"add_action", "add_entity"})
_CALLED = re.compile(r"\.\s*(\w*(?:[aA]dd|[aA]ction|[eE]ntit)\w*)\s*\(")
"""Matches a call of a method whose name may be a misspelt method of a launch description."""
_OWN_SCOPE = (ast.FunctionDef, ast.AsyncFunctionDef, ast.Lambda, ast.ClassDef)


def description_problems(tree: ast.Module, source: Source) -> Iterator[Problem]:
    """Yield a problem for each function that returns no launch description, and for each misspelt method of a description."""
    functions = [node for node in tree.body if isinstance(node, ast.FunctionDef)]
    for function in [node for node in functions if node.name == "generate_launch_description"][-1:]:
        if not _may_return(function):
            message = "generate_launch_description() returns nothing; end it with 'return LaunchDescription([...])'"
            yield Problem("no-description", message, span_of(function.body[-1], source))
    if not any(map(_method_like, set(_CALLED.findall(source.text.text)))):
        return  # because walking the functions takes longer than everything else
    for function in functions:
        for node, problem in _misspelt_methods(function, source):
            if is_from_launch(tree, node.func):
                yield problem


def _may_return(function: ast.FunctionDef) -> bool:
    """Return whether a function returns a value, raises an error itself, or is replaced by a decorator."""
    if function.decorator_list or _returns(function.body[-1]):
        return True
    return any(map(_returns, _own_nodes(function)))


def _returns(node: ast.AST) -> bool:
    return node.value is not None if isinstance(node, ast.Return) else isinstance(node, (ast.Yield, ast.YieldFrom, ast.Raise))


def _misspelt_methods(function: ast.FunctionDef, source: Source) -> Iterator[tuple[ast.Call, Problem]]:
    """Yield a problem for each misspelt method of a launch description, with the call that creates the launch description."""
    descriptions: dict[str, ast.Call] = {}
    nodes = list(_own_nodes(function))
    for node in nodes:
        if isinstance(node, ast.Assign) and isinstance(node.value, ast.Call) and callee(node.value) == "LaunchDescription":
            descriptions |= {target.id: node.value for target in node.targets if isinstance(target, ast.Name)}
    if not descriptions:
        return
    stored = Counter([node.id for node in nodes if isinstance(node, ast.Name) and not isinstance(node.ctx, ast.Load)])
    for node in nodes:
        if not (isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute) and isinstance(node.func.value, ast.Name)):
            continue
        owner, name = node.func.value.id, node.func.attr
        if owner in descriptions and stored[owner] == 1 and (method := _method_like(name)):
            message = f"LaunchDescription has no method '{name}'; did you mean '{method}'?"
            yield descriptions[owner], Problem("no-method", message, span_of(node.func, source))


def _method_like(name: str) -> str:
    """Return the method of a launch description that a misspelt name resembles, "" if there is none."""
    return "" if name in _METHODS else next(iter(similar_names(name, sorted(_METHODS), 1, 0.75)), "")


def _own_nodes(function: ast.FunctionDef) -> Iterator[ast.AST]:
    """Yield the nodes in the body of a function, without those of functions and classes inside it."""
    waiting: list[ast.AST] = list(function.body)
    while waiting:
        node = waiting.pop()
        if not isinstance(node, _OWN_SCOPE):
            yield node
            waiting += ast.iter_child_nodes(node)
