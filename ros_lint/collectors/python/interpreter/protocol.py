"""The interfaces between the Python interpreter, its handlers of statements and expressions, and the models of libraries."""

from __future__ import annotations

import ast
from abc import ABC, abstractmethod
from collections.abc import Iterable, Sequence
from contextlib import AbstractContextManager
from typing import Protocol

from ros_lint.base.budget import Budget
from ros_lint.collectors.python.interpreter.recorder import How, Recorder
from ros_lint.collectors.python.interpreter.values import Frame, Function, LaunchObject, Method, Source, Value
from ros_lint.facts.launch import LaunchCondition


class Library(Protocol):
    """The models of the modules that are not interpreted, such as launch and setuptools, and of their objects."""

    def describes(self, module: str) -> bool:
        """Return whether the library has a model of a top-level module, whose source is then not interpreted."""
        ...

    def model(self, module: str, at: ast.stmt) -> ast.Module | None:
        """Return a short program with the effects of a released module, None if there is no such program.

        All nodes in the syntax tree of the program have the position of ``at``, the statement that imports the module.
        """
        ...

    def member(self, name: str, node: ast.AST, source: Source) -> Value:
        """Return the value of a dotted name such as ``os.path.join``. ``node`` is the expression or the import with that name."""
        ...

    def is_substitution(self, name: str) -> bool:
        """Return whether ``name`` is the name of a substitution class of launch, which may be imported from any module."""
        ...

    def call(
        self,
        interpreter: Interpreter,
        callee: str | Method,
        arguments: list[Value],
        keywords: dict[str, Value],
        node: ast.Call,
        frame: Frame,
    ) -> Value:
        """Return the result of a call.

        ``callee`` is the dotted name of a library function, or a method of a path or of an object of the library.
        """
        ...

    def attribute(self, owner: LaunchObject, name: str) -> Value:
        """Return the value of the attribute ``name`` of an object of the library (launch or setuptools)."""
        ...

    def subscript(self, interpreter: Interpreter, owner: Value, key: Value) -> Value:
        """Return the value of ``owner[key]``, where ``owner`` is neither a known collection nor a known text."""
        ...

    def texts(self, value: Value, budget: Budget) -> tuple[str, ...]:
        """Return every text that a value can become at launch. Characters of the private use area represent unknown parts.

        Raises BudgetExceeded if the evaluation needs more steps than ``budget`` has left.
        """
        ...

    def with_defaults(self, interpreter: Interpreter, text: str) -> tuple[str, ...]:
        """Return the possible values of ``text``, a text that is known only at launch.

        Each launch argument that has been declared so far is assumed to have its default value.
        """
        ...

    def misuse(self, made: LaunchObject, how: How) -> How | None:
        """Return the kind of error if the operation ``how`` uses a launch object as a text or truth value, None if it is valid.

        ``"a" + LaunchConfiguration("b")`` -> "added"
        """
        ...


class Interpreter(Recorder, ABC):
    """The operations of the interpreter that the handlers of statements, expressions and calls need."""

    most_items = 5_000
    """The maximum number of elements of a collection that are iterated over."""
    most_turns = 2_000
    """The maximum number of iterations of a loop."""

    def __init__(self, library: Library, budget: Budget) -> None:
        super().__init__(budget)
        self.library = library
        self.called: dict[ast.Try, frozenset[str]] = {}
        """The names of the functions that the body of a try statement calls, for the statements interpreted so far."""

    @abstractmethod
    def under(self, *conditions: LaunchCondition) -> AbstractContextManager[None]:
        """Return a context manager for the interpretation of code that runs only if ``conditions`` hold.

        Conditions of enclosing ``with`` blocks also apply.
        """

    @abstractmethod
    def module(self, name: str, importer: Source, at: ast.stmt) -> Source | None:
        """Return the interpreted module that the import statement ``at`` names, None if the module cannot be interpreted."""

    @abstractmethod
    def evaluate(self, node: ast.expr, frame: Frame) -> Value:
        """Return the value of an expression. Raises ProgramRaised and BudgetExceeded."""

    @abstractmethod
    def execute(self, body: Sequence[ast.stmt], frame: Frame) -> int:
        """Interpret statements, and return how they end: NEXT, CONTINUE, BREAK or LEAVE.

        Raises ProgramRaised and BudgetExceeded.
        """

    @abstractmethod
    def function(self, node: ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda, frame: Frame) -> Function:
        """Return the function that a definition or a lambda creates, with the values of its default arguments."""

    @abstractmethod
    def builtin(self, node: ast.Name, frame: Frame) -> Value:
        """Return the value of a name that the program does not bind, and record the name as unbound if it is not builtin."""

    @abstractmethod
    def call(self, function: Value, arguments: list[Value], keywords: dict[str, Value], node: ast.Call, frame: Frame) -> Value:
        """Return the result of calling ``function``. Raises ProgramRaised and BudgetExceeded."""

    @abstractmethod
    def result(self, value: Value, operands: Iterable[Value]) -> Value:
        """Return ``value``, the result of an operation on ``operands``.

        If an unknown operand made ``value`` unknown, an interpreter that records origins of unknown values returns the operand.
        """

    @abstractmethod
    def join_paths(self, left: Value, right: Sequence[Value], node: ast.expr, frame: Frame) -> Value:
        """Return the joined path of ``left / right`` or ``left.joinpath(*right)``.

        The result is a PathJoinSubstitution if a part is a substitution of launch, else a path of pathlib.
        """

    @abstractmethod
    def open_file(self, path: str, at: ast.expr, source: Source) -> Value:
        """Record that the program opens a file, and return its content, Unknown if the file is not in the workspace."""

    @abstractmethod
    def texts(self, value: Value) -> tuple[str, ...]:
        """Return every text that a value can become at launch. Characters of the private use area represent unknown parts.

        Raises BudgetExceeded.
        """

    @abstractmethod
    def record_division(self, node: ast.expr, frame: Frame) -> None:
        """Record that the expression ``node`` raises TypeError, because it divides a text by a text.

        Nothing is recorded unless the expression certainly runs.
        """

    @abstractmethod
    def record_misuse(self, value: Value, how: How, node: ast.expr, frame: Frame) -> None:
        """Record that the operation ``how`` wrongly uses ``value``, a launch object, as a text or truth value.

        Nothing is recorded unless the operation certainly runs, or if it is valid for the object.
        """
