"""Interpretation of statements that bind names: assignments, imports, deletions, global and nonlocal."""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING, Any

from ros_lint.collectors.conditional_text import are_consistent
from ros_lint.collectors.python.interpreter.alternatives import alternatives, around, cause, plain, union
from ros_lint.collectors.python.interpreter.dictionaries import store
from ros_lint.collectors.python.interpreter.elements import may_have_more
from ros_lint.collectors.python.interpreter.methods import items, more, replace
from ros_lint.collectors.python.interpreter.operations import hashable, operation
from ros_lint.collectors.python.interpreter.values import (
    Frame,
    Guarded,
    Instance,
    LaunchObject,
    LibraryName,
    ProgramRaised,
    Unknown,
    Value,
    Written,
    settled,
)
from ros_lint.collectors.symbolic_text import UNKNOWN, is_plain

if TYPE_CHECKING:
    from ros_lint.collectors.python.interpreter.protocol import Interpreter


def _assign(machine: Interpreter, node: ast.Assign, frame: Frame) -> None:
    value = machine.evaluate(node.value, frame)
    for target in node.targets:
        bind(machine, target, value, frame)


def _annotated(machine: Interpreter, node: ast.AnnAssign, frame: Frame) -> None:
    if node.value is not None:
        bind(machine, node.target, machine.evaluate(node.value, frame), frame)


def _augmented(machine: Interpreter, node: ast.AugAssign, frame: Frame) -> None:
    value = machine.evaluate(node.value, frame)
    load: ast.expr = node.target
    before = machine.evaluate(load, frame)
    target_value = plain(before)
    if isinstance(target_value, list) and isinstance(node.op, ast.Add):
        elements = items(machine, value)
        if elements is None:
            machine.escape(value)
            elements = [more(value)]
        machine.budget.step(len(elements))
        target_value += [machine.guard(element) for element in elements]
        return
    # An augmented text keeps the place of the original text.
    where = target_value.node if isinstance(target_value, Written) and target_value.source is frame.source else node.value
    bind(machine, node.target, operation(machine, node.op, before, value, where, frame), frame)


def bind(machine: Interpreter, target: ast.expr, value: Value, frame: Frame) -> None:
    """Assign a value to a target: a name, an attribute, a subscript, or a tuple or list of targets."""
    if isinstance(target, ast.Name):
        around = frame.declared.get(target.id)
        if around is not None and machine.conditions and target.id in around.names:
            value = machine.joined([Guarded(settled(around.names[target.id]), ()), Guarded(value, machine.conditions)])
        (around or frame).names[target.id] = value
    elif isinstance(target, (ast.Tuple, ast.List)):
        _unpack(machine, target.elts, value, frame)
    elif isinstance(target, ast.Attribute):
        for alternative in alternatives(machine.evaluate(target.value, frame)):
            if isinstance(alternative.value, Instance):
                _set_attribute(machine, alternative.value, target.attr, value)
            elif isinstance(alternative.value, LaunchObject):
                alternative.value.keywords[target.attr] = value
            else:
                machine.escape(value)
    elif isinstance(target, ast.Subscript):
        _store(machine, target, value, frame)
    elif isinstance(target, ast.Starred):
        bind(machine, target.value, value, frame)


def _set_attribute(machine: Interpreter, owner: Instance, name: str, value: Value) -> None:
    """Set an attribute of an object.

    If the interpreted code runs under conditions that did not hold when the object was created, the old value remains an
    alternative of the attribute.
    """
    beyond = tuple([condition for condition in machine.conditions if condition not in owner.conditions])
    before = owner.attributes[name] if name in owner.attributes else owner.cls.find(name)
    if beyond and before is not None:
        value = union([machine.removed(before), Guarded(value, beyond)])
    owner.attributes[name] = value


def _unpack(machine: Interpreter, targets: Sequence[ast.expr], value: Value, frame: Frame) -> None:
    values = items(machine, value)
    star = next((index for index, target in enumerate(targets) if isinstance(target, ast.Starred)), -1)
    if values is None or (star < 0 and len(values) != len(targets)) or len(values) < len(targets) - 1:
        machine.escape(value)
        for target in targets:
            bind(machine, target, cause(value, "part of an unknown value"), frame)
        return
    if star >= 0:
        after = len(targets) - star - 1
        values = [*values[:star], values[star : len(values) - after], *values[len(values) - after :]]
    for target, element in zip(targets, values, strict=True):
        bind(machine, target, plain(element), frame)


def _store(machine: Interpreter, target: ast.Subscript, value: Value, frame: Frame) -> None:
    key = _key(machine, target.slice, frame)
    for owner in _choices(machine, machine.evaluate(target.value, frame)):
        if isinstance(owner, list) and isinstance(key, slice):
            _store_slice(machine, owner, key, value)
        elif isinstance(owner, dict):
            store(machine, owner, hashable(machine, key), value)
        elif isinstance(owner, list) and isinstance(key, int) and -len(owner) <= key < len(machine.present(owner)):
            replace(machine, owner, key, [value])
        elif isinstance(owner, LibraryName) and owner.name == "os.environ":
            _set_variable(machine, target, key, value, frame)
        elif isinstance(owner, LibraryName) and owner.name == "context.launch_configurations" and isinstance(key, str):
            call = ast.copy_location(ast.Call(target, [target.slice, target], []), target)
            machine.set_configuration(key, value, call, frame.source)
        else:
            machine.escape(value)


def _choices(machine: Interpreter, value: Value) -> Iterator[Value]:
    """Yield each alternative of a value, except those that contradict the conditions under which the interpreted code runs.

    While the caller uses an alternative, the conditions of the alternative also apply to the interpreted code.
    """
    for alternative in alternatives(value):
        if are_consistent((*machine.conditions, *alternative.conditions)):
            with machine.under(*alternative.conditions):
                yield alternative.value


def _key(machine: Interpreter, node: ast.expr, frame: Frame) -> Value:
    """Return the value of the expression in the brackets of a subscript. ``a[1:2]`` -> ``slice(1, 2)``.

    The result for a slice with an unknown bound is Unknown.
    """
    if not isinstance(node, ast.Slice):
        return plain(machine.evaluate(node, frame))
    ends = [plain(machine.evaluate(end, frame)) if end is not None else None for end in (node.lower, node.upper, node.step)]
    return slice(*ends) if all(end is None or isinstance(end, int) for end in ends) else Unknown("a slice")


def _store_slice(machine: Interpreter, owner: list[Value], key: slice, value: Value) -> None:
    elements = items(machine, value)
    if elements is None:
        machine.escape(value)
        elements = [more(value)]
    try:
        replace(machine, owner, key, elements)
    except ValueError:
        raise ProgramRaised("ValueError") from None


def _set_variable(machine: Interpreter, target: ast.Subscript, name: Value, value: Value, frame: Frame) -> None:
    if isinstance(name, str) and is_plain(name):
        call = ast.copy_location(ast.Call(target, [target.slice, target], []), target)
        machine.set_variable(name, value, call, frame.source)


def _import(machine: Interpreter, node: ast.Import, frame: Frame) -> None:
    for alias in node.names:
        module = machine.module(alias.name, frame.source, node)
        top, *inner = alias.name.split(".")
        if alias.asname:
            frame.names[alias.asname] = module or LibraryName(alias.name)
        elif module is None or not inner:
            frame.names[top] = module or LibraryName(top)
        elif package := machine.module(top, frame.source, node):
            frame.names[top] = package
            for depth, name in enumerate(inner, 2):  # an import sets each module as an attribute of its package
                child = machine.module(".".join([top, *inner][:depth]), frame.source, node)
                if child is None:
                    break
                package.names[name] = child
                package = child


def _import_from(machine: Interpreter, node: ast.ImportFrom, frame: Frame) -> None:
    name = "." * node.level + (node.module or "")
    module = machine.module(name, frame.source, node)
    for alias in node.names:
        if alias.name == "*":
            for member, value in module.names.items() if module is not None else ():
                frame.names[member] = value
            continue
        if machine.library.is_substitution(alias.name):
            frame.names[alias.asname or alias.name] = machine.library.member(f"{name}.{alias.name}", node, frame.source)
            continue
        inner = settled(module.names.get(alias.name)) if module is not None else None
        if inner is None:
            full = f"{name}.{alias.name}" if node.module else f"{name}{alias.name}"
            inner = machine.module(full, frame.source, node)
        if inner is None:
            inner = machine.library.member(f"{name}.{alias.name}", node, frame.source)
        frame.names[alias.asname or alias.name] = inner


def _global(_machine: Interpreter, node: ast.Global, frame: Frame) -> None:
    outermost = frame
    while outermost.outer is not None:
        outermost = outermost.outer
    frame.declared.update(dict.fromkeys(node.names, outermost))


def _nonlocal(_machine: Interpreter, node: ast.Nonlocal, frame: Frame) -> None:
    for name in node.names:
        around = frame.outer
        while around is not None and name not in around.names:
            around = around.outer
        if around is not None:
            frame.declared[name] = around


def _delete(machine: Interpreter, node: ast.Delete, frame: Frame) -> None:
    waiting = list(node.targets)
    while waiting:
        target = waiting.pop(0)
        if isinstance(target, (ast.Tuple, ast.List)):
            waiting += target.elts
        elif isinstance(target, ast.Name):
            frame.declared.get(target.id, frame).names.discard(target.id)
        elif isinstance(target, ast.Attribute):
            owner = plain(machine.evaluate(target.value, frame))
            if isinstance(owner, Instance):
                owner.attributes.pop(target.attr, None)
        elif isinstance(target, ast.Subscript):
            key = _key(machine, target.slice, frame)
            for owner in _choices(machine, machine.evaluate(target.value, frame)):
                _delete_element(machine, owner, key)


def _delete_element(machine: Interpreter, owner: Value, key: Value) -> None:
    """Remove the item ``key`` of a list or dictionary.

    In code that runs only under conditions (a branch), the item is kept as perhaps missing instead.
    """
    if isinstance(owner, dict):
        key = hashable(machine, key)
        known = UNKNOWN not in owner and key != UNKNOWN
    elif isinstance(owner, list):
        known = isinstance(key, (int, slice)) and not may_have_more(owner)
    else:
        return
    try:
        if isinstance(owner, list):
            replace(machine, owner, key, [])
        elif machine.conditions and around(owner[key]) != machine.conditions:
            owner[key] = machine.removed(owner[key])
        else:
            del owner[key]
    except (LookupError, TypeError) as error:
        if known:
            raise ProgramRaised(type(error).__name__) from None


STATEMENTS: dict[type[ast.stmt], Callable[[Interpreter, Any, Frame], None]] = {
    ast.Assign: _assign,
    ast.AnnAssign: _annotated,
    ast.AugAssign: _augmented,
    ast.Import: _import,
    ast.ImportFrom: _import_from,
    ast.Global: _global,
    ast.Nonlocal: _nonlocal,
    ast.Delete: _delete,
}
"""The function that interprets each kind of statement in this module, by the syntax tree class of the statement."""
