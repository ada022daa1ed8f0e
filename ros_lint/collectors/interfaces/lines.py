"""Read the lines of a .msg, .srv or .action file as rosidl_adapter does, and find the errors for which it rejects the file.

The rules are those of rosidl_adapter/parser.py, which are the same from Humble to Rolling.
"""

from __future__ import annotations

import re
from bisect import bisect_right
from typing import TYPE_CHECKING, Final, NamedTuple

from ros_lint.base.suggestions import did_you_mean, similar_names
from ros_lint.base.text import file_start
from ros_lint.collectors.interfaces import naming
from ros_lint.facts.interfaces import InterfaceFile, InterfaceProblem

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ros_lint.base.text import Span, Text

_INTEGERS: Final = {
    **{f"int{bits}": (-(1 << bits - 1), (1 << bits - 1) - 1) for bits in (8, 16, 32, 64)},
    **{f"uint{bits}": (0, (1 << bits) - 1) for bits in (8, 16, 32, 64)},
    "byte": (0, 255),
    "char": (0, 255),
}
_STRINGS: Final = ("string", "wstring")
_PLAIN: Final = frozenset({"bool", "float32", "float64", *_INTEGERS, *_STRINGS})
"""The primitive types of interface definitions, which are not messages."""
_ROS_1_TYPES: Final = {"time": "builtin_interfaces/Time", "duration": "builtin_interfaces/Duration"}
_SUGGESTED_TYPES: Final = {
    "float": "float32 or float64",
    "double": "float64",
    "int": "int32",
    "uint": "uint32",
    "long": "int64",
    "short": "int16",
    "str": "string",
    "std::string": "string",
    "boolean": "bool",
}
"""Types of programming languages, and the interface types that replace them."""
_KEYWORDS: Final = frozenset({
    "alignas", "alignof", "and", "and_eq", "asm", "auto", "bitand", "bitor", "bool", "break", "case", "catch", "char",
    "char16_t", "char32_t", "class", "compl", "const", "const_cast", "constexpr", "continue", "decltype", "default", "delete",
    "do", "double", "dynamic_cast", "else", "enum", "explicit", "export", "extern", "false", "float", "for", "friend", "goto",
    "if", "inline", "int", "long", "mutable", "namespace", "new", "noexcept", "not", "not_eq", "nullptr", "operator", "or",
    "or_eq", "private", "protected", "public", "register", "reinterpret_cast", "restrict", "return", "short", "signed",
    "sizeof", "static", "static_assert", "static_cast", "struct", "switch", "template", "this", "thread_local", "throw", "true",
    "try", "typedef", "typeid", "typename", "union", "unsigned", "using", "virtual", "void", "volatile", "wchar_t", "while",
    "xor", "xor_eq",
})  # fmt: skip
"""Keywords of C and C++, which cannot be field names, because generated code uses field names as names of members."""
_SEPARATORS: Final = {"msg": 0, "srv": 1, "action": 2}
"""The number of lines ``---`` in an interface definition, by the suffix of its file."""
_SEPARATOR = re.compile(r"^---(?=\r?$)", re.MULTILINE)
_SIMILAR_SEPARATOR = re.compile(r"^[ \t]*[-_=]{2,}[ \t]*(?=#|\r?$)", re.MULTILINE)
_LINE = re.compile(r"^[^#\r\n]+", re.MULTILINE)
_INVALID_UTF_8 = re.compile("[\udc80-\udcff]+")
_SCOPED = re.compile(r"([a-z]\w*)(?:/|::|\.)msg(?:/|::|\.)([A-Z]\w*)")


class _LineError(Exception):
    """An error for which rosidl rejects a line.

    It has the message, the start and end offset of the wrong part in the line, and a replacement for that part or None.
    """

    def __init__(self, message: str, start: int, part: str, instead: str | None = None) -> None:
        super().__init__(message)
        self.message = message
        self.start = start
        self.end = start + len(part)
        self.instead = instead


class _Element(NamedTuple):
    """A field or a constant of an interface definition, such as ``geometry_msgs/Pose pose`` or ``int32 LIMIT=5``."""

    name: str
    start: int
    """The offset of the name in the line."""
    message: str
    """The message type of the field, "" for other types."""


_MOST_PROBLEMS = 100
"""Maximum number of errors of a file that are reported. rosidl itself stops at the first one."""


def collect(source: Text) -> InterfaceFile:
    """Return the message types in an interface definition, and the errors for which rosidl rejects the definition."""
    path, text = source.path, source.text
    if source.codec == "utf-8-sig" or not _is_utf_8(source):
        return InterfaceFile(path, (), (_encoding(source, 0, 0),))
    if len(text.splitlines()) != text.count("\n") + (text[-1:] not in ("", "\n")):
        return InterfaceFile(path)  # it has line separators, such as U+2028, that split lines in rosidl but not in editors
    if not text.isascii() and (invalid := _INVALID_UTF_8.search(text)):
        return InterfaceFile(path, (), (_encoding(source, *invalid.span()),))
    name, _, suffix = path.rpartition("/")[2].rpartition(".")
    text = text.replace("\t", " ")
    problems: list[InterfaceProblem] = []
    if not naming.is_message(name):
        better = f"{naming.camel(name)}.{suffix}"
        problems.append(
            InterfaceProblem(f"'{name}' is not a valid interface name; rename the file to '{better}'", file_start(path))
        )
    marks = [match.start() for match in _SEPARATOR.finditer(text)]
    separators = frozenset(marks)
    separators_valid = len(marks) == _SEPARATORS[suffix]
    problems += () if separators_valid else _separation(source, text, suffix, marks)
    types: list[tuple[str, Span]] = []
    first_places: dict[tuple[str, int], int] = {}
    for match in _LINE.finditer(text):
        at = match.start()
        if at in separators or (not separators_valid and _SIMILAR_SEPARATOR.match(text, at)):
            continue
        try:
            element = _element(match[0].rstrip())
        except _LineError as error:
            if len(problems) < _MOST_PROBLEMS:
                problems.append(InterfaceProblem(error.message, source.span(at + error.start, at + error.end), error.instead))
            continue
        if element is None:
            continue
        if element.message:
            types.append((element.message, source.span(at, at + len(element.message))))
        start = at + element.start
        first = first_places.setdefault((element.name, bisect_right(marks, at)), start)
        if first != start and separators_valid:
            line = source.position(first)[0]
            message = f"'{element.name}' is already defined on line {line}; choose another name"
            problems.append(InterfaceProblem(message, source.span(start, start + len(element.name))))
    return InterfaceFile(path, tuple(types), tuple(problems[:_MOST_PROBLEMS]))


def _is_utf_8(source: Text) -> bool:
    """Return whether a file is valid UTF-8, even if its first lines declare another encoding."""
    if source.codec == "utf-8":
        return True
    try:
        source.encode(source.text).decode("utf-8")
    except UnicodeError:
        return False
    return True


def _encoding(source: Text, start: int, end: int) -> InterfaceProblem:
    kind = "that begins with a byte order mark" if source.codec == "utf-8-sig" else "that is not in UTF-8"
    return InterfaceProblem(
        f"rosidl cannot read a file {kind}; save it as UTF-8 without a byte order mark", source.span(start, end)
    )


def _separation(source: Text, text: str, suffix: str, marks: list[int]) -> Iterator[InterfaceProblem]:
    """Yield the problems of a definition whose number of separator lines ``---`` is wrong.

    ``suffix`` is "msg", "srv" or "action"; ``marks`` are the offsets of the separator lines.
    """
    count = _SEPARATORS[suffix]
    parts = {"msg": "a message has no parts", "srv": "a service has two parts", "action": "an action has three parts"}[suffix]
    separators = frozenset(marks)
    similar = [match for match in _SIMILAR_SEPARATOR.finditer(text) if match.start() not in separators]
    if len(marks) > count:
        yield InterfaceProblem(f"there are too many lines '---'; {parts}", source.span(marks[count], marks[count] + 3))
    elif similar and len(marks) + len(similar) == count:
        for match in similar:
            instead = None if text[match.end() : match.end() + 1] == "#" else "---"
            message = f"a separator line must contain nothing but '---'; {parts}"
            yield InterfaceProblem(message, source.span(*match.span()), instead)
    else:
        lacks = "a line '---' is" if count - len(marks) == 1 else "two lines '---' are"
        yield InterfaceProblem(f"{lacks} missing; {parts}", file_start(source.path))


def _element(line: str) -> _Element | None:
    """Return the field or constant in a line without its comment, None for a blank line. Raises _LineError."""
    kind, _, rest = line.partition(" ")
    rest = rest.lstrip()
    if not kind:
        if not rest:
            return None
        raise _LineError("rosidl does not accept spaces at the beginning of a line; remove them", 0, line[: -len(rest)], "")
    if kind.startswith("//"):
        raise _LineError("a comment begins with '#', not '//'; write '#'", 0, "//", "#")
    if not rest:
        raise _LineError(f"a field consists of a type and a name, but this line only contains '{kind}'; add the name", 0, kind)
    start = len(line) - len(rest)
    name, equals, value = rest.partition("=")
    if equals:
        return _constant(kind, name.rstrip(), value.lstrip(), start, len(line) - len(value.lstrip()))
    name, _, value = rest.partition(" ")
    return _field(kind, name, value.lstrip(), start, len(line) - len(value.lstrip()))


def _constant(kind: str, name: str, value: str, start: int, value_start: int) -> _Element:
    if kind not in _PLAIN:
        message = _type(kind)
        raise _LineError(f"a constant must be a number, a string or a bool, not '{message or kind}'; correct its type", 0, kind)
    if not naming.is_constant(name):
        if naming.is_field(name):
            remedy = f"write '{name.upper()}={value}', or '{name} {value}' for a field with a default value"
            raise _LineError(f"'{name}={value}' is a constant, but its name is not in upper case; {remedy}", start, name)
        raise _LineError(
            f"'{name}' is not a valid name of a constant; use upper-case letters, digits and single underscores", start, name
        )
    _check_value(kind, value, value_start)
    return _Element(name, start, "")


def _field(kind: str, name: str, value: str, start: int, value_start: int) -> _Element:
    message = _type(kind)
    if not naming.is_field(name):
        if name[-1] in ";," and naming.is_field(name[:-1]):
            raise _LineError(f"a line must not end with '{name[-1]}'; remove it", start + len(name) - 1, name[-1], "")
        if name[0] == "[":
            raise _LineError(f"there must be no space before the brackets; write '{kind}{name}'", start, name)
        better = re.sub("__+", "_", naming.snake(name)).strip("_")
        hint = f"write '{better}'" if naming.is_field(better) else "use lower-case letters, digits and single underscores"
        raise _LineError(f"'{name}' is not a valid field name; {hint}", start, name)
    if name in _KEYWORDS:
        raise _LineError(f"'{name}' is a C++ keyword, so the generated code does not compile; choose another name", start, name)
    if value:
        if message:
            raise _LineError(
                f"a field of a message type cannot have a default value, but this one has '{value}'; remove it",
                value_start,
                value,
            )
        _check_value(kind, value, value_start)
    return _Element(name, start, message)


def _type(kind: str) -> str:
    """Return the message type in a field type: ``geometry_msgs/Pose[3]`` -> ``geometry_msgs/Pose``, ``int32[]`` -> "".

    Raises _LineError for an invalid type.
    """
    base, bracket, _ = kind.rpartition("[")
    if kind[-1] != "]":
        base = kind
    elif not bracket or (kind[len(base) :] != "[]" and not _is_size(kind[len(base) + 1 : -1].removeprefix("<="))):
        raise _LineError(f"'{kind}' is not a valid array type; write [], [3], or [<=3] for at most three elements", 0, kind)
    if base in _PLAIN:
        return ""
    plain, bound, size = base.partition("<=")
    if bound and plain in _STRINGS:
        if not _is_size(size):
            raise _LineError(f"'{base}' is not a valid bounded string; write '{plain}<=10'", 0, base)
        return ""
    if base in _ROS_1_TYPES:
        raise _LineError(f"ROS 2 has no type '{base}'; write '{_ROS_1_TYPES[base]}' and depend on 'builtin_interfaces'", 0, base)
    if suggestion := _SUGGESTED_TYPES.get(base.lower()):
        raise _LineError(f"there is no type '{base}'; write {suggestion}", 0, base)
    if (scoped := _SCOPED.fullmatch(base)) and naming.is_message(scoped[2]):
        replacement = f"{scoped[1]}/{scoped[2]}"
        raise _LineError(f"'{base}' is not a valid type in an interface file; write '{replacement}'", 0, base, replacement)
    package, slash, name = base.rpartition("/")
    if slash and not naming.is_field(package):
        raise _LineError(f"'{base}' is not a valid type; write a message of another package as package/Name", 0, base)
    if not naming.is_message(name):
        similar = [] if slash else similar_names(base, sorted(_PLAIN), 1, 0.7)
        better = f"{package}{slash}{naming.camel(name)}"
        hint = did_you_mean(similar) or (f"; names of messages look like '{better}'" if name.isidentifier() else "")
        raise _LineError(f"there is no type '{base}'{hint}", 0, base)
    return base


def _is_size(text: str) -> bool:
    number = _integer(text)
    return number is not None and number > 0


def _integer(text: str) -> int | None:
    try:
        return int(text)
    except ValueError:
        try:
            return int(text, 0)
        except ValueError:
            return None


def _check_value(kind: str, value: str, start: int) -> None:
    """Raise _LineError if ``value`` is not a valid default or constant of the field type ``kind``.

    ``start`` is the offset of the value in its line. For arrays of strings, only the brackets are checked.
    """
    comment = value.find("//")
    base, bracket, size = kind.removesuffix("]").partition("[")
    if bracket:
        elements = [element.strip() for element in value[1:-1].split(",")] if value[1:-1] else []
        at_most = size.startswith("<=")
        limit = int(size.removeprefix("<=") or 0)
        fits = not limit or len(elements) == limit or (at_most and len(elements) < limit)
        is_array = value[0] == "[" and value[-1] == "]"
        if is_array and (base.startswith(_STRINGS) or (fits and all(_is_value(base, element) for element in elements))):
            return
    elif _is_value(base, value):
        return
    if comment >= 0 and not base.startswith(_STRINGS):
        raise _LineError("a comment begins with '#', not '//'; write '#'", start + comment, "//", "#")
    raise _LineError(f"'{value}' is not a valid value of type '{kind}'; correct the value or the type", start, value)


def _is_value(kind: str, value: str) -> bool:
    if kind == "bool":
        return value.lower() in ("true", "false", "0", "1")
    if kind in _INTEGERS:
        number = _integer(value)
        return number is not None and _INTEGERS[kind][0] <= number <= _INTEGERS[kind][1]
    if kind.startswith("float"):
        try:
            float(value)
        except ValueError:
            return False
        return True
    quote = value[:1]
    if quote in ("'", '"') and value.endswith(quote):
        value = value[1:-1]
        if re.search(rf"(?<!\\){quote}", value):
            return False
        value = value.replace(f"\\{quote}", quote)
    limit = kind.partition("<=")[2]
    return not limit or len(value) <= int(limit)
