"""What changes while a setup.py is evaluated, and how to try both ways of a condition that is not known."""

from __future__ import annotations

import ast
from collections.abc import Callable
from typing import Any, Final

from ros_lint.collectors.setup_py.interpreter.values import Unknown, Value, either, merged

Container = Any
"""A list, dict or set. Scopes are dicts, too."""


class ExhaustedError(Exception):
    """The program takes more steps than a setup.py has."""


class LeaveError(Exception):
    """A statement leaves its block: return, break, continue, or an exception that ends the program."""

    def __init__(self, kind: str, value: Value = None, raised: str = "") -> None:
        super().__init__(kind)
        self.kind = kind
        self.value = value
        self.raised = raised
        """Of an exception: its class, if that is one of Python."""


MOST_FORKS: Final = 200
"""How many times both ways of an unknown condition are tried. Real programs have a handful."""


class Journal:
    """Remembers containers before they change, so that a block can be undone."""

    def __init__(self) -> None:
        self._open: list[dict[int, tuple[Container, Container]]] = []
        self._forks = 0

    @property
    def unsure(self) -> bool:
        """Whether what is done now is one of two ways."""
        return bool(self._open)

    def touch(self, container: Container) -> None:
        """Say that a container is about to change."""
        for changes in self._open:
            if id(container) not in changes:
                changes[id(container)] = (container, container.copy())

    def both(self, ways: tuple[Callable[[], None], Callable[[], None]], unknown: Unknown) -> None:
        """Go two ways one of which is taken, and leave behind what may be true after either."""
        self._forks += 1
        if self._forks > MOST_FORKS:
            raise ExhaustedError("more conditions are unknown than are followed")
        after: list[dict[int, Container]] = []
        left: list[LeaveError | None] = []
        touched: dict[int, tuple[Container, Container]] = {}
        for way in ways:
            changes: dict[int, tuple[Container, Container]] = {}
            self._open.append(changes)
            try:
                way()
                left.append(None)
            except LeaveError as leave:
                left.append(leave)
            finally:
                self._open.pop()
            after.append({key: container.copy() for key, (container, _) in changes.items()})
            for key, (container, before) in changes.items():
                self.touch(container)
                _refill(container, before)
                touched.setdefault(key, (container, before))
        # A way that ends the program is a check that fails: taken to hold.
        fails = [leave is not None and leave.kind == "raise" for leave in left]
        for key, (container, before) in touched.items():
            first, second = after[0].get(key, before), after[1].get(key, before)
            if fails[0] != fails[1]:
                _refill(container, second if fails[0] else first)
            else:
                _refill(container, _join(first, second, unknown))
        remaining = [leave for leave, fail in zip(left, fails, strict=True) if not fail]
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
    """Return a short text of an expression, to be quoted in a reason."""
    text = ast.unparse(_shown(node, _DEEPEST)) if node is not None else "it"
    return text if len(text) <= 40 else text[:37] + "..."


_DEEPEST = 30
"""How deep an expression is shown."""


def _shown(node: ast.AST, levels: int) -> ast.AST:
    """Return a copy of a node without f-strings, which each Python writes in its own way, and without what is too deep."""
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
    """Return an f-string as it can be written."""
    parts = []
    pieces: list[ast.expr] = node.values if isinstance(node, ast.JoinedStr) else [node]
    for part in pieces:
        if isinstance(part, ast.FormattedValue):
            parts.append(f"{{{at(part.value)}}}")
        else:
            parts.append(str(getattr(part, "value", "")))
    return f"f{''.join(parts)!r}"
