"""The values of names while a program is interpreted: a launch file, or a setup.py.

Texts, numbers, lists and dictionaries are Python's own. This module has classes for the other values: objects of the
launch libraries, functions and classes of the program, alternatives, and unknown values.
"""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterable, Iterator
from pathlib import PurePosixPath
from typing import Any, Final, NamedTuple

from ros_lint.base.text import Span, Text
from ros_lint.collectors.symbolic_text import MOST, UNKNOWN, are_consistent, conditional, conditions_of, configuration, is_plain
from ros_lint.facts.launch import LaunchCondition

Value = Any
"""A value of the program: a str, int, list ... of Python, or an object of this module."""

Conditions = tuple[LaunchCondition, ...]

PERHAPS: Final = LaunchCondition((UNKNOWN,), None)
"""An unknown condition."""


class Module(NamedTuple):
    """A module of the workspace."""

    text: Text
    tree: ast.Module


Modules = Callable[[str, Text], "Module | None"]
"""Finds a module by its dotted name (with leading dots if relative), for the module that imports it."""


class Source:
    """A module: its text, and the names that it binds."""

    __slots__ = ("ascii", "assigns_inside", "lent", "names", "text", "yields")

    def __init__(self, text: Text, *, lent: bool = False) -> None:
        self.text = text
        self.ascii = text.text.isascii()
        self.lent = lent
        """True for a model of a helper of a released package. Its places are those of the call."""
        self.yields = "yield" in text.text
        self.assigns_inside = ":=" in text.text
        self.names: dict[str, Value] = {}


class Written(str):
    """A text with the expression that produced it."""

    __slots__ = ("node", "source")

    node: ast.expr
    source: Source


def written(text: str, node: ast.expr, source: Source) -> Written:
    """Return a text with the expression that produced it."""
    made = Written(text)
    made.node = node
    made.source = source
    return made


class Unknown:
    """Any value.

    ``condition`` is the condition of its truth, if known. ``node`` is its origin, if the interpreter notes origins.
    """

    __slots__ = ("condition", "node", "reason")

    def __init__(self, reason: str, condition: LaunchCondition | None = None, node: ast.AST | Span | None = None) -> None:
        self.reason = reason
        self.condition = condition
        self.node = node


class Guarded:
    """A value that exists only under conditions."""

    __slots__ = ("conditions", "value")

    def __init__(self, value: Value, conditions: Conditions) -> None:
        self.value = value
        self.conditions = conditions


class Union:
    """One of several values."""

    __slots__ = ("values",)

    def __init__(self, values: tuple[Guarded, ...]) -> None:
        self.values = values


class SetOf(list[Value]):
    """A set: a list of distinct elements in the order of insertion, because unknown elements are not hashable."""


class Globbed(list[Value]):
    """The list that one call of glob() returns. A list made from it by an operation is no longer of this type."""

    __slots__ = ("pattern",)
    pattern: str


def globbed(pattern: str, paths: Iterable[Value]) -> Globbed:
    """Return paths as the result of a glob pattern."""
    result = Globbed(paths)
    result.pattern = pattern
    return result


class FilePath:
    """A path of pathlib. A known text is normalized as by pathlib: ``a/b`` for ``a//b/``."""

    __slots__ = ("text",)

    def __init__(self, text: str) -> None:
        self.text = str(PurePosixPath(text)) if is_plain(text) else text

    def __str__(self) -> str:
        return self.text


class LibraryName:
    """A name of a library: a module, a class, a function."""

    __slots__ = ("name",)

    def __init__(self, name: str) -> None:
        self.name = name

    @property
    def last(self) -> str:
        return self.name.rpartition(".")[2]


def argument_of(call: ast.Call, position: int, *names: str) -> ast.expr:
    """Return the expression of an argument of a call, or the whole call."""
    for keyword in call.keywords:
        if keyword.arg in names:
            return keyword.value
    if not 0 <= position < len(call.args) or any(isinstance(argument, ast.Starred) for argument in call.args):
        return call
    return call.args[position]


class LaunchObject:
    """An object of a class of the launch libraries: an action, a substitution, a description."""

    __slots__ = ("arguments", "conditions", "entities", "escaped", "keywords", "name", "node", "seen", "source")

    def __init__(self, name: str, arguments: list[Value], keywords: dict[str, Value], node: ast.Call, source: Source) -> None:
        self.name = name
        self.arguments = arguments
        self.keywords = keywords
        self.node = node
        self.source = source
        self.conditions: Conditions = ()
        self.entities: list[Value] = []
        """The entities of a launch description. The list may grow while it is visited."""
        self.seen = False
        """True if it is part of what is launched."""
        self.escaped = False
        """True if it escaped to code that is not interpreted."""

    def get(self, position: int, *names: str) -> Value:
        """Return an argument by its name or position, None if it is missing."""
        for name in names:
            if name in self.keywords:
                return self.keywords[name]
        return self.arguments[position] if 0 <= position < len(self.arguments) else None

    def written(self, position: int, *names: str) -> ast.expr:
        """Return the expression of an argument, or the whole call."""
        return argument_of(self.node, position, *names)


class Function:
    """A function of the program. ``frame`` is the one in which it was defined."""

    __slots__ = ("changed", "defaults", "frame", "keyword_defaults", "node", "owner")

    def __init__(self, node: ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda, frame: Frame) -> None:
        self.node = node
        self.frame = frame
        self.defaults: list[Value] = []
        self.keyword_defaults: dict[str, Value] = {}
        self.owner: Class | None = None
        self.changed = False  # True if an unknown decorator may replace it

    def yields(self) -> bool:
        """Return whether it is a generator, disregarding ``yield`` in nested functions."""
        waiting: list[ast.AST] = list(self.node.body) if isinstance(self.node.body, list) else []
        while waiting:
            inner = waiting.pop()
            if isinstance(inner, (ast.Yield, ast.YieldFrom)):
                return True
            if not isinstance(inner, (ast.FunctionDef, ast.AsyncFunctionDef, ast.Lambda, ast.ClassDef)):
                waiting += ast.iter_child_nodes(inner)
        return False

    def taking(self, arguments: list[Value], keywords: dict[str, Value]) -> dict[str, Value]:
        """Return the values of the parameters at the beginning of a call."""
        spec = self.node.args
        names = [argument.arg for argument in (*spec.posonlyargs, *spec.args)]
        values: dict[str, Value] = dict(self.keyword_defaults)
        if self.defaults:
            values.update(zip(names[-len(self.defaults) :], self.defaults, strict=True))
        values.update(zip(names, arguments, strict=False))
        known = {*names, *(argument.arg for argument in spec.kwonlyargs)}
        values.update({name: value for name, value in keywords.items() if name in known})
        if spec.vararg is not None:
            values[spec.vararg.arg] = tuple(arguments[len(names) :])
        if spec.kwarg is not None:
            values[spec.kwarg.arg] = {name: value for name, value in keywords.items() if name not in known}
        for name in known:
            values.setdefault(name, Unknown(f"the argument {name}"))
        if self.owner is not None:
            values.setdefault("__class__", self.owner)
        return values


class Bound:
    """A function with some of its arguments: a method, or a partial."""

    __slots__ = ("arguments", "function", "keywords")

    def __init__(self, function: Value, arguments: list[Value], keywords: dict[str, Value] | None = None) -> None:
        self.function = function
        self.arguments = arguments
        self.keywords = keywords or {}


class Method:
    """A method of a value of Python or of a library object."""

    __slots__ = ("name", "owner")

    def __init__(self, owner: Value, name: str) -> None:
        self.owner = owner
        self.name = name


class Class:
    """A class of the program."""

    __slots__ = ("bases", "fields", "name", "names")

    def __init__(self, name: str, bases: list[Value], names: dict[str, Value], fields: list[str]) -> None:
        self.name = name
        self.bases = bases
        self.names = names
        self.fields = fields
        """Annotated names, in order: the parameters of a dataclass."""

    def find(self, name: str) -> Value | None:
        for cls in self._line():
            if isinstance(cls, Class) and name in cls.names:
                return cls.names[name]
        return None

    def every_field(self) -> dict[str, None]:
        """Return the fields of the class and its base classes; those of base classes come first."""
        line = [cls for cls in self._line() if isinstance(cls, Class)]
        return dict.fromkeys(name for cls in reversed(line) for name in cls.fields)

    def library_base(self) -> LibraryName | None:
        """Return the first base class that a library defines."""
        return next((cls for cls in self._line() if isinstance(cls, LibraryName)), None)

    def _line(self) -> Iterator[Value]:
        """Yield the class and its base classes, each once."""
        waiting: list[Value] = [self]
        seen: set[int] = set()
        while waiting:
            cls = waiting.pop()
            if id(cls) not in seen:
                seen.add(id(cls))
                yield cls
                if isinstance(cls, Class):
                    waiting += reversed(cls.bases)


class Instance:
    """An object of a class of the program. ``made`` is its launch object if a launch class is its base."""

    __slots__ = ("attributes", "cls", "made")

    def __init__(self, cls: Class) -> None:
        self.cls = cls
        self.attributes: dict[str, Value] = {}
        self.made: LaunchObject | None = None


class Context:
    """The launch context that is passed to functions."""

    __slots__ = ()


class Exit(NamedTuple):
    """An exit from an iteration, a loop or a function that is taken only under conditions."""

    signal: int
    """CONTINUE, BREAK or LEAVE of :mod:`ros_lint.collectors.python.interpreter.branches`."""
    conditions: Conditions
    """All conditions that hold at the exit."""
    names: dict[str, Value]
    """The names of the function at the exit."""


class Frame:
    """The names of a running function, or of a module."""

    __slots__ = ("declared", "exits", "names", "outer", "returned", "source", "yielded")

    def __init__(self, source: Source, outer: Frame | None, names: dict[str, Value]) -> None:
        self.source = source
        self.outer = outer
        self.names = names
        self.declared: dict[str, Frame] = {}
        """Names that ``global`` or ``nonlocal`` binds in another frame."""
        self.exits: list[Exit] = []
        """The exits, in order, of the blocks that are being interpreted."""
        self.returned: list[Guarded] = []
        self.yielded: list[Value] = []


class ProgramRaised(Exception):  # noqa: N818  (it represents any exception of the program)
    """The program raises an exception of the class ``kind``, "" if unknown.

    It is deliberate if a raise statement or a function such as sys.exit() raises it.
    """

    def __init__(self, kind: str = "", *, deliberate: bool = False) -> None:
        super().__init__(kind)
        self.kind = kind
        self.deliberate = deliberate


class BudgetExceeded(Exception):  # noqa: N818
    """The program needs too many steps or too much memory."""


def union(values: Iterable[Value]) -> Value:
    """Return a value that is one of several; the value itself if all are the same."""
    results: list[Guarded] = []
    for value in values:
        for alternative in alternatives(value):
            if len(alternative.conditions) > 1 and not are_consistent(alternative.conditions):
                continue
            if not any(same(alternative.value, known.value) and alternative.conditions == known.conditions for known in results):
                results.append(alternative)
        if len(results) > MOST:
            return Unknown("one of too many values")
    if not results:
        return Unknown("no value")
    if all(same(alternative.value, results[0].value) for alternative in results):
        return results[0].value
    return Union(tuple(results))


def alternatives(value: Value, conditions: Conditions = ()) -> Iterator[Guarded]:
    """Yield every alternative of a value with its conditions."""
    if isinstance(value, Union):
        for alternative in value.values:
            yield from alternatives(alternative, conditions)
    elif isinstance(value, Guarded):
        yield from alternatives(value.value, (*conditions, *value.conditions))
    else:
        yield Guarded(value, conditions)


def guarded_text(text: str, made: Value) -> Value:
    """Return a value that was computed from an alternative of a text, under the conditions of the text."""
    conditions = conditions_of(text)
    return Guarded(made, conditions) if conditions else made


def under(texts: Iterable[str], conditions: Conditions) -> Iterator[str]:
    """Yield texts under further conditions."""
    for text in texts:
        yield conditional(text, (*conditions, *conditions_of(text))) if conditions else text


def plain(value: Value) -> Value:
    """Return a value without the conditions around it."""
    while isinstance(value, Guarded):
        value = value.value
    return value


def cause(value: Value, reason: str) -> Unknown:
    """Return the unknown value that makes another one unknown: ``value``, if its origin is noted."""
    return value if isinstance(value, Unknown) and value.node is not None else Unknown(reason)


def around(value: Value) -> Conditions:
    """Return the conditions around a value."""
    conditions: Conditions = ()
    while isinstance(value, Guarded):
        conditions += value.conditions
        value = value.value
    return conditions


def same(one: Value, other: Value) -> bool:
    """Return whether two values are certainly the same."""
    if one is other:
        return True
    if isinstance(one, str) and isinstance(other, str):
        return one == other
    simple = (int, float, bool, type(None), tuple)
    return type(one) is type(other) and isinstance(one, simple) and bool(one == other)


def environment(name: str, default: str | None) -> str:
    """Return the symbolic text of an environment variable."""
    return configuration(f"${name}", default)
