"""Scopes, bindings and expressions of a Python source."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence
from typing import NamedTuple, Union

Block = tuple[int, ...]
"""The numbers of the branches (such as bodies of if statements) around a statement, outermost first.

A binding in an outer branch is visible in the inner branches.
"""

Step = Union[int, None]  # noqa: UP007  (evaluated on 3.10)
"""One step from a value to a part of the value: the index of an element, or None for each element (``for a in value``)."""


_COMPREHENSIONS = (ast.ListComp, ast.SetComp, ast.GeneratorExp, ast.DictComp)
_BINDING = frozenset({ast.NamedExpr, ast.Lambda, *_COMPREHENSIONS})
"""Kinds of expressions that bind names."""


class Where(NamedTuple):
    """A position in a source, with the scope and the branches that contain it."""

    scope: PythonScope
    block: Block
    line: int
    column: int


class Binding(NamedTuple):
    """A place where a name gets a value. ``value`` is the expression of the value, None if the value is unknown.

    If ``steps`` is not empty, the name gets a part of that value: ``(0,)`` for ``a`` in ``a, b = value``.
    """

    value: ast.expr | None
    where: Where
    steps: tuple[Step, ...] = ()


class Expression(NamedTuple):
    """An outermost expression of a statement, and the targets of the assignment if the statement is an assignment or a loop."""

    node: ast.expr
    where: Where
    inner: list[ast.AST]
    """``node`` and all its descendants in the syntax tree."""
    targets: tuple[ast.expr, ...] = ()
    """The targets to which the statement assigns the value of the expression, or the elements of the value."""


class PythonScope:
    """The names that a module, a class or a function binds, with their bindings.

    ``shared`` is True for a module or class, whose names all functions of the file can use; False for a function.
    """

    __slots__ = ("bindings", "parent", "shared")

    def __init__(self, parent: PythonScope | None, *, shared: bool = True) -> None:
        self.parent = parent
        self.shared = shared
        self.bindings: dict[str, list[Binding]] = {}

    def bind(self, name: str, value: ast.expr | None, where: Where, steps: tuple[Step, ...] = ()) -> None:
        self.bindings.setdefault(name, []).append(Binding(value, where, steps))

    def find(self, name: str) -> PythonScope | None:
        """Return the innermost scope that binds ``name``, from this scope outwards, None if no scope binds it."""
        scope: PythonScope | None = self
        while scope is not None and name not in scope.bindings:
            scope = scope.parent
        return scope


def scan(tree: ast.Module) -> list[Expression]:
    """Return the outermost expressions of all statements of a module, in textual order.

    The scopes of the expressions contain all bindings of the module.
    """
    scanner = _Scanner()
    scanner.block(tree.body, PythonScope(None), ())
    return scanner.expressions


class _Scanner:
    def __init__(self) -> None:
        self.expressions: list[Expression] = []
        self._blocks = 0

    def block(self, body: Sequence[ast.stmt], scope: PythonScope, block: Block) -> None:
        for statement in body:
            self._statement(statement, scope, block)

    def _branch(self, body: Sequence[ast.stmt], scope: PythonScope, block: Block) -> None:
        if body:
            self._blocks += 1
            self.block(body, scope, (*block, self._blocks))

    def _statement(self, statement: ast.stmt, scope: PythonScope, block: Block) -> None:
        where = Where(scope, block, statement.lineno, statement.col_offset)
        match statement:
            case ast.FunctionDef() | ast.AsyncFunctionDef():
                self._function(statement, scope, where)
            case ast.ClassDef():
                scope.bind(statement.name, None, where)
                for base in (*statement.bases, *statement.decorator_list):
                    self._expression(base, where)
                self.block(statement.body, PythonScope(scope), ())
            case ast.Assign(targets=targets, value=value):
                for target in targets:
                    self._bind(target, value, where)
                self._expression(value, where, tuple(targets))
            case ast.AnnAssign(target=target, value=value):
                if value is not None:
                    self._bind(target, value, where)
                    self._expression(value, where, (target,))
            case ast.AugAssign(target=target, value=value):
                self._bind(target, None, where)
                self._expression(value, where)
            case ast.Expr(value=value):
                self._expression(value, where)
            case ast.For(target=target, iter=values) | ast.AsyncFor(target=target, iter=values):
                self._bind(target, values, where, (None,))
                self._expression(values, where, (target,))
                self._branch(statement.body, scope, block)
                self._branch(statement.orelse, scope, block)
            case ast.With(items=items) | ast.AsyncWith(items=items):
                for item in items:
                    self._expression(item.context_expr, where)
                    if item.optional_vars is not None:
                        self._bind(item.optional_vars, None, where)
                self.block(statement.body, scope, block)
            case ast.Import(names=names) | ast.ImportFrom(names=names):
                for alias in names:
                    scope.bind(alias.asname or alias.name.partition(".")[0], None, where)
            case _:
                self._other(statement, where)

    def _other(self, statement: ast.stmt, where: Where) -> None:
        """Record the expressions and enter the blocks of a statement such as if, while, try, match or return."""
        for name, value in ast.iter_fields(statement):
            if isinstance(value, ast.expr):
                self._expression(value, where)
            elif isinstance(value, list) and value and isinstance(value[0], ast.stmt):
                if name == "finalbody" or (name == "body" and not isinstance(statement, (ast.If, ast.While))):
                    self.block(value, where.scope, where.block)
                else:
                    self._branch(value, where.scope, where.block)
            elif isinstance(value, list):
                for item in value:
                    self._part(item, where)

    def _part(self, item: object, where: Where) -> None:
        """Record the names that ``item``, a part of a statement, binds, and the statements in it.

        Such parts are exception handlers, cases of match, and names in a global statement. Other parts bind no names.
        """
        names: list[str | None] = []
        if isinstance(item, ast.ExceptHandler):
            names = [item.name]
        elif isinstance(item, ast.match_case):
            names = [inner.name for inner in ast.walk(item.pattern) if isinstance(inner, (ast.MatchAs, ast.MatchStar))]
        elif isinstance(item, str):
            names = [item]
        for name in filter(None, names):
            where.scope.bind(name, None, where)
        if isinstance(item, (ast.ExceptHandler, ast.match_case)):
            self._branch(item.body, where.scope, where.block)

    def _function(self, node: ast.FunctionDef | ast.AsyncFunctionDef, scope: PythonScope, where: Where) -> None:
        scope.bind(node.name, None, where)
        inner = PythonScope(scope, shared=False)
        parameters = node.args
        for default in (*parameters.defaults, *parameters.kw_defaults, *node.decorator_list):
            if default is not None:
                self._expression(default, where)
        for argument in (*parameters.posonlyargs, *parameters.args, *parameters.kwonlyargs, parameters.vararg, parameters.kwarg):
            if argument is not None:
                inner.bind(argument.arg, None, Where(inner, (), node.lineno, node.col_offset))
        self.block(node.body, inner, ())

    def _expression(self, node: ast.expr, where: Where, targets: tuple[ast.expr, ...] = ()) -> None:
        inner_nodes = nodes(node)
        self.expressions.append(Expression(node, where, inner_nodes, targets))
        for inner in inner_nodes:
            if inner.__class__ not in _BINDING:
                continue
            if isinstance(inner, ast.NamedExpr):
                self._bind(inner.target, inner.value, where)
            elif isinstance(inner, ast.Lambda):
                for argument in (*inner.args.args, *inner.args.kwonlyargs):
                    where.scope.bind(argument.arg, None, where)
            elif isinstance(inner, _COMPREHENSIONS):
                for generator in inner.generators:
                    self._bind(generator.target, generator.iter, where, (None,))

    def _bind(self, target: ast.expr, value: ast.expr | None, where: Where, steps: tuple[Step, ...] = ()) -> None:
        if isinstance(target, ast.Name):
            where.scope.bind(target.id, value, where, steps)
        elif isinstance(target, (ast.Tuple, ast.List)):
            starred = any(isinstance(item, ast.Starred) for item in target.elts)
            for index, item in enumerate(target.elts):
                self._bind(item, None if starred else value, where, (*steps, index))
        elif isinstance(target, ast.Starred):
            self._bind(target.value, None, where)


def nodes(node: ast.AST) -> list[ast.AST]:
    """Return a syntax node and all its descendants, breadth first. The function is faster than ``ast.walk``."""
    collected = [node]
    for inner in collected:
        for name in inner._fields:
            value = getattr(inner, name)
            if value.__class__ is list:
                collected += [item for item in value if isinstance(item, ast.AST)]
            elif isinstance(value, ast.AST) and value._fields:
                collected.append(value)
    return collected


def reaching(name: str, where: Where) -> Iterator[Binding] | None:
    """Return the bindings that may give a name its value at a point of the program, None if no scope binds the name."""
    scope = where.scope.find(name)
    if scope is None:
        return None
    bindings = scope.bindings[name]
    if scope is where.scope:
        place = (where.line, where.column)
        before = [binding for binding in bindings if (binding.where.line, binding.where.column) < place]
        return iter(_last(before, where.block) or bindings)
    return iter(_last(bindings, ()))  # everything around a function is bound when it runs


def _last(bindings: Sequence[Binding], block: Block) -> list[Binding]:
    """Return those of the ``bindings`` of a name that may be in effect at the end of ``bindings`` in ``block``.

    ``bindings`` are in textual order. The result is the last binding that certainly runs, and all later bindings, which run
    only in branches.
    """
    possible: list[Binding] = []
    for binding in bindings:
        own = binding.where.block
        if own == block[: len(own)]:
            possible = []
        possible.append(binding)
    return possible
