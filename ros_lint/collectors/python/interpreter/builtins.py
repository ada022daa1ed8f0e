"""Models of Python's builtin functions and of functions of common libraries: each computes a result from symbolic arguments."""

from __future__ import annotations

import builtins
import collections.abc
import numbers
import typing
from collections.abc import Callable, Mapping
from functools import partial
from typing import TYPE_CHECKING, Any

from ros_lint.collectors import symbolic_text as launch_text
from ros_lint.collectors.python.interpreter import container_functions
from ros_lint.collectors.python.interpreter.alternatives import plain
from ros_lint.collectors.python.interpreter.calls import LibraryCall, Rule, nothing, unknown, unknown_text
from ros_lint.collectors.python.interpreter.methods import call_method, of_instance
from ros_lint.collectors.python.interpreter.operations import each, text_of, truth
from ros_lint.collectors.python.interpreter.values import (
    Bound,
    Class,
    Guarded,
    Instance,
    LaunchObject,
    LibraryName,
    Method,
    ProgramRaised,
    SetOf,
    Union,
    Unknown,
    Value,
)
from ros_lint.collectors.symbolic_text import OWN_FOLDER, UNKNOWN

if TYPE_CHECKING:
    from ros_lint.collectors.python.interpreter.protocol import Interpreter


def _str(call: LibraryCall) -> Value:
    value = call.get(0)
    if isinstance(value, LaunchObject):
        call.machine.record_misuse(value, "formatted", call.node, call.frame)
        return unknown_text(call)
    return call.result(text_of(value)) if value is not None or call.arguments else ""


def _repr(call: LibraryCall) -> Value:
    value = plain(call.get(0))
    if isinstance(value, (int, float, type(None))) or (isinstance(value, str) and launch_text.is_plain(value)):
        return call.result((repr(str(value) if isinstance(value, str) else value),))
    return call.result(text_of(value)) if isinstance(value, (list, tuple, dict)) else unknown_text(call)


def _number(kind: type) -> Rule:
    def rule(call: LibraryCall) -> Value:
        values = [plain(value) for value in (*call.arguments, *call.keywords.values())]
        if all(isinstance(value, (int, float)) or _is_short_text(value) for value in values):
            try:
                return kind(*values)
            except (TypeError, ValueError, OverflowError) as error:
                raise ProgramRaised(type(error).__name__) from None
        return Unknown("a number")

    return rule


def _is_short_text(value: Value) -> bool:
    return isinstance(value, str) and launch_text.is_plain(value) and len(value) < 50


def _bool(call: LibraryCall) -> Value:
    answer, condition = truth(call.machine, call.get(0))
    return answer if answer is not None else Unknown("a truth", condition)


def _list(call: LibraryCall) -> Value:
    if not call.arguments:
        return []
    elements = call.items(0)
    return call.like(0, elements) if elements is not None else unknown(call)


def _tuple(call: LibraryCall) -> Value:
    elements = _list(call)
    return tuple(elements) if isinstance(elements, list) else elements


def _dict(call: LibraryCall) -> Value:
    entries: dict[Any, Value] = {}
    call_method(call.machine, Method(entries, "update"), call.arguments, call.keywords, call.node, call.frame)
    return entries


def _length(call: LibraryCall) -> Value:
    return each(call.get(0), partial(_length_of, call.machine))


def _length_of(machine: Interpreter, value: Value) -> Value:
    value = plain(value)
    if isinstance(value, list):
        elements = machine.present(value)
        return Unknown("a length") if machine.any_perhaps(elements) else len(elements)
    if isinstance(value, (tuple, dict, range)) or (isinstance(value, str) and launch_text.is_plain(value)):
        return len(value)
    return Unknown("a length")


def _range(call: LibraryCall) -> Value:
    *before, last = call.arguments or [None]
    return each(last, lambda last_value: _range_of([*before, last_value]))


def _range_of(arguments: list[Value]) -> Value:
    values = [plain(argument) for argument in arguments]
    if values and all(isinstance(value, int) for value in values):
        try:
            return range(*values)
        except (TypeError, ValueError):
            raise ProgramRaised from None
    return Unknown("a range")


def _enumerate(call: LibraryCall) -> Value:
    elements = call.items(0)
    start = plain(call.get(1, "start")) or 0
    if elements is None or not isinstance(start, int):
        return unknown(call)
    return [_keep(element, partial(_pair, index)) for index, element in enumerate(elements, start)]


def _pair(index: int, value: Value) -> Value:
    return (index, value)


def _keep(value: Value, function: Callable[[Value], Value]) -> Value:
    """Return ``function(value)``. If ``value`` exists only under conditions (``Guarded``), so does the result."""
    if isinstance(value, Guarded):
        return Guarded(_keep(value.value, function), value.conditions)
    return function(value)


def _isinstance(call: LibraryCall) -> Value:
    value, kind = plain(call.get(0)), plain(call.get(1))
    kinds = kind if isinstance(kind, tuple) else (kind,)
    names = {class_.last for class_ in kinds if isinstance(class_, LibraryName)}
    if isinstance(value, (str, int, float, list, dict, tuple, type(None))) and len(names) == len(kinds):
        if isinstance(value, SetOf):
            value = set[Value]()
        return any(_is_of(value, name) for name in names)
    if isinstance(value, LaunchObject) and len(names) == len(kinds):
        return value.name in names or (Unknown("a kind") if names & {"Action", "Substitution", "Entity"} else False)
    if isinstance(value, Instance):
        return any(isinstance(class_, Class) and value.cls is class_ for class_ in kinds) or Unknown("a kind")
    return Unknown("a kind")


def _is_of(value: Value, name: str) -> bool:
    """Return whether a known value is an instance of the class ``name``: ``_is_of([1], "Sequence")`` -> True.

    The class is a class of builtins, collections.abc, numbers or typing.
    """
    if name == "NoneType":
        return value is None
    kinds = [getattr(module, name, None) for module in (builtins, collections.abc, numbers)]
    kind = next(filter(None, kinds), None) or typing.get_origin(getattr(typing, name, None))
    return isinstance(kind, type) and isinstance(value, kind)


def _getattr(call: LibraryCall) -> Value:
    owner, name = plain(call.get(0)), plain(call.get(1))
    if isinstance(owner, Instance) and isinstance(name, str):
        if len(call.arguments) > 2 and name not in owner.attributes and owner.cls.find(name) is None:
            return call.arguments[2]
        return of_instance(owner, name)
    return Unknown("an attribute")


def _fields(call: LibraryCall) -> Value:
    """Model of ``dataclasses.fields()``: return an object with the attribute ``name`` for each field of a class."""
    owner = plain(call.get(0))
    cls = owner.cls if isinstance(owner, Instance) else owner
    if not isinstance(cls, Class):
        return unknown(call)
    fields: list[Value] = []
    for name in cls.every_field():
        field = Instance(Class("Field", [], {}, []))
        field.attributes["name"] = name
        fields.append(field)
    return fields


def _open(call: LibraryCall) -> Value:
    paths, mode = call.texts(0, "file"), plain(call.get(1, "mode"))
    if isinstance(mode, str) and not _MAKES.isdisjoint(mode):
        call.machine.ask(paths)  # the file need not exist before
    if len(paths) != 1 or (isinstance(mode, str) and not _WRITES.isdisjoint(mode)):
        return Unknown("a file")
    return call.machine.open_file(paths[0], next(iter(call.node.args), call.node), call.frame.source)


_WRITES = frozenset("wxa+")
_MAKES = frozenset("wxa")


def _parsed(call: LibraryCall) -> Value:
    return each(call.get(0, "stream", "s"), partial(_content, call.machine))


def _content(machine: Interpreter, text: Value) -> Value:
    if not isinstance(text, str) or not launch_text.is_plain(text):
        machine.escape(text)
        return text if isinstance(text, Unknown) else Unknown("the content of a file")
    machine.budget.step(len(text) // 50)
    from ros_lint.base.safe_yaml import YamlBoundError, YamlError, load  # noqa: PLC0415  (few launch files read YAML)

    try:
        return load(text)
    except YamlBoundError:
        return Unknown("the content of a file")
    except YamlError:
        raise ProgramRaised from None


def _partial(call: LibraryCall) -> Value:
    return Bound(call.arguments[0], call.arguments[1:], call.keywords) if call.arguments else unknown(call)


def _copied(call: LibraryCall) -> Value:
    value = plain(call.get(0))
    if isinstance(value, list):
        return value.copy() if type(value) is list else SetOf(value)
    return dict(value) if isinstance(value, dict) else value


def _copied_whole(call: LibraryCall) -> Value:
    return _deep(call.machine, call.get(0), {})


def _deep(machine: Interpreter, value: Value, done: dict[int, Value]) -> Value:
    """Return a copy of a value, as ``copy.deepcopy()`` does. ``done`` has the copies made so far, by the id of the original."""
    if isinstance(value, Guarded):
        return Guarded(_deep(machine, value.value, done), value.conditions)
    if isinstance(value, Union):
        return Union(tuple([Guarded(_deep(machine, element.value, done), element.conditions) for element in value.values]))
    if isinstance(value, tuple):
        return tuple([_deep(machine, element, done) for element in value])
    if not isinstance(value, (list, dict)) or id(value) in done:
        return done.get(id(value), value)
    machine.budget.step(1 + len(value) // 8)
    if isinstance(value, list):
        items: list[Value] = SetOf() if isinstance(value, SetOf) else []
        done[id(value)] = items
        items += [_deep(machine, element, done) for element in value]
        return items
    entries: dict[Any, Value] = {}
    done[id(value)] = entries
    entries.update({key: _deep(machine, element, done) for key, element in value.items()})
    return entries


BUILTINS: Mapping[str, Value] = {
    "__file__": f"{OWN_FOLDER}/{UNKNOWN}",
    **dict.fromkeys(
        (
            "str", "int", "float", "bool", "list", "dict", "tuple", "set", "frozenset", "len", "range", "enumerate", "zip",
            "sorted", "reversed", "map", "filter", "any", "all", "min", "max", "sum", "isinstance", "hasattr", "getattr",
            "setattr", "print", "open", "super", "next", "iter", "repr", "type", "locals", "globals", "vars", "input", "abs",
            "round", "format", "callable", "id", "hash", "object", "property", "staticmethod", "classmethod", "bytes",
            "exec", "eval", "dir", "chr", "ord", "divmod", "pow", "slice", "issubclass", "NotImplemented", "Ellipsis",
            "exit", "quit", "__name__", "__import__", "bytearray", "complex", "memoryview", "__doc__", "__debug__",
            "delattr", "hex", "oct", "bin", "ascii", "breakpoint", "help", "compile", "copyright", "credits", "license",
            "BaseException", "Exception", "ArithmeticError", "AssertionError", "AttributeError", "EnvironmentError",
            "EOFError", "FileExistsError", "FileNotFoundError", "ImportError", "IndexError", "IOError", "KeyError",
            "KeyboardInterrupt", "LookupError", "ModuleNotFoundError", "NameError", "NotADirectoryError",
            "NotImplementedError", "OSError", "OverflowError", "PermissionError", "RecursionError", "RuntimeError",
            "StopIteration", "SyntaxError", "SystemError", "SystemExit", "TimeoutError", "TypeError", "UnicodeError",
            "UnicodeDecodeError", "ValueError", "Warning", "UserWarning", "DeprecationWarning", "ZeroDivisionError",
        )
    ),
}  # fmt: skip
"""The builtin names of Python. Only ``__file__`` has a value other than None."""

FUNCTIONS: Mapping[str, Rule] = {
    **container_functions.FUNCTIONS,
    "yaml.safe_load": _parsed,
    "yaml.load": _parsed,
    "json.load": _parsed,
    "json.loads": _parsed,
    "functools.partial": _partial,
    "copy.copy": _copied,
    "copy.deepcopy": _copied_whole,
    "collections.OrderedDict": _dict,
    "dataclasses.fields": _fields,
    "builtins.str": _str,
    "builtins.int": _number(int),
    "builtins.float": _number(float),
    "builtins.bool": _bool,
    "builtins.list": _list,
    "builtins.iter": _list,
    "builtins.tuple": _tuple,
    "builtins.dict": _dict,
    "builtins.len": _length,
    "builtins.range": _range,
    "builtins.enumerate": _enumerate,
    "builtins.isinstance": _isinstance,
    "builtins.getattr": _getattr,
    "builtins.print": nothing,
    "builtins.open": _open,
    "builtins.repr": _repr,
    "builtins.input": unknown_text,
    "builtins.type": unknown,
}
"""The models that compute the results of functions, by the full name of the function such as ``builtins.len``."""
