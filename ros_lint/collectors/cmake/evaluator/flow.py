"""Running of CMake code: sequences of commands, calls of functions and macros, and files."""

from __future__ import annotations

from collections.abc import Callable, Container, Sequence
from functools import partial
from typing import Any, Final

from ros_lint.collectors.cmake.evaluator.blocks import Node, UnbalancedError, blocks
from ros_lint.collectors.cmake.evaluator.run import DEEPEST, MOST_STEPS, Handler, Run
from ros_lint.collectors.cmake.evaluator.state import (
    NEXT,
    RETURN,
    STOP,
    TESTS,
    USUAL,
    BudgetError,
    Changes,
    Choice,
    Exit,
    Frame,
    Procedure,
    Variables,
)
from ros_lint.collectors.cmake.evaluator.values import ELEMENT, HOLE, MAYBE, certainly_set, elements, join, maybe
from ros_lint.collectors.cmake.syntax import QUOTED, Command
from ros_lint.facts.visibility import ALL_FACETS

HANDLERS: Final[dict[str, Handler]] = {}
"""The handler of each CMake command. :mod:`ros_lint.collectors.cmake.evaluate` fills it and BLOCKS."""
BLOCKS: Final[dict[type, Callable[[Run, Any], Exit]]] = {}
"""The function that runs each type of block."""


def run_body(run: Run, body: Sequence[Node], start: int = 0) -> Exit:
    """Run commands in order from index ``start``, and return the possible exits."""
    run.steps += len(body) - start + 1
    if run.steps > MOST_STEPS:
        raise BudgetError
    frame = run.frames[-1]
    procedures = run.procedures
    for index in range(start, len(body)):
        node = body[index]
        if type(node) is Command:
            frame.command = node
            name = node.name
            if name in procedures:
                ended = run_named(run, name, run.arguments(node))
            else:
                run.command_names.add(name)
                handler = HANDLERS.get(name)
                args = run.arguments(node)
                ended = (handler(run, args) if handler is not None else run.run_external_command(run, name, args)) or NEXT
        else:
            ended = BLOCKS[type(node)](run, node)
        if ended == NEXT:
            continue
        if not ended & NEXT:
            return ended
        if ended == NEXT | STOP:
            continue  # a branch that stops with an error has no effects
        run.steps -= len(body) - index - 1  # run_body() counts the rest again
        rest, changes = perhaps(run, partial(run_body, run, body, index + 1), ended)
        run.join([{}, changes], 1 if ended & USUAL else None)
        return (ended & ~(NEXT | USUAL | TESTS)) | rest
    return NEXT


def perhaps(run: Run, piece: Callable[[], Exit], reached: Exit = NEXT) -> tuple[Exit, Changes]:
    """Run ``piece`` as code that may not run. The bits USUAL and TESTS of ``reached`` say when it runs."""
    unsure, testing = run.uncertain_conditions, run.testing
    run.uncertain_conditions += not reached & USUAL
    run.testing = testing or bool(reached & TESTS)
    try:
        return run.branch(piece)
    finally:
        run.uncertain_conditions, run.testing = unsure, testing


def run_named(run: Run, name: str, args: list[str]) -> Exit:
    """Run the command ``name`` (in lower case) with evaluated arguments."""
    run.command_names.add(name)
    procedure = run.procedures.get(name)
    if procedure is not None:
        return call(run, procedure, args)
    handler = HANDLERS.get(name)
    if handler is not None:
        return handler(run, args) or NEXT
    return run.run_external_command(run, name, args) or NEXT


def count_step(run: Run) -> None:
    """Count a step. Raises BudgetError if there are too many."""
    run.steps += 1
    if run.steps > MOST_STEPS:
        raise BudgetError


def _without(run: Run, name: str, args: list[str]) -> Exit:
    """Run a command of CMake itself, ignoring a procedure of the same name."""
    handler = HANDLERS.get(name)
    return (handler(run, args) or NEXT) if handler is not None else NEXT


def call(run: Run, procedure: Procedure | Choice, args: list[str]) -> Exit:
    """Call a function or macro."""
    if type(procedure) is Choice:
        return _call_one_of(run, procedure, args)
    assert type(procedure) is Procedure
    body = procedure.body
    if not body:
        return NEXT
    frames = run.frames
    if len(frames) > DEEPEST:
        raise BudgetError
    run.charge(2 * ELEMENT * len(args))
    firm = len(args)
    gaps: Container[str] = ()
    command = frames[-1].command
    text = "".join(args)
    if (HOLE in text or MAYBE in text) and command is not None:
        index = run.firm_arguments(command)
        if index is not None:  # cmake_language(CALL name) has two arguments more than the called command
            firm = max(0, index - (len(run.arguments(command)) - len(args)))
        gaps = _gaps(run, command)
    values = _call_values(procedure, args, firm, gaps)
    for arg in args:
        run.notice(arg)
    frame = Frame(procedure.own, procedure.path, procedure.folder, procedure)
    frames.append(frame)
    if procedure.macro:
        frame.macro_arguments = values
        try:
            return run_body(run, body)
        finally:
            frames.pop()
    values["CMAKE_CURRENT_FUNCTION"] = procedure.name
    folder = procedure.folder or HOLE
    values["CMAKE_CURRENT_FUNCTION_LIST_DIR"] = folder
    values["CMAKE_CURRENT_FUNCTION_LIST_FILE"] = f"{folder}/{procedure.path.rpartition('/')[2]}"
    run.scopes.append(Variables(values))
    try:
        ended = run_body(run, body)
    finally:
        frames.pop()
        run.scopes.pop()
    return NEXT | ended & STOP if ended & (NEXT | RETURN) else ended


def _call_one_of(run: Run, choice: Choice, args: list[str]) -> Exit:
    name = next(option.name for option in choice.procedures if option is not None).lower()
    ended: Exit = 0
    branches: list[Changes] = []
    for number, option in enumerate(choice.procedures):
        piece = partial(call, run, option, args) if option is not None else partial(_without, run, name, args)
        outcome, changes = perhaps(run, piece, USUAL if number == choice.usual else NEXT)
        ended |= outcome
        branches.append(changes)
    run.join(branches, choice.usual)
    return ended


def _call_values(procedure: Procedure, args: list[str], firm: int, gaps: Container[str]) -> dict[str, str]:
    """Return the values of the parameters and of ARGC, ARGV, ARGN, ARGV0 and so on.

    ``firm`` is the index of the first argument that may be missing or be several arguments; the positions of all arguments
    after it are unknown. ``gaps`` are quoted arguments that may be empty.
    """
    parameters = procedure.parameters
    if firm == len(args):
        values = dict(zip(parameters, args, strict=False))
        for name in parameters[len(args) :]:
            values[name] = ""
        values["ARGN"] = _listed(args[len(parameters) :], gaps)
        if not procedure.counts:
            return values
        values["ARGC"] = str(len(args))
    else:
        values = {name: args[index] if index < firm else HOLE for index, name in enumerate(parameters)}
        values["ARGC"] = HOLE
        if firm >= len(parameters):
            values["ARGN"] = _listed(args[len(parameters) :], gaps)
        else:  # ARGN may have any of the other arguments, which may be keywords
            values["ARGN"] = join([HOLE, *(maybe(item) for arg in args[firm:] for item in elements(arg))])
        values.update({f"ARGV{index}": HOLE for index in range(firm, len(args) + 10)})
    values["ARGV"] = _listed(args, gaps)
    values.update({f"ARGV{index}": arg for index, arg in enumerate(args[:firm])})
    return values


def _gaps(run: Run, command: Command) -> set[str]:
    """Return the quoted arguments that may be empty."""
    values = {run.evaluated(text) for text, kind, _, _ in command.args if kind == QUOTED}
    return {value for value in values if MAYBE in value and not certainly_set(value)}


def _listed(args: Sequence[str], gaps: Container[str]) -> str:
    """Return arguments as a list. An argument of ``gaps`` that is not alone may add an empty element."""
    listed = join(args)
    return f"{listed};{MAYBE}" if gaps and len(args) > 1 and any(arg in gaps for arg in args) else listed


def run_file(run: Run, commands: Sequence[Command], frame: Frame) -> Exit:
    """Run the commands of a file. A return() ends only the file."""
    if len(run.frames) > DEEPEST:
        raise BudgetError
    run.enter_file(frame)
    try:
        try:
            body = blocks(commands)
        except UnbalancedError as error:
            body = error.body
            if frame.own:
                run.problem("cmake-syntax", str(error), error.command.place(frame.path))
            run.hide(ALL_FACETS, str(error), error.command.place(frame.path) if frame.own else None)
        ended = run_body(run, body)
    finally:
        run.frames.pop()
        run.place_file()
    return NEXT | ended & STOP if ended & (NEXT | RETURN) else ended
