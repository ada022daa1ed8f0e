"""The import statements of a Python source, found in its syntax tree."""

from __future__ import annotations

import ast
import re
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

from ros_lint.base.text import Text
from ros_lint.collectors.python.string_values import callee
from ros_lint.collectors.python.syntax import start_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator


class Import(NamedTuple):
    """One module that a source imports: by an import statement, or by a call such as ``importlib.import_module("a")``.

    Relative imports are included only if their ImportError is caught.
    """

    start: int
    """The offset of the module name."""
    module: str
    """The dotted name of the module, "" if it is computed. A relative name begins with dots: ``.a`` for ``from . import a``."""
    optional: bool
    """True if the program runs without the module: under TYPE_CHECKING, in dead code, or with the error caught."""
    caught: bool = False
    """True if the import is optional because an ImportError in particular is caught."""
    skips: bool = False
    """True for ``pytest.importorskip()``, which skips the test if the module is missing."""


_SKIPS = "importorskip"
_DYNAMIC = frozenset({"import_module", _SKIPS, "__import__"})
GUARD = re.compile(r"TYPE_CHECKING|version_info|platform|DISTRO|distro|suppress|(?i:ros_?version)")
"""Words that may make imports optional, in the condition of an if statement or in a with statement around the imports."""
_MISSING = frozenset({"ImportError", "ModuleNotFoundError"})
_IMPORT_ERRORS = _MISSING | {"Exception", "BaseException"}
_EXITS = frozenset({"exit", "quit", "_exit", "fail"})


def walk(source: Text, tree: ast.Module) -> list[Import]:
    """Return the imports of a source, in textual order.

    These imports are optional:

    - Imports under ``if TYPE_CHECKING``, and imports for ROS 1 only.
    - Imports in a try statement that continues after an ImportError, or under a test of the platform. Exception: every
      branch imports from the same package.
    - Imports in a try statement inside a function or another block, if its handler replaces the ImportError by another error.
      That error explains what to install.
    - Calls such as ``importlib.import_module("a")``, because programs with such calls usually run without the module.
    - Imports of ``a`` and of its submodules after ``pytest.importorskip("a")``.
    """
    walker = _Walker(tree)
    imports = [
        Import(start, module, bool(optional), optional == _CAUGHT)
        for statement, optional in walker.imports(tree.body, inside=False)
        if optional == _CAUGHT or not _is_relative(statement)
        for start, module in _modules(source, statement)
    ]
    if any(name in source.text for name in _DYNAMIC):
        imports += _calls(source, tree)
    imports.sort()
    return _after_skips(imports) if _SKIPS in source.text else imports


def _off(tree: ast.Module) -> frozenset[str]:
    """Return the names that a module binds only once, at its top level, to a false constant: ``A`` for ``A = False``."""
    bound: dict[str, int] = {}
    off: set[str] = set()
    for statement in tree.body:
        target = statement.targets[0] if isinstance(statement, ast.Assign) else getattr(statement, "target", None)
        value = getattr(statement, "value", None)
        if isinstance(target, ast.Name) and isinstance(value, ast.Constant) and not value.value:
            off.add(target.id)
    if not off:
        return frozenset()
    for node in ast.walk(tree):
        if isinstance(node, ast.Name) and not isinstance(node.ctx, ast.Load):
            bound[node.id] = bound.get(node.id, 0) + 1
        elif isinstance(node, (ast.Import, ast.ImportFrom)):
            bound.update({alias.asname or alias.name: 2 for alias in node.names})
        elif isinstance(node, (ast.FunctionDef, ast.ClassDef)):
            bound[node.name] = 2
        elif isinstance(node, ast.arg):
            bound[node.arg] = 2
    return frozenset(name for name in off if bound.get(name) == 1)


def _calls(source: Text, tree: ast.Module) -> Iterator[Import]:
    for node in ast.walk(tree):
        if isinstance(node, ast.Call) and node.args:
            module = node.args[0]
            name = callee(node)
            if name not in _DYNAMIC:
                continue
            if not isinstance(module, ast.Constant) or not isinstance(module.value, str):
                yield Import(start_of(source, module), "", True)
            elif not module.value.startswith("."):
                start = source.text.find(module.value, start_of(source, module))
                yield Import(max(start, 0), module.value, True, skips=name == _SKIPS)


def _after_skips(imports: Iterable[Import]) -> list[Import]:
    """Return the imports after a change: ``import a.b`` becomes optional after ``pytest.importorskip("a")``."""
    results: list[Import] = []
    skips: tuple[str, ...] = ()
    for item in imports:
        if item.skips:
            skips += (f"{item.module}.",)
        results.append(item._replace(optional=item.optional or f"{item.module}.".startswith(skips)))
    return results


_Found = tuple["ast.Import | ast.ImportFrom", int]
"""An import statement, and how optional it is: 0 if required, 1 if optional, _CAUGHT if its ImportError is caught."""
_CAUGHT = 2
"""The number for an import that is optional because an ImportError is caught, rather than any error of the block."""


class _Walker:
    """Finds the import statements of a module in its syntax tree, and whether each of them is optional."""

    def __init__(self, tree: ast.Module) -> None:
        self._tree = tree

    @cached_property
    def _off(self) -> frozenset[str]:
        return _off(self._tree)

    def imports(self, body: Iterable[ast.stmt], inside: bool = True) -> Iterator[_Found]:
        for statement in body:
            if isinstance(statement, (ast.Import, ast.ImportFrom)):
                yield statement, 0
            elif isinstance(statement, ast.If):
                yield from self._conditional(statement)
            elif isinstance(statement, ast.Try) or type(statement).__name__ == "TryStar":
                yield from self._try(statement, inside)  # type: ignore[arg-type]  # of the same fields
            elif isinstance(statement, (ast.With, ast.AsyncWith)) and any(_suppresses(item) for item in statement.items):
                yield from ((found, _CAUGHT) for found, _ in self.imports(statement.body))
            else:
                for block in ("body", "orelse"):
                    yield from self.imports(getattr(statement, block, ()))
                for case in getattr(statement, "cases", ()):
                    yield from self.imports(case.body)

    def _conditional(self, statement: ast.If) -> Iterator[_Found]:
        body, orelse = list(self.imports(statement.body)), list(self.imports(statement.orelse))
        if not body and not orelse:
            return
        test = statement.test
        words = {
            str(getattr(node, "id", None) or getattr(node, "attr", None) or getattr(node, "value", "")) for node in ast.walk(test)
        }
        if _is_off(test, self._off) or (isinstance(test, (ast.Name, ast.Attribute)) and "TYPE_CHECKING" in words):
            yield from ((found, optional or 1) for found, optional in body)
            yield from orelse
        elif (of_ros_2 := _tells_ros_2(test, words)) is not None:
            for branch, runs in ((body, of_ros_2), (orelse, not of_ros_2)):
                yield from ((found, optional or (0 if runs else 1)) for found, optional in branch)
        elif not GUARD.search(" ".join(words)):
            yield from body
            yield from orelse
        else:
            yield from _alternatives([body, orelse], 1)

    def _try(self, statement: ast.Try, inside: bool) -> Iterator[_Found]:
        branches = [[*self.imports(statement.body), *self.imports(statement.orelse)]]
        in_other_handlers: list[_Found] = []
        for handler in statement.handlers:
            if _catches_import_error(handler) and (not _gives_up(handler) or (inside and _explains(handler))):
                branches.append(list(self.imports(handler.body)))
            else:
                in_other_handlers += self.imports(handler.body)
        kind = _CAUGHT if any(_catches_import_error(handler, _MISSING) for handler in statement.handlers) else 1
        yield from _alternatives(branches, kind) if len(branches) > 1 else branches[0]
        yield from in_other_handlers
        yield from self.imports(statement.finalbody)


def _is_off(test: ast.expr, off: frozenset[str]) -> bool:
    """Return whether a condition is always false because of the names in ``off``, which always have a false value."""
    if isinstance(test, ast.BoolOp):
        return (any if isinstance(test.op, ast.And) else all)(_is_off(part, off) for part in test.values)
    return isinstance(test, ast.Name) and test.id in off


_OF_ROS = re.compile(r"ros_?version", re.IGNORECASE)


def _tells_ros_2(test: ast.expr, words: Iterable[str]) -> bool | None:
    """Return whether a comparison of the ROS version with 1 or 2 is true in ROS 2, None for any other condition.

    ``ROS_VERSION == 1`` -> False. ``words`` are the names and constants in the condition.
    """
    if not (isinstance(test, ast.Compare) and isinstance(test.ops[0], (ast.Eq, ast.NotEq)) and any(map(_OF_ROS.search, words))):
        return None
    numbers = [str(side.value) for side in (test.left, *test.comparators) if isinstance(side, ast.Constant)]
    if len(test.ops) > 1 or numbers not in (["1"], ["2"]):
        return None
    return (numbers == ["2"]) == isinstance(test.ops[0], ast.Eq)


def _alternatives(branches: list[list[_Found]], kind: int) -> Iterator[_Found]:
    """Yield the imports of alternative branches, each with a number: 0 for a required import, else how optional it is.

    An import is required if every branch imports from the same top-level package. A relative import is also required if
    another branch has imports, because the other branch may replace only this one module. Any other import gets the number
    ``kind``. An import that is already optional within its branch keeps its number.
    """
    needed = [{root for statement, optional in branch if not optional for root in _roots(statement)} for branch in branches]
    always = set.intersection(*needed)
    replaced = sum(map(bool, branches)) > 1
    for branch in branches:
        for statement, optional in branch:
            yield (
                statement,
                optional or (0 if always.issuperset(_roots(statement)) or (replaced and _is_relative(statement)) else kind),
            )


def _is_relative(statement: ast.Import | ast.ImportFrom) -> bool:
    return isinstance(statement, ast.ImportFrom) and bool(statement.level)


def _roots(statement: ast.Import | ast.ImportFrom) -> set[str]:
    """Return the top-level packages of an import statement: ``import a.b, c`` -> {"a", "c"}, any relative import -> {"."}."""
    if _is_relative(statement):
        return {"."}
    names = [alias.name for alias in statement.names] if isinstance(statement, ast.Import) else [statement.module or ""]
    return {name.partition(".")[0] for name in names}


def _catches_import_error(handler: ast.ExceptHandler, errors: frozenset[str] = _IMPORT_ERRORS) -> bool:
    kind = handler.type
    kinds = kind.elts if isinstance(kind, ast.Tuple) else [kind]
    return any(
        (kind is None and errors is _IMPORT_ERRORS)
        or (isinstance(kind, ast.Name) and kind.id in errors)
        or (isinstance(kind, ast.Attribute) and kind.attr in errors)
        for kind in kinds
    )


def _gives_up(handler: ast.ExceptHandler) -> bool:
    last = handler.body[-1]
    if isinstance(last, ast.Expr) and isinstance(last.value, ast.Call):
        return callee(last.value) in _EXITS
    return isinstance(last, ast.Raise)


def _explains(handler: ast.ExceptHandler) -> bool:
    """Return whether the last statement of a handler raises a new error, as in ``raise RuntimeError("install a")``."""
    last = handler.body[-1]
    return isinstance(last, ast.Raise) and isinstance(last.exc, ast.Call)


def _suppresses(item: ast.withitem) -> bool:
    nodes = list(ast.walk(item.context_expr))
    words = [str(getattr(node, "id", None) or getattr(node, "attr", "")) for node in nodes]
    return any("suppress" in word for word in words) and not _IMPORT_ERRORS.isdisjoint(words)


_FROM_AT = re.compile(r"from(?:\s|\\)*")


def _modules(source: Text, statement: ast.Import | ast.ImportFrom) -> Iterator[tuple[int, str]]:
    if isinstance(statement, ast.Import):
        for alias in statement.names:
            yield start_of(source, alias), alias.name
    else:
        word = _FROM_AT.match(source.text, start_of(source, statement))
        assert word is not None
        names = [statement.module] if statement.module else [alias.name for alias in statement.names]
        yield from ((word.end(), f"{'.' * statement.level}{name}") for name in names)
