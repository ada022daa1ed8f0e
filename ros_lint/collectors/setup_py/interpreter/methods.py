"""Methods of texts, lists, dictionaries and sets in setup.py files."""

from __future__ import annotations

import ast

from ros_lint.collectors.python.methods import TEXT_METHODS
from ros_lint.collectors.setup_py.interpreter.expressions import Expressions
from ros_lint.collectors.setup_py.interpreter.operators import LONGEST, TooLargeError, check_format, check_size
from ros_lint.collectors.setup_py.interpreter.sequences import in_order
from ros_lint.collectors.setup_py.interpreter.state import at
from ros_lint.collectors.setup_py.interpreter.values import REST, Native, Unknown, Value, certain, located, unknown_in

_METHODS: dict[type, frozenset[str]] = {
    str: TEXT_METHODS | {"format", "join", "replace"},
    list: frozenset({"append", "extend", "insert", "remove", "pop", "sort", "reverse", "copy", "clear", "index", "count"}),
    dict: frozenset({"get", "items", "keys", "values", "update", "setdefault", "pop", "copy", "clear"}),
    set: frozenset({"add", "update", "discard", "remove", "union", "difference", "intersection", "copy", "clear"}),
    tuple: frozenset({"index", "count"}),
}


def method(owner: Value, name: str) -> Native | None:
    """Return a method of a value, None if it is unknown."""
    for kind, known in _METHODS.items():
        if isinstance(owner, kind) and name in known:
            return Native(f"{kind.__name__}.{name}", owner)
    return None


def call(program: Expressions, function: Native, arguments: list[Value], keywords: dict[str, Value], node: ast.Call) -> Value:
    """Return the result of a method, and apply its changes to the owner."""
    kind, _, name = function.name.partition(".")
    if kind == "str":
        return _text_method(program, name, function.owner, arguments, keywords, node)
    return _container_method(program, name, function.owner, arguments, keywords, node)


def _text_method(
    program: Expressions, name: str, owner: str, arguments: list[Value], keywords: dict[str, Value], node: ast.Call
) -> Value:
    program.weigh(*arguments, *keywords.values())
    unknown = unknown_in([*arguments, *keywords.values()])
    if unknown:
        return unknown
    if name == "join" and sum(map(len, arguments[0])) + len(owner) * len(arguments[0]) > LONGEST:
        raise TooLargeError
    if name == "format":
        check_format(owner)
        if _reads_parts(owner):
            return Unknown(f"{at(node)} reads an attribute or element in a format", node)
    if name in ("format", "replace"):
        check_size(owner, [*arguments, *keywords.values()])
    found = getattr(str, name)(owner, *arguments, **keywords)
    program.weigh(found)
    return located(found, node)


def _reads_parts(template: str) -> bool:
    """Return whether a field of a template of str.format() reads an attribute or element of a value.

    Attributes of a value lead to the modules of the evaluator. Raises ValueError for a template that is no format, and
    TooLargeError for a format specification that contains fields, because a value decides on the width.
    """
    import string  # noqa: PLC0415  (few setup.py files format like this)

    for _, field, spec, _ in string.Formatter().parse(template):
        if spec and "{" in spec:
            raise TooLargeError
        if field and ("." in field or "[" in field):
            return True
    return False


def _container_method(
    program: Expressions, name: str, owner: Value, arguments: list[Value], keywords: dict[str, Value], node: ast.Call
) -> Value:
    if isinstance(owner, list):
        return _list_method(program, name, owner, arguments, keywords, node)
    if isinstance(owner, dict):
        return _dict_method(program, name, owner, arguments, keywords, node)
    program.weigh(owner, *arguments)
    unknown = unknown_in([owner, *arguments])
    if unknown:
        return unknown
    if isinstance(owner, set):
        program.journal.touch(owner)
    return getattr(type(owner), name)(owner, *arguments)


def _list_method(
    program: Expressions,
    name: str,
    owner: list[Value],
    arguments: list[Value],
    keywords: dict[str, Value],
    node: ast.Call,
) -> Value:
    program.journal.touch(owner)
    if name == "append":
        owner.append(arguments[0])
        return None
    if name == "extend":
        owner += program.elements(arguments[0], node.args[0])
        return None
    if name == "copy":
        return owner.copy()
    if name in ("clear", "reverse"):
        getattr(owner, name)()
        return None
    if name == "sort":
        owner[:] = in_order(program, node, owner, **keywords)
        return None
    program.weigh(owner, *arguments)
    if unknown_in([owner, *(arguments if name != "insert" else arguments[:1])]):
        program.taint(owner, node)
        return unknown_in([owner])
    return getattr(list, name)(owner, *arguments)


def _dict_method(
    program: Expressions,
    name: str,
    owner: dict[Value, Value],
    arguments: list[Value],
    keywords: dict[str, Value],
    node: ast.Call,
) -> Value:
    if name == "items":
        return list(owner.items())
    if name in ("keys", "values"):
        return list(getattr(owner, name)())
    program.journal.touch(owner)
    if name == "update":
        for more in [*arguments, keywords]:
            if isinstance(more, dict):
                owner.update(more)
            else:
                program.taint(owner, node)
        return None
    if name in ("copy", "clear"):
        return getattr(owner, name)()
    program.weigh(arguments[0])
    if not certain(arguments[0]):
        program.taint(owner, node)
        return unknown_in(arguments)
    if REST in owner and arguments[0] not in owner:
        return owner[REST]
    return getattr(owner, name)(*arguments)
