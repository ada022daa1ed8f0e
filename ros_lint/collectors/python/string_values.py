"""The texts and paths that expressions of a Python source have, computed from constants and package look-ups."""

from __future__ import annotations

import ast
import posixpath
from collections.abc import Callable, Iterator
from typing import Any, Final

from ros_lint.collectors.python.scopes import Binding, Step, Where, reaching
from ros_lint.collectors.symbolic_text import prefix, share

_MOST: Final = 16
"""The maximum number of alternative texts of an expression."""
_DEEPEST: Final = 40
_LONGEST: Final = 10_000

Values = tuple["str | None", ...]
"""The possible texts of an expression, never empty. None represents an unknown text."""

ANYTHING: Values = (None,)

_SHARE = frozenset({"FindPackageShare", "FindPackageShareDirectory", "get_package_share_directory", "get_package_share_path"})
_PREFIX = frozenset({"FindPackage", "FindPackagePrefix", "get_package_prefix"})
LOOK_UPS = _SHARE | _PREFIX
"""Functions and substitutions that find a package, whose name is the first argument."""
_PATHS = frozenset({"Path", "PurePath", "PosixPath", "PurePosixPath"})
_THROUGH = _PATHS | {"str", "fspath", "abspath", "realpath", "expanduser", "normpath"}
_SAME_METHODS = frozenset({"as_posix", "resolve", "absolute", "expanduser", "strip"})


def callee(node: ast.Call) -> str:
    """Return the last name of the called function: ``os.path.join(a)`` -> ``join``. It is "" if the function has no name."""
    function = node.func
    if isinstance(function, ast.Attribute):
        return function.attr
    return function.id if isinstance(function, ast.Name) else ""


def dotted(node: ast.expr) -> str:
    """Return the dotted name that an expression consists of: ``os.path.join``. The result is "" for any other expression."""
    names: list[str] = []
    while isinstance(node, ast.Attribute):
        names.append(node.attr)
        node = node.value
    return ".".join([node.id, *reversed(names)]) if isinstance(node, ast.Name) else ""


def argument(node: ast.Call, *names: str) -> ast.expr | None:
    """Return the keyword argument of a call with a name in ``names``, else the first positional argument, else None."""
    for keyword in node.keywords:
        if keyword.arg in names:
            return keyword.value
    first = node.args[0] if node.args else None
    return None if isinstance(first, ast.Starred) else first


class Evaluator:
    """Computes the possible texts of the expressions of one file. Each expression is evaluated once."""

    def __init__(self) -> None:
        self._done: dict[int, Values] = {}
        self._depth = 0

    def values(self, node: ast.expr | None, where: Where) -> Values:
        """Return the possible texts of an expression, with None for an unknown text. The result is never empty.

        A folder of an installed package is represented by a path that no file system has, see
        :mod:`ros_lint.collectors.symbolic_text`.
        """
        if node is None or self._depth > _DEEPEST:
            return ANYTHING
        done = self._done.get(id(node))
        if done is not None:
            return done
        self._done[id(node)] = ANYTHING  # for a name whose definition uses itself
        self._depth += 1
        try:
            handler = _HANDLERS.get(type(node))
            texts = tuple(dict.fromkeys(handler(self, node, where))) if handler else ANYTHING
        finally:
            self._depth -= 1
        if len(texts) > _MOST or any(text and len(text) > _LONGEST for text in texts):
            texts = ANYTHING
        self._done[id(node)] = texts
        return texts

    def _name(self, node: ast.Name, where: Where) -> Values:
        bindings = reaching(node.id, where)
        if bindings is None:
            return ANYTHING
        return tuple(text for binding in bindings for text in self._bound(binding))

    def _bound(self, binding: Binding) -> Iterator[str | None]:
        if binding.value is None:
            yield None
        elif not binding.steps:
            yield from self.values(binding.value, binding.where)
        else:
            for node in self._take(binding.value, binding.steps) or (None,):
                yield from self.values(node, binding.where)

    def _take(self, node: ast.expr, steps: tuple[Step, ...]) -> list[ast.expr]:
        """Return the elements that ``steps`` select from a literal list or tuple, [] if the elements are unknown.

        A number selects the element with this index, and None selects every element. Each step selects from the elements of
        the step before.
        """
        nodes = [node]
        for step in steps:
            following: list[ast.expr] = []
            for inner in nodes:
                elements = inner.elts if isinstance(inner, (ast.List, ast.Tuple, ast.Set)) else []
                if any(isinstance(item, ast.Starred) for item in elements) or (step is not None and step >= len(elements)):
                    return []
                following += elements if step is None else [elements[step]]
            nodes = following
        return nodes

    def _constant(self, node: ast.Constant, _: Where) -> Values:
        value = node.value
        return (str(value),) if isinstance(value, (str, int, float)) else ANYTHING

    def _formatted(self, node: ast.JoinedStr, where: Where) -> Values:
        parts = [part.value if isinstance(part, ast.FormattedValue) else part for part in node.values]
        return self._combine(parts, where, "".join)

    def _combine(self, parts: list[ast.expr], where: Where, function: Callable[[list[str]], str]) -> Values:
        rows: list[list[str]] = [[]]
        for part in parts:
            texts = self.values(part, where)
            if None in texts or len(rows) * len(texts) > _MOST:
                return ANYTHING
            rows = [[*row, text] for row in rows for text in texts if text is not None]
        return tuple(function(row) for row in rows)

    def _operation(self, node: ast.BinOp, where: Where) -> Values:
        match node.op:
            case ast.Add():
                return self._combine([node.left, node.right], where, "".join)
            case ast.Div():
                return self._combine([node.left, node.right], where, _join)
            case ast.Mod():
                operands = node.right.elts if isinstance(node.right, ast.Tuple) else [node.right]
                return self._fill(node.left, "%s", operands, where)
        return ANYTHING

    def _fill(self, template: ast.expr, mark: str, parts: list[ast.expr], where: Where) -> Values:
        texts = self.values(template, where)
        if len(texts) != 1 or texts[0] is None or texts[0].count(mark) != len(parts):
            return ANYTHING
        pieces = texts[0].split(mark)
        return self._combine(parts, where, lambda given: "".join(a + b for a, b in zip(pieces, [*given, ""], strict=True)))

    def _choice(self, node: ast.IfExp, where: Where) -> Values:
        return (*self.values(node.body, where), *self.values(node.orelse, where))

    def _attribute(self, node: ast.Attribute, where: Where) -> Values:
        return self._combine([node.value], where, _parent) if node.attr == "parent" else ANYTHING

    def _call(self, node: ast.Call, where: Where) -> Values:
        name = callee(node)
        if name in LOOK_UPS:
            place = share if name in _SHARE else prefix
            packages = self.values(argument(node, "package", "package_name"), where)
            return tuple(None if text is None else place(text) for text in packages)
        if name == "join" and not (isinstance(node.func, ast.Attribute) and isinstance(node.func.value, ast.Constant)):
            return self._combine(node.args, where, _join)
        if name in _PATHS and len(node.args) > 1:
            return self._combine(node.args, where, _join)
        if name in ("PathJoinSubstitution", "PathSubstitution"):
            parts = argument(node, "substitutions", "path")
            return self._combine(parts.elts, where, _join) if isinstance(parts, (ast.List, ast.Tuple)) else ANYTHING
        if name in _THROUGH:
            return self.values(argument(node), where)
        if name == "dirname" and node.args:
            return self._combine(node.args[:1], where, _parent)
        return self._method(node, node.func, where) if isinstance(node.func, ast.Attribute) else ANYTHING

    def _method(self, node: ast.Call, function: ast.Attribute, where: Where) -> Values:
        if function.attr in _SAME_METHODS:
            return self.values(function.value, where)
        if function.attr == "joinpath":
            return self._combine([function.value, *node.args], where, _join)
        if function.attr == "format" and not node.keywords:
            return self._fill(function.value, "{}", node.args, where)
        return ANYTHING


def _join(texts: list[str]) -> str:
    return posixpath.join("", *texts)


def _parent(texts: list[str]) -> str:
    return posixpath.dirname(texts[0])


_HANDLERS: dict[type[ast.expr], Callable[[Evaluator, Any, Where], Values]] = {
    ast.Constant: Evaluator._constant,
    ast.Name: Evaluator._name,
    ast.JoinedStr: Evaluator._formatted,
    ast.BinOp: Evaluator._operation,
    ast.IfExp: Evaluator._choice,
    ast.Attribute: Evaluator._attribute,
    ast.Call: Evaluator._call,
}
