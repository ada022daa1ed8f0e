"""The modules that a Python file imports, as paths, to find the files that it imports directly or indirectly."""

from __future__ import annotations

import ast
import re
from itertools import accumulate
from typing import TYPE_CHECKING

from ros_lint.collectors.python.source_errors import NotPythonError
from ros_lint.collectors.python.string_values import callee
from ros_lint.collectors.python.syntax import parse

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from ros_lint.base.text import Text

_IMPORTERS = frozenset({
    "__import__", "import_module", "iter_modules", "run_module", "run_path", "spec_from_file_location", "walk_packages",
})  # fmt: skip
"""Functions that find, import or run modules by their name or path."""

_MENTIONED = re.compile("|".join(sorted(_IMPORTERS)))
_STATEMENT = re.compile(
    r"\b(?:from[ \t]*(\.[ \t.]{0,50}[\w.]*|[\w.]+)(?:[ \t]|\\\r?\n){0,50})?"
    r"\bimport\b[ \t]*(?:\(([^()]*)\)|((?:[^\n;#\\]|\\\r?\n)*))"
)
_COMMENT = re.compile("#[^\n]*")
_NAME = re.compile(r"[ \t\r\n\\]*([\w.]+|\*)")


def imported_paths(source: Text, path: str) -> frozenset[str] | None:
    """Return the paths of all modules and names that a file imports, without suffix, None if it may import further modules.

    ``path`` is the path of the file. Examples:

    - ``import a.b`` and ``from a import b`` give ``a`` and ``a/b``, because ``b`` may be a module.
    - ``from . import b`` gives ``robot/b`` in ``robot/talker.py``.
    - ``from a import *`` gives ``a`` and ``a/*``, which means all modules in ``a``.

    A regular expression finds the statements, also in strings. If the file names a function that imports modules, such as
    ``import_module``, the file is parsed instead.
    """
    if _MENTIONED.search(source.text):
        return _of_tree(source, path)
    paths: set[str] = set()
    for module, in_brackets, rest in _STATEMENT.findall(source.text):
        names = [name[1] for part in _COMMENT.sub("", in_brackets or rest).split(",") if (name := _NAME.match(part))]
        if module:
            relative = module.replace(" ", "").replace("\t", "")
            absolute = relative.lstrip(".")
            paths.update(_of_from(absolute, len(relative) - len(absolute), names, path))
        else:
            paths.update([prefix for name in names for prefix in _prefixes(name)])
    return frozenset(paths)


def _of_tree(source: Text, path: str) -> frozenset[str] | None:
    """Return the imported paths from the syntax tree, None if a function imports a module by a name that is not constant."""
    try:
        tree = parse(source)
    except NotPythonError:
        return None
    paths: set[str] = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            paths.update([prefix for alias in node.names for prefix in _prefixes(alias.name)])
        elif isinstance(node, ast.ImportFrom):
            paths.update(_of_from(node.module or "", node.level, [alias.name for alias in node.names], path))
        elif isinstance(node, ast.Call) and callee(node) in _IMPORTERS:
            name = node.args[0] if node.args else None
            if not isinstance(name, ast.Constant) or not isinstance(name.value, str) or name.value.startswith("."):
                return None
            paths.update(_prefixes(name.value))
    return frozenset(paths)


def _of_from(module: str, level: int, names: Iterable[str], path: str) -> Iterator[str]:
    """Yield the paths of the modules that ``from module import names`` may import. ``level`` is the number of leading dots."""
    folders = path.split("/")[:-level] if level else []
    folder = "/".join([*folders, *(module.split(".") if module else ())])
    yield from accumulate(folder.split("/"), "{}/{}".format)
    yield from (f"{folder}/{name}".lstrip("/") for name in names)


def _prefixes(name: str) -> Iterator[str]:
    return accumulate(name.split("."), "{}/{}".format)
