"""Nodes and the parameters that they declare in Python sources (rclpy)."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from typing import TYPE_CHECKING, Final

from ros_lint.base.text import Span
from ros_lint.collectors.python.scopes import nodes
from ros_lint.collectors.python.source_errors import NotPythonError
from ros_lint.collectors.python.string_values import callee
from ros_lint.collectors.python.syntax import parse
from ros_lint.facts.sources import DeclaredParameter, NodeCode, ParameterType

if TYPE_CHECKING:
    from ros_lint.base.text import Text

_USED = re.compile(r"\brclpy\b|declare_parameter")
_OPEN: Final = frozenset({"automatically_declare_parameters_from_overrides", "allow_undeclared_parameters"})
_WORD = re.compile(r"[\w./]*\w")
_CREATES: Final = frozenset({
    "ActionClient", "ActionServer", "Subscriber", "create_client", "create_publisher", "create_service", "create_subscription",
})  # fmt: skip
"""Functions and classes that create a topic, service or action (rclpy, message_filters)."""
_TYPES: dict[type, ParameterType] = {bool: "bool", int: "integer", float: "double", str: "string"}
_ARRAYS: dict[type, ParameterType] = {bool: "bool_array", int: "integer_array", float: "double_array", str: "string_array"}
_CONSTANTS: dict[str, ParameterType] = {
    "BOOL": "bool",
    "INTEGER": "integer",
    "DOUBLE": "double",
    "STRING": "string",
    "BOOL_ARRAY": "bool_array",
    "INTEGER_ARRAY": "integer_array",
    "DOUBLE_ARRAY": "double_array",
    "STRING_ARRAY": "string_array",
}


def node_code(source: Text) -> NodeCode | None:
    """Return the node names and declared parameters in a Python file, None if it does not use rclpy."""
    if _USED.search(source.text) is None:
        return None
    try:
        tree = parse(source)
    except NotPythonError:
        return NodeCode(source.path, complete=False)
    found = nodes(tree)
    calls = [(callee(node), node) for node in found if isinstance(node, ast.Call)]
    texts = {node.value for node in found if isinstance(node, ast.Constant) and isinstance(node.value, str)}
    is_dynamic = any(word in source.text for word in ("dynamic_typing", "ParameterTypeException"))
    declared = [
        parameter
        for called, call in calls
        if called in ("declare_parameter", "declare_parameters")
        for parameter in _declared(call, called, source, is_dynamic=is_dynamic)
    ]
    is_open = any(word in source.text for word in _OPEN) and any(
        node.arg in _OPEN for node in found if isinstance(node, ast.keyword)
    )
    topics = [_topic(call) for called, call in calls if called in _CREATES]
    names = [_name(call) for called, call in calls if called in ("__init__", "create_node") or called.endswith("Node")]
    return NodeCode(
        source.path,
        tuple(dict.fromkeys([name for name in names if name is not None])),
        tuple([parameter for parameter in declared if parameter is not None]),
        tuple(sorted(text for text in texts if _WORD.fullmatch(text))),
        not is_open and None not in declared,
        None if None in topics else tuple(sorted({topic for topic in topics if topic is not None})),
    )


def _name(call: ast.Call) -> str | None:
    """Return the name of the node that a call creates, None if it is computed."""
    values = [*call.args[:2], *(keyword.value for keyword in call.keywords if keyword.arg == "node_name")]
    return next((value.value for value in values if isinstance(value, ast.Constant) and isinstance(value.value, str)), None)


def _topic(call: ast.Call) -> str | None:
    """Return the name of the topic, service or action that a call creates, None if it is computed."""
    named = [keyword.value for keyword in call.keywords if keyword.arg in ("topic", "srv_name", "action_name")]
    texts = [value.value for value in (*named, *call.args[1:3]) if isinstance(value, ast.Constant)]
    return next((text for text in texts if isinstance(text, str)), None)


def _declared(call: ast.Call, called: str, source: Text, *, is_dynamic: bool) -> Iterator[DeclaredParameter | None]:
    """Yield the parameters that a call declares, None for one whose name is computed."""
    arguments: dict[str, ast.expr] = {keyword.arg: keyword.value for keyword in call.keywords if keyword.arg}
    places = ("name", "value") if called == "declare_parameter" else ("namespace", "parameters")
    arguments.update(zip(places, call.args, strict=False))
    if called == "declare_parameter":
        yield _parameter(arguments.get("name"), arguments.get("value"), "", source, is_dynamic=is_dynamic)
        return
    namespace, rows = arguments.get("namespace"), arguments.get("parameters")
    if not isinstance(namespace, ast.Constant) or not isinstance(rows, (ast.List, ast.Tuple)):
        yield None
        return
    prefix = f"{namespace.value}." if isinstance(namespace.value, str) and namespace.value else ""
    for row in rows.elts:
        if isinstance(row, (ast.Tuple, ast.List)) and row.elts:
            value = row.elts[1] if len(row.elts) > 1 else None
            yield _parameter(row.elts[0], value, prefix, source, is_dynamic=is_dynamic)
        else:
            yield None


def _parameter(
    name: ast.expr | None, value: ast.expr | None, prefix: str, source: Text, *, is_dynamic: bool
) -> DeclaredParameter | None:
    if not isinstance(name, ast.Constant) or not isinstance(name.value, str):
        return None
    line = source.line(name.lineno)
    column = len(line.encode()[: name.col_offset].decode(errors="ignore")) + 1
    end = column + len(name.value) + 2 if name.end_lineno == name.lineno else column
    span = Span(source.path, name.lineno, column, name.lineno, end)
    return DeclaredParameter(prefix + name.value, "" if is_dynamic or value is None else _type(value), span)


def _type(value: ast.expr) -> ParameterType:
    """Return the type of a default value, "" if it is not certain."""
    if isinstance(value, ast.UnaryOp) and isinstance(value.op, (ast.USub, ast.UAdd)):
        value = value.operand
    if isinstance(value, ast.Constant):
        return _TYPES.get(type(value.value), "")
    if isinstance(value, (ast.List, ast.Tuple)) and value.elts:
        types = {_type(element) for element in value.elts}
        only = types.pop() if len(types) == 1 else ""
        return next((_ARRAYS[kind] for kind, name in _TYPES.items() if name == only), "")
    if isinstance(value, ast.Attribute) and "Type" in ast.dump(value.value):
        return _CONSTANTS.get(value.attr.removeprefix("PARAMETER_"), "")
    return ""
