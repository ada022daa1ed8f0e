"""Evaluation of the expressions of a setup.py, from its text and the names of the package's files."""

from __future__ import annotations

import ast
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Sequence
from typing import Any, Final

from ros_lint.collectors.setup_py.interpreter.files import ROOT, Files
from ros_lint.collectors.setup_py.interpreter.operators import UNARY, TooLargeError, binary, compare, formatted
from ros_lint.collectors.setup_py.interpreter.state import ExhaustedError, Journal, LeaveError, at
from ros_lint.collectors.setup_py.interpreter.values import (
    REST,
    Class,
    Function,
    Maybe,
    Module,
    Native,
    Unknown,
    Value,
    Word,
    certain,
    either,
    is_path,
    located,
    size_of,
    unknown_in,
)

MOST_STEPS: Final = 100_000
"""Expressions and statements that one setup.py may evaluate. Real ones need a few hundred."""
Scopes = tuple[dict[str, Value], ...]


class Expressions(ABC):
    """Evaluator of expressions in scopes. Subclasses define calls, attributes and builtins."""

    def __init__(self, files: Files) -> None:
        self.files = files
        self.journal = Journal()
        self.scopes: Scopes = ({"__file__": f"{ROOT}/setup.py", "__name__": "__main__"},)
        self.strange: list[ast.Name] = []
        """Undefined names in code that certainly runs."""
        self.caught = 0
        """Number of enclosing try statements with handlers."""
        self.inner = 0
        """Number of the innermost scopes that are scopes of comprehensions."""
        self._steps = 0

    @abstractmethod
    def call(self, function: Value, arguments: list[Value], keywords: dict[str, Value], node: ast.Call) -> Value:
        """Return the result of a call."""

    @abstractmethod
    def attribute(self, owner: Value, name: str, node: ast.AST) -> Value:
        """Return an attribute of a value."""

    @abstractmethod
    def builtin(self, name: str) -> Value | None:
        """Return the value of a name that the program does not define, None if it is no known builtin."""

    def step(self) -> None:
        self._steps += 1
        if self._steps > MOST_STEPS:
            raise ExhaustedError("it takes more steps than are followed")

    def weigh(self, *values: Value) -> None:
        """Count what looking through values takes. Raises ExhaustedError."""
        self._steps += size_of(values) >> 12
        self.step()

    def value(self, node: ast.expr) -> Value:
        """Return the value of an expression. Raises LeaveError if it ends the program, and ExhaustedError."""
        self.step()
        handler = _HANDLERS.get(type(node))
        if handler is None:
            return Unknown(f"{at(node)} is not followed", node)
        try:
            found = handler(self, node)
            if isinstance(found, (str, list, tuple)):
                self._steps += len(found) >> 8  # copying takes time too
            return found
        except TooLargeError:
            return Unknown(f"{at(node)} is too large", node)
        except (ArithmeticError, AttributeError, LookupError, TypeError, ValueError) as error:
            if self.caught:
                raise LeaveError("raise", raised=type(error).__name__) from None
            return Unknown(f"{at(node)} fails with {type(error).__name__}", node)

    def truth(self, value: Value) -> bool | None:
        """Return the truth of a value, None if it is unknown."""
        if isinstance(value, Unknown):
            return None
        if isinstance(value, list) and value and all(isinstance(item, (Unknown, Maybe)) for item in value):
            return None
        if isinstance(value, (Module, Native, Function, Class)):
            return True
        return bool(value)

    def elements(self, value: Value, node: ast.AST) -> Iterator[Value]:
        """Yield the elements of a value. An unknown value has one unknown element."""
        if isinstance(value, Unknown):
            yield value
        elif isinstance(value, dict):
            for key in list(value):
                yield Unknown(f"not all keys of {at(node)} are known", node) if key is REST else key
        elif isinstance(value, (Module, Native, Function, Class)) or is_path(value):
            yield Unknown(f"{at(node)} cannot be iterated over", node)
        else:
            for item in value:
                self.step()
                yield item

    def assign(self, name: str, value: Value) -> None:
        self.journal.touch(self.scopes[0])
        self.scopes[0][name] = value

    def bind(self, target: ast.expr, value: Value) -> None:
        """Assign a value to a name, to an element, or to a tuple of these."""
        if isinstance(target, ast.Name):
            self.assign(target.id, value)
        elif isinstance(target, ast.Starred):
            self.bind(target.value, value)
        elif isinstance(target, (ast.Tuple, ast.List)):
            self._unpack(target.elts, value)
        elif isinstance(target, ast.Subscript):
            owner, key = self.value(target.value), self.value(target.slice)
            self.weigh(key)
            if isinstance(owner, (dict, list)):
                self.journal.touch(owner)
                if isinstance(key, slice) or not certain(key):
                    self.taint(owner, target)
                    if isinstance(key, slice) and isinstance(owner, list) and isinstance(value, list):
                        owner.pop()
                        owner[key] = value
                else:
                    owner[key] = value

    def _unpack(self, targets: Sequence[ast.expr], value: Value) -> None:
        items = list(self.elements(value, targets[0]))
        unknown = unknown_in(item for item in items if isinstance(item, (Unknown, Maybe)))
        starred = next((index for index, target in enumerate(targets) if isinstance(target, ast.Starred)), None)
        if unknown or len(items) < len(targets) - (starred is not None):
            unknown = unknown or Unknown("it is unpacked into another number of names", targets[0])
            for target in targets:
                self.bind(target, [unknown] if isinstance(target, ast.Starred) else unknown)
        elif starred is None:
            for target, item in zip(targets, items, strict=False):
                self.bind(target, item)
        else:
            after = len(targets) - starred - 1
            middle = items[starred : len(items) - after]
            for target, item in zip(targets, [*items[:starred], middle, *items[len(items) - after :]], strict=True):
                self.bind(target, item)

    def taint(self, value: Value, node: ast.AST) -> None:
        """Mark a container as possibly changed by something unknown."""
        if isinstance(value, list):
            self.journal.touch(value)
            value.append(Unknown(f"{at(node)} may change it", node))
        elif isinstance(value, dict):
            self.journal.touch(value)
            value[REST] = Unknown(f"{at(node)} may change it", node)

    # --- one method for each kind of expression

    def _constant(self, node: ast.Constant) -> Value:
        return located(node.value, node)

    def _name(self, node: ast.Name) -> Value:
        for scope in self.scopes:
            if node.id in scope:
                return scope[node.id]
        found = self.builtin(node.id)
        if found is None:
            if not self.journal.unsure:
                self.strange.append(node)
            return Unknown(f"the name {node.id} is not known", node)
        return found

    def _attribute(self, node: ast.Attribute) -> Value:
        owner = self.value(node.value)
        return owner if isinstance(owner, Unknown) else self.attribute(owner, node.attr, node)

    def _joined(self, node: ast.JoinedStr) -> Value:
        parts = [self.value(part) for part in node.values]
        self.weigh(*parts)
        unknown = unknown_in(parts)
        if unknown is not None and unknown.node in node.values:  # its place depends on the version of Python
            return Unknown(unknown.reason, node)
        return unknown or Word.at("".join(parts), node)

    def _formatted(self, node: ast.FormattedValue) -> Value:
        value = self.value(node.value)
        spec = self.value(node.format_spec) if node.format_spec else ""
        self.weigh(value)
        unknown = unknown_in([value, spec])
        if unknown:
            return unknown
        return formatted(value, node.conversion, spec)

    def _binary(self, node: ast.BinOp) -> Value:
        return self.binary(node.op, self.value(node.left), self.value(node.right), node)

    def binary(self, operation: ast.operator, left: Value, right: Value, node: ast.AST) -> Value:
        """Return what a binary operator gives. Raises what the operator raises, ValueError and ExhaustedError."""
        if not (isinstance(left, list) and isinstance(right, list)):  # these are put together as they are
            self.weigh(left, right)
        return binary(operation, left, right, node)

    def _boolean(self, node: ast.BoolOp) -> Value:
        stops = isinstance(node.op, ast.Or)
        found: Value = None
        for index, part in enumerate(node.values):
            value = self.value(part)
            found = value if index == 0 else either(found, value, Unknown(f"{at(node)} is not known", node))
            truth = self.truth(value)
            if truth is stops:
                return found if unknown_in([found]) else value
            if truth is not None:
                found = value
        return found

    def _unary(self, node: ast.UnaryOp) -> Value:
        value = self.value(node.operand)
        if isinstance(node.op, ast.Not):
            truth = self.truth(value)
            return Unknown(f"{at(node)} is not known", node) if truth is None else not truth
        unknown = unknown_in([value])
        return unknown or UNARY[type(node.op)](value)

    def _compare(self, node: ast.Compare) -> Value:
        left = self.value(node.left)
        for operation, right_node in zip(node.ops, node.comparators, strict=True):
            right = self.value(right_node)
            self.weigh(left, right)
            found = compare(operation, left, right)
            if found is not True:
                return found
            left = right
        return True

    def _choice(self, node: ast.IfExp) -> Value:
        truth = self.truth(self.value(node.test))
        if truth is None:
            unknown = Unknown(f"the condition {at(node.test)} is not known", node)
            return either(self.value(node.body), self.value(node.orelse), unknown)
        return self.value(node.body if truth else node.orelse)

    def _list(self, node: ast.List) -> Value:
        found: list[Value] = []
        for element in node.elts:
            if isinstance(element, ast.Starred):
                found += self.elements(self.value(element.value), element)
            else:
                found.append(self.value(element))
        return found

    def _tuple(self, node: ast.Tuple) -> Value:
        return tuple(self._list(node))  # type: ignore[arg-type]  # of the same fields

    def _set(self, node: ast.Set) -> Value:
        items = self._list(node)  # type: ignore[arg-type]  # of the same fields
        self.weigh(items)
        return unknown_in([items]) or set(items)

    def _dict(self, node: ast.Dict) -> Value:
        found: dict[Value, Value] = {}
        for key_node, value_node in zip(node.keys, node.values, strict=True):
            value = self.value(value_node)
            if key_node is not None:
                self._enter(found, key_node, value)
            elif isinstance(value, dict):
                found.update(value)
            else:
                found[REST] = Unknown(f"the keys of {at(value_node)} are not known", value_node)
        return found

    def _enter(self, found: dict[Value, Value], node: ast.expr, value: Value, sure: bool = True) -> None:
        """Set a value in a dict, with the value of an expression as the key."""
        key = self.value(node)
        self.weigh(key)
        if sure and certain(key):
            found[key] = value
        else:
            found[REST] = unknown_in([key]) or Unknown(f"whether {at(node)} is there is not known", node)

    def _subscript(self, node: ast.Subscript) -> Value:
        owner, key = self.value(node.value), self.value(node.slice)
        self.weigh(key)
        if isinstance(owner, Unknown) or not certain(key):
            return unknown_in([owner, key])
        if isinstance(owner, dict):
            if key not in owner and REST in owner:
                return owner[REST]
            return owner[key]
        if isinstance(owner, list) and any(isinstance(item, (Unknown, Maybe)) for item in owner):
            return unknown_in([owner])
        return located(owner[key], node)

    def _slice(self, node: ast.Slice) -> Value:
        parts = [None if part is None else self.value(part) for part in (node.lower, node.upper, node.step)]
        return unknown_in(parts) or slice(*parts)

    def function(self, node: ast.Lambda | ast.FunctionDef | ast.AsyncFunctionDef) -> Function:
        """Return the value of a function definition or lambda."""
        defaults = tuple(self.value(default) for default in node.args.defaults)
        keywords = tuple(None if default is None else self.value(default) for default in node.args.kw_defaults)
        return Function(node, self.scopes, defaults, keywords)

    def _named(self, node: ast.NamedExpr) -> Value:
        """Return the value of ``name := value``, assigned in the innermost scope that is no comprehension."""
        value = self.value(node.value)
        inner, self.scopes = self.scopes[: self.inner], self.scopes[self.inner :]
        try:
            self.assign(node.target.id, value)
        finally:
            self.scopes = (*inner, *self.scopes)
        return value

    def _call(self, node: ast.Call) -> Value:
        function = self.value(node.func)
        arguments: list[Value] = []
        for argument in node.args:
            if isinstance(argument, ast.Starred):
                arguments += self.elements(self.value(argument.value), argument)
            else:
                arguments.append(self.value(argument))
        keywords: dict[str, Value] = {}
        for keyword in node.keywords:
            value = self.value(keyword.value)
            if keyword.arg is not None:
                keywords[keyword.arg] = value
            elif isinstance(value, dict):
                keywords.update(value)
            else:
                keywords[REST] = Unknown(f"{at(keyword.value)} is not known", keyword.value)
        if isinstance(function, Unknown):
            for argument in [*arguments, *keywords.values()]:
                self.taint(argument, node)
            return Unknown(f"{at(node.func)}() is not followed", node)
        return self.call(function, arguments, keywords, node)

    def _comprehension(self, node: ast.ListComp | ast.GeneratorExp) -> Value:
        found: list[Value] = []

        def add(sure: bool) -> None:
            value = self.value(node.elt)
            found.append(value if sure or isinstance(value, (Maybe, Unknown)) else Maybe(value))

        self._generate(node.generators, add)
        return found

    def _set_comprehension(self, node: ast.SetComp) -> Value:
        found = self._comprehension(node)  # type: ignore[arg-type]  # of the same fields
        self.weigh(found)
        return unknown_in([found]) or set(found)

    def _dict_comprehension(self, node: ast.DictComp) -> Value:
        found: dict[Value, Value] = {}

        def add(sure: bool) -> None:
            self._enter(found, node.key, self.value(node.value), sure)

        self._generate(node.generators, add)
        return found

    def _generate(self, generators: Sequence[ast.comprehension], add: Callable[[bool], None]) -> None:
        """Run the loops of a comprehension. Each round calls ``add`` with whether the round is certain."""
        outer = self.scopes
        self.scopes = ({}, *outer)
        self.inner += 1

        def loop(index: int, sure: bool) -> None:
            if index == len(generators):
                add(sure)
                return
            generator = generators[index]
            for item in self.elements(self.value(generator.iter), generator.iter):
                self.bind(generator.target, item.value if isinstance(item, Maybe) else item)
                truths = []
                for condition in generator.ifs:
                    truths.append(self.truth(self.value(condition)))
                    if truths[-1] is False:
                        break
                else:
                    loop(index + 1, sure and not isinstance(item, (Maybe, Unknown)) and None not in truths)

        try:
            loop(0, sure=True)
        finally:
            self.scopes = outer
            self.inner -= 1


_HANDLERS: dict[type[ast.expr], Callable[[Any, Any], Value]] = {
    ast.Constant: Expressions._constant,
    ast.Name: Expressions._name,
    ast.Attribute: Expressions._attribute,
    ast.JoinedStr: Expressions._joined,
    ast.FormattedValue: Expressions._formatted,
    ast.BinOp: Expressions._binary,
    ast.BoolOp: Expressions._boolean,
    ast.UnaryOp: Expressions._unary,
    ast.Compare: Expressions._compare,
    ast.IfExp: Expressions._choice,
    ast.List: Expressions._list,
    ast.Tuple: Expressions._tuple,
    ast.Set: Expressions._set,
    ast.Dict: Expressions._dict,
    ast.Subscript: Expressions._subscript,
    ast.Slice: Expressions._slice,
    ast.Lambda: Expressions.function,
    ast.NamedExpr: Expressions._named,
    ast.Call: Expressions._call,
    ast.ListComp: Expressions._comprehension,
    ast.GeneratorExp: Expressions._comprehension,
    ast.SetComp: Expressions._set_comprehension,
    ast.DictComp: Expressions._dict_comprehension,
}
