"""The values that the names of a program have while it is interpreted. The program is a launch file or a setup.py.

Texts, numbers, lists and dictionaries are those of Python. This module has classes for the other values: objects of
the launch libraries, functions and classes of the program, alternatives, and unknown values. A text may be symbolic:
marks stand for its parts that are known only at launch, see :mod:`ros_lint.collectors.symbolic_text`.
"""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from pathlib import PurePosixPath
from types import MappingProxyType
from typing import Any, Final, NamedTuple

from ros_lint.base.text import Span, Text
from ros_lint.collectors.symbolic_text import UNKNOWN, configuration, is_plain
from ros_lint.facts.launch import LaunchCondition

Value = Any
"""A value of the program: a str, int, list ... of Python, or an object of this module."""

Conditions = tuple[LaunchCondition, ...]

PERHAPS: Final = LaunchCondition((UNKNOWN,), None)
"""An unknown condition, that is, a condition that may or may not hold."""


class Module(NamedTuple):
    """The source and the syntax tree of a module of the workspace."""

    text: Text
    tree: ast.Module


Modules = Callable[[str, Text], "Module | None"]
"""A function that finds a module by its dotted name (with leading dots if relative) and the source of the importing module.

It returns None if there is no such module.
"""


class Names(dict[str, Value]):
    """The names of a running function, class body or module with their values, which may be pending (:class:`Pending`)."""

    __slots__ = ("changed",)

    def __init__(self, names: Mapping[str, Value] = MappingProxyType({})) -> None:
        super().__init__(names)
        self.changed: dict[str, None] = {}
        """The names that were bound or deleted since this object was created, in order."""

    def __setitem__(self, name: str, value: Value) -> None:
        self.changed[name] = None
        super().__setitem__(name, value)

    def discard(self, name: str) -> None:
        """Delete a name, if it is bound."""
        if name in self:
            self.changed[name] = None
            del self[name]

    def become(self, others: Names) -> None:
        """Bind exactly the names in ``others``."""
        for name in [name for name in self if name not in others]:
            self.discard(name)
        for name, value in others.items():
            if name not in self or self[name] is not value:
                self[name] = value

    def settle(self) -> None:
        """Join the alternatives of all pending values."""
        self.update({name: settled(value) for name, value in self.items() if type(value) is Pending})


class Source:
    """An interpreted module: its source, and the values of the names that it binds at its top level."""

    __slots__ = ("ascii", "assigns_inside", "lent", "names", "text", "yields")

    def __init__(self, text: Text, *, lent: bool = False) -> None:
        self.text = text
        self.ascii = text.text.isascii()
        self.lent = lent
        """True for a model, that is, a short program in place of a released module. Findings in it have the place of the call."""
        self.yields = "yield" in text.text
        self.assigns_inside = ":=" in text.text
        self.names = Names()


class Written(str):
    """A text, the expression that produced it, and the module of that expression."""

    __slots__ = ("node", "source")

    node: ast.expr
    source: Source

    def __reduce__(self) -> tuple[type[str], tuple[str]]:
        """Pickle the text alone: facts may contain such a text, and the interpreted module does not belong to them."""
        return str, (str(self),)


def written(text: str, node: ast.expr, source: Source) -> Written:
    """Return ``text`` with the expression that produced it, and the module of that expression."""
    made = Written(text)
    made.node = node
    made.source = source
    return made


class Unknown:
    """An unknown value; ``reason`` says what is unknown.

    ``condition`` is the condition under which the value is true, None if it is not known. ``node`` is the expression from which
    the unknown value comes, None if the interpreter does not record it.
    """

    __slots__ = ("condition", "node", "reason")

    def __init__(self, reason: str, condition: LaunchCondition | None = None, node: ast.AST | Span | None = None) -> None:
        self.reason = reason
        self.condition = condition
        self.node = node


class Guarded:
    """A value that exists only if all its conditions hold, such as a list element that a branch appends."""

    __slots__ = ("conditions", "value")

    def __init__(self, value: Value, conditions: Conditions) -> None:
        self.value = value
        self.conditions = conditions


class Union:
    """A value that is one of several alternatives. Each alternative has the conditions under which it is the value."""

    __slots__ = ("values",)

    def __init__(self, values: tuple[Guarded, ...]) -> None:
        self.values = values


class Pending:
    """The value of a name after two branches, as long as the name is not read. :func:`settled` joins its alternatives.

    Most names that branches and loops bind are not read after them, so that most values never have to be joined.
    """

    __slots__ = ("join", "parts", "value")

    def __init__(self, parts: tuple[Guarded, ...], join: Callable[[Sequence[Guarded]], Value]) -> None:
        self.parts = parts
        """The values in the branches, which may be pending themselves; () if they are joined."""
        self.join = join
        self.value: Value = None


def settled(value: Value) -> Value:
    """Return ``value``, or its joined alternatives if it is pending."""
    if type(value) is not Pending:
        return value
    waiting = [value]  # no recursion, because a value may be pending after any number of branches
    while waiting:
        pending = waiting[-1]
        inner = [part.value for part in pending.parts if type(part.value) is Pending and part.value.parts]
        if inner:
            waiting += inner
            continue
        waiting.pop()
        if pending.parts:
            parts = [Guarded(settled(part.value), part.conditions) for part in pending.parts]
            pending.value, pending.parts = pending.join(parts), ()
    return value.value


class SetOf(list[Value]):
    """A set of Python, represented by a list of distinct elements in order of insertion.

    It is a list, because unknown elements are not hashable.
    """


class Globbed(list[Value]):
    """The list of files that a call of ``glob(pattern)`` returns. An operator such as ``+`` turns it into a plain list."""

    __slots__ = ("pattern",)
    pattern: str


def globbed(pattern: str, paths: Iterable[Value]) -> Globbed:
    """Return paths as the result of ``glob(pattern)``."""
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
    """A dotted name of a module, class, function or constant of a library, such as ``os.path.join``."""

    __slots__ = ("name",)

    def __init__(self, name: str) -> None:
        self.name = name

    @property
    def last(self) -> str:
        return self.name.rpartition(".")[2]


def argument_of(call: ast.Call, position: int, *names: str) -> ast.expr:
    """Return the expression of a call's argument at ``position`` or with a keyword in ``names``, else the call itself."""
    for keyword in call.keywords:
        if keyword.arg in names:
            return keyword.value
    if not 0 <= position < len(call.args) or any(isinstance(argument, ast.Starred) for argument in call.args):
        return call
    return call.args[position]


class LaunchObject:
    """An object of a class of the launch libraries, such as an action, a substitution or a launch description."""

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
        """True if the object is part of the launch description."""
        self.escaped = False
        """True if code that is not interpreted gets the object, so that this code may launch it."""

    def get(self, position: int, *names: str) -> Value:
        """Return the value of the argument at ``position`` or with a keyword in ``names``, None if it is missing."""
        for name in names:
            if name in self.keywords:
                return self.keywords[name]
        return self.arguments[position] if 0 <= position < len(self.arguments) else None

    def may_hide(self, *names: str) -> bool:
        """Return whether unknown ``**keywords`` of the call may contain an argument with a name in ``names``.

        The result is False if the call has such an argument outside of ``**keywords``.
        """
        return UNKNOWN in self.keywords and self.keywords.keys().isdisjoint(names)

    def written(self, position: int, *names: str) -> ast.expr:
        """Return the expression of the argument at ``position`` or with a keyword in ``names``, else the call itself."""
        return argument_of(self.node, position, *names)


class Function:
    """A function that the program defines. ``frame`` has the names of the module or function that contains the definition."""

    __slots__ = ("changed", "defaults", "frame", "keyword_defaults", "node", "owner")

    def __init__(self, node: ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda, frame: Frame) -> None:
        self.node = node
        self.frame = frame
        self.defaults: list[Value] = []
        self.keyword_defaults: dict[str, Value] = {}
        self.owner: Class | None = None
        self.changed = False  # True if an unknown decorator may replace it

    def yields(self) -> bool:
        """Return whether the function is a generator. ``yield`` in nested functions does not count."""
        waiting: list[ast.AST] = list(self.node.body) if isinstance(self.node.body, list) else []
        while waiting:
            inner = waiting.pop()
            if isinstance(inner, (ast.Yield, ast.YieldFrom)):
                return True
            if not isinstance(inner, (ast.FunctionDef, ast.AsyncFunctionDef, ast.Lambda, ast.ClassDef)):
                waiting += ast.iter_child_nodes(inner)
        return False

    def taking(self, arguments: list[Value], keywords: dict[str, Value]) -> dict[str, Value]:
        """Return the values of the parameters, by name, if the function is called with these arguments.

        A parameter without argument has its default value, or is unknown if it has no default.
        """
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
    """A function and values of its first arguments: a bound method, or the result of ``functools.partial()``."""

    __slots__ = ("arguments", "function", "keywords")

    def __init__(self, function: Value, arguments: list[Value], keywords: dict[str, Value] | None = None) -> None:
        self.function = function
        self.arguments = arguments
        self.keywords = keywords or {}


class Method:
    """A method of a text, a collection, a path or an object of a library: ``a.append``."""

    __slots__ = ("name", "owner")

    def __init__(self, owner: Value, name: str) -> None:
        self.owner = owner
        self.name = name


PLAIN_BASES = frozenset({"ABC", "Enum", "NamedTuple", "Protocol", "object"})
"""Library classes whose subclasses are no objects of the library."""


class Class:
    """A class that the program defines."""

    __slots__ = ("bases", "fields", "name", "names")

    def __init__(self, name: str, bases: list[Value], names: dict[str, Value], fields: list[str]) -> None:
        self.name = name
        self.bases = bases
        self.names = names
        self.fields = fields
        """The annotated names in the class body, in order. For a dataclass, they are the parameters of the constructor."""

    def find(self, name: str) -> Value | None:
        for cls in self._line():
            if isinstance(cls, Class) and name in cls.names:
                return cls.names[name]
        return None

    def derives_from(self, base: Class) -> bool:
        """Return whether ``base`` is this class or one of its base classes."""
        return any(cls is base for cls in self._line())

    def inherited(self, derived: Class, name: str) -> Value | None:
        """Return the attribute ``name`` that ``super()`` has in a method of the class ``derived``, None if it is not found.

        The method is called for an object of the class ``self``, which is ``derived`` or a class derived from it.
        """
        line = list(self._line())
        for cls in line[line.index(derived) + 1 :] if derived in line else ():
            if isinstance(cls, Class) and name in cls.names:
                return cls.names[name]
            if isinstance(cls, LibraryName) and cls.last not in PLAIN_BASES:
                return LibraryName(f"{cls.name}.{name}")
        return None

    def every_field(self) -> dict[str, None]:
        """Return the names of the fields of the base classes, followed by the fields of the class itself."""
        line = [cls for cls in self._line() if isinstance(cls, Class)]
        return dict.fromkeys(name for cls in reversed(line) for name in cls.fields)

    def library_base(self) -> LibraryName | None:
        """Return the first direct or indirect base class that a library defines, None if there is none."""
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
    """An object of a class that the program defines.

    If its class derives from a launch class, such as Node, ``made`` is the object of the launch class, else None.
    """

    __slots__ = ("attributes", "cls", "conditions", "made")

    def __init__(self, cls: Class, conditions: Conditions = ()) -> None:
        self.cls = cls
        self.conditions = conditions
        """The conditions under which the object is created."""
        self.attributes: dict[str, Value] = {}
        self.made: LaunchObject | None = None


class Super:
    """The result of ``super()`` in a method of the class ``cls``, for the object ``instance``."""

    __slots__ = ("cls", "instance")

    def __init__(self, cls: Class, instance: Instance) -> None:
        self.cls = cls
        self.instance = instance


class Context:
    """The launch context that launch passes to functions, for example to the function of an OpaqueFunction."""

    __slots__ = ()


class Exit(NamedTuple):
    """An exit from an iteration, a loop or a function that is taken only under conditions."""

    signal: int
    """How the program exits: CONTINUE, BREAK or LEAVE of :mod:`ros_lint.collectors.python.interpreter.branches`."""
    conditions: Conditions
    """All conditions that hold at the exit."""
    names: Names
    """The names of the function at the exit, with their values."""


class Frame:
    """The names of a running function, class body or module, with their values."""

    __slots__ = ("declared", "exits", "names", "outer", "returned", "source", "yielded")

    def __init__(self, source: Source, outer: Frame | None, names: Mapping[str, Value]) -> None:
        self.source = source
        self.outer = outer
        self.names = names if isinstance(names, Names) else Names(names)
        self.declared: dict[str, Frame] = {}
        """Names that ``global`` or ``nonlocal`` binds in another frame."""
        self.exits: list[Exit] = []
        """The conditional exits, such as ``return`` in a branch, of the blocks that are being interpreted, in order."""
        self.returned: list[Guarded] = []
        self.yielded: list[Value] = []


class ProgramRaised(Exception):  # noqa: N818  (it represents any exception of the program)
    """The program raises an exception. ``kind`` is the name of its class, "" if unknown.

    ``deliberate`` is True if a raise statement, or a function such as sys.exit(), raises the exception.
    """

    def __init__(self, kind: str = "", *, deliberate: bool = False) -> None:
        super().__init__(kind)
        self.kind = kind
        self.deliberate = deliberate


def environment(name: str, default: str | None) -> str:
    """Return a text that represents the value of the environment variable ``name``, which is known only at launch."""
    return configuration(f"${name}", default)
