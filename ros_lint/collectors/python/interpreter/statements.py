"""Interpretation of Python statements except assignments, imports and loops."""

from __future__ import annotations

import ast
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, TypeVar

from ros_lint.base.budget import BudgetExceeded
from ros_lint.collectors.python.exceptions import catching, kind_raised
from ros_lint.collectors.python.interpreter import assignments
from ros_lint.collectors.python.interpreter.alternatives import plain
from ros_lint.collectors.python.interpreter.assignments import bind
from ros_lint.collectors.python.interpreter.branches import (
    BREAK,
    CONTINUE,
    LEAVE,
    NEXT,
    either,
    follow_for,
    follow_while,
    forget_conditions,
    gives_up,
)
from ros_lint.collectors.python.interpreter.operations import truth
from ros_lint.collectors.python.interpreter.values import (
    Bound,
    Class,
    Conditions,
    Frame,
    Function,
    Guarded,
    LibraryName,
    ProgramRaised,
    Unknown,
    Value,
)
from ros_lint.collectors.python.lookups import catches_missing_file, catches_missing_package
from ros_lint.collectors.python.string_values import LOOK_UPS, callee
from ros_lint.collectors.symbolic_text import presence
from ros_lint.facts.launch import LaunchCondition

if TYPE_CHECKING:
    from ros_lint.collectors.python.interpreter.protocol import Interpreter

_Node = TypeVar("_Node", bound=ast.AST)


def execute(machine: Interpreter, body: Sequence[ast.stmt], frame: Frame) -> int:
    """Interpret statements, and return how they end: NEXT, CONTINUE, BREAK or LEAVE.

    Raises ProgramRaised and BudgetExceeded.
    """
    depth = len(machine.conditions)
    for statement in body:
        handler = _STATEMENTS.get(type(statement))
        if handler is not None:
            try:
                signal = handler(machine, statement, frame)
            except BudgetExceeded:
                machine.stop_at(statement, frame.source)
                raise
            if signal:
                return signal
            forget_conditions(machine, depth)
    return NEXT


def _expression(machine: Interpreter, node: ast.Expr, frame: Frame) -> int:
    machine.evaluate(node.value, frame)
    return NEXT


def _if(machine: Interpreter, node: ast.If, frame: Frame) -> int:
    test = node.test
    if isinstance(test, ast.BoolOp) and isinstance(test.op, ast.And) and not node.orelse and not _may_leave(node.body):
        inner: list[ast.stmt] = node.body  # nested if statements, so that each condition is evaluated by itself
        for part in reversed(test.values[1:]):
            inner = [ast.copy_location(ast.If(part, inner, []), node)]
        node = ast.copy_location(ast.If(test.values[0], inner, []), node)
    value = machine.evaluate(node.test, frame)
    machine.record_misuse(value, "tested", node.test, frame)
    answer, condition = truth(machine, value)
    if answer is not None:
        return execute(machine, node.body if answer else node.orelse, frame)
    return either(machine, node.body, node.orelse, condition, frame, test=node.test)


def _may_leave(body: Sequence[ast.stmt]) -> bool:
    ways_out = (ast.Return, ast.Raise, ast.Break, ast.Continue)
    return any(isinstance(node, ways_out) for statement in body for node in ast.walk(statement))


def _with(machine: Interpreter, node: ast.With | ast.AsyncWith, frame: Frame) -> int:
    for item in node.items:
        value = machine.evaluate(item.context_expr, frame)
        if item.optional_vars is not None:
            bind(machine, item.optional_vars, value, frame)
    return execute(machine, node.body, frame)


def _try(machine: Interpreter, node: ast.Try, frame: Frame) -> int:
    before = machine.conditions
    called = machine.called.get(node)
    if called is None:
        called = machine.called[node] = _called(node.body)
    missing = next((handler for handler in node.handlers if catches_missing_package(handler)), None)
    if missing is not None and not called.isdisjoint(LOOK_UPS) and not gives_up(missing.body, everywhere=not machine.conditions):
        # The package is optional, because the file handles the case that it is missing.
        there = LaunchCondition((presence(machine.another()),), None)
        signal = either(machine, [*node.body, *node.orelse], missing.body, there, frame)
        return _finally(machine, node, frame, before) or signal
    absent = next((handler for handler in node.handlers if catches_missing_file(handler)), None)
    if (
        absent is not None
        and not called.isdisjoint(_OPENERS)
        and _assigns(absent.body)
        and not gives_up(absent.body, everywhere=False)
    ):
        exists = LaunchCondition((machine.another(),), None)  # the machine that runs the launch file may have the file
        machine.guarded += 1
        try:
            signal = either(machine, [*node.body, *node.orelse], absent.body, exists, frame)
        finally:
            machine.guarded -= 1
        return _finally(machine, node, frame, before) or signal
    guarded = absent is not None
    machine.guarded += guarded
    machine.caught += bool(node.handlers)
    raised: ProgramRaised | None = None
    signal = NEXT
    try:
        signal = execute(machine, node.body, frame)
    except ProgramRaised as error:
        raised = error
    finally:
        machine.guarded -= guarded
        machine.caught -= bool(node.handlers)
    if raised is not None:
        handler = catching(node, raised.kind)
        if handler is None:
            _finally(machine, node, frame, before)
            raise raised
        if handler.name:
            frame.names[handler.name] = Unknown("an exception")
        signal = execute(machine, handler.body, frame)
    elif signal == NEXT:
        signal = execute(machine, node.orelse, frame)
    return _finally(machine, node, frame, before) or signal


def _finally(machine: Interpreter, node: ast.Try, frame: Frame, before: Conditions) -> int:
    """Interpret the finally block of a try statement, and return how the block ends: NEXT, CONTINUE, BREAK or LEAVE.

    ``before`` are the conditions under which the try statement runs. The finally block runs under the same conditions.
    """
    after, machine.conditions = machine.conditions, before
    signal = execute(machine, node.finalbody, frame)
    machine.conditions = (*after, *machine.conditions[len(before) :])
    return signal


_OPENERS = frozenset({"open", "read_bytes", "read_text"})


def _called(body: Sequence[ast.stmt]) -> frozenset[str]:
    """Return the names of the functions and methods that a block calls."""
    return frozenset([callee(node) for statement in body for node in ast.walk(statement) if isinstance(node, ast.Call)])


def _assigns(body: Sequence[ast.stmt]) -> bool:
    """Return whether a statement of a block assigns a value that the code after the block can use."""
    return any(isinstance(statement, ast.Assign | ast.AnnAssign | ast.AugAssign) for statement in body)


def _return(machine: Interpreter, node: ast.Return, frame: Frame) -> int:
    value = machine.evaluate(node.value, frame) if node.value is not None else None
    frame.returned.append(Guarded(value, machine.conditions))
    return LEAVE


def _raise(machine: Interpreter, node: ast.Raise, frame: Frame) -> int:
    if not machine.caught:
        machine.raises.append((node, frame.source, machine.conditions))
    raise ProgramRaised(kind_raised(node), deliberate=True)


def _break(_machine: Interpreter, _node: ast.Break, _frame: Frame) -> int:
    return BREAK


def _continue(_machine: Interpreter, _node: ast.Continue, _frame: Frame) -> int:
    return CONTINUE


_SUBJECT, _ANYTHING = "<subject>", "<anything>"
"""Names for the subject of a match statement and for the unknown result of a pattern. No program can contain these names."""


def _match(machine: Interpreter, node: ast.Match, frame: Frame) -> int:
    subject = frame.names[_SUBJECT] = machine.evaluate(node.subject, frame)
    frame.names[_ANYTHING] = Unknown("whether a pattern fits")
    chain: list[ast.stmt] = []
    for case in reversed(node.cases):
        for inner in ast.walk(case.pattern):
            if isinstance(inner, (ast.MatchAs, ast.MatchStar)) and inner.name:
                frame.names[inner.name] = subject
        test = _fits(case.pattern)
        if case.guard is not None:
            test = ast.BoolOp(ast.And(), [test, case.guard])
        chain = [_at(ast.If(_at(test, case.pattern), case.body, chain), case.pattern)]
    return execute(machine, chain, frame)


def _fits(pattern: ast.pattern) -> ast.expr:
    """Return an expression that tests whether the subject of a match statement fits a pattern.

    ``case 1`` -> ``subject == 1``
    """
    subject: ast.expr = _at(ast.Name(_SUBJECT), pattern)
    match pattern:
        case ast.MatchValue(value=value):
            return _at(ast.Compare(subject, [ast.Eq()], [value]), pattern)
        case ast.MatchSingleton(value=value):
            return _at(ast.Compare(subject, [ast.Is()], [_at(ast.Constant(value), pattern)]), pattern)
        case ast.MatchOr(patterns=patterns):
            return _at(ast.BoolOp(ast.Or(), [_fits(alternative) for alternative in patterns]), pattern)
        case ast.MatchAs(pattern=None):
            return _at(ast.Constant(value=True), pattern)
        case ast.MatchAs(pattern=inner) if inner is not None:
            return _fits(inner)
    return _at(ast.Name(_ANYTHING), pattern)


def _at(made: _Node, place: ast.AST) -> _Node:
    return ast.copy_location(made, place)


def _function(machine: Interpreter, node: ast.FunctionDef | ast.AsyncFunctionDef, frame: Frame) -> int:
    function: Value = machine.function(node, frame)
    for decorator in reversed(node.decorator_list):
        name = decorator.id if isinstance(decorator, ast.Name) else ""
        if name in ("classmethod", "staticmethod", "property"):
            function = Bound(function, [], {"": name})
        elif isinstance(function, Function):
            function = _decorated(machine, function, decorator, frame)
    frame.names[node.name] = function
    return NEXT


_LEAVING = frozenset({"abc", "builtins", "contextlib", "functools", "launch_testing", "pytest", "typing", "unittest"})
"""Modules whose decorators do not change what a function does."""


def _decorated(machine: Interpreter, function: Function, decorator: ast.expr, frame: Frame) -> Value:
    """Return the function that a decorator makes of ``function``.

    If the decorator is unknown, return ``function`` with the attribute ``changed`` set to True.
    """
    name = machine.evaluate(decorator.func if isinstance(decorator, ast.Call) else decorator, frame)
    if isinstance(name, LibraryName) and name.name.partition(".")[0] in _LEAVING:
        return function
    by = machine.evaluate(decorator, frame) if isinstance(decorator, ast.Call) else name
    if isinstance(by, Function):
        call = ast.copy_location(ast.Call(decorator, [], []), decorator)
        made = machine.call(by, [function], {}, call, frame)
        if isinstance(made, (Function, Bound)):
            return made
    function.changed = True
    return function


def _class(machine: Interpreter, node: ast.ClassDef, frame: Frame) -> int:
    bases = [plain(machine.evaluate(base, frame)) for base in node.bases]
    inner = Frame(frame.source, frame, {})
    execute(machine, node.body, inner)
    inner.names.settle()
    fields = [
        statement.target.id
        for statement in node.body
        if isinstance(statement, ast.AnnAssign) and isinstance(statement.target, ast.Name)
    ]
    cls = Class(node.name, bases, inner.names, fields)
    for value in inner.names.values():
        if isinstance(value, Function):
            value.owner = cls
            value.frame = frame  # the names of a class are not in the scope of its methods
        elif isinstance(value, Bound) and isinstance(value.function, Function):
            value.function.owner = cls
            value.function.frame = frame
    frame.names[node.name] = cls
    return NEXT


_STATEMENTS: dict[type[ast.stmt], Callable[[Interpreter, Any, Frame], int | None]] = {
    **assignments.STATEMENTS,
    ast.Expr: _expression,
    ast.If: _if,
    ast.For: follow_for,
    ast.AsyncFor: follow_for,
    ast.While: follow_while,
    ast.With: _with,
    ast.AsyncWith: _with,
    ast.Try: _try,
    ast.Return: _return,
    ast.Raise: _raise,
    ast.Break: _break,
    ast.Continue: _continue,
    ast.Match: _match,
    ast.FunctionDef: _function,
    ast.AsyncFunctionDef: _function,
    ast.ClassDef: _class,
}
if hasattr(ast, "TryStar"):
    _STATEMENTS[ast.TryStar] = _try
