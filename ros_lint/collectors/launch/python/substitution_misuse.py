"""Notes of where a launch file in Python takes a substitution for the text that it becomes once something is launched."""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING, Literal, NamedTuple

from ros_lint.collectors.launch.python.substitutions import CONDITIONS, is_text
from ros_lint.collectors.python.interpreter.values import LaunchObject, Value
from ros_lint.collectors.symbolic_text import UNKNOWN

if TYPE_CHECKING:
    from ros_lint.collectors.python.interpreter.machine import Machine
    from ros_lint.collectors.python.interpreter.values import Conditions, Frame, Source

How = Literal["added", "joined", "formatted", "compared", "tested", "combined"]


class Misused(NamedTuple):
    """A place where a substitution is taken for a text."""

    how: How
    made: LaunchObject
    node: ast.expr
    source: Source


def note(machine: Machine, value: Value, how: How, node: ast.expr, frame: Frame) -> None:
    """Note that something is done with a value, if that is a substitution and it is not unknown whether it comes to that."""
    if not isinstance(value, LaunchObject):
        return
    if how == "tested" and value.name in CONDITIONS:
        how = "combined"
    elif not is_text(value):
        return
    if not are_unknown(machine.conditions):
        machine.misused.append(Misused(how, value, node, frame.source))


def are_unknown(conditions: Conditions) -> bool:
    """Return whether it is unknown what one of some conditions asks for."""
    return any(UNKNOWN in text for condition in conditions for text in condition.texts)
