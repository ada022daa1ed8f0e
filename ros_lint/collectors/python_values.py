"""Texts and paths in a Python source, as far as constants give them."""

from __future__ import annotations

import ast
import posixpath
from collections.abc import Callable, Iterator
from typing import NamedTuple

from ros_lint.collectors.python_scopes import Binding, Step, Where, reaching
from ros_lint.collectors.launch_text import OWN_FOLDER, UNKNOWN, prefix, share

_MOST = 16
_DEEPEST = 40
_LONGEST = 10_000


class Value(NamedTuple):
    """A text, UNKNOWN where a piece of it is not known, and the expressions that name the packages in its paths."""

    text: str
    packages: tuple[tuple[str, ast.expr], ...] = ()

    @property
    def known(self) -> bool:
        return UNKNOWN not in self.text


Values = tuple[Value, ...]
"""Every value that an expression may have; never empty."""

ANYTHING: Values = (Value(UNKNOWN),)

_SHARE = frozenset({"FindPackageShare", "get_package_share_directory", "get_package_share_path", "FindPackageShareDirectory"})
_PREFIX = frozenset({"FindPackagePrefix", "FindPackage", "get_package_prefix"})
LOOK_UPS = _SHARE | _PREFIX
_JOINS = frozenset({"PathJoinSubstitution", "PathSubstitution"})
_THROUGH = frozenset(
    {
        "Path", "PurePath", "PosixPath", "PurePosixPath", "str", "fspath", "abspath", "realpath", "expanduser",
        "normpath", "ParameterFile", "PythonLaunchDescriptionSource", "XMLLaunchDescriptionSource",
        "YAMLLaunchDescriptionSource",
        "AnyLaunchDescriptionSource", "FrontendLaunchDescriptionSource", "LaunchDescriptionSource", "TextSubstitution",
    }
)  # fmt: skip
_SAME_METHODS = frozenset({"perform", "as_posix", "resolve", "absolute", "expanduser", "strip"})


def callee(node: ast.Call) -> str:
    """Return the last name of what is called: ``Node`` of ``launch_ros.actions.Node(...)``."""
    function = node.func
    if isinstance(function, ast.Attribute):
        return function.attr
    return function.id if isinstance(function, ast.Name) else ""


def argument(node: ast.Call, position: int, *names: str) -> ast.expr | None:
    """Return an argument by its position or one of its names."""
    for keyword in node.keywords:
        if keyword.arg in names:
            return keyword.value
    found = node.args[position] if position < len(node.args) else None
    return None if isinstance(found, ast.Starred) else found


class Evaluator:
    """Evaluates expressions of one file. Each is evaluated once."""

    def __init__(self) -> None:
        self._done: dict[int, Values] = {}
        self._depth = 0

    def values(self, node: ast.expr | None, where: Where) -> Values:
        """Return the texts that an expression may have. Launch concatenates the parts of a list."""
        if node is None:
            return ANYTHING
        done = self._done.get(id(node))
        if done is not None:
            return done
        if self._depth > _DEEPEST:
            return ANYTHING
        self._done[id(node)] = ANYTHING  # for a name that is defined by itself
        self._depth += 1
        try:
            handler = _HANDLERS.get(type(node))
            found = handler(self, node, where) if handler else ANYTHING
        finally:
            self._depth -= 1
        found = tuple(dict.fromkeys(found))
        if len(found) > _MOST:
            found = ANYTHING
        self._done[id(node)] = found
        return found

    def elements(self, node: ast.expr, where: Where) -> list[tuple[ast.expr, Where]] | None:
        """Return the elements of a collection that is written out, None for any other."""
        for value, place in self._sources(node, where) or ():
            if isinstance(value, (ast.List, ast.Tuple, ast.Set)):
                if any(isinstance(item, ast.Starred) for item in value.elts):
                    return None
                return [(item, place) for item in value.elts]
            if isinstance(value, ast.Dict):
                return [(key, place) for key in value.keys if key is not None]
            break
        return None

    def _sources(self, node: ast.expr, where: Where) -> list[tuple[ast.expr, Where]] | None:
        """Return the expression that a name stands for, None when it is not one."""
        for _ in range(_DEEPEST):
            if not isinstance(node, ast.Name):
                return [(node, where)]
            bindings = list(reaching(node.id, where) or ())
            if len(bindings) != 1 or bindings[0].value is None or bindings[0].steps:
                return None
            node, where = bindings[0].value, bindings[0].where
        return None

    def _name(self, node: ast.Name, where: Where) -> Values:
        bindings = reaching(node.id, where)
        if bindings is None:
            return (Value(f"{OWN_FOLDER}/{UNKNOWN}"),) if node.id == "__file__" else ANYTHING
        return tuple(value for binding in bindings for value in self._bound(binding))

    def _bound(self, binding: Binding) -> Iterator[Value]:
        if binding.value is None:
            yield from ANYTHING
        elif not binding.steps:
            yield from self.values(binding.value, binding.where)
        else:
            places = self._take(binding.value, binding.where, binding.steps)
            if not places:
                yield from ANYTHING
            for node, where in places or ():
                yield from self.values(node, where)

    def _take(self, node: ast.expr, where: Where, steps: tuple[Step, ...]) -> list[tuple[ast.expr, Where]] | None:
        places = [(node, where)]
        for step in steps:
            following: list[tuple[ast.expr, Where]] = []
            for inner, place in places:
                elements = self.elements(inner, place)
                if elements is None or (step is not None and step >= len(elements)):
                    return None
                following += elements if step is None else [elements[step]]
            places = following
        return places

    def _constant(self, node: ast.Constant, _: Where) -> Values:
        if isinstance(node.value, str):
            return (Value(node.value),)
        return (Value(str(node.value)),) if isinstance(node.value, (int, float)) else ANYTHING

    def _formatted(self, node: ast.JoinedStr, where: Where) -> Values:
        return self.concatenation([part.value if isinstance(part, ast.FormattedValue) else part for part in node.values], where)

    def _sequence(self, node: ast.List | ast.Tuple, where: Where) -> Values:
        return self.concatenation(node.elts, where)

    def concatenation(self, parts: list[ast.expr], where: Where) -> Values:
        return self._combine([self.values(part, where) for part in parts], "".join)

    def _combine(self, rows: list[Values], function: Callable[[list[str]], str]) -> Values:
        if sum(len(values) > 1 for values in rows) > 1:
            # Two names from one loop or one branch go together, and which with which is not known.
            rows = [values if len(values) == 1 or values[0].packages else ANYTHING for values in rows]
            if sum(len(values) > 1 for values in rows) > 1:
                return ANYTHING
        found: list[tuple[Value, ...]] = [()]
        for values in rows:
            found = [(*before, value) for before in found for value in values]
            if len(found) > _MOST:
                return ANYTHING
        if any(sum(len(value.text) for value in row) > _LONGEST for row in found):
            return ANYTHING
        return tuple(
            Value(
                function([value.text for value in row]),
                tuple(dict.fromkeys(name for value in row for name in value.packages)),
            )
            for row in found
        )

    def _operation(self, node: ast.BinOp, where: Where) -> Values:
        if isinstance(node.op, ast.Add):
            return self.concatenation([node.left, node.right], where)
        if isinstance(node.op, ast.Div):
            return self._joined([node.left, node.right], where)
        if isinstance(node.op, ast.Mod):
            values = node.right.elts if isinstance(node.right, ast.Tuple) else [node.right]
            return self._format(self.values(node.left, where), "%s", values, where)
        return ANYTHING

    def _format(self, templates: Values, mark: str, parts: list[ast.expr], where: Where) -> Values:
        if len(templates) != 1 or templates[0].text.count(mark) != len(parts):
            return ANYTHING
        pieces = templates[0].text.split(mark)
        return self._combine(
            [self.values(part, where) for part in parts],
            lambda texts: "".join(a + b for a, b in zip(pieces, [*texts, ""], strict=True)),
        )

    def _joined(self, parts: list[ast.expr], where: Where) -> Values:
        return self._combine([self.values(part, where) for part in parts], lambda texts: posixpath.join("", *texts))

    def _choice(self, node: ast.IfExp, where: Where) -> Values:
        return (*self.values(node.body, where), *self.values(node.orelse, where))

    def _attribute(self, node: ast.Attribute, where: Where) -> Values:
        if node.attr == "parent":
            return self._combine([self.values(node.value, where)], lambda texts: posixpath.dirname(texts[0]))
        return ANYTHING

    def _subscript(self, node: ast.Subscript, where: Where) -> Values:
        key = node.slice
        for value, place in self._sources(node.value, where) or ():
            if isinstance(value, ast.Dict) and isinstance(key, ast.Constant):
                found = [v for k, v in zip(value.keys, value.values, strict=True) if _is(k, key.value)]
                return self.values(found[-1], place) if found else ANYTHING
            if isinstance(value, (ast.List, ast.Tuple)) and isinstance(key, ast.Constant) and isinstance(key.value, int):
                elements = self.elements(value, place)
                if elements is not None and -len(elements) <= key.value < len(elements):
                    return self.values(*elements[key.value])
        return ANYTHING

    def _call(self, node: ast.Call, where: Where) -> Values:
        name = callee(node)
        if name in LOOK_UPS:
            return self._look_up(node, name, where)
        if name == "join" and isinstance(node.func, ast.Attribute) and isinstance(node.func.value, ast.Constant):
            return ANYTHING  # of a string
        if name == "join" or (name in ("Path", "PurePath") and len(node.args) > 1):
            return self._joined(node.args, where)
        if name in _JOINS:
            parts = argument(node, 0, "substitutions", "path")
            if isinstance(parts, (ast.List, ast.Tuple)):
                return self._joined(parts.elts, where)
            elements = self.elements(parts, where) if parts is not None else None
            return self._joined([element for element, _ in elements], where) if elements else ANYTHING
        if name == "ThisLaunchFileDir":
            return (Value(OWN_FOLDER),)
        if name in _THROUGH:
            return self.values(argument(node, 0, "path", "text", "launch_file_path", "param_file", "location"), where)
        if name == "dirname":
            return self._combine([self.values(argument(node, 0), where)], lambda texts: posixpath.dirname(texts[0]))
        if isinstance(node.func, ast.Attribute):
            return self._method(node, node.func, where)
        return ANYTHING

    def _look_up(self, node: ast.Call, name: str, where: Where) -> Values:
        given = argument(node, 0, "package", "package_name")
        place = share if name in _SHARE else prefix
        return tuple(
            Value(place(value.text), ((value.text, given),)) if given is not None else Value(UNKNOWN)
            for value in self.values(given, where)
        )

    def _method(self, node: ast.Call, function: ast.Attribute, where: Where) -> Values:
        if function.attr == "find" and isinstance(function.value, ast.Call) and callee(function.value) in LOOK_UPS:
            return self._look_up(node, callee(function.value), where)
        if function.attr in _SAME_METHODS:
            return self.values(function.value, where)
        if function.attr == "joinpath":
            return self._joined([function.value, *node.args], where)
        if function.attr == "format" and not node.keywords:
            return self._format(self.values(function.value, where), "{}", node.args, where)
        return ANYTHING


def _is(key: ast.expr | None, value: object) -> bool:
    return isinstance(key, ast.Constant) and key.value == value


_HANDLERS: dict[type[ast.expr], Callable[[Evaluator, ast.expr, Where], Values]] = {
    ast.Constant: Evaluator._constant,
    ast.Name: Evaluator._name,
    ast.JoinedStr: Evaluator._formatted,
    ast.List: Evaluator._sequence,
    ast.Tuple: Evaluator._sequence,
    ast.BinOp: Evaluator._operation,
    ast.IfExp: Evaluator._choice,
    ast.Attribute: Evaluator._attribute,
    ast.Subscript: Evaluator._subscript,
    ast.Call: Evaluator._call,
}  # type: ignore[dict-item]
