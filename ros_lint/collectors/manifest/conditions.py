"""Conditions of package.xml elements: parser, and evaluation to true, false or unknown (REP 149).

The grammar is that of catkin_pkg (condition.py), including its leniency: ``and`` and ``or`` need no space after them,
and quoted strings may be empty.
"""

from __future__ import annotations

import operator
import re
from collections.abc import Callable, Iterator, Mapping
from functools import lru_cache
from typing import Final, NamedTuple

from ros_lint.facts.environment import ROS_2
from ros_lint.facts.manifest import Element, Manifest
from ros_lint.facts.visibility import Problem

MOST_DEPTH = 20
"""Maximum nesting of parentheses, because catkin_pkg needs exponential time for deeper nesting."""


class ConditionError(ValueError):
    """A condition that cannot be parsed."""

    def __init__(self, message: str, offset: int) -> None:
        super().__init__(message)
        self.message: Final = message
        """The reason, without the text of the condition."""
        self.offset: Final = offset
        """The offset of the error in the condition, in code points: 0 to the length of the condition."""


class Operand(NamedTuple):
    """An operand of a comparison: the value of an environment variable, or a text."""

    text: str
    """The name of the variable, or the text."""
    variable: bool
    """True if the operand is the value of a variable."""


class Comparison(NamedTuple):
    """A comparison of two operands as strings, so that "10" is less than "9"."""

    left: Operand
    """Left operand."""
    operator: str
    """``==``, ``!=``, ``<``, ``<=``, ``>`` or ``>=``."""
    right: Operand
    """Right operand."""


class Junction(NamedTuple):
    """Conditions joined by ``and`` (all must hold) or by ``or``."""

    every: bool
    """True for ``and``, false for ``or``."""
    parts: tuple[Condition, ...]
    """The joined conditions, at least two."""


Condition = Comparison | Junction
"""A parsed condition: a comparison, or conditions joined by ``and`` or ``or``."""

_OPERATORS: dict[str, Callable[[str, str], bool]] = {
    "==": operator.eq,
    "!=": operator.ne,
    "<=": operator.le,
    "<": operator.lt,
    ">=": operator.ge,
    ">": operator.gt,
}
_BLANK = re.compile(r"[ \n\r]*")
_OPERATOR = re.compile("==|!=|>=|>|<=|<")
_OPERAND = re.compile(
    r"""\$(?P<variable>[A-Za-z0-9_]+)|(?P<word>[A-Za-z0-9_-]+)|"(?P<double>[^"\n\r]*)"|'(?P<single>[^'\n\r]*)'"""
)
_ESCAPES = re.compile(r"\\(?:([tnfr])|([0-7]3|0|x[0-9a-fA-F]2|u[0-9a-fA-F]4))")
"""Matches the escapes that pyparsing replaces in quoted strings, including the numeric escapes since version 3.1."""
_BLANKS = {"t": "\t", "n": "\n", "f": "\f", "r": "\r"}


@lru_cache(maxsize=1024)
def parse(text: str) -> Condition:
    """Return the parsed condition. Raises ConditionError if catkin_pkg cannot parse the condition."""
    expanded = text.expandtabs()  # pyparsing expands tabs first
    try:
        condition, at = _junction(expanded, 0, 0)
        if at < len(expanded):
            raise ConditionError('expected "and", "or" or the end', at)
    except ConditionError as error:
        if expanded == text:
            raise
        # The tabs have shifted the offset.
        offset = next((i for i in range(len(text)) if len(text[: i + 1].expandtabs()) > error.offset), len(text))
        raise ConditionError(error.message, offset) from None
    return condition


def evaluate(condition: Condition, context: Mapping[str, str]) -> bool | None:
    """Return whether a condition holds, None if it depends on a variable that is not in ``context``."""
    if isinstance(condition, Junction):
        truths = [evaluate(part, context) for part in condition.parts]
        if condition.every:
            return False if False in truths else None if None in truths else True
        return True if True in truths else None if None in truths else False
    left, right = _value(condition.left, context), _value(condition.right, context)
    if left is None or right is None:
        return None
    return _OPERATORS[condition.operator](left, right)


def always(text: str) -> bool:
    """Return whether the condition ``text`` of an element ("" for no condition) holds in every ROS 2 environment."""
    return truth(text, ROS_2) is True


def truth(text: str, context: Mapping[str, str]) -> bool | None:
    """Return whether the condition ``text`` of an element ("" for no condition) holds, None if that is unknown.

    The result is also None for a condition that cannot be parsed. :func:`problems` reports such a condition.
    """
    if not text:
        return True
    try:
        return evaluate(parse(text), context)
    except ConditionError:
        return None


def variables(condition: Condition) -> frozenset[str]:
    """Return the names of the environment variables in a condition, without the dollar sign."""
    if isinstance(condition, Junction):
        return frozenset().union(*(variables(part) for part in condition.parts))
    return frozenset(side.text for side in (condition.left, condition.right) if side.variable)


def of(element: Element) -> str:
    """Return the text of the attribute ``condition`` of a child of ``<export>``: "" if it is missing, " " if it is empty."""
    for name, text in element.attributes:
        if name == "condition":
            return text or " "
    return ""


def build_types(manifest: Manifest, context: Mapping[str, str]) -> tuple[tuple[str, bool | None], ...]:
    """Return the ``<build_type>`` names of a manifest, each with the truth of its condition: True, or None if unknown.

    Names whose condition is false are omitted. An empty result means "catkin". With two build types whose condition is
    true, colcon does not treat the folder as a ROS package (package identification of colcon-ros).
    """
    types = [(element.text, truth(of(element), context)) for element in manifest.exports if element.tag == "build_type"]
    return tuple([(name, active) for name, active in types if active is not False])


def problems(manifest: Manifest) -> tuple[Problem, ...]:
    """Return a problem for each condition of a manifest that cannot be parsed.

    colcon does not treat the folder of such a manifest as a ROS package.
    """
    return tuple(_unparsable(manifest))


def _unparsable(manifest: Manifest) -> Iterator[Problem]:
    conditional = [(depend.condition, depend.tag, depend.span) for depend in manifest.depends if depend.condition]
    conditional += [(text, element.tag, element.span) for element in manifest.exports if (text := of(element))]
    for text, tag, span in conditional:
        try:
            parse(text)
        except ConditionError as error:
            message = f"condition '{text}' of <{tag}> does not parse: at character {error.offset + 1}, {error.message}"
            if not text.strip():
                message = f"condition of <{tag}> is empty; remove the attribute"
            yield Problem("invalid-condition", message, span)


def _value(operand: Operand, context: Mapping[str, str]) -> str | None:
    return context.get(operand.text) if operand.variable else operand.text


def _junction(text: str, at: int, depth: int) -> tuple[Condition, int]:
    """Return the condition that begins at the offset ``at``, and the offset after it. ``and`` has precedence over ``or``."""
    alternatives: list[Condition] = []
    while True:
        parts, at = _conjunction(text, at, depth)
        alternatives.append(parts[0] if len(parts) == 1 else Junction(True, tuple(parts)))
        if not text.startswith("or", at):
            return (alternatives[0] if len(alternatives) == 1 else Junction(False, tuple(alternatives))), at
        at += 2


def _conjunction(text: str, at: int, depth: int) -> tuple[list[Condition], int]:
    parts: list[Condition] = []
    while True:
        part, at = _comparison(text, at, depth)
        parts.append(part)
        at = _skip(text, at)
        if not text.startswith("and", at):
            return parts, at
        at += 3


def _comparison(text: str, at: int, depth: int) -> tuple[Condition, int]:
    at = _skip(text, at)
    if text.startswith("(", at):
        if depth == MOST_DEPTH:
            raise ConditionError("too many parentheses", at)
        junction, at = _junction(text, at + 1, depth + 1)
        if not text.startswith(")", at):
            raise ConditionError('expected "and", "or" or ")"', at)
        return junction, at + 1
    left, at = _operand(text, at)
    sign = _OPERATOR.match(text, at := _skip(text, at))
    if not sign:
        raise ConditionError("expected a comparison such as ==", at)
    right, at = _operand(text, _skip(text, sign.end()))
    return Comparison(left, sign[0], right), at


def _operand(text: str, at: int) -> tuple[Operand, int]:
    match = _OPERAND.match(text, at)
    if not match:
        raise ConditionError("expected a $variable, a word or a quoted string", at)
    kind = match.lastgroup or ""
    operand_text = match[kind]
    if kind in ("double", "single"):
        operand_text = _ESCAPES.sub(_escaped, operand_text)
    return Operand(operand_text, kind == "variable"), match.end()


def _escaped(escape: re.Match[str]) -> str:
    if escape[1]:
        return _BLANKS[escape[1]]
    number: str = escape[2]
    if number == "0":
        return "\0"
    return chr(int(number[1:], 16)) if number[0] in "xu" else number


def _skip(text: str, at: int) -> int:
    blank = _BLANK.match(text, at)
    return blank.end() if blank else at
