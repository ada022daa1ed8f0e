"""Detection of recursive calls that repeat an outer call, so that their interpretation would add nothing.

A function that searches a nested dictionary calls itself for each element. If the dictionary is unknown, the inner
call does the same as the outer call, on the same unknown values. Interpreting the inner call would add no result and
double the time at each level.
"""

from __future__ import annotations

import ast
from collections.abc import Iterable
from functools import lru_cache
from typing import TYPE_CHECKING, Any, NamedTuple

from ros_lint.collectors.python.interpreter.alternatives import alternatives
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
    settled,
)
from ros_lint.collectors.symbolic_text import UNKNOWN

if TYPE_CHECKING:
    from ros_lint.collectors.python.interpreter.recorder import Recorder

_MOST_VALUES = 500
"""The maximum number of values to compare. A call that reads more values never counts as a repetition."""

_DEEPEST = 12
"""The maximum nesting depth of collections and objects in a value to compare."""


class UnderWay(NamedTuple):
    """A function call that has begun and has not ended yet."""

    node: ast.AST
    """The definition of the function."""
    conditions: int
    """The number of conditions under which the call happens."""
    outline: Any = None
    """The outline (a hashable summary) of the values that the call reads. None for an outermost call, and if it is too large."""


def begin(under_way: list[UnderWay], function: Function, names: dict[str, Value], recorder: Recorder) -> bool:
    """Append a call to ``under_way`` and return True, or return False if the call repeats a call in ``under_way``.

    A call repeats an outer call of the same function if it reads the same values and runs under more conditions. The caller
    must not interpret a repeating call. A call without further conditions repeats nothing, because tests with known results
    end the recursion.

    ``names`` are the values of the parameters, by name. ``recorder`` has the conditions under which the call runs.
    """
    outline, conditions = None, len(recorder.conditions)
    outer = [call for call in under_way if call.node is function.node and call.conditions < conditions]
    if outer:
        outline = _outline({**names, **_read_from_around(function)}, recorder)
        if outline is not None and any(call.outline == outline for call in outer):
            return False
    under_way.append(UnderWay(function.node, conditions, outline))
    return True


def _read_from_around(function: Function) -> dict[tuple[str, Frame], Value]:
    """Return the values of the outer names that a function, and the functions that it calls, may read.

    The keys are pairs of a name and the module or function that binds the name.
    """
    values: dict[tuple[str, Frame], Value] = {}
    waiting, seen = [function], {function.node}
    while waiting:
        function = waiting.pop()
        for name in _names_in(function.node):
            around: Frame | None = function.frame
            while around is not None and name not in around.names:
                around = around.outer
            if around is None:
                continue
            value = values[name, around] = settled(around.names[name])
            if isinstance(value, Function) and value.node not in seen:
                seen.add(value.node)
                waiting.append(value)
    return values


@lru_cache(maxsize=512)
def _names_in(node: ast.AST) -> tuple[str, ...]:
    """Return the names in a definition, each once. A recursive search asks for them at every call."""
    return tuple(dict.fromkeys(inner.id for inner in ast.walk(node) if isinstance(inner, ast.Name)))


def _outline(names: dict[Any, Value], recorder: Recorder) -> Any:
    """Return the outline (a hashable summary, see :class:`_Outliner`) of names and values, None if there are too many values."""
    outliner = _Outliner(recorder)
    made = outliner.of(names)
    return None if outliner.too_much else made


class _Outliner:
    """Creates the outline of a value: a hashable value, equal for two values that differ only in unknown parts."""

    def __init__(self, recorder: Recorder) -> None:
        self._recorder = recorder
        self._left = _MOST_VALUES
        self.too_much = False
        self.unknown = 0
        """The number of unknown values so far."""

    def of(self, value: Value, depth: int = 0) -> Any:
        """Return the outline of a value that is nested ``depth`` levels deep in collections and objects."""
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
                return frozenset(self.of(item.value, depth + 1) for item in alternatives(value))
            case Unknown(condition=condition):
                self.unknown += 1
                known = condition is not None and not any(UNKNOWN in text for text in condition.texts)
                return Unknown, condition if known else None
            case FilePath(text=text):
                return FilePath, self._text(text)
            case list() | tuple():
                return type(value), self._elements(value, depth + 1)
            case dict():
                return dict, frozenset((key, self.of(item, depth + 1)) for key, item in value.items())
            case Instance(cls=cls, attributes=attributes):
                return cls, self.of(attributes, depth + 1)
            case LaunchObject(node=node, arguments=arguments, keywords=keywords, entities=entities):
                return node, *(self.of(inner, depth + 1) for inner in (arguments, keywords, entities))
            case LibraryName(name=name):
                return LibraryName, name
        return type(value), value

    def _text(self, text: str) -> Any:
        """Return the outline of a text: the text, or its known beginning and end if a part of it is unknown."""
        start, mark, rest = text.partition(UNKNOWN)
        if not mark:
            return str(text)
        self.unknown += 1
        return start, rest.rpartition(UNKNOWN)[2]

    def _elements(self, values: Iterable[Value], depth: int) -> Any:
        """Return the outlines (hashable summaries) of the elements of a list.

        Unknown or perhaps missing elements with equal outlines have one outline in the result, because each of these elements
        represents any number of elements.
        """
        outlines: dict[Any, None] = {}
        for value in filter(self._recorder.is_here, values):
            before = self.unknown
            outline = self.of(value, depth)
            several = self.unknown > before or isinstance(value, Guarded)
            outlines[outline if several else (len(outlines), outline)] = None
        return tuple(outlines)
