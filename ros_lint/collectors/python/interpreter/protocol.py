"""The interfaces of the Python interpreter: to its handlers, and to models of libraries."""

from __future__ import annotations

import ast
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Sequence
from contextlib import AbstractContextManager
from typing import Protocol

from ros_lint.collectors.python.interpreter.recorder import How, Recorder
from ros_lint.collectors.python.interpreter.values import Frame, Function, LaunchObject, Method, Source, Value
from ros_lint.facts.launch import LaunchCondition


class Library(Protocol):
    """The models of the libraries that a program imports, and of their objects."""

    def describes(self, module: str) -> bool:
        """Return whether there is a model of a top-level module. If so, its source is not interpreted."""
        ...

    def model(self, module: str, at: ast.stmt) -> ast.Module | None:
        """Return a program with the effects of a module, located at ``at``; None for any other module."""
        ...

    def member(self, name: str, node: ast.AST, source: Source) -> Value:
        """Return the value of a dotted name of a library; ``node`` is the expression or import."""
        ...

    def is_substitution(self, name: str) -> bool:
        """Return whether a name is a class of substitutions, whatever module it is imported from."""
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
        """Return the result of a library function (by its full name), or of a method of a library object or a path."""
        ...

    def attribute(self, owner: LaunchObject, name: str) -> Value:
        """Return an attribute of a library object."""
        ...

    def subscript(self, interpreter: Interpreter, owner: Value, key: Value) -> Value:
        """Return an item of a library object."""
        ...

    def texts(self, value: Value, spend: Callable[[int], None]) -> tuple[str, ...]:
        """Return every text that a value can become.

        ``spend`` is called with the number of steps and may raise BudgetExceeded.
        """
        ...

    def with_defaults(self, interpreter: Interpreter, text: str) -> tuple[str, ...]:
        """Return the values of a symbolic text if all arguments declared so far have their defaults."""
        ...

    def misuse(self, made: LaunchObject, how: How) -> How | None:
        """Return how an operation misuses a library object, None if it does not."""
        ...


class Interpreter(Recorder, ABC):
    """The operations of the interpreter that the handlers of statements, expressions and calls need."""

    most_items = 5_000
    """The maximum number of elements that are gone through."""
    most_turns = 2_000
    """The maximum number of turns of a loop."""

    def __init__(self, library: Library) -> None:
        super().__init__()
        self.library = library

    @abstractmethod
    def spend(self, steps: int) -> None:
        """Count steps. Raises BudgetExceeded."""

    @abstractmethod
    def under(self, *conditions: LaunchCondition) -> AbstractContextManager[None]:
        """Interpret a block under conditions."""

    @abstractmethod
    def module(self, name: str, importer: Source, at: ast.stmt) -> Source | None:
        """Return a module of the workspace, or a model of a released module; None for any other module."""

    @abstractmethod
    def evaluate(self, node: ast.expr, frame: Frame) -> Value:
        """Return the value of an expression. Raises ProgramRaised and BudgetExceeded."""

    @abstractmethod
    def execute(self, body: Sequence[ast.stmt], frame: Frame) -> int:
        """Interpret statements, and return how they end. Raises ProgramRaised and BudgetExceeded."""

    @abstractmethod
    def function(self, node: ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda, frame: Frame) -> Function:
        """Return the value of a function definition."""

    @abstractmethod
    def builtin(self, node: ast.Name, frame: Frame) -> Value:
        """Return the value of a name that the program does not bind."""

    @abstractmethod
    def call(self, function: Value, arguments: list[Value], keywords: dict[str, Value], node: ast.Call, frame: Frame) -> Value:
        """Return the result of a call. Raises ProgramRaised and BudgetExceeded."""

    @abstractmethod
    def result(self, value: Value, operands: Iterable[Value]) -> Value:
        """Return the result of an operation; in place of an unknown one its cause, if the interpreter notes origins."""

    @abstractmethod
    def join_paths(self, left: Value, right: Sequence[Value], node: ast.expr, frame: Frame) -> Value:
        """Return the result of ``/`` or joinpath: a path of pathlib, or a substitution."""

    @abstractmethod
    def open_file(self, path: str, at: ast.expr, source: Source) -> Value:
        """Return the text of a file of the workspace, Unknown for any other file."""

    @abstractmethod
    def texts(self, value: Value) -> tuple[str, ...]:
        """Return every text that a value can become. Raises BudgetExceeded."""

    @abstractmethod
    def record_misuse(self, value: Value, how: How, node: ast.expr, frame: Frame) -> None:
        """Note an operation on a value if it misuses an object of a library and is certain to run."""
