"""Models of the attributes and methods of the values in a program, such as ``text.split()`` and ``path.parent``."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence
from itertools import islice
from typing import TYPE_CHECKING, Any

from ros_lint.collectors.conditional_text import joined
from ros_lint.collectors.python.interpreter.alternatives import alternatives, around, cause, plain, same, union
from ros_lint.collectors.python.interpreter.dictionaries import entries, guarded, store, value_or_default
from ros_lint.collectors.python.interpreter.elements import append, chosen, may_have_more, waits, without
from ros_lint.collectors.python.interpreter.operations import hashable, of_sets, text_of, texts_made, with_format
from ros_lint.collectors.python.interpreter.ordering import arranged, is_known, is_small, unique
from ros_lint.collectors.python.interpreter.path_functions import call_of_path, of_path
from ros_lint.collectors.python.interpreter.values import (
    PERHAPS,
    Bound,
    Class,
    Context,
    FilePath,
    Function,
    Guarded,
    Instance,
    LaunchObject,
    LibraryName,
    Method,
    ProgramRaised,
    SetOf,
    Source,
    Super,
    Union,
    Unknown,
    Value,
    settled,
    written,
)
from ros_lint.collectors.python.methods import LENGTH_PRESERVING, NUMBERS, SPLITS, STRIPS, TEXT_METHODS, TRUTHS
from ros_lint.collectors.symbolic_text import LONGEST, UNKNOWN, expression, is_plain, is_settled, may_contain_place, quoted
from ros_lint.facts.launch import LaunchCondition

if TYPE_CHECKING:
    from ros_lint.collectors.python.interpreter.protocol import Interpreter
    from ros_lint.collectors.python.interpreter.values import Frame


def items(machine: Interpreter, value: Value) -> list[Value] | None:
    """Return the elements of a value in a new list, None if they are unknown.

    An element that exists only under conditions is a Guarded value, which has these conditions.
    """
    value = plain(value)
    if isinstance(value, Union):
        elements: list[Value] = []
        for alternative in alternatives(value):
            inner = items(machine, alternative.value)
            if inner is None and isinstance(alternative.value, Unknown):
                inner = [Unknown("element of an unknown value")]
            elif inner is None:
                return None
            elements += [Guarded(element, alternative.conditions or (PERHAPS,)) for element in inner]
        return elements
    if isinstance(value, Iterator):
        return list(islice(value, machine.most_items))
    if isinstance(value, (list, tuple, dict)):
        machine.budget.step(len(value) // 8)
    elif not isinstance(value, range) and not (isinstance(value, str) and is_plain(value)):
        return list(value.entities) if isinstance(value, LaunchObject) and value.name == "LaunchDescription" else None
    if len(value) > machine.most_items:
        return None
    if isinstance(value, dict):
        return [guarded(key, conditions) for key, _, conditions in entries(machine, value)]
    return machine.present(value) if isinstance(value, (list, tuple)) else list(value)


def more(value: Value, reason: str = "elements that are not known") -> Value:
    """Return an element of a collection that represents any number of unknown elements, also none."""
    return Guarded(cause(value, reason), (PERHAPS,))


def attribute(machine: Interpreter, owner: Value, node: ast.Attribute, frame: Frame) -> Value:
    """Return the value of the attribute ``node.attr`` of ``owner``. For methods of texts and collections, it is a Method."""
    name = node.attr
    if isinstance(owner, LibraryName):
        return machine.library.member(f"{owner.name}.{name}", node, frame.source)
    if isinstance(owner, Instance):
        return machine.possible(of_instance(owner, name))
    if isinstance(owner, Super):
        inherited = owner.instance.cls.inherited(owner.cls, name)
        return Unknown(f"attribute {name} of super()") if inherited is None else _bound(inherited, owner.instance)
    if isinstance(owner, Class):
        member = owner.find(name)
        return member if member is not None else Unknown(f"attribute {name}")
    if isinstance(owner, Source):
        return settled(owner.names.get(name, Unknown(f"{name} of a module")))
    if isinstance(owner, FilePath):
        return of_path(owner, name)
    if isinstance(owner, LaunchObject):
        return machine.library.attribute(owner, name)
    if isinstance(owner, Context):
        return LibraryName(f"context.{name}")
    if isinstance(owner, (str, list, dict, tuple)):
        return Method(owner, name)
    machine.escape(owner)
    return Unknown(f"attribute {name} of an unknown value")


def _bound(member: Value, instance: Instance) -> Value:
    return Bound(member, [instance]) if isinstance(member, (Function, LibraryName)) else member


def of_instance(owner: Instance, name: str) -> Value:
    """Return the attribute ``name`` of an object whose class is defined in the program."""
    if name in owner.attributes:
        return owner.attributes[name]
    member = owner.cls.find(name)
    if isinstance(member, Function):
        return Bound(member, [owner])
    if isinstance(member, Bound) and isinstance(member.function, Function):  # property, classmethod, staticmethod
        return member
    if member is not None:
        return member
    if owner.made is not None:
        return Method(owner.made, name)
    return Unknown(f"attribute {name} of an object")


_OF_MARKED = STRIPS | SPLITS | {"replace"}
"""Methods that can be applied to symbolic texts, in which special characters represent parts that are known only at launch."""
_OF_PLAIN = TEXT_METHODS | {"zfill", "encode"}


def call_method(
    machine: Interpreter, method: Method, arguments: list[Value], keywords: dict[str, Value], node: ast.Call, frame: Frame
) -> Value:
    """Return the result of calling a method of a text, collection or path. Methods such as ``append`` change the collection."""
    owner, name = method.owner, method.name
    if isinstance(owner, (list, dict)):
        machine.budget.step(1 + len(owner) // 8)
    if isinstance(owner, str):
        return _of_text(machine, owner, name, arguments, keywords, node, frame)
    if isinstance(owner, list) and name == "sort":
        replace(machine, owner, slice(None), arranged(machine, machine.present(owner), keywords, node, frame))
        return None
    if isinstance(owner, (list, tuple)) and name in ("index", "count"):
        return _position(owner, name, arguments)
    if isinstance(owner, SetOf) and name in _SET_METHODS:
        return _of_set(machine, owner, name, arguments)
    if isinstance(owner, list):
        return _of_list(machine, owner, name, arguments)
    if isinstance(owner, dict):
        return _of_dict(machine, owner, name, arguments, keywords)
    if isinstance(owner, FilePath):
        return call_of_path(machine, owner, name, arguments, keywords, node, frame)
    machine.escape([owner, arguments, keywords])
    return Unknown(f"{name}()")


def _of_text(
    machine: Interpreter, owner: str, name: str, arguments: list[Value], keywords: dict[str, Value], node: ast.Call, frame: Frame
) -> Value:
    if name == "format":
        for value in (*arguments, *keywords.values()):
            machine.record_misuse(value, "formatted", node, frame)
        return _formatted(owner, arguments, keywords, node, frame)
    if name == "read":
        return owner  # an open file is represented by its text
    if name == "join" and arguments:
        values = items(machine, arguments[0])
        if values is None:
            return written(UNKNOWN, node, frame.source)
        return texts_made(joined([text_of(value) for value in values], owner.join), node, frame)
    values = [plain(argument) for argument in arguments]
    named = {key: plain(value) for key, value in keywords.items()}
    known = all(isinstance(value, (str, int, tuple, type(None))) for value in (*values, *named.values()))
    known = known and all(is_plain(value) for value in (*values, *named.values()) if isinstance(value, str))
    possible = (is_settled(owner) or name in STRIPS) and (name in _OF_MARKED or (name in _OF_PLAIN and is_plain(owner)))
    if possible and known and len(owner) <= LONGEST:
        if _grows(owner, name, values):
            return UNKNOWN
        try:
            result = getattr(str(owner), name)(*values, **named)
        except (OverflowError, TypeError, ValueError) as error:
            raise ProgramRaised(type(error).__name__) from None
        machine.budget.step(len(result) if isinstance(result, list) else 0)
        return result if not isinstance(result, str) or len(result) <= LONGEST else UNKNOWN
    if (
        known
        and not named
        and name in LENGTH_PRESERVING
        and len(owner) <= LONGEST
        and waits(owner)
        and not may_contain_place(owner)
    ):
        later = expression(f"{quoted(owner)}.{name}({', '.join(map(repr, values))})")
        return Unknown("a truth", LaunchCondition((later,), None)) if name in TRUTHS else written(later, node, frame.source)
    if name in TRUTHS or name in NUMBERS:
        return Unknown(f"{name}() of a text that is not known")
    return written(UNKNOWN, node, frame.source) if name not in SPLITS else Unknown(f"{name}()")


def _grows(text: str, name: str, values: list[Value]) -> bool:
    """Return whether ``text.replace()`` or ``text.zfill()`` may return a text longer than the limit LONGEST."""
    if name == "zfill":
        return any(isinstance(width, int) and width > LONGEST for width in values)
    old, new = values[:2] if name == "replace" and len(values) > 1 else ("", "")
    return isinstance(old, str) and isinstance(new, str) and text.count(old) * len(new) > LONGEST


def _formatted(owner: str, arguments: list[Value], keywords: dict[str, Value], node: ast.Call, frame: Frame) -> Value:
    import string  # noqa: PLC0415  (few launch files format like this)

    rows: list[tuple[str, ...]] = []
    try:
        fields = list(string.Formatter().parse(owner))
    except ValueError:
        raise ProgramRaised("ValueError") from None
    count = 0
    for literal, field, spec, conversion in fields:
        rows.append((literal,))
        if field is None:
            continue
        key = field or str(count)
        count += 1
        value = arguments[int(key)] if key.isdigit() and int(key) < len(arguments) else keywords.get(key)
        if value is None:
            rows.append((UNKNOWN,))
        elif spec or conversion in ("r", "a"):
            rows.append(tuple(with_format(plain(value), text, spec or "", ord(conversion or "s")) for text in text_of(value)))
        else:
            rows.append(text_of(value))
    return texts_made(joined(rows, "".join), node, frame)


_SET_METHODS = frozenset({"copy", "difference", "intersection", "symmetric_difference", "union"})
_OPERATOR_OF = {"difference": ast.Sub(), "intersection": ast.BitAnd(), "symmetric_difference": ast.BitXor(), "union": ast.BitOr()}


def _of_set(machine: Interpreter, owner: SetOf, name: str, arguments: list[Value]) -> Value:
    """Return the result of a set method that creates a new set: copy, union, difference and so on."""
    result: Value = SetOf(owner)
    for argument in arguments:
        elements = items(machine, argument)
        if elements is None or isinstance(result, Unknown):
            return cause(argument, f"{name}() of a set")
        machine.budget.step(len(elements))
        result = of_sets(_OPERATOR_OF[name], result, elements)
    return result


def _position(owner: Sequence[Value], name: str, arguments: list[Value]) -> Value:
    """Return the result of ``owner.index(argument)`` or ``owner.count(argument)``, Unknown if any value is unknown."""
    wanted = plain(arguments[0]) if arguments else None
    if len(arguments) != 1 or not is_small(owner) or not all(is_small(value) and is_known(value) for value in (owner, wanted)):
        return Unknown(f"{name}() in an unknown value")
    try:
        return owner.index(wanted) if name == "index" else owner.count(wanted)
    except ValueError:
        raise ProgramRaised("ValueError") from None


def _of_list(machine: Interpreter, owner: list[Value], name: str, arguments: list[Value]) -> Value:
    first = arguments[0] if arguments else None
    match name:
        case "append":
            machine.budget.step()
            append(machine, owner, first)
            return None
        case "add" if any(same(element, first) for element in owner):
            return None
        case "add":
            owner.append(machine.guard(first))
            return None
        case "extend" | "update":
            elements = items(machine, first)
            if elements is None:
                machine.escape(first)
                owner.append(machine.guard(more(first)))
            else:
                machine.budget.step(len(elements))
                owner += [machine.guard(element) for element in elements]
            if name == "update":
                owner[:] = unique(owner)
            return None
        case "insert":
            position = plain(first)
            owner.insert(position if isinstance(position, int) else len(owner), machine.guard(arguments[-1]))
            return None
        case "pop":
            return _popped(machine, owner, first)
        case "copy":
            return list(owner)
        case "reverse":
            replace(machine, owner, slice(None), machine.present(owner)[::-1])
            return None
        case "clear":
            replace(machine, owner, slice(None), [])
            return None
        case "remove" | "discard":
            equal = [index for index, element in enumerate(owner) if same(plain(element), plain(first))]
            equal = [index for index in equal if machine.is_here(owner[index])]
            certain = bool(equal) and not machine.any_perhaps([owner[equal[0]]])
            for index in equal[:1] if certain else equal:
                owner[index] = machine.removed(owner[index]) if machine.conditions else Guarded(owner[index], (PERHAPS,))
            if certain and not machine.conditions:
                del owner[equal[0]]
            elif not equal and name == "remove" and all(map(is_known, (*machine.present(owner), first))):
                raise ProgramRaised("ValueError")
            return None
    return Unknown(f"{name}() of a list")


def _popped(machine: Interpreter, owner: list[Value], position: Value) -> Value:
    index = -1 if position is None else plain(position)
    present = machine.present(owner)
    if isinstance(index, int) and -len(present) <= index < len(present):
        element = plain(present[index]) if machine.is_at(present, index) else union(present)
        replace(machine, owner, index, [])
        return element
    if not isinstance(index, int) or may_have_more(present):
        return Unknown("pop() from a place that is not known")
    raise ProgramRaised("IndexError")


def replace(machine: Interpreter, owner: list[Value], key: int | slice, values: list[Value]) -> None:
    """Replace the elements of a list at an index or slice by ``values``. Raises IndexError and ValueError.

    In code that runs only under conditions, the new elements exist only under these conditions, and the old elements only if
    these conditions do not hold. If an element may be missing, positions are unknown, so any element may be the replaced one.
    """
    present = machine.present(owner)
    if isinstance(key, int):
        index = range(len(present))[key]
        part = slice(index, index + 1)
    else:
        part = key
    known = part == slice(None) or machine.is_at(present, key)
    if known and not machine.conditions:
        owner[part] = values
        return
    places = [place for place, element in enumerate(owner) if machine.is_here(element)]
    first = next(iter(places[part] or places[part.start :]), len(owner))
    for place in places[part] if known else places:
        owner[place] = machine.removed(owner[place]) if known else Guarded(owner[place], (PERHAPS,))
    owner[first:first] = [machine.guard(value) for value in values]


def _of_dict(
    machine: Interpreter, owner: dict[Any, Value], name: str, arguments: list[Value], keywords: dict[str, Value]
) -> Value:
    key = hashable(machine, plain(arguments[0])) if arguments else None
    match name:
        case "items":
            return [guarded((key, value), conditions) for key, value, conditions in entries(machine, owner)]
        case "keys":
            return [guarded(key, conditions) for key, _, conditions in entries(machine, owner)]
        case "values":
            return [guarded(value, conditions) for _, value, conditions in entries(machine, owner)]
        case "copy":
            return dict(owner)
        case "get" | "pop" | "setdefault":
            default = arguments[1] if len(arguments) > 1 else None
            if isinstance(key, str) and not is_plain(key):
                return union([*chosen(owner, key), Guarded(default, without(owner, key))])
            if key in owner:
                value = value_or_default(machine, owner, key, default)
                if name == "setdefault":
                    store(machine, owner, key, value)
                elif name == "pop" and machine.conditions:
                    owner[key] = machine.removed(owner[key])
                elif name == "pop":
                    del owner[key]
                return value
            if UNKNOWN in owner:
                return union([owner[UNKNOWN], default])
            if name == "pop" and len(arguments) == 1 and key != UNKNOWN:
                raise ProgramRaised("KeyError")
            if name == "setdefault":
                store(machine, owner, key, default)
            return default
        case "clear":
            if machine.conditions:
                owner.update({key: machine.removed(value) for key, value in owner.items()})
            else:
                owner.clear()
            return None
        case "popitem" if UNKNOWN not in owner:
            if not owner:
                raise ProgramRaised("KeyError")
            return owner.popitem()
        case "update":
            return _updated(machine, owner, arguments, keywords)
    return Unknown(f"{name}() of a dictionary")


def _updated(machine: Interpreter, owner: dict[Any, Value], arguments: list[Value], keywords: dict[str, Value]) -> None:
    for argument in arguments:
        for alternative in alternatives(argument):
            with machine.under(*alternative.conditions):
                _update_with(machine, owner, alternative.value)
    for key, value in keywords.items():
        store(machine, owner, key, value)


def _update_with(machine: Interpreter, owner: dict[Any, Value], argument: Value) -> None:
    if isinstance(argument, dict):
        for key, value in list(argument.items()):
            store(machine, owner, key, value)
        return
    pairs = items(machine, argument)
    for pair in pairs or ():
        parts = items(machine, pair)
        if parts is not None and len(parts) == 2:
            with machine.under(*around(pair)):
                store(machine, owner, hashable(machine, plain(parts[0])), parts[1])
        else:
            owner[UNKNOWN] = cause(pair, "elements that are not known")
    if pairs is None:
        owner[UNKNOWN] = cause(argument, "elements that are not known")
        machine.escape(argument)
