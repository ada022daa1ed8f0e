"""The block structure of a CMake file: commands nested in if(), foreach(), while(), function(), macro() and block()."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

from ros_lint.collectors.cmake.syntax import Argument, Command


class If(NamedTuple):
    """An ``if()`` with its branches. Each branch is a pair: its condition (None for ``else()``) and its commands."""

    command: Command
    branches: tuple[tuple[Command | None, Body], ...]


class Loop(NamedTuple):
    """A ``foreach()`` or ``while()``: its first command, and the commands before its end command."""

    command: Command
    body: Body


class Definition(NamedTuple):
    """A ``function()`` or ``macro()``: its first command, and the commands before its end command."""

    command: Command
    body: Body


class ScopeBlock(NamedTuple):
    """A ``block()`` command with the commands between it and its ``endblock()``. A block has its own scope of variables."""

    command: Command
    body: Body


Node = Command | If | Loop | Definition | ScopeBlock
Body = tuple[Node, ...]

Rewrite = Callable[[tuple[Argument, ...]], tuple[Argument, ...]]
"""A function that returns new arguments for the arguments of a command."""

_ENDS = {
    "endif": "if",
    "endforeach": "foreach",
    "endwhile": "while",
    "endfunction": "function",
    "endmacro": "macro",
    "endblock": "block",
}
_STARTS = frozenset(_ENDS.values())
_BRANCHES = frozenset({"else", "elseif"})


class UnbalancedError(Exception):
    """A command opens a block that is never closed, or ends a block that is not open.

    ``command`` is the wrong command. ``body`` has the commands and blocks before the outermost open block.
    """

    def __init__(self, message: str, command: Command, body: Body) -> None:
        super().__init__(message)
        self.command = command
        self.body = body


class _Open:
    """A block whose end command has not been read yet."""

    __slots__ = ("branches", "command", "condition", "nodes")

    def __init__(self, command: Command) -> None:
        self.command = command
        self.condition: Command | None = command
        self.nodes: list[Node] = []
        self.branches: list[tuple[Command | None, Body]] = []

    def next_branch(self, condition: Command | None) -> None:
        self.branches.append((self.condition, tuple(self.nodes)))
        self.condition = condition
        self.nodes = []

    def close(self) -> Node:
        body = tuple(self.nodes)
        match self.command.name:
            case "if":
                return If(self.command, (*self.branches, (self.condition, body)))
            case "foreach" | "while":
                return Loop(self.command, body)
            case "block":
                return ScopeBlock(self.command, body)
            case _:
                return Definition(self.command, body)


def blocks(commands: Sequence[Command]) -> Body:
    """Return the commands of a file as a tree of blocks. Raises UnbalancedError for an unclosed block or a stray end command."""
    nodes: list[Node] = []
    stack: list[_Open] = []
    outer_nodes: list[list[Node]] = []
    for command in commands:
        name = command.name
        if name in _STARTS:
            stack.append(_Open(command))
            outer_nodes.append(nodes)
            nodes = stack[-1].nodes
        elif name in _BRANCHES:
            if not stack or stack[-1].command.name != "if" or stack[-1].condition is None:
                raise UnbalancedError(f"{name}() is not in an if()", command, tuple(outer_nodes[0] if outer_nodes else nodes))
            stack[-1].next_branch(command if name == "elseif" else None)
            nodes = stack[-1].nodes
        elif name in _ENDS:
            if not stack or stack[-1].command.name != _ENDS[name]:
                message = f"{name}() does not close a {_ENDS[name]}()"
                raise UnbalancedError(message, command, tuple(outer_nodes[0] if outer_nodes else nodes))
            block = stack.pop().close()
            nodes = outer_nodes.pop()
            nodes.append(block)
        else:
            nodes.append(command)
    if stack:
        unclosed = stack[-1].command
        raise UnbalancedError(f"{unclosed.name}() is not closed", unclosed, tuple(outer_nodes[0]))
    return tuple(nodes)


def rewritten(body: Body, arguments: Rewrite) -> Body:
    """Return commands and blocks with new arguments: ``arguments`` is applied to the arguments of every command.

    This is for functions that are defined in a macro: references to the parameters of the macro are replaced in their bodies.
    """
    return tuple(_rewritten(node, arguments) for node in body)


def _rewritten(node: Node, arguments: Rewrite) -> Node:
    command = node if isinstance(node, Command) else node.command
    command = command._replace(args=arguments(command.args))
    match node:
        case Command():
            return command
        case If():
            branches = tuple(
                (
                    condition and condition._replace(args=arguments(condition.args)),
                    rewritten(body, arguments),
                )
                for condition, body in node.branches
            )
            return If(command, branches)
        case _:
            return type(node)(command, rewritten(node.body, arguments))
