"""Statements and calls of Python launch files: a machine that follows the program and runs nothing.

Where a branch depends on what is not known, both sides are followed on the same objects, under a condition each, and
names that differ afterwards stand for one of several values. Steps, depth and sizes are bounded; what goes beyond the
bounds is not known.
"""

from __future__ import annotations

import ast
import posixpath
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from typing import Any

from ros_lint.collectors.launch_py_eval import EVALUATE, hashable, negated, operation, opposite_of, text_of, truth
from ros_lint.collectors.launch_py_library import BUILTINS, call_library, subscript_library
from ros_lint.collectors.launch_py_methods import call_method, items
from ros_lint.collectors.launch_py_objects import (
    PERHAPS,
    Api,
    Bound,
    Class,
    Conditions,
    FilePath,
    Frame,
    Function,
    Guarded,
    Instance,
    Made,
    Method,
    OutOfBudget,
    Raised,
    Source,
    Union,
    Unknown,
    Value,
    alternatives,
    plain,
    union,
)
from ros_lint.collectors.launch_py_texts import SUBSTITUTIONS, texts
from ros_lint.collectors.launch_text import UNKNOWN, joined, presence
from ros_lint.facts import LaunchCondition
from ros_lint.text import Text

STEPS = 150_000
_STEPS_A_CALL = 60_000
_DEEPEST_CALL = 40
_MOST_TURNS = 2_000

_NEXT, _BREAK, _CONTINUE, _LEAVE = range(4)
Modules = Callable[[str, Text], "Text | None"]
"""Finds the text of a module by its dotted name (dots in front for a relative one), for a module that imports it."""


class Machine:
    """Follows one launch file and the modules that it imports."""

    def __init__(self, modules: Modules, files: Callable[[str], Value]) -> None:
        self._modules = modules
        self._files = files
        self._sources: dict[str, Source | None] = {}
        self._left = STEPS
        self._depth = 0
        self.conditions: Conditions = ()
        self.made: list[Made] = []
        """Everything made of the classes of the launch libraries, in order."""
        self.looked_up: list[tuple[str, ast.expr, Source, Conditions]] = []
        """Packages looked up at once, where, and under which conditions."""
        self.unbound: list[tuple[ast.expr, Source]] = []
        """Names that nothing binds."""
        self.named: dict[str, tuple[ast.expr, Source]] = {}
        """Where each package that is looked up is written first."""

    # --- bounds and conditions ------------------------------------------------------------------------------------

    def spend(self, steps: int) -> None:
        """Count steps. Raises OutOfBudget."""
        self._left -= steps
        if self._left < 0:
            raise OutOfBudget

    @contextmanager
    def under(self, *conditions: LaunchCondition) -> Iterator[None]:
        """Follow something that happens only under conditions."""
        before = self.conditions
        self.conditions = (*before, *conditions)
        try:
            yield
        finally:
            self.conditions = before

    def guard(self, value: Value) -> Value:
        """Return a value as it goes into a collection now."""
        return Guarded(value, self.conditions) if self.conditions else value

    def lose(self, value: Value) -> None:
        """Note that a value goes where it cannot be followed: what it holds may be launched."""
        waiting, count = [value], 0
        while waiting and count < 1_000:
            one = waiting.pop()
            count += 1
            if isinstance(one, Made):
                if not one.lost:
                    one.lost = True
                    waiting += [*one.arguments, *one.keywords.values(), *one.entities]
            elif isinstance(one, Guarded):
                waiting.append(one.value)
            elif isinstance(one, Union):
                waiting += one.values
            elif isinstance(one, (list, tuple)):
                waiting += one
            elif isinstance(one, dict):
                waiting += one.values()
            elif isinstance(one, Instance):
                waiting += [one.made, *one.attributes.values()] if one.made is not None else one.attributes.values()

    # --- modules --------------------------------------------------------------------------------------------------

    def run(self, tree: ast.Module, source: Source) -> Frame:
        """Follow the statements of a module."""
        frame = Frame(source, None, source.names)
        source.names.setdefault("__name__", "launch_file")
        with suppress(Raised):
            self._block(tree.body, frame)
        source.names = frame.names
        return frame

    def module(self, name: str, importer: Source) -> Source | None:
        """Return a module of the workspace, followed once; None for one of a library."""
        key = f"{importer.text.path}:{name}" if name.startswith(".") else name
        if key in self._sources:
            return self._sources[key]
        self._sources[key] = None  # while it is followed: modules may import each other
        text = self._modules(name, importer.text)
        if text is None:
            return None
        found = Source(text)
        try:
            tree = ast.parse(text.text)
        except (SyntaxError, ValueError, RecursionError, MemoryError):
            return None
        self._sources[key] = found
        self.run(tree, found)
        return found

    # --- statements -----------------------------------------------------------------------------------------------

    def evaluate(self, node: ast.expr, frame: Frame) -> Value:
        """Return the value of an expression. Raises Raised and OutOfBudget."""
        self._left -= 1
        if self._left < 0:
            raise OutOfBudget
        return EVALUATE[type(node)](self, node, frame)

    def _block(self, body: Sequence[ast.stmt], frame: Frame) -> int:
        for statement in body:
            handler = _STATEMENTS.get(type(statement))
            if handler is not None:
                signal = handler(self, statement, frame)
                if signal:
                    return signal
        return _NEXT

    def _expression(self, node: ast.Expr, frame: Frame) -> int:
        self.evaluate(node.value, frame)
        return _NEXT

    def _assign(self, node: ast.Assign, frame: Frame) -> int:
        value = self.evaluate(node.value, frame)
        for target in node.targets:
            self.bind(target, value, frame)
        return _NEXT

    def _annotated(self, node: ast.AnnAssign, frame: Frame) -> int:
        if node.value is not None:
            self.bind(node.target, self.evaluate(node.value, frame), frame)
        return _NEXT

    def _augmented(self, node: ast.AugAssign, frame: Frame) -> int:
        value = self.evaluate(node.value, frame)
        load: ast.expr = node.target
        before = self.evaluate(load, frame)
        one = plain(before)
        if isinstance(one, list) and isinstance(node.op, ast.Add):
            found = items(self, value)
            if found is None:
                self.lose(value)
                found = [Unknown("elements that are not known")]
            self.spend(len(found))
            one += [self.guard(element) for element in found]
            return _NEXT
        self.bind(node.target, operation(self, node.op, before, value, node.value, frame), frame)
        return _NEXT

    def bind(self, target: ast.expr, value: Value, frame: Frame) -> None:
        """Give a value to a target of an assignment."""
        if isinstance(target, ast.Name):
            frame.declared.get(target.id, frame).names[target.id] = value
        elif isinstance(target, (ast.Tuple, ast.List)):
            self._unpack(target.elts, value, frame)
        elif isinstance(target, ast.Attribute):
            for one in alternatives(self.evaluate(target.value, frame)):
                if isinstance(one.value, Instance):
                    one.value.attributes[target.attr] = value
                elif isinstance(one.value, Made):
                    one.value.keywords[target.attr] = value
                else:
                    self.lose(value)
        elif isinstance(target, ast.Subscript):
            self._store(target, value, frame)
        elif isinstance(target, ast.Starred):
            self.bind(target.value, value, frame)

    def _unpack(self, targets: Sequence[ast.expr], value: Value, frame: Frame) -> None:
        values = items(self, value)
        star = next((index for index, target in enumerate(targets) if isinstance(target, ast.Starred)), -1)
        if values is None or (star < 0 and len(values) != len(targets)) or len(values) < len(targets) - 1:
            self.lose(value)
            for target in targets:
                self.bind(target, Unknown("part of what is not known"), frame)
            return
        if star >= 0:
            after = len(targets) - star - 1
            values = [*values[:star], values[star : len(values) - after], *values[len(values) - after :]]
        for target, one in zip(targets, values, strict=True):
            self.bind(target, plain(one), frame)

    def _store(self, target: ast.Subscript, value: Value, frame: Frame) -> None:
        key = plain(self.evaluate(target.slice, frame)) if not isinstance(target.slice, ast.Slice) else Unknown("a slice")
        for one in alternatives(self.evaluate(target.value, frame)):
            owner = one.value
            if isinstance(owner, dict):
                name = hashable(key)
                if self.conditions and name in owner:
                    owner[name] = union([owner[name], self.guard(value)])
                else:
                    owner[name] = value
            elif isinstance(owner, list) and isinstance(key, int) and -len(owner) <= key < len(owner):
                owner[key] = value
            else:
                self.lose(value)

    def _if(self, node: ast.If, frame: Frame) -> int:
        answer, condition = truth(self, self.evaluate(node.test, frame))
        if answer is not None:
            return self._block(node.body if answer else node.orelse, frame)
        return self._either(node.body, node.orelse, condition, frame)

    def _either(self, body: Sequence[ast.stmt], other: Sequence[ast.stmt], condition: LaunchCondition, frame: Frame) -> int:
        """Follow both sides of a branch, and join what they leave behind."""
        before, opposite = self.conditions, opposite_of(condition)
        start = dict(frame.names)
        first = self._side(body, (*before, condition), frame)
        first_names = frame.names
        frame.names = start
        second = self._side(other, (*before, opposite), frame)
        second_names = frame.names
        self.conditions = before
        if first == _LEAVE and second == _LEAVE:
            return _LEAVE
        if _LEAVE in (first, second):
            # The rest of the function runs only if the other side was taken.
            frame.names = _kept(first_names, second_names) if first == _LEAVE else _kept(second_names, first_names)
            self.conditions = (*before, opposite if first == _LEAVE else condition)
            return _NEXT
        frame.names = first_names
        for name, value in second_names.items():
            if name not in first_names:
                first_names[name] = value
            elif first_names[name] is not value:
                first_names[name] = union([Guarded(first_names[name], (condition,)), Guarded(value, (opposite,))])
        return first if first == second else _NEXT

    def _side(self, body: Sequence[ast.stmt], conditions: Conditions, frame: Frame) -> int:
        self.conditions = conditions
        try:
            return self._block(body, frame)
        except Raised:
            return _LEAVE

    def _for(self, node: ast.For | ast.AsyncFor, frame: Frame) -> int:
        values = items(self, self.evaluate(node.iter, frame))
        before = self.conditions
        if values is None:
            self.bind(node.target, Unknown("element of what is not known"), frame)
            return self._perhaps(node.body, frame)
        for turn, value in enumerate(values):
            if turn > _MOST_TURNS:
                raise OutOfBudget
            self.spend(1)
            guards = next(alternatives(value)).conditions if isinstance(value, Guarded) else ()
            self.bind(node.target, plain(value), frame)
            self.conditions = (*before, *guards)
            signal = self._block(node.body, frame)
            if signal == _LEAVE:
                return signal
            if signal == _BREAK:
                self.conditions = before
                return _NEXT
            if len(self.conditions) == len(before) + len(guards):
                self.conditions = before
        return self._block(node.orelse, frame)

    def _perhaps(self, body: Sequence[ast.stmt], frame: Frame) -> int:
        """Follow a block that may run any number of times."""
        signal = self._either(body, (), PERHAPS, frame)
        return signal if signal == _LEAVE else _NEXT

    def _while(self, node: ast.While, frame: Frame) -> int:
        for _ in range(_MOST_TURNS):
            self.spend(1)
            answer, _condition = truth(self, self.evaluate(node.test, frame))
            if answer is None:
                return self._perhaps(node.body, frame)
            if not answer:
                return self._block(node.orelse, frame)
            signal = self._block(node.body, frame)
            if signal == _LEAVE:
                return signal
            if signal == _BREAK:
                return _NEXT
        raise OutOfBudget

    def _with(self, node: ast.With | ast.AsyncWith, frame: Frame) -> int:
        for item in node.items:
            value = self.evaluate(item.context_expr, frame)
            if item.optional_vars is not None:
                self.bind(item.optional_vars, value, frame)
        return self._block(node.body, frame)

    def _try(self, node: ast.Try, frame: Frame) -> int:
        looked_up = len(self.looked_up)
        try:
            signal = self._block(node.body, frame)
        except Raised:
            signal = _NEXT
            for handler in node.handlers[:1]:
                if handler.name:
                    frame.names[handler.name] = Unknown("an exception")
                signal = self._block(handler.body, frame)
        else:
            if node.handlers and len(self.looked_up) > looked_up:
                self._without(node, looked_up, frame)
            if signal == _NEXT:
                signal = self._block(node.orelse, frame)
        final = self._block(node.finalbody, frame)
        return final or signal

    def _without(self, node: ast.Try, first: int, frame: Frame) -> None:
        """A package that is looked up may be missing, and the file does without."""
        there = LaunchCondition((presence(self.looked_up[first][0]),), None)
        self.looked_up[first:] = [
            (name, at, source, (*conditions, LaunchCondition((presence(name),), None)))
            for name, at, source, conditions in self.looked_up[first:]
        ]
        for handler in node.handlers:
            self._either(handler.body, (), opposite_of(there), frame)

    def _return(self, node: ast.Return, frame: Frame) -> int:
        value = self.evaluate(node.value, frame) if node.value is not None else None
        frame.returned.append(Guarded(value, self.conditions))
        return _LEAVE

    def _raise(self, node: ast.Raise, frame: Frame) -> int:  # noqa: ARG002
        raise Raised

    def _break(self, node: ast.Break, frame: Frame) -> int:  # noqa: ARG002
        return _BREAK

    def _continue(self, node: ast.Continue, frame: Frame) -> int:  # noqa: ARG002
        return _CONTINUE

    def _match(self, node: ast.Match, frame: Frame) -> int:
        subject = self.evaluate(node.subject, frame)
        for case in node.cases:
            for inner in ast.walk(case.pattern):
                if isinstance(inner, (ast.MatchAs, ast.MatchStar)) and inner.name:
                    frame.names[inner.name] = subject
            if self._perhaps(case.body, frame) == _LEAVE:
                return _LEAVE
        return _NEXT

    def _function(self, node: ast.FunctionDef | ast.AsyncFunctionDef, frame: Frame) -> int:
        found: Value = self.function(node, frame)
        for decorator in node.decorator_list:
            name = decorator.id if isinstance(decorator, ast.Name) else ""
            if name in ("classmethod", "staticmethod", "property"):
                found = Bound(found, [], {"": name})
        frame.names[node.name] = found
        return _NEXT

    def function(self, node: ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda, frame: Frame) -> Function:
        """Return a function of the program."""
        found = Function(node, frame)
        found.defaults = [self.evaluate(default, frame) for default in node.args.defaults]
        for argument, default in zip(node.args.kwonlyargs, node.args.kw_defaults, strict=True):
            if default is not None:
                found.keyword_defaults[argument.arg] = self.evaluate(default, frame)
        if frame.source.yields and not isinstance(node, ast.Lambda):
            walked = (inner for statement in node.body for inner in ast.walk(statement))
            found.yields = any(isinstance(inner, (ast.Yield, ast.YieldFrom)) for inner in walked)
        return found

    def _class(self, node: ast.ClassDef, frame: Frame) -> int:
        bases = [plain(self.evaluate(base, frame)) for base in node.bases]
        inner = Frame(frame.source, frame, {})
        self._block(node.body, inner)
        fields = [
            statement.target.id
            for statement in node.body
            if isinstance(statement, ast.AnnAssign) and isinstance(statement.target, ast.Name)
        ]
        found = Class(node.name, bases, inner.names, fields)
        for value in inner.names.values():
            if isinstance(value, Function):
                value.owner = found
                value.frame = frame  # methods do not see the names of their class
            elif isinstance(value, Bound) and isinstance(value.function, Function):
                value.function.owner = found
                value.function.frame = frame
        frame.names[node.name] = found
        return _NEXT

    def _import(self, node: ast.Import, frame: Frame) -> int:
        for alias in node.names:
            found = self.module(alias.name, frame.source)
            top = alias.name.partition(".")[0]
            if alias.asname:
                frame.names[alias.asname] = found or Api(alias.name)
            elif found is None or "." not in alias.name:
                frame.names[top] = found or Api(top)
        return _NEXT

    def _import_from(self, node: ast.ImportFrom, frame: Frame) -> int:
        name = "." * node.level + (node.module or "")
        found = self.module(name, frame.source)
        for alias in node.names:
            if alias.name == "*":
                frame.names.update(found.names if found is not None else {})
                continue
            if alias.name in SUBSTITUTIONS:
                frame.names[alias.asname or alias.name] = Api(f"{name}.{alias.name}")
                continue
            inner = found.names.get(alias.name) if found is not None else None
            if inner is None:
                inner = self.module(
                    f"{name}.{alias.name}".replace("..", ".") if node.level else f"{name}.{alias.name}", frame.source
                )
            frame.names[alias.asname or alias.name] = inner if inner is not None else Api(f"{name}.{alias.name}")
        return _NEXT

    def _global(self, node: ast.Global, frame: Frame) -> int:
        outermost = frame
        while outermost.outer is not None:
            outermost = outermost.outer
        frame.declared.update(dict.fromkeys(node.names, outermost))
        return _NEXT

    def _nonlocal(self, node: ast.Nonlocal, frame: Frame) -> int:
        for name in node.names:
            around = frame.outer
            while around is not None and name not in around.names:
                around = around.outer
            if around is not None:
                frame.declared[name] = around
        return _NEXT

    def _delete(self, node: ast.Delete, frame: Frame) -> int:
        for target in node.targets:
            if isinstance(target, ast.Name):
                frame.names.pop(target.id, None)
        return _NEXT

    # --- calls ----------------------------------------------------------------------------------------------------

    def builtin(self, name: str, node: ast.expr, frame: Frame) -> Value:
        """Return what a name means that the program does not bind."""
        if name == "__file__":
            return BUILTINS["__file__"]
        if name in BUILTINS:
            return Api(f"builtins.{name}")
        self.unbound.append((node, frame.source))
        # Python would stop here; what is meant is mostly plain.
        return Api(name)

    def call(self, function: Value, arguments: list[Value], keywords: dict[str, Value], node: ast.Call, frame: Frame) -> Value:
        """Return what calling a value returns."""
        self.spend(1)
        if isinstance(function, Api):
            return call_library(self, function.name, arguments, keywords, node, frame)
        if isinstance(function, Method):
            if isinstance(function.owner, Made):
                return call_library(self, function, arguments, keywords, node, frame)
            return call_method(self, function, arguments, keywords, node, frame)
        if isinstance(function, Function):
            try:
                return self._run_function(function, arguments, keywords)
            except Raised:
                if function.frame.source is frame.source:
                    raise
                # A helper is more likely to be misread than to fail.
                self.lose([arguments, keywords])
                return Unknown(f"{getattr(function.node, 'name', 'a function')}() cannot be followed")
        if isinstance(function, Bound):
            return self._run_bound(function, arguments, keywords, node, frame)
        if isinstance(function, Class):
            return self._make(function, arguments, keywords, node, frame)
        self.lose([arguments, keywords])
        return Unknown("the result of a call that cannot be followed")

    def _run_bound(self, bound: Bound, arguments: list[Value], keywords: dict[str, Value], node: ast.Call, frame: Frame) -> Value:
        kept = {name: value for name, value in bound.keywords.items() if name}
        return self.call(bound.function, [*bound.arguments, *arguments], {**kept, **keywords}, node, frame)

    def _make(self, cls: Class, arguments: list[Value], keywords: dict[str, Value], node: ast.Call, frame: Frame) -> Value:
        made = Instance(cls)
        base = cls.library_base()
        if base is not None and base.last not in ("ABC", "object", "Enum", "NamedTuple", "Protocol"):
            result = call_library(self, base.name, arguments, keywords, node, frame)
            made.made = result if isinstance(result, Made) else None
        init = cls.find("__init__")
        if isinstance(init, Function):
            self._run_function(init, [made, *arguments], keywords)
        else:
            for name, value in zip(cls.fields, arguments, strict=False):
                made.attributes[name] = value
            made.attributes.update({name: value for name, value in keywords.items() if name in cls.fields})
        return made

    def _run_function(self, function: Function, arguments: list[Value], keywords: dict[str, Value]) -> Value:
        node = function.node
        if self._depth >= _DEEPEST_CALL:
            self.lose([arguments, keywords])
            return Unknown("calls that are nested too deeply")
        frame = Frame(function.frame.source, function.frame, self._parameters(function, arguments, keywords))
        if isinstance(node, ast.Lambda):
            self._depth += 1
            try:
                return self.evaluate(node.body, frame)
            finally:
                self._depth -= 1
        before, left = self.conditions, self._left
        self._left = min(left, _STEPS_A_CALL)
        allowed = self._left
        self._depth += 1
        try:
            signal = self._block(node.body, frame)
        except OutOfBudget:
            if left <= allowed:
                raise
            self.lose([arguments, keywords])
            return Unknown("a call that takes too long")
        except Raised:
            if not frame.returned:
                raise
            signal = _LEAVE  # this way out of several ends here
        finally:
            self._depth -= 1
            self._left = left - (allowed - self._left)
            self.conditions = before
        if function.yields:
            return frame.yielded
        if signal != _LEAVE and frame.returned:
            frame.returned.append(Guarded(None, (PERHAPS,)))
        if not frame.returned:
            return None
        if len(frame.returned) == 1:
            return frame.returned[0].value
        count = len(before)
        return union(Guarded(one.value, one.conditions[count:]) for one in frame.returned)

    def _parameters(self, function: Function, arguments: list[Value], keywords: dict[str, Value]) -> dict[str, Value]:
        spec = function.node.args
        names = [argument.arg for argument in (*spec.posonlyargs, *spec.args)]
        found: dict[str, Value] = dict(function.keyword_defaults)
        if function.defaults:
            found.update(zip(names[-len(function.defaults) :], function.defaults, strict=True))
        found.update(zip(names, arguments, strict=False))
        known = {*names, *(argument.arg for argument in spec.kwonlyargs)}
        found.update({name: value for name, value in keywords.items() if name in known})
        if spec.vararg is not None:
            found[spec.vararg.arg] = tuple(arguments[len(names) :])
        if spec.kwarg is not None:
            found[spec.kwarg.arg] = {name: value for name, value in keywords.items() if name not in known}
        for name in known:
            found.setdefault(name, Unknown(f"the argument {name}"))
        if function.owner is not None:
            found.setdefault("__class__", function.owner)
        return found

    # --- what the library needs -----------------------------------------------------------------------------------

    def join_paths(self, left: Value, right: Sequence[Value], node: ast.expr, frame: Frame) -> Value:
        """Return what ``/`` or joinpath makes: a path of pathlib, or a substitution."""
        if isinstance(left, Made) or any(isinstance(plain(one), Made) for one in right):
            call = node if isinstance(node, ast.Call) else ast.Call(node, [], [])
            ast.copy_location(call, node)
            return Made("PathJoinSubstitution", [[left, *right]], {}, call, frame.source)
        rows = [text_of(left), *[text_of(one) for one in right]]
        return union(FilePath(text) for text in joined(rows, lambda row: posixpath.join("", *row)))

    def open_file(self, path: str, node: ast.expr) -> Value:  # noqa: ARG002
        """Return the text of a file of the workspace, or what stands for it."""
        found = self._files(path)
        return found if found is not None else Unknown(f"the content of {path.rpartition('/')[2] or 'a file'}")

    def subscript_of_library(self, owner: Value, key: Value) -> Value:
        """Return an element of something that a library has."""
        return subscript_library(self, owner, key)

    def look_up(self, package: str, at: ast.expr, source: Source, eager: bool) -> None:
        """Note that a package is looked up."""
        if UNKNOWN not in package:
            self.named.setdefault(package, (at, source))
        if eager:
            self.looked_up.append((package, at, source, self.conditions))

    def texts(self, value: Value) -> tuple[str, ...]:
        return texts(value)

    def negated(self, value: Value) -> Value:
        return negated(self, value)


def _kept(left: dict[str, Value], rest: dict[str, Value]) -> dict[str, Value]:
    """Return the names after a branch of which one side left the function."""
    return {**{name: value for name, value in left.items() if name not in rest}, **rest}


_STATEMENTS: dict[type[ast.stmt], Callable[[Machine, Any, Frame], int]] = {
    ast.Expr: Machine._expression,
    ast.Assign: Machine._assign,
    ast.AnnAssign: Machine._annotated,
    ast.AugAssign: Machine._augmented,
    ast.If: Machine._if,
    ast.For: Machine._for,
    ast.AsyncFor: Machine._for,
    ast.While: Machine._while,
    ast.With: Machine._with,
    ast.AsyncWith: Machine._with,
    ast.Try: Machine._try,
    ast.Return: Machine._return,
    ast.Raise: Machine._raise,
    ast.Break: Machine._break,
    ast.Continue: Machine._continue,
    ast.Match: Machine._match,
    ast.FunctionDef: Machine._function,
    ast.AsyncFunctionDef: Machine._function,
    ast.ClassDef: Machine._class,
    ast.Import: Machine._import,
    ast.ImportFrom: Machine._import_from,
    ast.Global: Machine._global,
    ast.Nonlocal: Machine._nonlocal,
    ast.Delete: Machine._delete,
}
if hasattr(ast, "TryStar"):
    _STATEMENTS[ast.TryStar] = Machine._try
