"""Statements of a launch file that run only in distributions before Galactic."""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING

from ros_lint.collectors.python.syntax import span_of

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ros_lint.base.text import Span, Text

_BEFORE_GALACTIC = frozenset({"ardent", "bouncy", "crystal", "dashing", "eloquent", "foxy"})


def alternatives_for_old(tree: ast.Module, source: Text) -> Iterator[Span]:
    """Yield the spans of the ``if`` statements and expressions whose condition names a distribution before Galactic.

    The value that they compare with the name need not be known: ``Popen("echo $ROS_DISTRO", ...)`` is such a value.
    """
    if any(name in source.text for name in _BEFORE_GALACTIC):
        for node in ast.walk(tree):
            if isinstance(node, (ast.If, ast.IfExp)) and any(map(_is_before_galactic, ast.walk(node.test))):
                yield span_of(source, node)


def _is_before_galactic(node: ast.AST) -> bool:
    if not isinstance(node, ast.Constant) or not isinstance(node.value, (str, bytes)):
        return False
    word = node.value if isinstance(node.value, str) else node.value.decode(errors="replace")
    return word.strip() in _BEFORE_GALACTIC
