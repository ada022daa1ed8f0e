"""Tests in CMake conditions, such as EXISTS, STREQUAL and VERSION_LESS (if() in cmake-commands(7))."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Final

from ros_lint.base.text import to_bytes
from ros_lint.collectors.cmake.evaluator.truth import (
    FALSE,
    LIKELY,
    NUMBER,
    TRUE,
    UNKNOWN,
    UNLIKELY,
    ConditionToken,
    Truth,
    number_of,
)
from ros_lint.collectors.cmake.evaluator.values import HOLE, TREE, certainly_set, elements, is_fixed, is_known, split_cost

if TYPE_CHECKING:
    from ros_lint.collectors.cmake.evaluator.run import Run

# --- unary tests ---------------------------------------------------------------------------------------------------


def _defined(run: Run, token: ConditionToken) -> Truth:
    name = token.text
    if not is_known(name):
        return Truth(UNKNOWN)
    if name.startswith("ENV{") and name.endswith("}"):
        run.tested_variables.add(name)
        return Truth(TRUE if run.lookup(name[4:-1], "ENV") and is_known(run.lookup(name[4:-1], "ENV")) else UNKNOWN)
    if name.startswith("CACHE{") and name.endswith("}"):
        return Truth(TRUE if certainly_set(run.cache.get(name[6:-1], HOLE)) else UNKNOWN)
    value = run.get(name)
    if value is None:
        return Truth(UNLIKELY if run.may_be_set(name) else FALSE)
    return Truth(TRUE if certainly_set(value) else UNKNOWN)


def _target(run: Run, token: ConditionToken) -> Truth:
    if token.text in run.targets:
        return Truth(TRUE if "CONDITIONAL" not in run.targets[token.text] else UNKNOWN)
    return Truth(UNKNOWN if run.open_world or not is_known(token.text) else FALSE)


def _command(run: Run, token: ConditionToken) -> Truth:
    name = token.text.lower()
    if name in run.procedures:
        return Truth(TRUE)
    return Truth(UNKNOWN)


def _exists(run: Run, token: ConditionToken) -> Truth:
    path = run.paths.source_or_outside(token.text) if token.text.startswith(TREE) else None
    if path is None:
        return Truth(UNKNOWN)
    return Truth(TRUE if run.paths.is_file(path) or run.paths.is_folder(path) else UNLIKELY)


def _is_directory(run: Run, token: ConditionToken) -> Truth:
    path = run.paths.source_or_outside(token.text) if token.text.startswith(TREE) else None
    if path is None:
        return Truth(UNKNOWN)
    return Truth(TRUE if run.paths.is_folder(path) else UNLIKELY)


def _is_absolute(_run: Run, token: ConditionToken) -> Truth:
    if not is_fixed(token.text):
        return Truth(UNKNOWN)
    return Truth(TRUE if token.text.startswith(("/", "~")) else FALSE)


_POLICY = re.compile(r"CMP(\d{4})")


def _policy(_run: Run, token: ConditionToken) -> Truth:
    match = _POLICY.fullmatch(token.text)
    if match is None:
        return Truth(FALSE)
    return Truth(TRUE if int(match[1]) <= 50 else LIKELY)


def _unknown(_run: Run, _token: ConditionToken) -> Truth:
    return Truth(UNKNOWN)


UNARY: Final[dict[str, Callable[[Run, ConditionToken], Truth]]] = {
    "DEFINED": _defined,
    "TARGET": _target,
    "COMMAND": _command,
    "EXISTS": _exists,
    "IS_DIRECTORY": _is_directory,
    "IS_ABSOLUTE": _is_absolute,
    "POLICY": _policy,
    "IS_SYMLINK": _unknown,
    "TEST": _unknown,
}


# --- binary tests --------------------------------------------------------------------------------------------------


def _operands(run: Run, token: ConditionToken) -> tuple[str, ...]:
    """Return the possible values of an operand: the value of the variable with this name, or the text if no such variable is set.

    An empty variable may be unset, so for an empty variable the result has the text and the empty value.
    """
    if token.quoted:
        # Before policy CMP0054, quoted arguments were also looked up as variables.
        return (token.text if run.policy_version >= (3, 1) or run.get(token.text) is None else HOLE,)
    value = run.get(token.text) if is_known(token.text) else None
    if value is None:
        return (token.text,)
    return (value,) if value else (token.text, value)


def _agreed(answers: Iterable[int]) -> int:
    """Return the truth value of a test if it is equal for all possible values of the operands, else UNKNOWN."""
    different = set(answers)
    return different.pop() if len(different) == 1 else UNKNOWN


def _of_operands(compare: Callable[[str, str], int]) -> Callable[[Run, ConditionToken, ConditionToken], int]:
    def compared(run: Run, left: ConditionToken, right: ConditionToken) -> int:
        seconds = _operands(run, right)
        return _agreed(compare(first, second) for first in _operands(run, left) for second in seconds)

    return compared


def _comparison(compare: Callable[[str, str], bool]) -> Callable[[Run, ConditionToken, ConditionToken], int]:
    def compared(first: str, second: str) -> int:
        if is_known(first) and is_known(second):
            return TRUE if compare(first, second) else FALSE
        return UNKNOWN

    return _of_operands(compared)


def _same(first: str, second: str) -> int:
    if is_known(first) and is_known(second):
        return TRUE if first == second else FALSE
    if first == second and is_fixed(first):
        return TRUE
    if is_fixed(first) and is_fixed(second) and _root(first) and _root(second) and _root(first) != _root(second):
        return FALSE  # colcon never builds in the source folder
    if "" in (first, second) and is_fixed(first) and is_fixed(second):
        return FALSE
    return UNKNOWN


def _root(path: str) -> str:
    """Return the first component of an absolute path if this is a placeholder for an unknown folder, else "".

    A placeholder, such as that of the workspace folder, begins with the control character ATOM.
    """
    return path.split("/")[1] if path.startswith("/\1") else ""


def _numbers(compare: Callable[[float, float], bool]) -> Callable[[str, str], bool]:
    def compared(left: str, right: str) -> bool:
        first, second = NUMBER.match(left), NUMBER.match(right)
        if first is None or second is None:
            return False
        return compare(number_of(first[0]), number_of(second[0]))

    return compared


_COMPONENT = re.compile(r"\s*([-+]?)(\d+)", re.ASCII)


def compare_versions(left: str, right: str) -> int:
    """Return -1, 0 or 1 for two versions, in the order of VERSION_LESS: -1 if ``left`` is older, 0 if both are equal.

    Components are compared in order, each parsed like strtoul() in C.
    """
    left_at, right_at = 0, 0
    while "0" <= left[left_at : left_at + 1] <= "9" or "0" <= right[right_at : right_at + 1] <= "9":
        first, left_at = _component(left, left_at)
        second, right_at = _component(right, right_at)
        if first != second:
            return -1 if (len(first), first) < (len(second), second) else 1
        left_at += left[left_at : left_at + 1] == "."
        right_at += right[right_at : right_at + 1] == "."
    return 0


def _component(text: str, at: int) -> tuple[str, int]:
    """Return the digits of the version component at an offset, and the offset of its end: ``1.020``, 2 -> ``("20", 5)``.

    Leading zeros are omitted. A negative number wraps around, as in strtoul().
    """
    match = _COMPONENT.match(text, at)
    if match is None:
        return "", at
    digits = match[2].lstrip("0")
    if match[1] == "-" and digits:
        digits = str(max((1 << 64) - int(digits[:_MOST_DIGITS]), 1))
    return digits, match.end()


_MOST_DIGITS: Final = 20
"""Maximum number of digits of a 64-bit number."""


def _versions(compare: Callable[[int, int], bool]) -> Callable[[str, str], bool]:
    return lambda left, right: compare(compare_versions(left, right), 0)


def _matches(run: Run, left: ConditionToken, right: ConditionToken) -> int:
    from ros_lint.collectors.cmake.evaluator.regex import find, forget  # noqa: PLC0415  (few scripts use MATCHES)

    texts = _operands(run, left)
    if not (is_known(texts[0]) and is_known(right.text)):
        forget(run)
        return UNKNOWN
    matches = [find(run, right.text, text) for text in texts]
    if None in matches or matches[0] != matches[-1]:
        forget(run)
        return UNKNOWN
    return TRUE if matches[0] else FALSE


def _in_list(run: Run, left: ConditionToken, right: ConditionToken) -> int:
    value = run.get(right.text)
    if value is None:
        return UNLIKELY if run.may_be_set(right.text) else FALSE
    run.budget.charge(split_cost(value))
    return _agreed(_is_element(element, value) for element in _operands(run, left))


def _is_element(element: str, value: str) -> int:
    if not is_known(element) or not element + value:
        return UNKNOWN
    if element in elements(value):
        return TRUE
    return FALSE if is_known(value) else UNKNOWN


def _newer(_run: Run, _left: ConditionToken, _right: ConditionToken) -> int:
    return UNKNOWN


BINARY: Final[dict[str, Callable[[Run, ConditionToken, ConditionToken], int]]] = {
    "STREQUAL": _of_operands(_same),
    "STRLESS": _comparison(lambda left, right: to_bytes(left) < to_bytes(right)),
    "STRGREATER": _comparison(lambda left, right: to_bytes(left) > to_bytes(right)),
    "STRLESS_EQUAL": _comparison(lambda left, right: to_bytes(left) <= to_bytes(right)),
    "STRGREATER_EQUAL": _comparison(lambda left, right: to_bytes(left) >= to_bytes(right)),
    "EQUAL": _comparison(_numbers(lambda left, right: left == right)),
    "LESS": _comparison(_numbers(lambda left, right: left < right)),
    "GREATER": _comparison(_numbers(lambda left, right: left > right)),
    "LESS_EQUAL": _comparison(_numbers(lambda left, right: left <= right)),
    "GREATER_EQUAL": _comparison(_numbers(lambda left, right: left >= right)),
    "VERSION_EQUAL": _comparison(_versions(lambda left, right: left == right)),
    "VERSION_LESS": _comparison(_versions(lambda left, right: left < right)),
    "VERSION_GREATER": _comparison(_versions(lambda left, right: left > right)),
    "VERSION_LESS_EQUAL": _comparison(_versions(lambda left, right: left <= right)),
    "VERSION_GREATER_EQUAL": _comparison(_versions(lambda left, right: left >= right)),
    "MATCHES": _matches,
    "IN_LIST": _in_list,
    "IS_NEWER_THAN": _newer,
    "PATH_EQUAL": _newer,
}
