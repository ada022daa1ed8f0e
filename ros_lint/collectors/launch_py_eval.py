"""Expressions of Python launch files."""

from __future__ import annotations

import ast
import operator
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any

from ros_lint.collectors.launch_py_methods import attribute, items
from ros_lint.collectors.launch_py_objects import (
    PERHAPS,
    Api,
    Conditions,
    FilePath,
    Frame,
    Guarded,
    Made,
    Raised,
    Union,
    Unknown,
    Value,
    alternatives,
    plain,
    union,
    written,
)
from ros_lint.collectors.launch_text import LONGEST, UNKNOWN, certain_part, is_plain, joined, presence
from ros_lint.facts import LaunchCondition

if TYPE_CHECKING:
    from ros_lint.collectors.launch_py_run import Machine

_NUMBERS = (int, float, bool)
_MOST_ITEMS = 5_000


def each(value: Value, function: Callable[[Value], Value]) -> Value:
    """Apply a function to every alternative of a value."""
    if isinstance(value, Guarded):
        value = value.value
    if not isinstance(value, Union):
        return function(value)
    found: list[Value] = []
    raised = False
    for one in alternatives(value):
        try:
            found.append(Guarded(function(one.value), one.conditions))
        except Raised:  # then this alternative is none
            raised = True
    if raised and not found:
        raise Raised
    return union(found)


def truth(machine: Machine, value: Value) -> tuple[bool | None, LaunchCondition]:
    """Return whether a value is true, and the condition for it where that is not known."""
    value = plain(value)
    if isinstance(value, Unknown):
        return None, value.condition or PERHAPS
    if isinstance(value, Union):
        return _truth_of_several(machine, value)
    if isinstance(value, str):
        if is_plain(value) or certain_part(value):
            return bool(value), PERHAPS
        return None, LaunchCondition((str(value),), "", wanted=False)
    if value is None or isinstance(value, (*_NUMBERS, list, dict, tuple, set, frozenset, range)):
        return bool(value), PERHAPS
    return (None if isinstance(value, Api) else True), PERHAPS


def _truth_of_several(machine: Machine, value: Union) -> tuple[bool | None, LaunchCondition]:
    answers = [(truth(machine, one.value)[0], one.conditions) for one in alternatives(value)]
    if len({answer for answer, _ in answers}) == 1:
        return answers[0][0], PERHAPS
    for wanted in (True, False):
        found = [conditions for answer, conditions in answers if answer is wanted]
        if len(found) == 1 and len(found[0]) == 1 and all(answer is not None for answer, _ in answers):
            return None, found[0][0] if wanted else opposite_of(found[0][0])
    return None, PERHAPS


def text_of(value: Value) -> tuple[str, ...]:
    """Return what str() makes of a value."""
    found: list[str] = []
    for one in alternatives(value):
        if isinstance(one.value, str):
            found.append(one.value)
        elif isinstance(one.value, FilePath):
            found.append(one.value.text)
        elif one.value is None or isinstance(one.value, (*_NUMBERS, bytes)):
            found.append(str(one.value))
        elif isinstance(one.value, (list, tuple, dict, set)):
            found.append(_shown(one.value))
        else:
            found.append(UNKNOWN)
    return tuple(dict.fromkeys(found))


def _shown(value: Any) -> str:
    """Return the text of a collection if it holds nothing but what Python can show."""
    stack, count = [value], 0
    while stack:
        one = stack.pop()
        count += 1
        if count > 200:
            return UNKNOWN
        if isinstance(one, dict):
            stack += [*one.keys(), *one.values()]
        elif isinstance(one, (list, tuple, set)):
            stack += one
        elif not (one is None or isinstance(one, (str, *_NUMBERS))):
            return UNKNOWN
    return str(value)


def _constant(_: Machine, node: ast.Constant, frame: Frame) -> Value:
    return written(node.value, node, frame.source) if isinstance(node.value, str) else node.value


def _name(machine: Machine, node: ast.Name, frame: Frame) -> Value:
    around: Frame | None = frame.declared.get(node.id, frame)
    while around is not None:
        if node.id in around.names:
            return around.names[node.id]
        around = around.outer
    return machine.builtin(node.id, node, frame)


def _list(machine: Machine, node: ast.List, frame: Frame) -> Value:
    return _elements(machine, node.elts, frame)


def _tuple(machine: Machine, node: ast.Tuple, frame: Frame) -> Value:
    found = _elements(machine, node.elts, frame)
    return tuple(found) if isinstance(found, list) else found


def _set(machine: Machine, node: ast.Set, frame: Frame) -> Value:
    # Kept as a list: its order is of no account, and what is in it need not have a hash.
    return _elements(machine, node.elts, frame)


def _elements(machine: Machine, nodes: Iterable[ast.expr], frame: Frame) -> Value:
    found: list[Value] = []
    for node in nodes:
        if not isinstance(node, ast.Starred):
            found.append(machine.evaluate(node, frame))
            continue
        value = machine.evaluate(node.value, frame)
        inner = items(machine, value)
        if inner is None:
            machine.lose(value)
            return Unknown("a list with * of what is not known")
        found += inner
    return found


def _dict(machine: Machine, node: ast.Dict, frame: Frame) -> Value:
    found: dict[Value, Value] = {}
    unknown = False
    for key_node, value_node in zip(node.keys, node.values, strict=True):
        value = machine.evaluate(value_node, frame)
        if key_node is None:
            value = plain(value)
            if isinstance(value, dict):
                found.update(value)
            else:
                unknown = True
            continue
        key = plain(machine.evaluate(key_node, frame))
        found[hashable(key)] = value
    if unknown:
        machine.lose(found)
    return found


def hashable(key: Value) -> Any:
    """Return what a value is as a key: itself, or a text for what cannot be one."""
    if isinstance(key, (list, tuple, Made)):
        from ros_lint.collectors.launch_py_texts import texts  # noqa: PLC0415  (they know each other)

        found = texts(key)
        return found[0] if len(found) == 1 else UNKNOWN
    if isinstance(key, (str, *_NUMBERS)) or key is None:
        return key
    return UNKNOWN


def _formatted(machine: Machine, node: ast.JoinedStr, frame: Frame) -> Value:
    rows: list[tuple[str, ...]] = []
    for part in node.values:
        if isinstance(part, ast.Constant):
            rows.append((str(part.value),))
            continue
        assert isinstance(part, ast.FormattedValue)
        value = machine.evaluate(part.value, frame)
        found = text_of(value)
        if part.format_spec is not None or part.conversion not in (-1, 115):
            spec = machine.evaluate(part.format_spec, frame) if part.format_spec is not None else ""
            found = tuple(_with_format(plain(value), one, plain(spec), part.conversion) for one in found)
        rows.append(found)
    return texts_made(joined(rows, "".join), node, frame)


def _with_format(value: Value, text: str, spec: Value, conversion: int) -> str:
    if not isinstance(spec, str) or not is_plain(spec) or not is_plain(text) or len(spec) > 8:
        return UNKNOWN
    try:
        if conversion == 114:
            return format(repr(value if isinstance(value, _NUMBERS) else text), spec)
        return format(value if isinstance(value, _NUMBERS) else text, spec)
    except (ValueError, OverflowError, MemoryError):
        return UNKNOWN


def texts_made(found: tuple[str, ...], node: ast.expr, frame: Frame) -> Value:
    """Return a text, or one of several, made by an expression."""
    if len(found) == 1:
        return written(found[0], node, frame.source)
    return union(written(one, node, frame.source) for one in found)


_OPERATORS: dict[type[ast.operator], Callable[[Any, Any], Any]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.FloorDiv: operator.floordiv,
    ast.Mod: operator.mod,
    ast.BitOr: operator.or_,
    ast.BitAnd: operator.and_,
    ast.BitXor: operator.xor,
}


def _operation(machine: Machine, node: ast.BinOp, frame: Frame) -> Value:
    left = machine.evaluate(node.left, frame)
    right = machine.evaluate(node.right, frame)
    return operation(machine, node.op, left, right, node, frame)


def operation(machine: Machine, op: ast.operator, left: Value, right: Value, node: ast.expr, frame: Frame) -> Value:
    """Return what an operator makes of two values."""
    return each(left, lambda one: each(right, lambda other: _single(machine, op, one, other, node, frame)))


def _single(machine: Machine, op: ast.operator, left: Value, right: Value, node: ast.expr, frame: Frame) -> Value:
    if isinstance(op, ast.Add):
        if isinstance(left, str) and isinstance(right, str):
            return written(left + right if len(left) + len(right) <= LONGEST else UNKNOWN, node, frame.source)
        if isinstance(left, str) and isinstance(right, Unknown):
            return written(left + UNKNOWN, node, frame.source)
        if isinstance(left, Unknown) and isinstance(right, str):
            return written(UNKNOWN + right, node, frame.source)
        if isinstance(left, (list, tuple)) and isinstance(right, (list, tuple)):
            machine.spend(len(left) + len(right))
            return [*left, *right] if isinstance(left, list) else (*left, *right)
        if isinstance(left, (list, tuple)) and isinstance(right, Unknown):
            return [*left, right]
        if isinstance(left, Unknown) and isinstance(right, (list, tuple)):
            return [left, *right]
    if isinstance(op, ast.Div) and (isinstance(left, (FilePath, Made)) or isinstance(right, FilePath)):
        return machine.join_paths(left, [right], node, frame)
    if isinstance(op, ast.Mod) and isinstance(left, str):
        return _percent(left, right, node, frame)
    if isinstance(op, ast.BitOr) and isinstance(left, dict) and isinstance(right, dict):
        return {**left, **right}
    if isinstance(left, _NUMBERS) and isinstance(right, _NUMBERS) and type(op) in _OPERATORS:
        try:
            if abs(left) < 1 << 64 and abs(right) < 1 << 64:
                return _OPERATORS[type(op)](left, right)
        except (ArithmeticError, TypeError, ValueError):
            raise Raised from None
    if isinstance(op, ast.Mult):
        if isinstance(left, int):
            left, right = right, left
        if isinstance(left, (str, list, tuple)) and isinstance(right, int) and len(left) * right <= _MOST_ITEMS:
            return left * right
    for lost in (left, right):
        machine.lose(lost)
    return Unknown("the result of an operator")


def _percent(left: str, right: Value, node: ast.expr, frame: Frame) -> Value:
    values = list(right) if isinstance(right, tuple) else [right]
    rows = [text_of(value) for value in values]
    pieces = left.split("%s")
    if len(pieces) == len(rows) + 1 and "%" not in "".join(pieces).replace("%%", ""):
        made = joined(rows, lambda row: "".join(a + b for a, b in zip(pieces, (*row, ""), strict=True)).replace("%%", "%"))
        return texts_made(made, node, frame)
    if all(isinstance(plain(value), (str, *_NUMBERS)) for value in values) and len(left) < 500 and not _wide(left):
        try:
            return written(left % tuple(plain(value) for value in values), node, frame.source)
        except (TypeError, ValueError):
            raise Raised from None
    return Unknown("text made with %")


def _wide(template: str) -> bool:
    return any(len(run) > 3 for run in "".join(c if c.isdigit() else " " for c in template).split())


def _unary(machine: Machine, node: ast.UnaryOp, frame: Frame) -> Value:
    value = machine.evaluate(node.operand, frame)
    if isinstance(node.op, ast.Not):
        return negated(machine, value)
    value = plain(value)
    if isinstance(value, _NUMBERS) and isinstance(node.op, ast.USub):
        return -value
    return value if isinstance(value, _NUMBERS) and isinstance(node.op, ast.UAdd) else Unknown("the result of an operator")


def negated(machine: Machine, value: Value) -> Value:
    """Return the opposite of the truth of a value."""
    answer, condition = truth(machine, value)
    if answer is not None:
        return not answer
    opposite = None if condition is PERHAPS else condition._replace(wanted=not condition.wanted)
    return Unknown("not known to be true", opposite)


def _boolean(machine: Machine, node: ast.BoolOp, frame: Frame) -> Value:
    stop_at = isinstance(node.op, ast.Or)
    perhaps: list[Value] = []
    for part in node.values:
        value = machine.evaluate(part, frame)
        answer, _ = truth(machine, value)
        if answer is stop_at:
            return union([*perhaps, value]) if perhaps else value
        if answer is None or part is node.values[-1]:
            perhaps.append(value)
    if len(perhaps) == 1:
        return perhaps[0]
    return union(perhaps)


_COMPARISONS: dict[type[ast.cmpop], Callable[[Any, Any], Any]] = {
    ast.Eq: operator.eq,
    ast.NotEq: operator.ne,
    ast.Lt: operator.lt,
    ast.LtE: operator.le,
    ast.Gt: operator.gt,
    ast.GtE: operator.ge,
}


def _compare(machine: Machine, node: ast.Compare, frame: Frame) -> Value:
    left = machine.evaluate(node.left, frame)
    result: Value = True
    for op, right_node in zip(node.ops, node.comparators, strict=True):
        right = machine.evaluate(right_node, frame)
        result = _both(op, left, right)
        if len(node.ops) == 1:
            return result
        answer, _ = truth(machine, result)
        if answer is not True:
            return result if answer is False else Unknown("a chain of comparisons")
        left = right
    return result


def _both(op: ast.cmpop, left: Value, right: Value) -> Value:
    return each(left, lambda one: each(right, lambda other: _one_compare(op, one, other)))


def _one_compare(op: ast.cmpop, left: Value, right: Value) -> Value:
    if isinstance(op, (ast.Is, ast.IsNot)):
        if isinstance(left, Unknown) or isinstance(right, Unknown):
            return Unknown("identity with what is not known")
        same = left is right or (isinstance(left, (str, *_NUMBERS)) and type(left) is type(right) and left == right)
        return same is isinstance(op, ast.Is)
    if isinstance(op, (ast.In, ast.NotIn)):
        return _contained(op, left, right)
    if isinstance(left, Unknown) or isinstance(right, Unknown):
        return Unknown("comparison with what is not known")
    if isinstance(op, (ast.Eq, ast.NotEq)):
        if isinstance(left, FilePath) and isinstance(right, FilePath):
            left, right = left.text, right.text
        if isinstance(left, str) and isinstance(right, str) and not (is_plain(left) and is_plain(right)) and left != right:
            if is_plain(left):
                left, right = right, left
            if is_plain(right):
                return Unknown("comparison with an argument", LaunchCondition((str(left),), str(right), isinstance(op, ast.Eq)))
            return Unknown("comparison with what is not known")
    try:
        return bool(_COMPARISONS[type(op)](left, right))
    except (TypeError, RecursionError):
        raise Raised from None


def _contained(op: ast.cmpop, left: Value, right: Value) -> Value:
    wanted = isinstance(op, ast.In)
    if isinstance(right, Api) and right.name == "installed packages" and isinstance(left, str):
        return Unknown("whether a package is installed", LaunchCondition((presence(left),), None, wanted))
    if isinstance(right, str):
        if isinstance(left, str) and is_plain(left) and is_plain(right):
            return (left in right) is wanted
    elif isinstance(right, (list, tuple, dict, range)) and isinstance(left, (str, *_NUMBERS, type(None))):
        inner = [plain(one) for one in right]
        if any(isinstance(one, (str, *_NUMBERS)) and one == left for one in inner):
            return wanted
        known = all(isinstance(one, (*_NUMBERS, type(None))) or (isinstance(one, str) and is_plain(one)) for one in inner)
        if known and (not isinstance(left, str) or is_plain(left)):
            return not wanted
        if known and len(inner) == 1 and isinstance(inner[0], str):
            return Unknown("comparison with an argument", LaunchCondition((str(left),), inner[0], wanted))
    return Unknown("membership that is not known")


def _choice(machine: Machine, node: ast.IfExp, frame: Frame) -> Value:
    answer, condition = truth(machine, machine.evaluate(node.test, frame))
    if answer is not None:
        return machine.evaluate(node.body if answer else node.orelse, frame)
    with machine.under(condition):
        first = machine.evaluate(node.body, frame)
    opposite = opposite_of(condition)
    with machine.under(opposite):
        second = machine.evaluate(node.orelse, frame)
    return union([Guarded(first, (condition,)), Guarded(second, (opposite,))])


def opposite_of(condition: LaunchCondition) -> LaunchCondition:
    """Return the condition that holds when this one does not."""
    return PERHAPS if condition is PERHAPS else condition._replace(wanted=not condition.wanted)


def _attribute(machine: Machine, node: ast.Attribute, frame: Frame) -> Value:
    return each(machine.evaluate(node.value, frame), lambda one: attribute(machine, one, node, frame))


def _subscript(machine: Machine, node: ast.Subscript, frame: Frame) -> Value:
    owner = machine.evaluate(node.value, frame)
    if isinstance(node.slice, ast.Slice):
        parts = [
            plain(machine.evaluate(part, frame)) if part is not None else None
            for part in (node.slice.lower, node.slice.upper, node.slice.step)
        ]
        return each(owner, lambda one: _slice(one, parts))
    key = machine.evaluate(node.slice, frame)
    return each(owner, lambda one: each(key, lambda other: subscript(machine, one, other)))


def _slice(owner: Value, parts: list[Value]) -> Value:
    known = all(part is None or isinstance(part, int) for part in parts)
    if known and (isinstance(owner, (list, tuple)) or (isinstance(owner, str) and is_plain(owner))):
        try:
            return owner[slice(*parts)]
        except ValueError:
            raise Raised from None
    return Unknown("part of what is not known")


def subscript(machine: Machine, owner: Value, key: Value) -> Value:
    """Return an element of a value."""
    if isinstance(owner, dict):
        if isinstance(key, str) and not is_plain(key):
            return union(owner.values()) if owner else Unknown("element of an empty dictionary")
        name = hashable(key)
        if name in owner:
            return owner[name]
        if isinstance(key, Unknown) or UNKNOWN in owner:
            return union(owner.values()) if owner else Unknown("element of an empty dictionary")
        raise Raised
    if isinstance(owner, (list, tuple)):
        if isinstance(key, int):
            try:
                return plain(owner[key])
            except IndexError:
                raise Raised from None
        return union(owner) if owner else Unknown("element of an empty list")
    if isinstance(owner, str) and is_plain(owner) and isinstance(key, int):
        try:
            return owner[key]
        except IndexError:
            raise Raised from None
    return machine.subscript_of_library(owner, key)


def _call(machine: Machine, node: ast.Call, frame: Frame) -> Value:
    function = machine.evaluate(node.func, frame)
    arguments: list[Value] = []
    complete = True
    for argument in node.args:
        if not isinstance(argument, ast.Starred):
            arguments.append(machine.evaluate(argument, frame))
            continue
        value = machine.evaluate(argument.value, frame)
        inner = items(machine, value)
        complete = complete and inner is not None
        arguments += inner if inner is not None else [value]
    keywords: dict[str, Value] = {}
    for keyword in node.keywords:
        value = machine.evaluate(keyword.value, frame)
        if keyword.arg is not None:
            keywords[keyword.arg] = value
            continue
        inner_value = plain(value)
        if isinstance(inner_value, dict):
            keywords.update({str(name): one for name, one in inner_value.items()})
        else:
            machine.lose(value)
    return each(function, lambda one: machine.call(one, arguments, keywords, node, frame))


def _lambda(machine: Machine, node: ast.Lambda, frame: Frame) -> Value:
    return machine.function(node, frame)


def _comprehension(machine: Machine, node: ast.ListComp | ast.SetComp | ast.GeneratorExp, frame: Frame) -> Value:
    found: list[Value] = []
    inner = Frame(frame.source, frame, {})
    _generate(machine, node.generators, inner, lambda: found.append(machine.guard(machine.evaluate(node.elt, inner))))
    return found


def _dict_comprehension(machine: Machine, node: ast.DictComp, frame: Frame) -> Value:
    found: dict[Value, Value] = {}
    inner = Frame(frame.source, frame, {})

    def add() -> None:
        key = hashable(plain(machine.evaluate(node.key, inner)))
        found[key] = machine.evaluate(node.value, inner)

    _generate(machine, node.generators, inner, add)
    return found


def _generate(machine: Machine, generators: list[ast.comprehension], frame: Frame, produce: Callable[[], None]) -> None:
    first, rest = generators[0], generators[1:]
    values = items(machine, machine.evaluate(first.iter, frame))
    guards: list[tuple[Value, Conditions]] = []
    if values is None:
        guards.append((Unknown("element of what is not known"), (PERHAPS,)))
    else:
        guards = [(plain(one), _around(one)) for one in values]
    for value, conditions in guards:
        machine.bind(first.target, value, frame)
        needed = list(conditions)
        for test in first.ifs:
            answer, condition = truth(machine, machine.evaluate(test, frame))
            if answer is False:
                break
            if answer is None:
                needed.append(condition)
        else:
            with machine.under(*needed):
                if rest:
                    _generate(machine, rest, frame, produce)
                else:
                    produce()


def _around(value: Value) -> Conditions:
    conditions: Conditions = ()
    while isinstance(value, Guarded):
        conditions += value.conditions
        value = value.value
    return conditions


def _slice_object(machine: Machine, node: ast.Slice, frame: Frame) -> Value:  # noqa: ARG001
    return Unknown("a slice")


def _named(machine: Machine, node: ast.NamedExpr, frame: Frame) -> Value:
    value = machine.evaluate(node.value, frame)
    machine.bind(node.target, value, frame)
    return value


def _starred(machine: Machine, node: ast.Starred, frame: Frame) -> Value:
    return machine.evaluate(node.value, frame)


def _yield(machine: Machine, node: ast.Yield, frame: Frame) -> Value:
    frame.yielded.append(machine.guard(machine.evaluate(node.value, frame) if node.value is not None else None))
    return None


def _yield_from(machine: Machine, node: ast.YieldFrom, frame: Frame) -> Value:
    value = machine.evaluate(node.value, frame)
    frame.yielded += items(machine, value) or [value]
    return None


def _await(machine: Machine, node: ast.Await, frame: Frame) -> Value:
    return machine.evaluate(node.value, frame)


EVALUATE: dict[type[ast.expr], Callable[[Machine, Any, Frame], Value]] = {
    ast.Constant: _constant,
    ast.Name: _name,
    ast.List: _list,
    ast.Tuple: _tuple,
    ast.Set: _set,
    ast.Dict: _dict,
    ast.JoinedStr: _formatted,
    ast.BinOp: _operation,
    ast.UnaryOp: _unary,
    ast.BoolOp: _boolean,
    ast.Compare: _compare,
    ast.IfExp: _choice,
    ast.Attribute: _attribute,
    ast.Subscript: _subscript,
    ast.Call: _call,
    ast.Lambda: _lambda,
    ast.ListComp: _comprehension,
    ast.SetComp: _comprehension,
    ast.GeneratorExp: _comprehension,
    ast.DictComp: _dict_comprehension,
    ast.NamedExpr: _named,
    ast.Starred: _starred,
    ast.Slice: _slice_object,
    ast.Yield: _yield,
    ast.YieldFrom: _yield_from,
    ast.Await: _await,
}
