"""List literals in a ``setup.py`` to which a fix can add elements."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from typing import TYPE_CHECKING

from ros_lint.collectors.python.source_errors import NotPythonError
from ros_lint.collectors.python.string_values import callee, dotted
from ros_lint.collectors.python.syntax import parse, span_of, start_of
from ros_lint.facts.setup_py import EditableList

if TYPE_CHECKING:
    from ros_lint.base.text import Text

_OPTIONS = ("data_files", "packages")


def collect(source: Text, package: str) -> tuple[EditableList, ...]:
    """Return the list literals that are the values of ``data_files``, ``packages`` and ``console_scripts``.

    The result is () unless setup.py has exactly one call of setup(). Each result has the name of the variable
    whose value is the package name ``package``, "" if there is no such variable.
    """
    try:
        tree = parse(source)
    except NotPythonError:
        return ()
    variables: dict[str, ast.expr] = {}
    for node in tree.body:
        if isinstance(node, ast.Assign) and len(node.targets) == 1 and isinstance(node.targets[0], ast.Name):
            variables[node.targets[0].id] = node.value
        elif isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name) and node.value is not None:
            variables[node.target.id] = node.value
    name = next((key for key, value in variables.items() if isinstance(value, ast.Constant) and value.value == package), "")
    calls = [node for node in ast.walk(tree) if isinstance(node, ast.Call) and _is_setup(node.func)]
    if len(calls) != 1:
        return ()
    glob = next((glob_name for node in tree.body if (glob_name := _glob(node))), "")
    return tuple(_slot(source, option, literal, name)._replace(glob=glob) for option, literal in _lists(calls[0], variables))


def _glob(node: ast.stmt) -> str:
    """Return the expression for the function ``glob.glob`` after an import, "" if ``node`` does not import the function.

    ``import glob`` -> ``glob.glob``, ``from glob import glob`` -> ``glob``
    """
    if isinstance(node, ast.Import):
        return next((f"{alias.asname or 'glob'}.glob" for alias in node.names if alias.name == "glob"), "")
    if isinstance(node, ast.ImportFrom) and node.module == "glob":
        return next((alias.asname or "glob" for alias in node.names if alias.name == "glob"), "")
    return ""


def _is_setup(function: ast.expr) -> bool:
    return (isinstance(function, ast.Name) and function.id == "setup") or (
        isinstance(function, ast.Attribute) and function.attr == "setup"
    )


def _lists(call: ast.Call, variables: dict[str, ast.expr]) -> Iterator[tuple[str, ast.List]]:
    for keyword in call.keywords:
        value = variables.get(keyword.value.id) if isinstance(keyword.value, ast.Name) else keyword.value
        if keyword.arg in _OPTIONS and isinstance(value, ast.List):
            yield keyword.arg, value
        elif keyword.arg == "entry_points" and isinstance(value, ast.Dict):
            for key, entries in zip(value.keys, value.values, strict=True):
                if isinstance(key, ast.Constant) and key.value == "console_scripts" and isinstance(entries, ast.List):
                    yield "console_scripts", entries


_COMMA = re.compile(r"(?:\s|#[^\n]*\n)*,")
_REMARK = re.compile(r"[ \t]*#[^\n]*")


def _slot(source: Text, option: str, found: ast.List, variable: str) -> EditableList:
    whole = span_of(source, found)
    close = source.offset(whole.end_line, whole.end_column) - 1
    if not found.elts:
        at = start_of(source, found) + 1
        return EditableList(option, source.span(at, at), True, None, 0, variable)
    last = span_of(source, found.elts[-1])
    at = source.offset(last.end_line, last.end_column)
    comma = _COMMA.match(source.text, at, close)
    line = source.line(last.line)
    before = line[: last.column - 1]
    end = comma.end() if comma else at
    if comma and (remark := _REMARK.match(source.text, end)):
        end = remark.end()
    written = source.text[start_of(source, found) : close]
    return EditableList(
        option,
        source.span(end, end),
        comma is not None,
        None if before.strip() else before,
        len(found.elts),
        variable,
        quote='"' if written.count('"') > written.count("'") else "'",
        joins=_joins(found),
    )


def _joins(found: ast.List) -> str:
    """Return how a list of data_files composes the names of its folders.

    ``os.path.join("share", name)`` -> ``os.path.join``, ``f"share/{name}"`` -> ``f``. The result is "" for any other expression.
    It is computed for the last folder that is not a plain text; it is "" if all folders are plain texts.
    """
    folders = [element.elts[0] for element in found.elts if isinstance(element, ast.Tuple) and element.elts]
    for folder in reversed(folders):
        if isinstance(folder, ast.Call) and callee(folder) == "join":
            return dotted(folder.func)
        if isinstance(folder, ast.JoinedStr):
            return "f"
        if not isinstance(folder, ast.Constant):
            return ""
    return ""
