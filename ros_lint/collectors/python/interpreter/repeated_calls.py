"""Calls in a Python launch file that repeat a call which is still being followed.

A function that searches a nested dictionary calls itself for each element. Where the dictionary is unknown, the inner call
does the same as the outer call, on the same unknown values. To follow the inner call too adds no result and doubles the
time at each level.
"""

from __future__ import annotations

import ast
from collections.abc import Iterable
from typing import Any, NamedTuple

from ros_lint.collectors.python.interpreter.values import (
    FilePath,
    Frame,
    Function,
    Guarded,
    Instance,
    LaunchObject,
    LibraryName,
    Union,
    Unknown,
    Value,
    alternatives,
)
from ros_lint.collectors.symbolic_text import UNKNOWN

_MOST_VALUES = 500
"""How many values two calls are compared by. A call that reads more values is never taken for a repetition."""

_DEEPEST = 12
"""How many collections and objects lie within each other in a value that is compared."""


class UnderWay(NamedTuple):
    """A call of a function of the program that is being followed."""

    node: ast.AST
    """The definition of the function."""
    conditions: int
    """The number of conditions under which the call happens."""
    outline: Any = None
    """The outline of what the call reads; None if that is too much, and for the outermost call of a function."""


def begin(under_way: list[UnderWay], function: Function, names: dict[str, Value], conditions: int) -> bool:
    """Add a call to those under way, and return True; return False if it repeats one of them, and is not to be followed.

    A call repeats a call around it if both read the same values and an undecided branch led from one to the other. Without
    such a branch the program ends the calls by itself. ``names`` are the values of the parameters, ``conditions`` is the
    number of conditions that hold. Most functions do not call themselves, so that outlines are made from the second call on.
    """
    outline = None
    outer = [call for call in under_way if call.node is function.node and call.conditions < conditions]
    if outer:
        outline = _outline({**names, **_read_from_around(function)})
        if outline is not None and any(call.outline == outline for call in outer):
            return False
    under_way.append(UnderWay(function.node, conditions, outline))
    return True


def _read_from_around(function: Function) -> dict[tuple[str, Frame], Value]:
    """Return what a function, and the functions that it may call, read from the functions and the module around them."""
    found: dict[tuple[str, Frame], Value] = {}
    waiting, seen = [function], {function.node}
    while waiting:
        function = waiting.pop()
        for name in {node.id for node in ast.walk(function.node) if isinstance(node, ast.Name)}:
            around: Frame | None = function.frame
            while around is not None and name not in around.names:
                around = around.outer
            if around is None:
                continue
            value = found[name, around] = around.names[name]
            if isinstance(value, Function) and value.node not in seen:
                seen.add(value.node)
                waiting.append(value)
    return found


def _outline(names: dict[Any, Value]) -> Any:
    """Return a value that is equal for names whose values differ only in what is unknown, None if that is too much."""
    outliner = _Outliner()
    made = outliner.of(names)
    return None if outliner.too_much else made


class _Outliner:
    """Makes hashable values that are equal for values which differ only in what is unknown."""

    def __init__(self) -> None:
        self._left = _MOST_VALUES
        self.too_much = False
        self.unknown = 0
        """The number of unknown values so far."""

    def of(self, value: Value, depth: int = 0) -> Any:
        """Return the outline of a value that lies within ``depth`` others."""
        self._left -= 1
        if self._left < 0 or depth > _DEEPEST:
            self.too_much = True
            return None
        match value:
            case str():
                return self._text(value)
            case Guarded(value=inner):
                return self.of(inner, depth + 1)
            case Union():
                return frozenset(self.of(one.value, depth + 1) for one in alternatives(value))
            case Unknown(condition=condition):
                self.unknown += 1
                known = condition is not None and not any(UNKNOWN in text for text in condition.texts)
                return Unknown, condition if known else None
            case FilePath(text=text):
                return FilePath, self._text(text)
            case list() | tuple() | set() | frozenset():
                return type(value), self._elements(value, depth + 1)
            case dict():
                return dict, frozenset((key, self.of(one, depth + 1)) for key, one in value.items())
            case Instance(cls=cls, attributes=attributes):
                return cls, self.of(attributes, depth + 1)
            case LaunchObject(node=node, arguments=arguments, keywords=keywords, entities=entities):
                return node, *(self.of(inner, depth + 1) for inner in (arguments, keywords, entities))
            case LibraryName(name=name):
                return LibraryName, name
        return type(value), value

    def _text(self, text: str) -> Any:
        """Return a text, or its beginning and end if a part of it is unknown: what stands between does not matter."""
        start, mark, rest = text.partition(UNKNOWN)
        if not mark:
            return str(text)
        self.unknown += 1
        return start, rest.rpartition(UNKNOWN)[2]

    def _elements(self, values: Iterable[Value], depth: int) -> Any:
        """Return the outlines of elements. An element that is unknown or conditional stands for any number of them."""
        found: dict[Any, None] = {}
        for value in values:
            before = self.unknown
            one = self.of(value, depth)
            several = self.unknown > before or isinstance(value, Guarded)
            found[one if several else (len(found), one)] = None
        return tuple(found)
