"""Evaluation of Python expressions, whose operands may be unknown or have alternatives."""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterable
from contextlib import suppress
from typing import TYPE_CHECKING, Any

from ros_lint.collectors.conditional_text import joined
from ros_lint.collectors.python.interpreter.alternatives import alternatives, around, cause, plain, union
from ros_lint.collectors.python.interpreter.assignments import bind
from ros_lint.collectors.python.interpreter.complements import opposite_of
from ros_lint.collectors.python.interpreter.dictionaries import value_or_default
from ros_lint.collectors.python.interpreter.elements import sliced, subscript
from ros_lint.collectors.python.interpreter.methods import attribute, items, more
from ros_lint.collectors.python.interpreter.operations import (
    INSTALLED,
    compared,
    each,
    hashable,
    negated,
    operation,
    text_of,
    texts_made,
    truth,
    with_format,
)
from ros_lint.collectors.python.interpreter.ordering import unique
from ros_lint.collectors.python.interpreter.values import (
    PERHAPS,
    Conditions,
    Frame,
    Guarded,
    LibraryName,
    ProgramRaised,
    SetOf,
    Union,
    Unknown,
    Value,
    settled,
    written,
)
from ros_lint.collectors.symbolic_text import UNKNOWN, expression, quoted
from ros_lint.facts.launch import LaunchCondition

if TYPE_CHECKING:
    from ros_lint.collectors.python.interpreter.protocol import Interpreter


_NUMBERS = (int, float, bool)


def _constant(_: Interpreter, node: ast.Constant, frame: Frame) -> Value:
    return written(node.value, node, frame.source) if isinstance(node.value, str) else node.value


def _name(machine: Interpreter, node: ast.Name, frame: Frame) -> Value:
    around: Frame | None = frame.declared.get(node.id, frame)
    while around is not None:
        if node.id in around.names:
            return settled(around.names[node.id])
        around = around.outer
    return machine.builtin(node, frame)


def _list(machine: Interpreter, node: ast.List, frame: Frame) -> Value:
    return _elements(machine, node.elts, frame)


def _tuple(machine: Interpreter, node: ast.Tuple, frame: Frame) -> Value:
    elements = _elements(machine, node.elts, frame)
    return tuple(elements) if isinstance(elements, list) else elements


def _set(machine: Interpreter, node: ast.Set, frame: Frame) -> Value:
    # Represented by a list, because its order does not matter and its elements need not be hashable.
    elements = _elements(machine, node.elts, frame)
    return SetOf(unique(elements)) if isinstance(elements, list) else elements


def _elements(machine: Interpreter, nodes: Iterable[ast.expr], frame: Frame) -> Value:
    elements: list[Value] = []
    for node in nodes:
        if not isinstance(node, ast.Starred):
            elements.append(machine.evaluate(node, frame))
            continue
        value = machine.evaluate(node.value, frame)
        inner = items(machine, value)
        if inner is None:
            machine.escape(value)
            inner = [more(value, "a list with * of an unknown value")]
        elements += inner
    return elements


def _dict(machine: Interpreter, node: ast.Dict, frame: Frame) -> Value:
    entries: dict[Value, Value] = {}
    unknown: Value = None
    for key_node, value_node in zip(node.keys, node.values, strict=True):
        value = machine.evaluate(value_node, frame)
        if key_node is None:
            value = plain(value)
            if isinstance(value, dict):
                entries.update(value)
            else:
                unknown = value
            continue
        key = plain(machine.evaluate(key_node, frame))
        entries[hashable(machine, key)] = value
    if unknown is not None:
        machine.escape(entries)
        entries[UNKNOWN] = cause(unknown, "elements that are not known")
    return entries


def _formatted(machine: Interpreter, node: ast.JoinedStr, frame: Frame) -> Value:
    rows: list[tuple[str, ...]] = []
    operands: list[Value] = []
    for part in node.values:
        if isinstance(part, ast.Constant):
            rows.append((str(part.value),))
            continue
        assert isinstance(part, ast.FormattedValue)
        value = machine.evaluate(part.value, frame)
        machine.record_misuse(value, "formatted", node, frame)
        operands.append(value)
        texts = text_of(value)
        if part.format_spec is not None or part.conversion not in (-1, 115):
            spec = machine.evaluate(part.format_spec, frame) if part.format_spec is not None else ""
            texts = tuple(with_format(plain(value), text, plain(spec), part.conversion) for text in texts)
        rows.append(texts)
    return machine.result(texts_made(joined(rows, "".join), node, frame), operands)


def _operation(machine: Interpreter, node: ast.BinOp, frame: Frame) -> Value:
    left = machine.evaluate(node.left, frame)
    right = machine.evaluate(node.right, frame)
    return operation(machine, node.op, left, right, node, frame)


def _unary(machine: Interpreter, node: ast.UnaryOp, frame: Frame) -> Value:
    value = machine.evaluate(node.operand, frame)
    if isinstance(node.op, ast.Not):
        machine.record_misuse(value, "tested", node, frame)
        return negated(machine, value)
    result = each(value, lambda number: _unary_of(node.op, number))
    return machine.result(result, (value,))


def _unary_of(op: ast.unaryop, value: Value) -> Value:
    if isinstance(value, _NUMBERS) and isinstance(op, (ast.USub, ast.UAdd)):
        return -value if isinstance(op, ast.USub) else +value
    return ~value if isinstance(value, int) and isinstance(op, ast.Invert) else Unknown("the result of an operator")


def _boolean(machine: Interpreter, node: ast.BoolOp, frame: Frame) -> Value:
    stop_at = isinstance(node.op, ast.Or)
    perhaps: list[Value] = []
    passed: Conditions = ()
    for part in node.values:
        with machine.under(*passed):
            value = machine.evaluate(part, frame)
        if part is not node.values[-1]:
            machine.record_misuse(value, "tested", part, frame)
        answer, condition = truth(machine, value)
        if part is node.values[-1] or answer is stop_at:
            if not (
                value == "" and any(isinstance(plain(alternative), Unknown) for alternative in perhaps)
            ):  # an unknown value may be an empty text
                perhaps.append(Guarded(value, passed) if passed else value)
            break
        if answer is None:
            condition = machine.fresh(condition, part)
            ends = condition if stop_at else opposite_of(condition)
            perhaps.append(Guarded(value, (*passed, ends)))
            passed = (*passed, opposite_of(ends))
    if len(perhaps) == 1:
        return perhaps[0]
    together = _together([plain(alternative) for alternative in perhaps], "or" if stop_at else "and")
    return union(perhaps) if together is None else together


def _together(values: list[Value], word: str) -> Value:
    """Return the truth value of comparisons combined by "and" or "or" (``word``): an Unknown with the condition for True.

    ``values`` are the results of the comparisons, such as ``LaunchConfiguration("a") == "b"``. Each comparison must compare a
    text that is known only at launch with a known text. Otherwise the result is None.
    """
    parts: list[str] = []
    for value in values:
        condition = value.condition if isinstance(value, Unknown) else None
        if condition is None or condition.equals is None or len(condition.texts) != 1 or UNKNOWN in condition.texts[0]:
            return None
        sign = "==" if condition.wanted else "!="
        parts.append(f"{quoted(condition.texts[0])} {sign} {quoted(condition.equals)}")
    return Unknown("a truth", LaunchCondition((expression(f" {word} ".join(parts)),), None))


def _compare(machine: Interpreter, node: ast.Compare, frame: Frame) -> Value:
    left = machine.evaluate(node.left, frame)
    result: Value = True
    for op, right_node in zip(node.ops, node.comparators, strict=True):
        right = machine.evaluate(right_node, frame)
        if isinstance(op, (ast.In, ast.NotIn)) and isinstance(right, (list, tuple, dict, str)):
            machine.budget.step(len(right) // 8)
        elif isinstance(op, (ast.Eq, ast.NotEq)):
            for side, opposite_side in ((left, right), (right, left)):
                if isinstance(opposite_side, str):
                    machine.record_misuse(side, "compared", node, frame)
        container = machine.present(right) if isinstance(op, (ast.In, ast.NotIn)) and isinstance(right, list) else right
        result = machine.result(compared(op, left, container), (left, right))
        if len(node.ops) == 1:
            return result
        answer, _ = truth(machine, result)
        if answer is not True:
            return result if answer is False else Unknown("a chain of comparisons")
        left = right
    return result


def _choice(machine: Interpreter, node: ast.IfExp, frame: Frame) -> Value:
    test = machine.evaluate(node.test, frame)
    machine.record_misuse(test, "tested", node.test, frame)
    answer, condition = truth(machine, test)
    if answer is not None:
        return machine.evaluate(node.body if answer else node.orelse, frame)
    condition = machine.fresh(condition, node.test)
    with machine.under(condition):
        first = machine.evaluate(node.body, frame)
    opposite = opposite_of(condition)
    with machine.under(opposite):
        second = machine.evaluate(node.orelse, frame)
    return machine.joined([Guarded(first, (condition,)), Guarded(second, (opposite,))])


def _attribute(machine: Interpreter, node: ast.Attribute, frame: Frame) -> Value:
    owner = machine.evaluate(node.value, frame)
    if not isinstance(owner, (Guarded, Union)):
        return machine.result(attribute(machine, owner, node, frame), (owner,))
    return each(owner, lambda alternative: attribute(machine, alternative, node, frame))


def _subscript(machine: Interpreter, node: ast.Subscript, frame: Frame) -> Value:
    owner = machine.evaluate(node.value, frame)
    if isinstance(node.slice, ast.Slice):
        parts = [
            plain(machine.evaluate(part, frame)) if part is not None else None
            for part in (node.slice.lower, node.slice.upper, node.slice.step)
        ]
        return machine.result(each(owner, lambda alternative: sliced(machine, alternative, parts)), (owner, *parts))
    key = machine.evaluate(node.slice, frame)
    result = each(owner, lambda alternative: each(key, lambda key_alternative: subscript(machine, alternative, key_alternative)))
    return machine.result(result, (owner, key))


def _call(machine: Interpreter, node: ast.Call, frame: Frame) -> Value:
    function = machine.evaluate(node.func, frame)
    arguments: list[Value] = []
    for argument in node.args:
        if not isinstance(argument, ast.Starred):
            arguments.append(machine.evaluate(argument, frame))
            continue
        value = machine.evaluate(argument.value, frame)
        inner = items(machine, value)
        arguments += inner if inner is not None else [more(value)]
    keywords: dict[str, Value] = {}
    for keyword in node.keywords:
        value = machine.evaluate(keyword.value, frame)
        if keyword.arg is not None:
            keywords[keyword.arg] = value
            continue
        inner_value = plain(value)
        if isinstance(inner_value, dict):
            machine.budget.step(len(inner_value) // 8)
            keywords.update({str(name): value_or_default(machine, inner_value, name, None) for name in inner_value})
        else:
            machine.escape(value)
            keywords[UNKNOWN] = cause(inner_value, "keywords that are not known")
    if not isinstance(function, (Guarded, Union)):
        return machine.call(function, arguments, keywords, node, frame)
    # Each alternative is called only under its conditions.
    results: list[Value] = []
    for alternative in alternatives(plain(function)):
        with suppress(ProgramRaised), machine.under(*alternative.conditions):
            results.append(Guarded(machine.call(alternative.value, arguments, keywords, node, frame), alternative.conditions))
    if not results:
        raise ProgramRaised
    return union(results)


def _lambda(machine: Interpreter, node: ast.Lambda, frame: Frame) -> Value:
    return machine.function(node, frame)


def _inside(node: ast.expr, frame: Frame) -> Frame:
    """Return a new frame, that is, a new scope for the names of a comprehension.

    A name that ``:=`` binds in the comprehension belongs to the outer frame.
    """
    inner = Frame(frame.source, frame, {})
    if frame.source.assigns_inside:
        names = [node_inside.target.id for node_inside in ast.walk(node) if isinstance(node_inside, ast.NamedExpr)]
        inner.declared = {name: frame.declared.get(name, frame) for name in names}
    return inner


def _comprehension(machine: Interpreter, node: ast.ListComp | ast.SetComp | ast.GeneratorExp, frame: Frame) -> Value:
    elements: list[Value] = []
    inner = _inside(node, frame)
    of = machine.evaluate(node.generators[0].iter, inner)
    if isinstance(of, LibraryName) and of.name == INSTALLED:
        return of  # for any element, because a membership test of the result tests for installed packages
    _generate(machine, node.generators, of, inner, lambda: elements.append(machine.guard(machine.evaluate(node.elt, inner))))
    return SetOf(unique(elements)) if isinstance(node, ast.SetComp) else elements


def _dict_comprehension(machine: Interpreter, node: ast.DictComp, frame: Frame) -> Value:
    entries: dict[Value, Value] = {}
    inner = _inside(node, frame)

    def add() -> None:
        key = hashable(machine, plain(machine.evaluate(node.key, inner)))
        entries[key] = machine.guard(machine.evaluate(node.value, inner))

    _generate(machine, node.generators, machine.evaluate(node.generators[0].iter, inner), inner, add)
    return entries


def _generate(
    machine: Interpreter, generators: list[ast.comprehension], of: Value, frame: Frame, produce: Callable[[], None]
) -> None:
    """Call ``produce`` for each iteration of a comprehension, while the names of its targets are bound in ``frame``.

    ``generators`` are the ``for`` parts of the comprehension, and ``of`` is the value that the first of them iterates over.
    """
    first, rest = generators[0], generators[1:]
    values = items(machine, of)
    guards: list[tuple[Value, Conditions]] = []
    if values is None:
        guards.append((cause(of, "element of an unknown value"), (PERHAPS,)))
    else:
        guards = [(plain(element), around(element)) for element in values]
    for value, conditions in guards:
        bind(machine, first.target, value, frame)
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
                    _generate(machine, rest, machine.evaluate(rest[0].iter, frame), frame, produce)
                else:
                    produce()


def _slice_object(machine: Interpreter, node: ast.Slice, frame: Frame) -> Value:  # noqa: ARG001
    return Unknown("a slice")


def _named(machine: Interpreter, node: ast.NamedExpr, frame: Frame) -> Value:
    value = machine.evaluate(node.value, frame)
    bind(machine, node.target, value, frame)
    return value


def _starred(machine: Interpreter, node: ast.Starred, frame: Frame) -> Value:
    return machine.evaluate(node.value, frame)


def _yield(machine: Interpreter, node: ast.Yield, frame: Frame) -> Value:
    frame.yielded.append(machine.guard(machine.evaluate(node.value, frame) if node.value is not None else None))
    return None


def _yield_from(machine: Interpreter, node: ast.YieldFrom, frame: Frame) -> Value:
    value = machine.evaluate(node.value, frame)
    frame.yielded += items(machine, value) or [value]
    return None


def _await(machine: Interpreter, node: ast.Await, frame: Frame) -> Value:
    return machine.evaluate(node.value, frame)


EVALUATE: dict[type[ast.expr], Callable[[Interpreter, Any, Frame], Value]] = {
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
