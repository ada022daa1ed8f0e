"""Encode values of a declared type as bytes, column by column.

The types are named tuples, enumerations, tuples, str, bytes, int and bool. The annotations of the fields of named tuples
define the encoding. The values of one field of all objects of a type are stored next to each other, so that the C code of
``array``, ``map`` and ``zip`` does most of the work. Decoding can create only values of these types, because the bytes
contain no name of a type or function.
"""

from __future__ import annotations

import sys
from array import array
from collections import defaultdict
from collections.abc import Callable, Iterable, Sequence
from enum import Enum
from functools import partial
from itertools import chain, count, islice
from operator import attrgetter
from types import NoneType, UnionType
from typing import Any, Generic, Literal, Protocol, TypeVar, Union, get_args, get_origin

T = TypeVar("T")

_CODES = {1: "B", 2: "H", 4: "I", 8: "q"}
"""Type codes of ``array`` by the number of bytes of an integer."""

_MOST_VALUES = 1 << 25
"""Maximum number of values in all columns of one encoding, because the bytes of a manipulated file could need all memory."""


class DecodeError(ValueError):
    """The bytes are not an encoding of a value of the expected type."""


class Codec(Generic[T]):
    """Encodes and decodes values of ``kind``, a type such as ``Report`` or ``tuple[Span, ...]``.

    Raises TypeError for a type that has no encoding.
    """

    def __init__(self, kind: Any) -> None:
        plan = _Plan()
        self._column = plan.column(kind)
        self.schema = f"{sys.byteorder} {plan.name(kind)} {plan.definitions}"
        """The definitions of all types in the encoding, as text. Two encodings with equal texts are compatible."""

    def encode(self, value: T) -> bytes:
        """Return ``value`` as bytes.

        Raises an exception of any class if the value does not have the type ``kind``.
        """
        writer = _Writer()
        self._column.write(writer, [value])
        return writer.data()

    def decode(self, data: bytes) -> T:
        """Return the value that was encoded. Raises DecodeError for bytes that :meth:`encode` does not return."""
        try:
            reader = _Reader(data)
            (value,) = self._column.read(reader, 1)
            reader.finish()
        except Exception as error:  # the errors of damaged bytes are not limited: IndexError, RecursionError and others
            raise DecodeError(f"{type(error).__name__}: {error}") from error
        result: T = value
        return result


class _Writer:
    """Collects the columns of the encoded values.

    Each distinct str is stored once, because most texts occur several times. A column of str has the numbers of the
    texts.
    """

    def __init__(self) -> None:
        self.numbers: defaultdict[str, int] = defaultdict()
        self.numbers.default_factory = self.numbers.__len__  # an unknown text gets the next number
        self._columns: list[bytes] = []

    def integers(self, column: Sequence[int]) -> None:
        """Add a column of integers.

        If all are equal, the value is stored once. Otherwise each takes as many bytes as the largest one needs.
        """
        if not column:
            return
        low, high = min(column), max(column)
        if low == high:
            self._columns += (b"\0", low.to_bytes(8, "little", signed=True))
            return
        width = 8 if low < 0 or high >> 32 else 4 if high >> 16 else 2 if high >> 8 else 1
        self._columns += (bytes([width]), array(_CODES[width], column).tobytes())

    def octets(self, data: bytes) -> None:
        """Add bytes unchanged."""
        self._columns.append(data)

    def data(self) -> bytes:
        """Return all distinct texts, followed by the columns, as bytes."""
        together = "".join(self.numbers)
        separator = next(number for number in count() if chr(number) not in together)
        texts = chr(separator).join(self.numbers).encode("utf-8", "surrogatepass")
        head = len(texts).to_bytes(8, "little") + separator.to_bytes(4, "little")
        return b"".join([head, texts, *self._columns])


class _Reader:
    """Returns the columns in the order in which :class:`_Writer` wrote them."""

    def __init__(self, data: bytes) -> None:
        self._data = data
        self._values = 0
        self._at = 12
        separator = chr(int.from_bytes(data[8:12], "little"))
        self.texts = self.octets(int.from_bytes(data[:8], "little")).decode("utf-8", "surrogatepass").split(separator)

    def integers(self, number: int) -> list[int]:
        """Return the next ``number`` integers."""
        self._values += number
        if number < 0 or self._values > _MOST_VALUES:
            raise ValueError("too many values")
        if not number:
            return []
        (width,) = self.octets(1)
        if not width:
            return [int.from_bytes(self.octets(8), "little", signed=True)] * number
        integers = array(_CODES[width])
        integers.frombytes(self.octets(number * width))
        return integers.tolist()

    def octets(self, number: int) -> bytes:
        """Return the next ``number`` bytes."""
        start, self._at = self._at, self._at + number
        if number < 0 or self._at > len(self._data):
            raise ValueError("the data ends too early")
        return self._data[start : self._at]

    def finish(self) -> None:
        """Raise ValueError if not all bytes have been read."""
        if self._at != len(self._data):
            raise ValueError("there are further bytes")


class _Column(Protocol):
    """Encodes and decodes all values at one position in the structure of a type, e.g. one field.

    An empty sequence of values is encoded as b"".
    """

    def write(self, writer: _Writer, values: Sequence[Any]) -> None:
        """Add the values to the writer."""

    def read(self, reader: _Reader, number: int) -> Sequence[Any]:
        """Return the next ``number`` values of the reader."""


class _Integers:
    def write(self, writer: _Writer, values: Sequence[int]) -> None:
        writer.integers(values)

    def read(self, reader: _Reader, number: int) -> list[int]:
        return reader.integers(number)


class _Texts:
    def write(self, writer: _Writer, values: Sequence[str]) -> None:
        writer.integers(list(map(writer.numbers.__getitem__, values)))

    def read(self, reader: _Reader, number: int) -> list[str]:
        return list(map(reader.texts.__getitem__, reader.integers(number)))


class _Octets:
    def write(self, writer: _Writer, values: Sequence[bytes]) -> None:
        writer.integers(list(map(len, values)))
        writer.octets(b"".join(values))

    def read(self, reader: _Reader, number: int) -> list[bytes]:
        return list(map(reader.octets, reader.integers(number)))


class _Choices:
    """Values from a short fixed list, stored as indexes into the list: bool, literals, and functions (encoded as None)."""

    def __init__(self, choices: Sequence[Any]) -> None:
        self._choices = choices
        self._numbers = {choice: number for number, choice in enumerate(choices)}

    def write(self, writer: _Writer, values: Sequence[Any]) -> None:
        writer.integers(list(map(self._numbers.__getitem__, values)))

    def read(self, reader: _Reader, number: int) -> list[Any]:
        return list(map(self._choices.__getitem__, reader.integers(number)))


_TRUTH = _Choices((False, True))


class _Members:
    """The column type for members of an enumeration: each is encoded as its integer. Combinations of flags are allowed."""

    def __init__(self, enumeration: type[Enum]) -> None:
        self._enumeration: Callable[[int], Enum] = enumeration

    def write(self, writer: _Writer, values: Sequence[Enum]) -> None:
        writer.integers(list(map(attrgetter("value"), values)))

    def read(self, reader: _Reader, number: int) -> list[Enum]:
        integers = reader.integers(number)
        members = {integer: self._enumeration(integer) for integer in set(integers)}
        return list(map(members.__getitem__, integers))


class _Optional:
    def __init__(self, column: _Column) -> None:
        self._column = column

    def write(self, writer: _Writer, values: Sequence[Any]) -> None:
        _TRUTH.write(writer, [value is not None for value in values])
        self._column.write(writer, [value for value in values if value is not None])

    def read(self, reader: _Reader, number: int) -> list[Any]:
        present = _TRUTH.read(reader, number)
        amount = sum(present)
        if not amount:
            return [None] * number
        values = iter(self._column.read(reader, amount))
        return [next(values) if is_present else None for is_present in present]


class _Sequences:
    """Tuples of any length. The lengths of all tuples are stored first, then the elements of all tuples."""

    def __init__(self, column: _Column) -> None:
        self._column = column

    def write(self, writer: _Writer, values: Sequence[tuple[Any, ...]]) -> None:
        writer.integers(list(map(len, values)))
        self._column.write(writer, list(chain.from_iterable(values)))

    def read(self, reader: _Reader, number: int) -> list[tuple[Any, ...]]:
        lengths = reader.integers(number)
        amount = sum(lengths)
        if not amount:
            return [()] * number
        elements = iter(self._column.read(reader, amount))
        return [tuple(islice(elements, length)) if length else () for length in lengths]


class _Rows:
    """Tuples of a fixed length, or named tuples. Each field is stored as one column."""

    def __init__(self, make: Callable[[Iterable[tuple[Any, ...]]], list[Any]]) -> None:
        self._make = make
        self.fields: list[_Column] = []

    def write(self, writer: _Writer, values: Sequence[tuple[Any, ...]]) -> None:
        if values:
            for field, column in zip(self.fields, zip(*values, strict=True), strict=True):
                field.write(writer, column)

    def read(self, reader: _Reader, number: int) -> list[Any]:
        if not number:
            return []
        return self._make(zip(*[field.read(reader, number) for field in self.fields], strict=True))


class _Plan:
    """Derives the column for a type from the annotations of the type, and records the definition of each class in the type."""

    def __init__(self) -> None:
        self.definitions: dict[str, str] = {}
        """For each class, by its name, the text of its fields or enumeration members."""
        self._classes: dict[type, _Column] = {}

    def column(self, kind: Any) -> _Column:
        """Return the column that encodes values of the type ``kind``. Raises TypeError if the type has no encoding."""
        if kind in _SIMPLE:
            return _SIMPLE[kind]
        if kind in self._classes:
            return self._classes[kind]
        arguments = get_args(kind)
        match get_origin(kind):
            case origin if origin in (Union, UnionType):
                return self._optional([argument for argument in arguments if argument is not NoneType])
            case origin if origin is tuple:
                if arguments[1:] == (Ellipsis,):
                    return _Sequences(self.column(arguments[0]))
                rows = _Rows(list)
                rows.fields = [self.column(argument) for argument in arguments]
                return rows
            case origin if origin is Literal:
                return _Choices(arguments)
        if isinstance(kind, type) and issubclass(kind, Enum):
            self._classes[kind] = _Members(kind)
            self.definitions[self.name(kind)] = str([(name, member.value) for name, member in kind.__members__.items()])
            return self._classes[kind]
        if isinstance(kind, type) and issubclass(kind, tuple):
            return self._class(kind)
        raise TypeError(f"values of {kind!r} have no encoding")

    def _optional(self, present: Sequence[Any]) -> _Column:
        if len(present) != 1:
            raise TypeError(f"values of {present} at one place have no encoding")
        if get_origin(present[0]) is Callable:
            return _Choices((None,))
        return _Optional(self.column(present[0]))

    def _class(self, kind: type[tuple[Any, ...]]) -> _Column:
        rows = _Rows(partial(_instances, partial(tuple.__new__, kind)))
        self._classes[kind] = rows  # before its fields, because a field may have the type itself
        fields = _fields(kind)
        self.definitions[self.name(kind)] = str([(name, self.name(field)) for name, field in fields])
        rows.fields = [self.column(field) for _, field in fields]
        return rows

    def name(self, kind: Any) -> str:
        """Return a text that identifies a type."""
        return f"{kind.__module__}.{kind.__qualname__}" if type(kind) in (type, type(Enum)) else str(kind)


def _instances(make: Callable[[tuple[Any, ...]], Any], rows: Iterable[tuple[Any, ...]]) -> list[Any]:
    return list(map(make, rows))


_SIMPLE: dict[Any, _Column] = {int: _Integers(), str: _Texts(), bool: _TRUTH, bytes: _Octets()}


class _Names(dict[str, Any]):
    """The names that annotations of a module can use. A name that is imported under ``if TYPE_CHECKING`` only is ``object``."""

    def __missing__(self, name: str) -> Any:
        scope = vars(sys.modules["builtins"])
        return scope.get(name, object)


def _fields(kind: Any) -> list[tuple[str, Any]]:
    """Return the names and types of the fields of a named tuple."""
    annotations = {name: getattr(kind.__annotations__[name], "__forward_arg__", None) for name in kind._fields}
    texts = ", ".join(f"({text or 'object'})" for text in annotations.values())
    types = eval(f"({texts},)", {}, _Names(vars(sys.modules[kind.__module__])))  # noqa: S307  (annotations of our own classes)
    return list(zip(annotations, types, strict=True))
