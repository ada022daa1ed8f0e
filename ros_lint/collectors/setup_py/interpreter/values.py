"""Values in the evaluation of a setup.py: values of Python, and classes for unknown values."""

from __future__ import annotations

import ast
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, Final, NamedTuple, TypeGuard

from ros_lint.base.text import Span
from ros_lint.base.wildcards import LONGEST

if TYPE_CHECKING:
    from pathlib import PurePosixPath

Value = Any
"""A value of Python (str, number, None, container, PurePosixPath), or one of the classes below."""


class Unknown:
    """An unknown value. As an element of a list it means any number of unknown elements."""

    __slots__ = ("node", "reason")

    def __init__(self, reason: str, node: ast.AST | Span | None) -> None:
        self.reason = reason
        """A clause without subject, such as "os.environ is not known"."""
        self.node = node


REST = "\ue002"
"""The key of a dict for all unknown keys. Its value is an Unknown."""


class Maybe:
    """An element of a list that may be missing, because its presence depends on something unknown."""

    __slots__ = ("value",)

    def __init__(self, value: Value) -> None:
        self.value = value


class Word(str):
    """A text with its origin: an expression of setup.py, or a place in another file."""

    __slots__ = ("node",)
    node: ast.AST | Span

    @classmethod
    def at(cls, text: str, node: ast.AST | Span) -> Word:
        word = cls(text)
        word.node = node
        return word


class Globbed(list[Value]):
    """The unchanged result of one glob."""

    __slots__ = ("pattern",)
    pattern: str


def globbed(pattern: str, paths: list[Value]) -> Globbed:
    """Return paths as the result of a glob pattern."""
    found = Globbed(paths)
    found.pattern = pattern
    return found


class Module(NamedTuple):
    """An imported module, or a submodule, by its dotted name."""

    name: str


class Native(NamedTuple):
    """A function or method with a model, by its name, such as ``os.path.join``.

    The owner is the value of a method.
    """

    name: str
    owner: Value = None

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Native) and self.name == other.name and self.owner is other.owner

    def __hash__(self) -> int:
        return hash(self.name)

    def __repr__(self) -> str:
        return f"<function {self.name}>"


class Function(NamedTuple):
    """A function of setup.py itself."""

    node: ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda
    scopes: tuple[dict[str, Value], ...]
    """The scopes in which it is defined, innermost first."""
    defaults: tuple[Value, ...]
    keyword_defaults: tuple[Value, ...]

    def __eq__(self, other: object) -> bool:
        return self is other

    def __hash__(self) -> int:
        return id(self)

    def __repr__(self) -> str:
        return "<function>"


class Class(NamedTuple):
    """A class that setup.py defines. Only its name is known."""

    name: str


LARGEST: Final = 1 << 25
"""Characters of a value that is followed. A list that holds another one twice, and so on, is larger than the memory."""
_DEEPEST: Final = 50
"""Containers in each other of a value that is followed. Python itself cannot hash a tuple of any depth."""
_ELEMENT: Final = 128
"""Characters that an element of a container counts for."""


def size_of(values: Iterable[Value]) -> int:
    """Return how many characters values count for, a container each time that it is there.

    The number is larger than LARGEST for values that are too large or too deep to be followed, which are not measured whole.
    """
    size = 0
    level = [*values]
    for _ in range(_DEEPEST):
        size += sum(map(_own_size, level))
        if size > LARGEST:
            return size
        level = [item for value in level for item in _inner(value)]
        if not level:
            return size
    return LARGEST + 1


def _own_size(value: Value) -> int:
    return len(value) if isinstance(value, str) else _ELEMENT * len(value) if _is_container(value) else 0


def _inner(value: Value) -> Iterable[Value]:
    """Return what a container holds."""
    if isinstance(value, dict):
        return (*value, *value.values())
    return value if _is_container(value) else ()


def _is_container(value: Value) -> bool:
    return isinstance(value, (list, dict, set, frozenset)) or type(value) is tuple


def followed(value: Value) -> Value:
    """Return a value, something unknown in place of one that is too large."""
    return value if size_of((value,)) <= LARGEST else Unknown("it is larger than is followed", None)


def certain(value: Value) -> bool:
    """Return whether nothing about a value is unknown."""
    return size_of((value,)) <= LARGEST and _certain(value)


def _certain(value: Value) -> bool:
    if isinstance(value, (Unknown, Maybe)):
        return False
    if isinstance(value, dict):
        return all(map(_certain, value.values()))
    return all(map(_certain, value)) if _is_container(value) else True


def unknown_in(values: Iterable[Value]) -> Unknown | None:
    """Return the first of some values that is unknown, or partly so."""
    values = [*values]
    if size_of(values) > LARGEST:
        return Unknown("it is larger than is followed", None)
    return _unknown_in(values)


def _unknown_in(values: Iterable[Value]) -> Unknown | None:
    for value in values:
        if isinstance(value, Unknown):
            return value
        if isinstance(value, Maybe):
            return Unknown("it depends on something that is not known", getattr(value.value, "node", None))
        if _is_container(value):
            inner = _unknown_in(value.values() if isinstance(value, dict) else value)
            if inner:
                return inner
    return None


def located(value: Value, node: ast.AST) -> Value:
    """Return a value with ``node`` as the origin of its text, or of the texts in its list or tuple."""
    if type(value) is str:
        return Word.at(value, node)
    if isinstance(value, list):
        value[:] = [Word.at(item, node) if type(item) is str else item for item in value]
    elif type(value) is tuple:
        return tuple(Word.at(item, node) if type(item) is str else item for item in value)
    return value


def same(left: Value, right: Value) -> bool:
    """Return whether two values are known to be equal."""
    return left is right or (certain(left) and certain(right) and type(left) is type(right) and bool(left == right))


def either(left: Value, right: Value, unknown: Unknown) -> Value:
    """Return the value that represents one of two values, chosen by an unknown condition."""
    if same(left, right):
        return left
    if isinstance(left, list) and isinstance(right, list):
        return merged(left, right)
    return unknown


def merged(left: list[Value], right: list[Value]) -> list[Value]:
    """Return a list that represents one of two lists: their common start, then other elements as Maybe."""
    shared = 0
    while shared < min(len(left), len(right)) and same(left[shared], right[shared]):
        shared += 1
    rest = [*left[shared:], *right[shared:]]
    return [*left[:shared], *(item if isinstance(item, (Maybe, Unknown)) else Maybe(item) for item in rest)]


def path_of(*parts: Value) -> PurePosixPath:
    """Return a path as pathlib.Path() makes it. Raises TypeError as that does, and ValueError for one that is too long."""
    if sum(len(str(part)) for part in parts) > LONGEST:
        raise ValueError(parts)
    from pathlib import PurePosixPath  # noqa: PLC0415  (it is slow to import, and few scripts want it)

    return PurePosixPath(*parts)


def is_path(value: Value) -> TypeGuard[PurePosixPath]:
    """Return whether a value is a path of pathlib."""
    return type(value).__name__ == "PurePosixPath"
