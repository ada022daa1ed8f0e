"""A call of a library function, as it is passed to the model that computes the symbolic result of the function."""

from __future__ import annotations

import ast
from collections.abc import Callable
from typing import TYPE_CHECKING

from ros_lint.collectors.python.interpreter.alternatives import alternatives, union
from ros_lint.collectors.python.interpreter.methods import items
from ros_lint.collectors.python.interpreter.operations import text_of, texts_made
from ros_lint.collectors.python.interpreter.values import (
    Globbed,
    Union,
    Unknown,
    Value,
    globbed,
    written,
)
from ros_lint.collectors.symbolic_text import UNKNOWN

if TYPE_CHECKING:
    from ros_lint.collectors.python.interpreter.protocol import Interpreter
    from ros_lint.collectors.python.interpreter.values import Frame


class LibraryCall:
    """A call of a library function: the name of the function, the values of its arguments, and the call in the source."""

    __slots__ = ("arguments", "frame", "keywords", "machine", "name", "node")

    def __init__(
        self, machine: Interpreter, name: str, arguments: list[Value], keywords: dict[str, Value], node: ast.Call, frame: Frame
    ) -> None:
        self.machine = machine
        self.name = name
        self.arguments = arguments
        self.keywords = keywords
        self.node = node
        self.frame = frame

    def get(self, position: int, *names: str) -> Value:
        for name in names:
            if name in self.keywords:
                return self.keywords[name]
        return self.arguments[position] if position < len(self.arguments) else None

    def texts(self, position: int, *names: str) -> tuple[str, ...]:
        """Return the possible texts of the argument at ``position`` or with a keyword in ``names``, (UNKNOWN,) if it is missing.

        If the argument may be a text or None, None is ignored, because Python would fail with it.
        """
        value = self.get(position, *names)
        if isinstance(value, Union):
            value = union(alternative for alternative in alternatives(value) if alternative.value is not None)
        return (UNKNOWN,) if value is None else text_of(value)

    def result(self, found: tuple[str, ...]) -> Value:
        return texts_made(found, self.node, self.frame)

    def like(self, position: int, elements: list[Value]) -> list[Value]:
        """Return ``elements`` as a result of glob() if the argument at ``position`` is a result of glob(), else unchanged.

        So ``sorted(glob("*.py"))`` keeps its pattern.
        """
        value = self.get(position)
        return globbed(value.pattern, elements) if isinstance(value, Globbed) else elements

    def items(self, position: int) -> list[Value] | None:
        return items(self.machine, self.get(position))


Rule = Callable[[LibraryCall], Value]


def unknown(call: LibraryCall) -> Value:
    """Model of a function whose effects are unknown: return Unknown, and record that unknown code gets the arguments."""
    call.machine.escape([call.arguments, call.keywords])
    return Unknown(f"{call.name.rpartition('.')[2]}()")


def unknown_text(call: LibraryCall) -> Value:
    """Model of a function that returns a text: return a text that is unknown until the program runs."""
    return written(UNKNOWN, call.node, call.frame.source)


def nothing(_: LibraryCall) -> Value:
    """Model of a function that returns None. Its effects are ignored."""
    return None
