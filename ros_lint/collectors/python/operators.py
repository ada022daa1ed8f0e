"""Operators of Python that all evaluators of Python code apply in the same way to known values, and limits for their operands."""

from __future__ import annotations

import ast
import operator
import re
from collections.abc import Callable, Mapping
from typing import Any, Final

ARITHMETIC: Final[Mapping[type[ast.operator], Callable[[Any, Any], Any]]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.FloorDiv: operator.floordiv,
    ast.Mod: operator.mod,
}
"""Functions for the operators on numbers, texts and lists. The evaluator has to limit the sizes of the operands."""

BITWISE: Final[Mapping[type[ast.operator], Callable[[Any, Any], Any]]] = {
    ast.BitOr: operator.or_,
    ast.BitAnd: operator.and_,
    ast.BitXor: operator.xor,
}

COMPARISONS: Final[Mapping[type[ast.cmpop], Callable[[Any, Any], Any]]] = {
    ast.Eq: operator.eq,
    ast.NotEq: operator.ne,
    ast.Lt: operator.lt,
    ast.LtE: operator.le,
    ast.Gt: operator.gt,
    ast.GtE: operator.ge,
}
"""Functions for the comparisons by value. Each evaluator implements ``is`` and ``in`` itself."""

_WIDE = re.compile(r"\d{4,}|%[-#0 +]*(?:\d*\.)?\*")


def is_wide(template: str) -> bool:
    """Return whether a ``%`` template may format a value to more than 999 characters: ``%1000d``, or ``%*d``."""
    return bool(_WIDE.search(template))
