"""Operators, comparisons and truth of values, for operands that may be unknown or have alternatives."""

from __future__ import annotations

import ast
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

from ros_lint.collectors.conditional_text import distinct, joined
from ros_lint.collectors.python.interpreter.alternatives import alternatives, around, guarded_text, plain, under, union
from ros_lint.collectors.python.interpreter.complements import opposite_of
from ros_lint.collectors.python.interpreter.ordering import MOST_COMPARED, is_known, is_small, unique
from ros_lint.collectors.python.interpreter.values import (
    PERHAPS,
    FilePath,
    Frame,
    Guarded,
    LaunchObject,
    LibraryName,
    ProgramRaised,
    SetOf,
    Union,
    Unknown,
    Value,
    written,
)
from ros_lint.collectors.python.operators import ARITHMETIC, BITWISE, COMPARISONS, is_wide
from ros_lint.collectors.symbolic_text import (
    LONGEST,
    UNKNOWN,
    certain_part,
    expression,
    is_plain,
    presence,
    quoted,
)
from ros_lint.facts.launch import LaunchCondition

if TYPE_CHECKING:
    from ros_lint.collectors.python.interpreter.protocol import Interpreter

TOO_LARGE = "is too large"
"""The reason for an unknown value: its computation would exceed a limit."""
INSTALLED = "installed packages"
"""The name of the object that represents the list of installed packages of the ament index."""

_NUMBERS = (int, float, bool)
_MOST_ITEMS = 5_000
_STEPS_A_PAIR = 4
"""Steps of the budget to combine an alternative of one operand with one of the other operand."""


def each(value: Value, function: Callable[[Value], Value]) -> Value:
    """Apply a function to each alternative of a value, and return a value with the results as alternatives.

    Alternatives for which the function raises ProgramRaised are omitted. If none is left, ProgramRaised is raised.
    """
    if isinstance(value, Guarded):
        value = value.value
    if not isinstance(value, Union):
        return function(value)
    results: list[Value] = []
    raised = False
    for alternative in alternatives(value):
        try:
            results.append(Guarded(function(alternative.value), alternative.conditions))
        except ProgramRaised:  # the alternative is excluded
            raised = True
    if raised and not results:
        raise ProgramRaised
    return union(results)


def truth(machine: Interpreter, value: Value) -> tuple[bool | None, LaunchCondition]:
    """Return whether a value is true, None if that is unknown, and the condition under which it is true.

    The condition has a meaning only if the truth is unknown.
    """
    value = plain(value)
    if isinstance(value, Unknown):
        return None, value.condition or PERHAPS
    if isinstance(value, Union):
        return _truth_of_several(machine, value)
    if isinstance(value, str):
        if is_plain(value) or certain_part(value):
            return bool(value), PERHAPS
        return None, LaunchCondition((str(value),), "", wanted=False)
    if isinstance(value, list) and value and isinstance(value[0], Guarded):
        return _truth_of_list(machine, value)
    if isinstance(value, dict) and value and all(isinstance(item, Guarded) for item in value.values()):
        return _truth_of_list(machine, list(value.values()))
    if value is None or isinstance(value, (*_NUMBERS, list, dict, tuple, range)):
        return bool(value), PERHAPS
    return (None if isinstance(value, LibraryName) else True), PERHAPS


def _truth_of_list(machine: Interpreter, values: list[Value]) -> tuple[bool | None, LaunchCondition]:
    """Return whether a list whose elements may be missing is true, and PERHAPS, the unknown condition, as in :func:`truth`.

    The first result is False if all elements are missing, True if no element may be missing, else None.
    """
    elements = machine.present(values)
    if not elements:
        return False, PERHAPS
    missing = [condition for value in elements for condition in around(value) if condition not in machine.conditions]
    return (None if missing else True), PERHAPS


def _truth_of_several(machine: Interpreter, value: Union) -> tuple[bool | None, LaunchCondition]:
    answers = [(truth(machine, alternative.value)[0], alternative.conditions) for alternative in alternatives(value)]
    if len({answer for answer, _ in answers}) == 1:
        return answers[0][0], PERHAPS
    for wanted in (True, False):
        matching = [conditions for answer, conditions in answers if answer is wanted]
        if len(matching) == 1 and len(matching[0]) == 1 and all(answer is not None for answer, _ in answers):
            return None, matching[0][0] if wanted else opposite_of(matching[0][0])
    return None, PERHAPS


def text_of(value: Value) -> tuple[str, ...]:
    """Return the possible texts of ``str(value)``, UNKNOWN for an unknown text."""
    if isinstance(value, str):
        return (value,)
    return distinct(
        text for alternative in alternatives(value) for text in under((_str(alternative.value),), alternative.conditions)
    )


def _str(value: Value) -> str:
    if isinstance(value, str):
        return value
    if isinstance(value, FilePath):
        return value.text
    if value is None or isinstance(value, (*_NUMBERS, bytes)):
        return str(value)
    return _shown(value) if isinstance(value, (list, tuple, dict, set)) else UNKNOWN


def _shown(value: Any) -> str:
    """Return the text of ``str(value)`` for a collection, UNKNOWN if it is large or has elements other than texts and numbers."""
    stack, count = [value], 0
    while stack:
        item = stack.pop()
        count += 1
        if count > 200:
            return UNKNOWN
        if isinstance(item, dict):
            stack += [*item.keys(), *item.values()]
        elif isinstance(item, (list, tuple)) and not isinstance(item, SetOf):
            stack += item
        elif not (item is None or isinstance(item, (str, *_NUMBERS))):
            return UNKNOWN
    return str(value)


def hashable(machine: Interpreter, key: Value) -> Any:
    """Return the key under which the interpreter stores an item of a dictionary: texts, numbers and None are unchanged.

    A tuple, a list or a launch object with only one possible text is replaced by this text, any other value by UNKNOWN.
    """
    if isinstance(key, (str, *_NUMBERS)) or key is None:
        return key
    if isinstance(key, (list, tuple, LaunchObject)):
        texts = machine.texts(key)
        return texts[0] if len(texts) == 1 else UNKNOWN
    return UNKNOWN


def with_format(value: Value, text: str, spec: Value, conversion: int) -> str:
    """Return the result of ``format(value, spec)``, UNKNOWN if it cannot be computed.

    ``text`` is the result of ``str(value)``. ``conversion`` is the code of ``!r`` or ``!a`` as in :class:`ast.FormattedValue`.
    """
    if not isinstance(spec, str) or not is_plain(spec) or not is_plain(text) or len(spec) > 8:
        return UNKNOWN
    try:
        if conversion in _CONVERSIONS and isinstance(value, (str, *_NUMBERS)):
            return format(_CONVERSIONS[conversion](value if isinstance(value, _NUMBERS) else text), spec)
        if conversion in _CONVERSIONS and isinstance(value, FilePath):
            return UNKNOWN
        return format(value if isinstance(value, _NUMBERS) else text, spec)
    except (ValueError, OverflowError, MemoryError):
        return UNKNOWN


def texts_made(found: tuple[str, ...], node: ast.expr, frame: Frame) -> Value:
    """Return the possible texts ``found`` of the expression ``node`` as one value, which stores ``node`` as its origin."""
    if len(found) == 1:
        return written(found[0], node, frame.source)
    return union(guarded_text(text, written(text, node, frame.source)) for text in found)


_CONVERSIONS = {ord("r"): repr, ord("a"): ascii}
_OPERATORS = {**ARITHMETIC, **BITWISE}
_ORDERS = {ast.Lt: "<", ast.LtE: "<=", ast.Gt: ">", ast.GtE: ">="}


def operation(machine: Interpreter, op: ast.operator, left: Value, right: Value, node: ast.expr, frame: Frame) -> Value:
    """Return the result of a binary operator: ``left op right``, for all alternatives of both operands."""
    if isinstance(op, ast.Add):
        for side, opposite_side in ((left, right), (right, left)):
            if isinstance(opposite_side, (str, list, tuple, LaunchObject)):
                machine.record_misuse(side, "added", node, frame)
    elif isinstance(op, ast.Mod) and isinstance(left, str):
        for side in right if isinstance(right, tuple) else (right,):
            machine.record_misuse(side, "formatted", node, frame)
    if isinstance(left, Union) and isinstance(right, Union):
        machine.budget.step(len(left.values) * len(right.values) * _STEPS_A_PAIR)
    result = each(left, lambda side: each(right, lambda other: _single(machine, op, side, other, node, frame)))
    return machine.result(result, (left, right))


def _single(machine: Interpreter, op: ast.operator, left: Value, right: Value, node: ast.expr, frame: Frame) -> Value:
    if isinstance(op, ast.Add):
        if isinstance(left, str) and isinstance(right, str):
            return written(left + right if len(left) + len(right) <= LONGEST else UNKNOWN, node, frame.source)
        if isinstance(left, str) and isinstance(right, Unknown):
            return written(left + UNKNOWN, node, frame.source)
        if isinstance(left, Unknown) and isinstance(right, str):
            return written(UNKNOWN + right, node, frame.source)
        if isinstance(left, (list, tuple)) and isinstance(right, (list, tuple)):
            machine.budget.step(len(left) + len(right))
            if machine.caught and isinstance(left, tuple) is not isinstance(right, tuple):
                raise ProgramRaised("TypeError")
            return [*left, *right] if isinstance(left, list) else (*left, *right)
        if isinstance(left, (list, tuple)) and isinstance(right, Unknown):
            return [*left, right]
        if isinstance(left, Unknown) and isinstance(right, (list, tuple)):
            return [left, *right]
    if isinstance(op, ast.Div) and (isinstance(left, (FilePath, LaunchObject)) or isinstance(right, FilePath)):
        return machine.join_paths(left, [right], node, frame)
    if isinstance(op, ast.Div) and isinstance(left, str) and isinstance(right, str):
        if machine.caught:
            raise ProgramRaised("TypeError")
        machine.record_division(node, frame)
        return machine.join_paths(left, [right], node, frame)
    if isinstance(op, ast.Mod) and isinstance(left, str):
        return _percent(left, right, node, frame)
    if isinstance(op, ast.BitOr) and isinstance(left, dict) and isinstance(right, dict):
        return {**left, **right}
    if isinstance(left, SetOf) and isinstance(right, SetOf) and type(op) in _SETS:
        machine.budget.step(len(left) + len(right))
        return of_sets(op, left, right)
    if isinstance(left, _NUMBERS) and isinstance(right, _NUMBERS) and type(op) in _OPERATORS:
        try:
            if abs(left) < 1 << 64 and abs(right) < 1 << 64:
                return _OPERATORS[type(op)](left, right)
        except (ArithmeticError, TypeError, ValueError):
            raise ProgramRaised from None
    if isinstance(op, ast.Mult):
        if isinstance(left, int):
            left, right = right, left
        if isinstance(left, (str, list, tuple)) and isinstance(right, int):
            return left * right if len(left) * right <= _MOST_ITEMS else Unknown(TOO_LARGE)
    if all(isinstance(operand, _KNOWN) and (not isinstance(operand, str) or is_plain(operand)) for operand in (left, right)):
        numbers = isinstance(left, _NUMBERS) and isinstance(right, _NUMBERS)
        # Outside of try, the rest of the program is interpreted as if the types were right.
        if (
            machine.caught
            and type(op) in _OPERATORS
            and not numbers
            and not isinstance(left, SetOf)
            and not isinstance(right, SetOf)
        ):
            raise ProgramRaised("TypeError")
        return Unknown("the result of an operator")
    for operand in (left, right):
        machine.escape(operand)
    return Unknown("the result of an operator")


_SETS = (ast.Sub, ast.BitAnd, ast.BitOr, ast.BitXor)
_KNOWN = (str, *_NUMBERS, list, tuple, dict, type(None))


def of_sets(op: ast.operator, left: Sequence[Value], right: Sequence[Value]) -> Value:
    """Return the result of ``|``, ``-``, ``&`` or ``^`` for two sets.

    If any element is unknown, the result of ``-``, ``&`` and ``^`` is Unknown.
    """
    if isinstance(op, ast.BitOr):
        return SetOf(unique([*left, *right]))
    if not all(map(is_known, (*left, *right))):
        return Unknown("the elements of a set")
    first, second = unique(left), unique(right)
    if isinstance(op, ast.BitXor):
        return SetOf([*(item for item in first if item not in second), *(item for item in second if item not in first)])
    return SetOf([item for item in first if (item in second) is isinstance(op, ast.BitAnd)])


def _percent(left: str, right: Value, node: ast.expr, frame: Frame) -> Value:
    values = list(right) if isinstance(right, tuple) else [right]
    rows = [text_of(value) for value in values]
    pieces = left.split("%s")
    if len(pieces) == len(rows) + 1 and "%" not in "".join(pieces).replace("%%", ""):
        made = joined(rows, lambda row: "".join(a + b for a, b in zip(pieces, (*row, ""), strict=True)).replace("%%", "%"))
        return texts_made(made, node, frame)
    fields: Value = tuple([plain(value) for value in values])
    if isinstance(plain(right), dict):
        fields = {key: plain(value) for key, value in plain(right).items()}
        values = [*fields, *fields.values()]
    if len(left) >= 500 or is_wide(left):
        return Unknown(TOO_LARGE)
    if all(_is_scalar(plain(value)) for value in values):
        try:
            text = left % fields
        except (KeyError, OverflowError, TypeError, ValueError) as error:
            raise ProgramRaised(type(error).__name__) from None
        return written(text if len(text) <= LONGEST else UNKNOWN, node, frame.source)
    return Unknown("text made with %")


def _is_scalar(value: Value) -> bool:
    return value is None or isinstance(value, _NUMBERS) or (isinstance(value, str) and is_plain(value))


def negated(machine: Interpreter, value: Value) -> Value:
    """Return the result of ``not value``."""
    answer, condition = truth(machine, value)
    if answer is not None:
        return not answer
    opposite = None if condition is PERHAPS else condition._replace(wanted=not condition.wanted)
    return Unknown("not known to be true", opposite)


def compared(op: ast.cmpop, left: Value, right: Value) -> Value:
    """Return the result of a comparison ``left op right``, for all alternatives of both operands."""
    return each(left, lambda left_value: each(right, lambda right_value: _one_compare(op, left_value, right_value)))


def _one_compare(op: ast.cmpop, left: Value, right: Value) -> Value:
    if isinstance(op, (ast.Is, ast.IsNot)):
        if isinstance(left, Unknown) or isinstance(right, Unknown):
            return Unknown("identity with an unknown value")
        same = left is right or (isinstance(left, (str, *_NUMBERS)) and type(left) is type(right) and left == right)
        return same is isinstance(op, ast.Is)
    if isinstance(op, (ast.In, ast.NotIn)):
        return _contained(op, left, right)
    if isinstance(left, (Unknown, LibraryName, LaunchObject)) or isinstance(right, (Unknown, LibraryName, LaunchObject)):
        return Unknown("comparison with an unknown value")
    if isinstance(op, (ast.Eq, ast.NotEq)):
        if isinstance(left, FilePath) and isinstance(right, FilePath):
            left, right = left.text, right.text
        if isinstance(left, str) and isinstance(right, str) and not (is_plain(left) and is_plain(right)) and left != right:
            if is_plain(left):
                left, right = right, left
            if is_plain(right):
                return Unknown("comparison with an argument", LaunchCondition((str(left),), str(right), isinstance(op, ast.Eq)))
            return Unknown("comparison with an unknown value")
    elif isinstance(left, str) and isinstance(right, str) and not (is_plain(left) and is_plain(right)):
        return _asked(f"{quoted(left)} {_ORDERS[type(op)]} {quoted(right)}")
    if isinstance(left, (list, tuple, dict)) and isinstance(right, (list, tuple, dict)):
        if not (is_small(left) and is_small(right)):
            return Unknown("a comparison of much")
        if not (is_known(left) and is_known(right)):
            return Unknown("comparison with an unknown value")
        if isinstance(left, SetOf) and isinstance(right, SetOf) and all(map(_is_scalar, (*left, *right))):
            left, right = set(left), set(right)
    try:
        return bool(COMPARISONS[type(op)](left, right))
    except (TypeError, RecursionError):
        raise ProgramRaised from None


def _contained(op: ast.cmpop, left: Value, right: Value) -> Value:
    wanted = isinstance(op, ast.In)
    if isinstance(right, LibraryName) and right.name == INSTALLED:
        return Unknown("whether a package is installed", LaunchCondition((presence(_str(left)),), None, wanted))
    if isinstance(right, str):
        if isinstance(left, str) and is_plain(left) and is_plain(right):
            return (left in right) is wanted
    elif isinstance(right, range):
        return (left in right) is wanted if isinstance(left, int) else Unknown("membership that is not known")
    elif isinstance(right, (list, tuple, dict)) and isinstance(left, (str, *_NUMBERS, type(None))):
        if isinstance(right, dict):
            right = [Guarded(key, around(value)) if isinstance(value, Guarded) else key for key, value in right.items()]
        inner = [plain(item) for item in right]
        equal = [isinstance(item, (str, *_NUMBERS, type(None))) and item == left for item in inner]
        if any(equal):
            certain = any(match and not isinstance(item, Guarded) for match, item in zip(equal, right, strict=True))
            if certain:
                return wanted
            guards = [around(item) for match, item in zip(equal, right, strict=True) if match]
            if len(guards) > 1 or len(guards[0]) > 1:
                return Unknown("membership that is not known")
            return Unknown("membership that is not known", guards[0][0] if wanted else opposite_of(guards[0][0]))
        known = all(isinstance(item, (*_NUMBERS, type(None))) or (isinstance(item, str) and is_plain(item)) for item in inner)
        if known and (not isinstance(left, str) or is_plain(left)):
            return not wanted
        if known and len(inner) == 1 and isinstance(inner[0], str):
            return Unknown("comparison with an argument", LaunchCondition((str(left),), inner[0], wanted))
        if known and isinstance(left, str) and len(inner) <= MOST_COMPARED:
            one_of = ", ".join([quoted(item) for item in inner if isinstance(item, str)])
            return _asked(f"{quoted(left)} {'in' if wanted else 'not in'} ({one_of},)")
    return Unknown("membership that is not known")


def _asked(question: str) -> Unknown:
    """Return an Unknown: the truth value of ``question``, a Python expression that only launch can evaluate."""
    if UNKNOWN in question:
        return Unknown("comparison with an unknown value")
    return Unknown("a truth", LaunchCondition((expression(question),), None))
