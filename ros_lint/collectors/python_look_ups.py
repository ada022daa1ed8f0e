"""Packages that a Python source looks up by name, such as ``get_package_share_directory("p")``."""

from __future__ import annotations

import ast
import re
from typing import TYPE_CHECKING

from ros_lint.collectors.launch_py_scopes import Expression, scan
from ros_lint.collectors.launch_py_values import LOOK_UPS, Evaluator, argument, callee
from ros_lint.collectors.python_imports import outside_strings
from ros_lint.collectors.python_syntax import span_of
from ros_lint.facts import Facet, Mention, Opaque

if TYPE_CHECKING:
    from ros_lint.text import Text

_NAMED = re.compile(rf"\b({'|'.join(sorted(LOOK_UPS))})\b(?:[ \t]*\()?")
_LITERAL = re.compile(r"\s*(?:package(?:_name)?[ \t]*=[ \t]*)?([\"'])([\w.-]+)\1\s*[,)]")
_NOT_FOUND = frozenset({"PackageNotFoundError", "LookupError", "KeyError", "Exception", "BaseException"})
_CATCHES = re.compile(rf"\bexcept[ \t]*(?:[(:]|[^\n]*\b(?:{'|'.join(sorted(_NOT_FOUND))})\b)")


def literals(source: Text) -> list[Mention] | None:
    """Return what :func:`look_ups` does, or None when that takes a syntax tree."""
    text = source.text
    if "get_package_" not in text and "FindPackage" not in text:
        return []
    calls = [match for match in _NAMED.finditer(text) if match[0][-1] == "("]
    if not calls:
        return []
    found = []
    for call in calls:
        before = text[text.rfind("\n", 0, call.start()) + 1 : call.start()]
        given = _LITERAL.match(text, call.end())
        if given is None or "#" in before or "'" in before or '"' in before:
            return None
        found.append((call[1], given))
    if _CATCHES.search(text) or not outside_strings(text, [call.start() for call in calls]):
        return None
    spans = source.spans([(given.start(1), given.end(2) + 1) for _, given in found])
    return [
        Mention(given[2], "package", span, f'{name}("{given[2]}")')
        for (name, given), span in zip(found, spans, strict=True)
    ]


def look_ups(source: Text, tree: ast.Module) -> list[Mention | Opaque]:
    """Return the packages that a source looks up, in order; opaque are those whose name is computed.

    Optional are look-ups in a try statement that catches the error (reference, section E2, row 17).
    """
    calls: list[tuple[ast.Call, ast.expr]] = []
    tries: list[ast.Try] = []
    for node in ast.walk(tree):
        if isinstance(node, ast.Call):
            if callee(node) in LOOK_UPS and (given := argument(node, 0, "package", "package_name")) is not None:
                calls.append((node, given))
        elif isinstance(node, ast.Try):
            tries.append(node)
    if not calls:
        return []
    guarded = [_body(node) for node in tries if any(_catches(handler) for handler in node.handlers)]
    values = _Values(tree)
    found: list[Mention | Opaque] = []
    for call, given in calls:
        optional = any(call.lineno in lines for lines in guarded)
        span = span_of(source, given)
        for package in values.of(call, given):
            if package is None:
                found.append(Opaque(Facet.USES, f"the package that {callee(call)}() looks up is computed", span))
            else:
                found.append(Mention(package, "package", span, f'{callee(call)}("{package}")', optional))
    return sorted(found, key=lambda fact: fact.span)


class _Values:
    """The packages that the arguments of look-ups may name."""

    def __init__(self, tree: ast.Module) -> None:
        self._tree = tree
        self._evaluator = Evaluator()
        self._expressions: list[Expression] | None = None

    def of(self, call: ast.Call, given: ast.expr) -> list[str | None]:
        """Return what an argument may be, None among it when it may be something unknown."""
        if isinstance(given, ast.Constant):
            return [given.value] if isinstance(given.value, str) else []
        if self._expressions is None:
            self._expressions = scan(self._tree)
        for expression in self._expressions:
            node = expression.node
            if node.lineno <= call.lineno <= (node.end_lineno or 0) and any(inner is call for inner in ast.walk(node)):
                values = self._evaluator.values(given, expression.where)
                return [value.text if value.known else None for value in values]
        return [None]


def _body(node: ast.Try) -> range:
    return range(node.body[0].lineno, (node.body[-1].end_lineno or 0) + 1)


def _catches(handler: ast.ExceptHandler) -> bool:
    if handler.type is None:
        return True
    return any(
        (node.id if isinstance(node, ast.Name) else getattr(node, "attr", "")) in _NOT_FOUND
        for node in ast.walk(handler.type)
    )
