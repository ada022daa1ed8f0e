"""Interpretation of the statements, functions and imports of a setup.py, up to its calls of setup()."""

from __future__ import annotations

import ast
from collections.abc import Callable, Sequence
from typing import Final, NamedTuple

from ros_lint.collectors.python.exceptions import catching, kind_raised
from ros_lint.collectors.setup_py.interpreter import library
from ros_lint.collectors.setup_py.interpreter.expressions import Expressions
from ros_lint.collectors.setup_py.interpreter.files import Files
from ros_lint.collectors.setup_py.interpreter.operators import TooLargeError
from ros_lint.collectors.setup_py.interpreter.state import ExhaustedError, LeaveError, at
from ros_lint.collectors.setup_py.interpreter.values import Class, Function, Maybe, Module, Native, Unknown, Value

DEEPEST: Final = 40
"""Greatest depth of nested calls."""


class Setup(NamedTuple):
    """A call of setup()."""

    options: dict[str, Value]
    node: ast.Call | None
    module: str
    """The module of the function: setuptools, or a package that extends it."""


class Program(Expressions):
    """Interpreter of one setup.py. :meth:`run` fills the attributes with the results."""

    def __init__(self, package: str, files: Files) -> None:
        super().__init__(files)
        self.package = package
        self.setups: list[Setup] = []
        self.generated: list[str] = []
        """Dotted names of Python modules that a generator adds to the package."""
        self.no_functions: list[tuple[ast.Call, Value]] = []
        """Calls of values that cannot be called, in code that certainly runs."""
        self.end: str = ""
        """The reason why the evaluation stopped before the end, as a clause; "" if it did not."""
        self._depth = 0
        self._declared: dict[str, dict[str, Value]] = {}
        """Scopes of the names that the current function declares global or nonlocal."""

    def run(self, tree: ast.Module) -> None:
        try:
            self._block(tree.body)
        except ExhaustedError as error:
            self.end = str(error)
        except LeaveError as leave:
            self.end = "it ends before its last line" if leave.kind == "raise" else "a loop is left on an unknown condition"
        except RecursionError:
            self.end = "it is nested too deeply"

    # --- methods that the evaluation of expressions needs

    def builtin(self, name: str) -> Value | None:
        return library.builtin(name)

    def attribute(self, owner: Value, name: str, node: ast.AST) -> Value:
        if isinstance(owner, Module):
            return self._member(owner.name, name, node)
        if isinstance(owner, Native):
            found = library.member(f"{owner.name}.{name}")
            return Unknown(f"{at(node)} is not known", node) if found is None else found
        return library.method(owner, name, node)

    def _member(self, module: str, name: str, node: ast.AST) -> Value:
        if (module, name) == ("os", "environ"):
            return library.environment(node)
        found = library.member(f"{module}.{name}")
        if found is not None:
            return found
        if name == "setup":
            return Native("setup", module)
        if name in _HELPERS:
            return Native(name)
        return Unknown(f"{module}.{name} is not known", node)

    def call(self, function: Value, arguments: list[Value], keywords: dict[str, Value], node: ast.Call) -> Value:
        if isinstance(function, Native):
            if function.name in ("setup", "setuptools.setup"):
                self.setups.append(Setup(keywords, node, function.owner or "setuptools"))
                return Unknown("what setup() returns is not followed", node)
            if function.name in _HELPERS:
                return _HELPERS[function.name](self, arguments, keywords, node)
            return library.call(self, function, arguments, keywords, node)
        if isinstance(function, Function):
            return self._invoke(function, arguments, keywords, node)
        if (isinstance(function, (Module, list, str)) or type(function) is tuple) and not self.journal.unsure:
            self.no_functions.append((node, function))
        return Unknown(f"{at(node.func)}() is not followed", node)

    def _invoke(self, function: Function, arguments: list[Value], keywords: dict[str, Value], node: ast.Call) -> Value:
        if self._depth >= DEEPEST:
            raise ExhaustedError("its functions call each other too often")
        scope = self._parameters(function, arguments, keywords, node)
        outer, inner, declared = self.scopes, self.inner, self._declared
        self.scopes, self.inner, self._declared = (scope, *function.scopes), 0, {}
        self._depth += 1
        try:
            if isinstance(function.node, ast.Lambda):
                return self.value(function.node.body)
            if any(isinstance(inner, (ast.Yield, ast.YieldFrom)) for inner in ast.walk(function.node)):
                return Unknown(f"{at(node.func)}() is a generator, which is not followed", node)
            self._block(function.node.body)
        except LeaveError as leave:
            if leave.kind in ("return", "unclear"):
                return leave.value
            raise
        finally:
            self.scopes, self.inner, self._declared = outer, inner, declared
            self._depth -= 1
        return None

    def _parameters(
        self, function: Function, arguments: list[Value], keywords: dict[str, Value], node: ast.Call
    ) -> dict[str, Value]:
        given = function.node.args
        names = [parameter.arg for parameter in (*given.posonlyargs, *given.args)]
        scope: dict[str, Value] = {}
        if function.defaults:
            scope.update(zip(names[-len(function.defaults) :], function.defaults, strict=True))
        for parameter, default in zip(given.kwonlyargs, function.keyword_defaults, strict=True):
            scope[parameter.arg] = default
        scope.update(zip(names, arguments, strict=False))
        if given.vararg:
            scope[given.vararg.arg] = tuple(arguments[len(names) :])
        known = {*names, *(parameter.arg for parameter in given.kwonlyargs)}
        scope.update({name: value for name, value in keywords.items() if name in known})
        if given.kwarg:
            scope[given.kwarg.arg] = {name: value for name, value in keywords.items() if name not in known}
        for name in known - scope.keys():
            scope[name] = Unknown(f"{at(node)} gives no {name}", node)
        return scope

    def assign(self, name: str, value: Value) -> None:
        scope = self._declared.get(name)
        if scope is None:
            super().assign(name, value)
        else:
            self.journal.touch(scope)
            scope[name] = value

    # --- statements

    def _block(self, body: Sequence[ast.stmt]) -> None:
        for statement in body:
            self.step()
            try:
                self._statement(statement)
            except (ArithmeticError, AttributeError, LookupError, TypeError, ValueError) as error:
                if self.caught:
                    raise LeaveError("raise", raised=type(error).__name__) from None
                raise ExhaustedError(f"line {statement.lineno} fails with {type(error).__name__}") from None

    def _statement(self, statement: ast.stmt) -> None:
        match statement:
            case ast.Expr(value=value):
                self.value(value)
            case ast.Assign(targets=targets, value=value):
                found = self.value(value)
                for target in targets:
                    self.bind(target, found)
            case ast.AnnAssign(target=target, value=value):
                if value is not None:
                    self.bind(target, self.value(value))
            case ast.AugAssign(target=target, op=operation, value=value):
                self._augment(target, operation, self.value(value), statement)
            case ast.If(test=test, body=body, orelse=orelse):
                self._branch(self.truth(self.value(test)), body, orelse, test)
            case ast.For(target=target, iter=values, body=body, orelse=orelse):
                self._for(target, values, body, orelse)
            case ast.While(test=test, body=body):
                self._while(test, body)
            case ast.With(items=items, body=body):
                for item in items:
                    self.value(item.context_expr)
                    if item.optional_vars is not None:
                        self.bind(item.optional_vars, Unknown(f"{at(item.context_expr)} is not known", item.context_expr))
                self._block(body)
            case ast.Try():
                self._try(statement)
            case ast.FunctionDef(name=name) | ast.AsyncFunctionDef(name=name):
                decorated = Unknown(f"the decorator of {name}() is not followed", statement)
                self.assign(name, decorated if statement.decorator_list else self.function(statement))
            case ast.ClassDef(name=name):
                self.assign(name, Class(name))
            case ast.Import() | ast.ImportFrom():
                self._import(statement)
            case ast.Return(value=value):
                raise LeaveError("return", None if value is None else self.value(value))
            case ast.Raise():
                raise LeaveError("raise", raised=kind_raised(statement))
            case ast.Break() | ast.Continue():
                raise LeaveError(type(statement).__name__.lower())
            case ast.Global(names=names):
                self._declared.update(dict.fromkeys(names, self.scopes[-1]))
            case ast.Nonlocal(names=names):
                for name in names:
                    scope = next((scope for scope in self.scopes[1:] if name in scope), self.scopes[-1])
                    self._declared[name] = scope
            case ast.Delete(targets=targets):
                for target in targets:
                    if isinstance(target, ast.Name):
                        self.assign(target.id, Unknown(f"{target.id} is deleted", target))
                    elif isinstance(target, ast.Subscript):
                        self.taint(self.value(target.value), target)
            case ast.Pass() | ast.Assert():
                pass
            case _:
                raise ExhaustedError(f"{type(statement).__name__.lower()} statements are not followed")

    def _branch(self, truth: bool | None, body: Sequence[ast.stmt], orelse: Sequence[ast.stmt], test: ast.expr) -> None:
        if truth is not None:
            self._block(body if truth else orelse)
            return
        unknown = Unknown(f"the condition {at(test)} is not known", test)
        self.journal.both((lambda: self._block(body), lambda: self._block(orelse)), unknown)

    def _augment(self, target: ast.expr, operation: ast.operator, value: Value, statement: ast.AugAssign) -> None:
        owner = self.value(target)
        if isinstance(owner, list) and isinstance(operation, ast.Add):
            self.journal.touch(owner)
            owner += self.elements(value, statement.value)
            return
        try:
            found = self.binary(operation, owner, value, statement)
        except (ArithmeticError, TypeError, ValueError) as error:
            if self.caught and not isinstance(error, TooLargeError):
                raise
            found = Unknown(f"{at(statement)} fails", statement)
        self.bind(target, found)

    def _for(self, target: ast.expr, values: ast.expr, body: Sequence[ast.stmt], orelse: Sequence[ast.stmt]) -> None:
        def once(item: Value) -> Callable[[], None]:
            def run() -> None:
                self.bind(target, item)
                self._body(body)

            return run

        try:
            for item in self.elements(self.value(values), values):
                if isinstance(item, (Unknown, Maybe)):
                    unknown = item if isinstance(item, Unknown) else Unknown(f"not all of {at(values)} is known", values)
                    inner = item.value if isinstance(item, Maybe) else item
                    self.journal.both((once(inner), lambda: None), unknown)
                else:
                    once(item)()
        except LeaveError as leave:
            if leave.kind != "break":
                raise
        else:
            self._block(orelse)

    def _body(self, body: Sequence[ast.stmt]) -> None:
        try:
            self._block(body)
        except LeaveError as leave:
            if leave.kind != "continue":
                raise

    def _while(self, test: ast.expr, body: Sequence[ast.stmt]) -> None:
        try:
            while truth := self.truth(self.value(test)):
                self._body(body)
            if truth is None:
                unknown = Unknown(f"the condition {at(test)} is not known", test)
                self.journal.both((lambda: self._body(body), lambda: None), unknown)
        except LeaveError as leave:
            if leave.kind != "break":
                raise

    def _try(self, statement: ast.Try) -> None:
        try:
            self._try_handlers(statement)
        except LeaveError:
            self._block(statement.finalbody)
            raise
        self._block(statement.finalbody)

    def _try_handlers(self, statement: ast.Try) -> None:
        self.caught += bool(statement.handlers)
        try:
            self._block(statement.body)
        except LeaveError as leave:
            self.caught -= bool(statement.handlers)
            handler = catching(statement, leave.raised) if leave.kind == "raise" else None
            if handler is None:
                raise
            if handler.name:
                self.assign(handler.name, Unknown("the exception is not followed", handler))
            self._block(handler.body)
        else:
            self.caught -= bool(statement.handlers)
            self._block(statement.orelse)

    def _import(self, statement: ast.Import | ast.ImportFrom) -> None:
        if isinstance(statement, ast.Import):
            for alias in statement.names:
                name = alias.name if alias.asname else alias.name.partition(".")[0]
                self.assign(alias.asname or name, library.member(name) or Module(name))
            return
        for alias in statement.names:
            if alias.name == "*":
                for name in ("setup", "find_packages", "find_namespace_packages"):
                    self.assign(name, self._member(statement.module or "", name, statement))
            else:
                found = self._member(statement.module or "", alias.name, statement)
                self.assign(alias.asname or alias.name, found)


def _generate_parameter_module(program: Program, arguments: list[Value], keywords: dict[str, Value], _: ast.Call) -> Value:
    name = arguments[0] if arguments else keywords.get("module_name")
    if isinstance(name, str):
        program.generated.append(f"{program.package}.{name}")
    return None


def _generate_distutils_setup(program: Program, _: list[Value], keywords: dict[str, Value], node: ast.Call) -> Value:
    """Return the options of generate_distutils_setup() in catkin_pkg, which adds data of package.xml."""
    version = Unknown("the version in package.xml is not looked at", node)
    return {"name": program.package, "version": version, **keywords}


_HELPERS: dict[str, Callable[[Program, list[Value], dict[str, Value], ast.Call], Value]] = {
    "generate_parameter_module": _generate_parameter_module,
    "generate_distutils_setup": _generate_distutils_setup,
}
