"""Package look-ups of a Python source, such as ``get_package_share_directory("p")``, and paths of files in the packages."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterable, Iterator
from typing import NamedTuple

from ros_lint.base.text import Text
from ros_lint.collectors.python.excerpt import excerpt
from ros_lint.collectors.python.imports import outside_strings
from ros_lint.collectors.python.scopes import Expression, Where, nodes, scan
from ros_lint.collectors.python.string_values import LOOK_UPS, Evaluator, argument, callee
from ros_lint.collectors.python.syntax import parse, span_of
from ros_lint.collectors.symbolic_text import installed
from ros_lint.facts.sources import LookUp, Mention
from ros_lint.facts.visibility import Facet, Opaque

_NAMED = re.compile(rf"\b({'|'.join(sorted(LOOK_UPS))})\b(?:[ \t]*\()?")
_LITERAL = re.compile(r"\s*(?:package(?:_name)?[ \t]*=[ \t]*)?([\"'])([\w.-]+)\1\s*[,)]")
_FILE_NAME = re.compile(r"""\.(?<=[\w)}]\.)[A-Za-z]\w{1,9}["']""")
_NOT_FOUND = frozenset({"PackageNotFoundError", "LookupError", "KeyError", "Exception", "BaseException"})
_NO_FILE = frozenset({"FileNotFoundError", "OSError", "IOError", "EnvironmentError", "Exception", "BaseException"})
_ASKS = frozenset({"has_resource", "get_packages_with_prefixes", "get_resources"})
_CATCHES = re.compile(rf"except[ \t]*(?:[(:]|[^\n]*\b(?:{'|'.join(sorted(_NOT_FOUND))})\b)|\b(?:{'|'.join(sorted(_ASKS))})\(")


class Found(NamedTuple):
    """The package look-ups of a source: the packages with known names, the look-ups of computed names, and the paths of files."""

    mentions: tuple[Mention, ...] = ()
    opaque: tuple[Opaque, ...] = ()
    files: tuple[LookUp, ...] = ()


def literals(source: Text) -> Found | None:
    """Return the package look-ups of a source by a search of its text, None if only a syntax tree can give the result.

    The result is equal to the result of :func:`look_ups`.
    """
    text = source.text
    if "get_package_" not in text and "FindPackage" not in text:
        return Found()
    calls = [match for match in _NAMED.finditer(text) if match[0][-1] == "("]
    if not calls:
        return Found()
    calls_with_names = []
    for call in calls:
        before = text[text.rfind("\n", 0, call.start()) + 1 : call.start()]
        name_match = _LITERAL.match(text, call.end())
        if name_match is None or "#" in before or "'" in before or '"' in before:
            return None
        calls_with_names.append((call[1], name_match))
    if _FILE_NAME.search(text) or _CATCHES.search(text) or not outside_strings(text, [call.start() for call in calls]):
        return None
    spans = source.spans([(name_match.start(1), name_match.end(2) + 1) for _, name_match in calls_with_names])
    return Found(
        tuple(
            Mention(name_match[2], "package", span, f'{name}("{name_match[2]}")')
            for (name, name_match), span in zip(calls_with_names, spans, strict=True)
        )
    )


def in_excerpt(source: Text) -> Found:
    """Return the package look-ups of a source, parsed after the removal of functions that do not affect the result.

    The result is equal to the result of :func:`look_ups`. Raises :class:`NotPythonError`.
    """
    words = LOOK_UPS
    while True:
        text, omitted = excerpt(source.text, words)
        tree = parse(Text(source.path, text))
        telling = list(_telling(scan(tree)))
        names = {name for expression, _ in telling if expression.where.scope.shared for name in _bound(expression)}
        if words.issuperset(names) or not any(name in body for name in names for body in omitted):
            return _found(source, tree, telling)
        words |= names


def look_ups(source: Text, tree: ast.Module) -> Found:
    """Return the packages that a source looks up, and the paths of files in their share folders.

    If the name of a package is computed, the look-up is in ``opaque``. A look-up is optional if it runs only where the package
    exists: a condition tests for the package, or a handler catches the exception of a missing package.
    """
    return _found(source, tree, _telling(scan(tree)))


def _found(source: Text, tree: ast.Module, telling: Iterable[tuple[Expression, list[tuple[ast.Call, ast.expr]]]]) -> Found:
    evaluator = Evaluator()
    mentions: list[Mention] = []
    opaque: list[Opaque] = []
    files: list[LookUp] = []
    guarded = _guarded(tree) if _CATCHES.search(source.text) else []
    for expression, calls in telling:
        for call, given in calls:
            span = span_of(source, given)
            for package in evaluator.values(given, expression.where):
                if package is None:
                    reason = f"the package that {callee(call)}() looks up is computed"
                    opaque.append(Opaque(Facet.USES, reason, span))
                elif not isinstance(given, ast.Constant) or isinstance(given.value, str):
                    optional = any(call.lineno in lines for lines in guarded)
                    mentions.append(Mention(package, "package", span, f'{callee(call)}("{package}")', optional))
        for node, package, path in _paths(evaluator, expression.node, expression.where):
            files.append(LookUp(package, path, span_of(source, node)))
    return Found(
        tuple(sorted(mentions, key=lambda mention: mention.span)),
        tuple(sorted(opaque, key=lambda found: found.span)),
        tuple(sorted(files, key=lambda found: found.span)),
    )


def _telling(expressions: list[Expression]) -> Iterator[tuple[Expression, list[tuple[ast.Call, ast.expr]]]]:
    """Yield the expressions that look up a package, directly or through a variable that has the result of a look-up.

    Each expression is followed by the look-up calls in it: the call, and the argument with the package name.
    """
    calls = [list(_calls(expression.inner)) for expression in expressions]
    names = [{node.id for node in expression.inner if node.__class__ is ast.Name} for expression in expressions]
    names_bound: set[str] = set()
    relevant: set[int] = set()
    grown = True
    while grown:
        grown = False
        for index, expression in enumerate(expressions):
            if index not in relevant and (calls[index] or not names_bound.isdisjoint(names[index])):
                relevant.add(index)
                names_bound |= _bound(expression)
                grown = True
    return ((expressions[index], calls[index]) for index in sorted(relevant))


def _bound(expression: Expression) -> set[str]:
    return {node.id for target in expression.targets for node in nodes(target) if isinstance(node, ast.Name)}


def _calls(inner: list[ast.AST]) -> Iterator[tuple[ast.Call, ast.expr]]:
    for node in inner:
        if node.__class__ is ast.Call and callee(node) in LOOK_UPS:
            package = argument(node, "package", "package_name")
            if package is not None:
                yield node, package


def _paths(evaluator: Evaluator, node: ast.expr, where: Where) -> Iterator[tuple[ast.expr, str, str]]:
    """Yield the outermost expressions in ``node`` that are paths in share folders: expression, package and path in the folder."""
    if isinstance(node, (ast.Call, ast.BinOp, ast.JoinedStr)):
        texts = evaluator.values(node, where)
        if texts != (None,):
            places = [place for text in texts if text for place in installed(text)]
            yield from ((node, place.package, place.share) for place in places if place.known and place.share)
            return
    for child in ast.iter_child_nodes(node):
        if isinstance(child, ast.expr):
            yield from _paths(evaluator, child, where)
        elif isinstance(child, ast.keyword):
            yield from _paths(evaluator, child.value, where)


def _guarded(tree: ast.Module) -> list[range]:
    """Return the ranges of lines that run only if a package exists.

    A condition tests whether the package exists, or a handler catches the exception of a missing package.
    """
    lines = []
    for node in nodes(tree):
        if isinstance(node, ast.Try) and any(catches_missing_package(handler) for handler in node.handlers):
            lines.append(_lines(node.body))
        block = getattr(node, "body", None)
        body: list[ast.stmt] = block if isinstance(block, list) else []
        for index, inner in enumerate(body):
            if isinstance(inner, ast.If) and (there := _asks(inner.test)) is not None:
                rest = body[index + 1 :] if isinstance(inner.body[-1], (ast.Return, ast.Continue)) else []
                lines += [_lines(inner.body)] if there else [_lines(inner.orelse), _lines(rest)]
    return lines


def _lines(body: list[ast.stmt]) -> range:
    return range(body[0].lineno, (body[-1].end_lineno or 0) + 1) if body else range(0)


def _asks(test: ast.expr) -> bool | None:
    """Return whether a condition tests that a package is installed (True) or missing (False), None for any other condition.

    ``has_resource("packages", "p")`` -> True, ``not has_resource("packages", "p")`` -> False
    """
    inner = list(ast.walk(test))
    if not any(isinstance(node, ast.Call) and callee(node) in _ASKS for node in inner):
        return None
    return not any(isinstance(node, (ast.Not, ast.NotIn)) for node in inner)


def catches_missing_package(handler: ast.ExceptHandler) -> bool:
    """Return whether a handler catches the exception that the look-up of a missing package raises."""
    return _catches(handler, _NOT_FOUND)


def catches_missing_file(handler: ast.ExceptHandler) -> bool:
    """Return whether a handler catches the exception that opening a missing file raises."""
    return _catches(handler, _NO_FILE)


def _catches(handler: ast.ExceptHandler, names: frozenset[str]) -> bool:
    if handler.type is None:
        return True
    return any((node.id if isinstance(node, ast.Name) else getattr(node, "attr", "")) in names for node in ast.walk(handler.type))
