"""Evaluation of function(), macro() and block()."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any, Final

from ros_lint.collectors.cmake.evaluator.blocks import Body, Definition, If, ScopeBlock, rewritten
from ros_lint.collectors.cmake.evaluator.expansion import substituted
from ros_lint.collectors.cmake.evaluator.flow import run_body
from ros_lint.collectors.cmake.evaluator.run import Run
from ros_lint.collectors.cmake.evaluator.state import NEXT, BlockVariables, Exit, Procedure
from ros_lint.collectors.cmake.evaluator.values import HOLE
from ros_lint.collectors.cmake.syntax import QUOTED, UNQUOTED, Argument, Command
from ros_lint.facts.visibility import Facet


def _define(run: Run, node: Definition) -> Exit:
    run.frames[-1].command = node.command
    args = run.arguments(node.command)
    if not args or HOLE in args[0]:
        run.hide(Facet.USES | Facet.EXPORTS, "the name of a function is unknown")
        return NEXT
    frame = run.frames[-1]
    body = node.body
    if frame.macro_arguments is not None:
        body = rewritten(body, partial(_substituted, frame.macro_arguments))
    file = next(frame for frame in reversed(run.frames) if frame.procedure is None)
    procedure = Procedure(
        args[0],
        node.command.name == "macro",
        tuple(args[1:]),
        body,
        frame.own,
        frame.path,
        file.folder,
        frame.procedure.provider if frame.procedure else frame.provider,
        reads_argument_variables(body),
    )
    run.put(run.procedures, args[0].lower(), procedure)
    return NEXT


def reads_argument_variables(body: Body) -> bool:
    """Return whether a command in the body of a function may read the arguments by number (ARGV, ARGC, ARGV0 and so on)."""
    for node in body:
        commands: list[Command | None]
        bodies: list[Body]
        if isinstance(node, Command):
            commands, bodies = [node], []
        elif isinstance(node, If):
            commands, bodies = [command for command, _ in node.branches], [branch_body for _, branch_body in node.branches]
        else:
            commands, bodies = [node.command], [node.body]
        if any(map(reads_argument_variables, bodies)):
            return True
        if any(command is not None and _reads_argument_variables(command) for command in commands):
            return True
    return False


def _reads_argument_variables(command: Command) -> bool:
    return command.name == "include" or any("ARGV" in text or "ARGC" in text for text, *_ in command.args)


def _substituted(macro_arguments: dict[str, str], args: tuple[Argument, ...]) -> tuple[Argument, ...]:
    substituted_args = []
    for text, kind, start, end in args:
        value = substituted(text, macro_arguments) if kind in (UNQUOTED, QUOTED) else text
        substituted_args.append((value, kind, start, end))
    return tuple(substituted_args)


def _run_scope(run: Run, node: ScopeBlock) -> Exit:
    """Run a block(), and return how it may end (Exit).

    The variables of the block, except those after PROPAGATE, are removed at its end.
    """
    run.frames[-1].command = node.command
    args = run.arguments(node.command)
    if "SCOPE_FOR" in args and "VARIABLES" not in args:
        return run_body(run, node.body)
    names = args[args.index("PROPAGATE") + 1 :] if "PROPAGATE" in args else []
    run.scopes.append(BlockVariables())
    try:
        exits = run_body(run, node.body)
        propagated = {name: run.scopes[-1][name] for name in names if name in run.scopes[-1]}
    finally:
        run.scopes.pop()
    for name, value in propagated.items():
        run.set(name, value)
    return exits


BLOCKS: Final[dict[type, Callable[[Run, Any], Exit]]] = {Definition: _define, ScopeBlock: _run_scope}
