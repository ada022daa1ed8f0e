"""The modules that a Python file imports, as paths, to find the files that it imports directly or indirectly."""

from __future__ import annotations

import ast
from itertools import accumulate
from typing import TYPE_CHECKING

from ros_lint.collectors.python.source_errors import NotPythonError
from ros_lint.collectors.python.string_values import callee
from ros_lint.collectors.python.syntax import parse

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ros_lint.base.text import Text

_IMPORTERS = frozenset({
    "__import__", "import_module", "iter_modules", "run_module", "run_path", "spec_from_file_location", "walk_packages",
})  # fmt: skip
"""Functions that find, import or run modules by their name or path."""


def imported_paths(source: Text, path: str) -> frozenset[str] | None:
    """Return the paths of all modules and names that a file imports, without suffix, None if it may import further modules.

    ``path`` is the path of the file. ``import a.b`` gives ``a`` and ``a/b``, ``from a import b`` the same, because ``b`` may
    be a module. ``from . import b`` gives ``robot/b`` in ``robot/talker.py``. ``a/*`` stands for all modules in ``a``.
    """
    try:
        tree = parse(source)
    except NotPythonError:
        return None
    paths: set[str] = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            paths.update([prefix for alias in node.names for prefix in _prefixes(alias.name)])
        elif isinstance(node, ast.ImportFrom):
            paths.update(_of_from(node, path))
        elif isinstance(node, ast.Call) and callee(node) in _IMPORTERS:
            name = node.args[0] if node.args else None
            if not isinstance(name, ast.Constant) or not isinstance(name.value, str) or name.value.startswith("."):
                return None
            paths.update(_prefixes(name.value))
    return frozenset(paths)


def _of_from(node: ast.ImportFrom, path: str) -> Iterator[str]:
    folders = path.split("/")[: -node.level] if node.level else []
    module = "/".join([*folders, *(node.module.split(".") if node.module else ())])
    yield from accumulate(module.split("/"), "{}/{}".format)
    yield from (f"{module}/{alias.name}".lstrip("/") for alias in node.names)


def _prefixes(name: str) -> Iterator[str]:
    return accumulate(name.split("."), "{}/{}".format)
