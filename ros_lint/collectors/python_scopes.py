"""The names of a Python source: what is bound where, and which expressions there are."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence
from typing import NamedTuple, Union

Block = tuple[int, ...]
"""The branches around a statement, outermost first. What is bound in an outer block is bound in the inner ones."""

Step = Union[int, None]  # noqa: UP007  (evaluated on 3.10)
"""How a target takes its part of a value: an index, or None for each element in turn."""


class Where(NamedTuple):
    """A point in the program."""

    scope: Scope
    block: Block
    line: int
    column: int


class Binding(NamedTuple):
    """A name gets a value. ``value`` is None when nothing is known about it."""

    value: ast.expr | None
    where: Where
    steps: tuple[Step, ...] = ()


class Expression(NamedTuple):
    """An expression that a statement evaluates."""

    node: ast.expr
    where: Where
    conditional: bool
    target: str | None = None
    """The only name that it is assigned to; "" when the value is thrown away."""


class Scope:
    """A module, a function or a class."""

    __slots__ = ("bindings", "loads", "parent", "reflective")

    def __init__(self, parent: Scope | None) -> None:
        self.parent = parent
        self.bindings: dict[str, list[Binding]] = {}
        self.loads: set[str] = set()
        self.reflective = False
        """Whether it uses locals() or the like, which loads every name."""

    def bind(self, name: str, value: ast.expr | None, where: Where, steps: tuple[Step, ...] = ()) -> None:
        self.bindings.setdefault(name, []).append(Binding(value, where, steps))

    def find(self, name: str) -> Scope | None:
        """Return the scope that a name belongs to."""
        scope: Scope | None = self
        while scope is not None and name not in scope.bindings:
            scope = scope.parent
        return scope


def scan(tree: ast.Module) -> list[Expression]:
    """Return the expressions of a module in the order of the text; their scopes know every binding."""
    scanner = _Scanner()
    scanner.block(tree.body, Scope(None), (), conditional=False)
    return scanner.expressions


_REFLECTIVE = frozenset({"locals", "globals", "vars", "exec", "eval", "dir"})


class _Scanner:
    def __init__(self) -> None:
        self.expressions: list[Expression] = []
        self._blocks = 0

    def block(self, body: Sequence[ast.stmt], scope: Scope, block: Block, conditional: bool) -> None:
        for statement in body:
            self._statement(statement, scope, block, conditional)

    def _branch(self, body: Sequence[ast.stmt], scope: Scope, block: Block, conditional: bool = True) -> None:
        if body:
            self._blocks += 1
            self.block(body, scope, (*block, self._blocks), conditional)

    def _statement(self, statement: ast.stmt, scope: Scope, block: Block, conditional: bool) -> None:
        where = Where(scope, block, statement.lineno, statement.col_offset)
        match statement:
            case ast.FunctionDef() | ast.AsyncFunctionDef():
                self._function(statement, scope, where, conditional)
            case ast.ClassDef():
                scope.bind(statement.name, None, where)
                for base in (*statement.bases, *statement.decorator_list):
                    self._expression(base, where, conditional)
                self.block(statement.body, Scope(scope), (), conditional)
            case ast.Assign(targets=targets, value=value):
                for target in targets:
                    self._bind(target, value, where)
                only = targets[0].id if len(targets) == 1 and isinstance(targets[0], ast.Name) else None
                self._expression(value, where, conditional, only)
            case ast.AnnAssign(target=target, value=value):
                if value is not None:
                    self._bind(target, value, where)
                    only = target.id if isinstance(target, ast.Name) else None
                    self._expression(value, where, conditional, only)
            case ast.AugAssign(target=target, value=value):
                self._bind(target, None, where)
                if isinstance(target, ast.Name):
                    scope.loads.add(target.id)
                self._expression(value, where, conditional)
            case ast.Expr(value=value):
                self._expression(value, where, conditional, "")
            case ast.If(test=test, body=body, orelse=orelse):
                self._expression(test, where, conditional)
                if not _is_main_guard(test):
                    self._branch(body, scope, block)
                self._branch(orelse, scope, block)
            case ast.For(target=target, iter=values) | ast.AsyncFor(target=target, iter=values):
                self._bind(target, values, where, (None,))
                self._expression(values, where, conditional)
                self._branch(statement.body, scope, block, conditional or not _never_empty(values))
                self._branch(statement.orelse, scope, block, conditional)
            case ast.While(test=test):
                self._expression(test, where, conditional)
                self._branch(statement.body, scope, block)
                self._branch(statement.orelse, scope, block, conditional)
            case ast.With(items=items) | ast.AsyncWith(items=items):
                for item in items:
                    self._expression(item.context_expr, where, conditional)
                    if item.optional_vars is not None:
                        self._bind(item.optional_vars, None, where)
                self.block(statement.body, scope, block, conditional)
            case ast.Import(names=names) | ast.ImportFrom(names=names):
                for alias in names:
                    scope.bind(alias.asname or alias.name.partition(".")[0], None, where)
            case _:
                self._other(statement, where, conditional)

    def _other(self, statement: ast.stmt, where: Where, conditional: bool) -> None:
        """Try, match, return and the rest: expressions and blocks wherever they are."""
        for name, value in ast.iter_fields(statement):
            if isinstance(value, ast.expr):
                self._expression(value, where, conditional)
            elif isinstance(value, list) and value and isinstance(value[0], ast.stmt):
                if name in ("body", "finalbody"):
                    self.block(value, where.scope, where.block, conditional)
                else:
                    self._branch(value, where.scope, where.block)
            elif isinstance(value, list):
                for item in value:
                    if isinstance(item, ast.ExceptHandler):
                        if item.name:
                            where.scope.bind(item.name, None, where)
                        self._branch(item.body, where.scope, where.block)
                    elif isinstance(item, ast.match_case):
                        for inner in ast.walk(item.pattern):
                            if isinstance(inner, (ast.MatchAs, ast.MatchStar)) and inner.name:
                                where.scope.bind(inner.name, None, where)
                        self._branch(item.body, where.scope, where.block)
                    elif isinstance(item, str):  # global, nonlocal
                        where.scope.bind(item, None, where)

    def _function(self, node: ast.FunctionDef | ast.AsyncFunctionDef, scope: Scope, where: Where, conditional: bool) -> None:
        scope.bind(node.name, None, where)
        inner = Scope(scope)
        arguments = node.args
        for default in (*arguments.defaults, *arguments.kw_defaults, *node.decorator_list):
            if default is not None:
                self._expression(default, where, conditional)
        for argument in (
            *arguments.posonlyargs,
            *arguments.args,
            *arguments.kwonlyargs,
            arguments.vararg,
            arguments.kwarg,
        ):
            if argument is not None:
                inner.bind(argument.arg, None, Where(inner, (), node.lineno, node.col_offset))
        # When it runs, everything of the module is bound.
        self.block(node.body, inner, (), conditional=False)

    def _expression(self, node: ast.expr, where: Where, conditional: bool, target: str | None = None) -> None:
        self.expressions.append(Expression(node, where, conditional, target))
        scope = where.scope
        waiting = [node]
        while waiting:
            inner = waiting.pop()
            if isinstance(inner, ast.Name):
                if isinstance(inner.ctx, ast.Load):
                    self._load(inner.id, scope)
                continue
            if isinstance(inner, ast.NamedExpr):
                self._bind(inner.target, inner.value, where)
            elif isinstance(inner, ast.Lambda):
                for argument in (*inner.args.args, *inner.args.kwonlyargs):
                    scope.bind(argument.arg, None, where)
            elif isinstance(inner, (ast.ListComp, ast.SetComp, ast.GeneratorExp, ast.DictComp)):
                for generator in inner.generators:
                    self._bind(generator.target, generator.iter, where, (None,))
            waiting += children(inner)

    def _load(self, name: str, scope: Scope) -> None:
        # A function may use a name of the scopes around it, so it counts for all of them.
        around: Scope | None = scope
        while around is not None:
            around.loads.add(name)
            if name in _REFLECTIVE:
                around.reflective = True
            around = around.parent

    def _bind(self, target: ast.expr, value: ast.expr | None, where: Where, steps: tuple[Step, ...] = ()) -> None:
        if isinstance(target, ast.Name):
            where.scope.bind(target.id, value, where, steps)
        elif isinstance(target, (ast.Tuple, ast.List)):
            starred = any(isinstance(item, ast.Starred) for item in target.elts)
            for index, item in enumerate(target.elts):
                self._bind(item, None if starred else value, where, (*steps, index))
        elif isinstance(target, ast.Starred):
            self._bind(target.value, None, where)


def children(node: ast.expr) -> list[ast.expr]:
    """Return the expressions directly in an expression."""
    kind = type(node)
    if kind is ast.Call:
        return [node.func, *node.args, *[keyword.value for keyword in node.keywords]]  # type: ignore[attr-defined]
    if kind is ast.Constant or kind is ast.Name:
        return []
    if kind is ast.Attribute:
        return [node.value]  # type: ignore[attr-defined]
    if kind is ast.List or kind is ast.Tuple:
        return node.elts  # type: ignore[attr-defined, no-any-return]
    found: list[ast.expr] = []
    for name in node._fields:
        value = getattr(node, name)
        for item in value if isinstance(value, list) else (value,):
            if isinstance(item, ast.expr):
                found.append(item)
            elif isinstance(item, ast.comprehension):
                found += (item.target, item.iter, *item.ifs)
    return found


def reaching(name: str, where: Where) -> Iterator[Binding] | None:
    """Return the bindings that a name may have at a point of the program; None when nobody binds it."""
    scope = where.scope.find(name)
    if scope is None:
        return None
    bindings = scope.bindings[name]
    if scope is where.scope:
        place = (where.line, where.column)
        before = [binding for binding in bindings if (binding.where.line, binding.where.column) < place]
        return iter(_last(before, where.block) or bindings)
    return iter(_last(bindings, ()))


def _last(bindings: Sequence[Binding], block: Block) -> list[Binding]:
    """Return the last binding that is certain to have happened, and those after it that may have."""
    found: list[Binding] = []
    for binding in bindings:
        own = binding.where.block
        if own == block[: len(own)]:
            found = []
        found.append(binding)
    return found


def _is_main_guard(test: ast.expr) -> bool:
    return isinstance(test, ast.Compare) and isinstance(test.left, ast.Name) and test.left.id == "__name__"


def _never_empty(values: ast.expr) -> bool:
    return isinstance(values, (ast.List, ast.Tuple)) and bool(values.elts)
