"""Journal of changes in an evaluation of setup.py, to run both branches of an unknown condition."""

from __future__ import annotations

import ast
from collections.abc import Callable
from typing import Any, Final

from ros_lint.collectors.setup_py.interpreter.values import Unknown, Value, either, merged

Container = Any
"""A list, dict or set. Scopes are dicts as well."""


class ExhaustedError(Exception):
    """The evaluation of the program stops, because it exceeds a limit or cannot be continued."""


class LeaveError(Exception):
    """A statement leaves its block: return, break, continue, or an exception that ends the program."""

    def __init__(self, kind: str, value: Value = None, raised: str = "") -> None:
        super().__init__(kind)
        self.kind = kind
        self.value = value
        self.raised = raised
        """The name of the class of a raised exception, if it is a class of Python."""


MOST_FORKS: Final = 200
"""Unknown conditions of which both branches may be run. Real programs have a handful."""


class Journal:
    """Log of the contents of containers before they change, so that a block can be undone."""

    def __init__(self) -> None:
        self._open: list[dict[int, tuple[Container, Container]]] = []
        self._forks = 0

    @property
    def unsure(self) -> bool:
        """True while a branch of an unknown condition runs."""
        return bool(self._open)

    def touch(self, container: Container) -> None:
        """Log the content of a container. Call it before the container changes."""
        for changes in self._open:
            if id(container) not in changes:
                changes[id(container)] = (container, container.copy())

    def both(self, ways: tuple[Callable[[], None], Callable[[], None]], unknown: Unknown) -> None:
        """Run both branches of an unknown condition from the same initial state, and join the final states."""
        self._forks += 1
        if self._forks > MOST_FORKS:
            raise ExhaustedError("more conditions are unknown than are followed")
        after: list[dict[int, Container]] = []
        exits: list[LeaveError | None] = []
        touched: dict[int, tuple[Container, Container]] = {}
        for way in ways:
            changes: dict[int, tuple[Container, Container]] = {}
            self._open.append(changes)
            try:
                way()
                exits.append(None)
            except LeaveError as leave:
                exits.append(leave)
            finally:
                self._open.pop()
            after.append({key: container.copy() for key, (container, _) in changes.items()})
            for key, (container, before) in changes.items():
                self.touch(container)
                _refill(container, before)
                touched.setdefault(key, (container, before))
        # A branch that ends the program is usually a failed check, so the other branch is assumed.
        fails = [leave is not None and leave.kind == "raise" for leave in exits]
        for key, (container, before) in touched.items():
            first, second = after[0].get(key, before), after[1].get(key, before)
            if fails[0] != fails[1]:
                _refill(container, second if fails[0] else first)
            else:
                _refill(container, _join(first, second, unknown))
        remaining = [leave for leave, fail in zip(exits, fails, strict=True) if not fail]
        if not remaining:
            raise LeaveError("raise")
        if any(remaining):
            kinds = {leave.kind if leave else "" for leave in remaining}
            if len(kinds) == 1:
                values = [leave.value for leave in remaining if leave]
                raise LeaveError(kinds.pop(), either(values[0], values[-1], unknown))
            raise LeaveError("unclear", unknown)


def _refill(container: Container, content: Container) -> None:
    container.clear()
    if isinstance(container, list):
        container.extend(content)
    else:
        container.update(content)


def _join(first: Container, second: Container, unknown: Unknown) -> Container:
    if isinstance(first, list):
        return merged(first, second)
    if isinstance(first, set):
        return first | second
    joined = {}
    for key in [*first, *(key for key in second if key not in first)]:
        if key in first and key in second:
            joined[key] = either(first[key], second[key], unknown)
        else:
            joined[key] = first.get(key, second.get(key))
    return joined


def at(node: ast.AST | None) -> str:
    """Return a short text of an expression, for use in a reason."""
    text = ast.unparse(_shown(node, _DEEPEST)) if node is not None else "it"
    return text if len(text) <= 40 else text[:37] + "..."


_DEEPEST = 30
"""Greatest depth of an expression that is shown."""


def _shown(node: ast.AST, levels: int) -> ast.AST:
    """Return a copy of a node to unparse.

    F-strings are replaced, because ast.unparse() writes them differently in each version of Python. Nodes that are nested too
    deeply become ``...``.
    """
    if isinstance(node, (ast.JoinedStr, ast.FormattedValue)):
        return ast.Name(_template(node))
    if levels <= 0 and isinstance(node, ast.expr):
        return ast.Name("...")
    return type(node)(**{name: _shown_in(value, levels - 1) for name, value in ast.iter_fields(node)})


def _shown_in(value: Any, levels: int) -> Any:
    if isinstance(value, list):
        return [_shown_in(item, levels) for item in value]
    return _shown(value, levels) if isinstance(value, ast.AST) else value


def _template(node: ast.JoinedStr | ast.FormattedValue) -> str:
    """Return the source of an f-string, the same in each version of Python."""
    parts = []
    pieces: list[ast.expr] = node.values if isinstance(node, ast.JoinedStr) else [node]
    for part in pieces:
        if isinstance(part, ast.FormattedValue):
            parts.append(f"{{{at(part.value)}}}")
        else:
            parts.append(str(getattr(part, "value", "")))
    return f"f{''.join(parts)!r}"
