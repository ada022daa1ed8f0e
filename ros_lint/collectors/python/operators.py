"""Operators of Python that all evaluators apply in the same way to known values, and the limits of their operands."""

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
"""Operators on numbers, texts and lists. The evaluator has to limit the sizes of operands."""

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
"""Comparisons by value. Identity and membership are implemented by each evaluator."""

_WIDE = re.compile(r"\d{4,}|%[-#0 +]*(?:\d*\.)?\*")


def is_wide(template: str) -> bool:
    """Return whether a ``%`` template may format a value to more than 999 characters: ``%1000d``, or ``%*d``."""
    return bool(_WIDE.search(template))
