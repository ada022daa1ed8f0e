"""The interpretation of a setup.py, including its calls of setup()."""

from __future__ import annotations

import ast
from collections.abc import Iterable

from ros_lint.base.budget import BudgetExceeded
from ros_lint.base.text import Text
from ros_lint.collectors.python.interpreter.alternatives import alternatives
from ros_lint.collectors.python.interpreter.machine import Machine
from ros_lint.collectors.python.interpreter.operations import TOO_LARGE
from ros_lint.collectors.python.interpreter.statements import execute
from ros_lint.collectors.python.interpreter.values import (
    Bound,
    Class,
    Frame,
    Function,
    LibraryName,
    Method,
    Names,
    ProgramRaised,
    Source,
    Union,
    Unknown,
    Value,
    written,
)
from ros_lint.collectors.setup_py.interpreter.expression_text import at
from ros_lint.collectors.setup_py.interpreter.files import ROOT, Files
from ros_lint.collectors.setup_py.interpreter.library import MODULES, SetupLibrary
from ros_lint.collectors.setup_py.interpreter.values import REST, unknown_in
from ros_lint.collectors.symbolic_text import UNKNOWN


class Program(Machine):
    """Interpreter of one setup.py. :meth:`follow` interprets the file, and stores the results in the attributes.

    Unknown values are treated differently than in launch files. An expression that fails or has an unknown part is unknown,
    with the reason and the origin of the unknown part. After such an expression, the interpretation continues.
    """

    most_items = 50_000
    most_turns = 50_000

    def __init__(self, package: str, files: Files) -> None:
        self.setup_library = SetupLibrary(package, files)
        super().__init__(lambda name, importer: None, lambda path: None, self.setup_library)
        self.no_functions: list[tuple[ast.Call, Value]] = []
        """Calls of values that cannot be called, in code that certainly runs."""
        self.end: str = ""
        """The reason why the evaluation stopped early, a clause such as "it is nested too deeply"; "" if it ended regularly."""

    def follow(self, tree: ast.Module, text: Text) -> None:
        """Interpret the statements of the setup.py, and store the results in the attributes."""
        source = Source(text)
        frame = Frame(source, None, {"__file__": f"{ROOT}/setup.py", "__name__": "__main__"})
        try:
            if execute(self, tree.body, frame):
                self.end = "it ends before its last line"
            elif self.cut_off:
                self.end = f"it contains {self.cut_off[0][0]}"
        except BudgetExceeded:
            self.end = "it takes more steps than the limit"
        except ProgramRaised:
            self.end = "it ends before its last line"
        except (RecursionError, MemoryError):
            self.end = "it is nested too deeply"

    # --- the policy on unknown values -----------------------------------------------------------------------------

    def evaluate(self, node: ast.expr, frame: Frame) -> Value:
        """Return the value of an expression. If the expression raises an exception, the value is Unknown.

        Raises ProgramRaised if a ``raise`` statement raises the exception, or a try statement may catch it.
        """
        try:
            value = super().evaluate(node, frame)
        except ProgramRaised as error:
            if error.deliberate or self.caught:
                raise
            return Unknown(f"{at(node)} fails{error.kind and ' with '}{error.kind}", None, node)
        return self._with_origin(value, node, frame)

    def result(self, value: Value, operands: Iterable[Value]) -> Value:
        """Return ``value``, the result of an operation. If an unknown operand made the result unknown, return that operand."""
        fresh = isinstance(value, Unknown) and value.node is None and value.reason != TOO_LARGE
        if not fresh and not (isinstance(value, str) and UNKNOWN in value):
            return value
        unknown = unknown_in(operands, self.tests)
        return unknown if unknown is not None and unknown.node is not None else value

    def _with_origin(self, value: Value, node: ast.expr, frame: Frame) -> Value:
        """Return ``value`` with the expression ``node`` as its origin, unless ``value`` has an origin already."""
        if isinstance(value, str):
            if UNKNOWN in value:
                return Unknown(_reason(node), None, node)
            return value if hasattr(value, "node") else written(value, node, frame.source)
        if isinstance(value, Union):
            for alternative in alternatives(value):
                self._with_origin(alternative.value, node, frame)
        elif isinstance(value, Unknown) and value.node is None:
            value.reason = f"{at(node)} {TOO_LARGE}" if value.reason == TOO_LARGE else _reason(node)
            value.node = node
        elif isinstance(node, ast.Call) and isinstance(value, list):
            value[:] = [written(item, node, frame.source) if type(item) is str else item for item in value]
        elif isinstance(node, ast.Call) and type(value) is tuple:
            return tuple([written(item, node, frame.source) if type(item) is str else item for item in value])
        return value

    def builtin(self, node: ast.Name, frame: Frame) -> Value:
        before = len(self.unbound)
        value = super().builtin(node, frame)
        if len(self.unbound) == before:
            return value
        if self.conditions:
            self.unbound.pop()
        return Unknown(f"the name {node.id} is not known", None, node)

    def module(self, name: str, importer: Source, at: ast.stmt) -> Source | None:
        if not isinstance(at, ast.ImportFrom) or at.names[0].name != "*":
            return None
        source = Source(importer.text)
        names = ("setup", "find_packages", "find_namespace_packages")
        source.names = Names({member: self.library.member(f"{name}.{member}", at, importer) for member in names})
        return source

    def call(self, function: Value, arguments: list[Value], keywords: dict[str, Value], node: ast.Call, frame: Frame) -> Value:
        """Return the result of a call. Mark lists and dictionaries that are passed to an unknown function as possibly changed."""
        if isinstance(function, (Function, Class, Bound)):
            return super().call(function, arguments, keywords, node, frame)
        if isinstance(function, Method) or (isinstance(function, LibraryName) and function.name not in MODULES):
            value = super().call(function, arguments, keywords, node, frame)
            owner = [function.owner] if isinstance(function, Method) else []
            return self.result(value, [*owner, *arguments, *keywords.values()])
        if isinstance(function, (LibraryName, list, tuple, str)) and not self.conditions:
            self.no_functions.append((node, function))
        for argument in (*arguments, *keywords.values()):
            self._change(argument, node)
        return Unknown(_reason(node), None, node)

    def _change(self, value: Value, node: ast.Call) -> None:
        """Mark a list or dictionary as possibly changed by a call of an unknown function."""
        unknown = Unknown(f"{at(node)} may change it", None, node)
        for alternative in alternatives(value):
            if isinstance(alternative.value, list):
                alternative.value.append(unknown)
            elif isinstance(alternative.value, dict):
                alternative.value[REST] = unknown


def _reason(node: ast.expr) -> str:
    """Return why the value of an expression is unknown, as a clause of a message: "glob2() cannot be evaluated"."""
    if isinstance(node, ast.Call):
        return f"{at(node.func)}() cannot be evaluated"
    return f"the operator of {at(node)} cannot be evaluated" if isinstance(node, ast.BinOp) else f"{at(node)} is not known"
