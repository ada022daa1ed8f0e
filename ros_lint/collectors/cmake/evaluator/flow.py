"""Execution of CMake code: sequences of commands, calls of functions and macros, and files."""

from __future__ import annotations

from collections.abc import Callable, Container, Sequence
from functools import partial
from typing import Any, Final

from ros_lint.base.budget import BudgetExceeded
from ros_lint.collectors.cmake.evaluator.blocks import Node, UnbalancedError, blocks
from ros_lint.collectors.cmake.evaluator.run import DEEPEST, Handler, Run
from ros_lint.collectors.cmake.evaluator.state import (
    BY_DEFAULT,
    IF_TESTING,
    NEXT,
    RETURN,
    STOP,
    CallFrame,
    Changes,
    Choice,
    Exit,
    Procedure,
    Variables,
)
from ros_lint.collectors.cmake.evaluator.unset import READERS, note_unset_references
from ros_lint.collectors.cmake.evaluator.values import ELEMENT, HOLE, MAYBE, certainly_set, elements, join, mark_maybe
from ros_lint.collectors.cmake.syntax import QUOTED, Command
from ros_lint.facts.visibility import ALL_FACETS

HANDLERS: Final[dict[str, Handler]] = {}
"""The handler of each CMake command, by command name. :mod:`ros_lint.collectors.cmake.evaluate` fills this dictionary."""
BLOCKS: Final[dict[type, Callable[[Run, Any], Exit]]] = {}
"""By block type, such as Loop: the function that runs blocks of this type.

:mod:`ros_lint.collectors.cmake.evaluate` fills this dictionary."""


def run_body(run: Run, body: Sequence[Node], start: int = 0) -> Exit:
    """Run commands and blocks in order from index ``start``; return how they may end (Exit)."""
    run.budget.step(len(body) - start + 1)
    frame = run.frames[-1]
    procedures = run.procedures
    for index in range(start, len(body)):
        node = body[index]
        if type(node) is Command:
            frame.command = node
            name = node.name
            if name in procedures:
                exits = run_named(run, name, run.arguments(node))
            else:
                run.command_names.add(name)
                handler = HANDLERS.get(name)
                args = run.arguments(node)
                if name in READERS:
                    note_unset_references(run, node)
                exits = (handler(run, args) if handler is not None else run.run_external_command(run, name, args)) or NEXT
        else:
            exits = BLOCKS[type(node)](run, node)
        if exits == NEXT:
            continue
        if not exits & NEXT:
            return exits
        if exits == NEXT | STOP:
            continue  # a branch that stops with an error has no effects
        run.budget.steps += len(body) - index - 1  # run_body() counts the rest again
        rest, changes = run_conditionally(run, partial(run_body, run, body, index + 1), exits)
        run.join([{}, changes], 1 if exits & BY_DEFAULT else None)
        return (exits & ~(NEXT | BY_DEFAULT | IF_TESTING)) | rest
    return NEXT


def run_conditionally(run: Run, piece: Callable[[], Exit], exits: Exit = NEXT) -> tuple[Exit, Changes]:
    """Evaluate ``piece``, code under an undecided condition, and undo its changes. Return its possible Exit and its changes.

    ``exits`` are flags about the condition: BY_DEFAULT if it holds with default options, IF_TESTING if it holds only if tests
    are enabled, NEXT for any other condition.
    """
    uncertain, testing = run.uncertain_conditions, run.testing
    run.uncertain_conditions += not exits & BY_DEFAULT
    run.testing = testing or bool(exits & IF_TESTING)
    try:
        return run.branch(piece)
    finally:
        run.uncertain_conditions, run.testing = uncertain, testing


def run_named(run: Run, name: str, args: list[str]) -> Exit:
    """Run the command ``name`` (in lower case) with evaluated arguments; return how it may end (Exit)."""
    run.command_names.add(name)
    procedure = run.procedures.get(name)
    if procedure is not None:
        return call(run, procedure, args)
    handler = HANDLERS.get(name)
    if handler is not None:
        return handler(run, args) or NEXT
    return run.run_external_command(run, name, args) or NEXT


def _without(run: Run, name: str, args: list[str]) -> Exit:
    """Run the built-in CMake command ``name``, even if the package defines a function or macro with this name.

    Return how the command may end (Exit).
    """
    handler = HANDLERS.get(name)
    return (handler(run, args) or NEXT) if handler is not None else NEXT


def call(run: Run, procedure: Procedure | Choice, args: list[str]) -> Exit:
    """Run a function or macro with evaluated arguments; return how it may end (Exit)."""
    if type(procedure) is Choice:
        return _call_one_of(run, procedure, args)
    assert type(procedure) is Procedure
    body = procedure.body
    if not body:
        return NEXT
    frames = run.frames
    if len(frames) > DEEPEST:
        raise BudgetExceeded
    run.budget.charge(2 * ELEMENT * len(args))
    first_uncertain = len(args)
    possibly_empty: Container[str] = ()
    command = frames[-1].command
    text = "".join(args)
    if (HOLE in text or MAYBE in text) and command is not None:
        index = run.first_uncertain_argument(command)
        if index is not None:  # cmake_language(CALL name) has two arguments more than the called command
            first_uncertain = max(0, index - (len(run.arguments(command)) - len(args)))
        possibly_empty = _possibly_empty(run, command)
    values = _call_values(procedure, args, first_uncertain, possibly_empty)
    for arg in args:
        run.note_brackets(arg)
    frame = CallFrame(procedure.own, procedure.path, procedure.folder, procedure)
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
        exits = run_body(run, body)
    finally:
        frames.pop()
        run.scopes.pop()
    return NEXT | exits & STOP if exits & (NEXT | RETURN) else exits


def _call_one_of(run: Run, choice: Choice, args: list[str]) -> Exit:
    name = next(option.name for option in choice.procedures if option is not None).lower()
    exits: Exit = 0
    branches: list[Changes] = []
    for number, option in enumerate(choice.procedures):
        piece = partial(call, run, option, args) if option is not None else partial(_without, run, name, args)
        outcome, changes = run_conditionally(run, piece, BY_DEFAULT if number == choice.by_default else NEXT)
        exits |= outcome
        branches.append(changes)
    run.join(branches, choice.by_default)
    return exits


def _call_values(procedure: Procedure, args: list[str], first_uncertain: int, possibly_empty: Container[str]) -> dict[str, str]:
    """Return the values of the parameters and of ARGC, ARGV, ARGN, ARGV0 and so on.

    ``first_uncertain`` is the index of the first argument that may be missing or be several arguments. The positions of the
    later arguments are unknown. ``possibly_empty`` has the quoted arguments that may be empty.
    """
    parameters = procedure.parameters
    if first_uncertain == len(args):
        values = dict(zip(parameters, args, strict=False))
        for name in parameters[len(args) :]:
            values[name] = ""
        values["ARGN"] = _list_of(args[len(parameters) :], possibly_empty)
        if not procedure.counts:
            return values
        values["ARGC"] = str(len(args))
    else:
        values = {name: args[index] if index < first_uncertain else HOLE for index, name in enumerate(parameters)}
        values["ARGC"] = HOLE
        if first_uncertain >= len(parameters):
            values["ARGN"] = _list_of(args[len(parameters) :], possibly_empty)
        else:  # ARGN may have any of the other arguments, which may be keywords
            values["ARGN"] = join([HOLE, *(mark_maybe(item) for arg in args[first_uncertain:] for item in elements(arg))])
        values.update({f"ARGV{index}": HOLE for index in range(first_uncertain, len(args) + 10)})
    values["ARGV"] = _list_of(args, possibly_empty)
    values.update({f"ARGV{index}": arg for index, arg in enumerate(args[:first_uncertain])})
    return values


def _possibly_empty(run: Run, command: Command) -> set[str]:
    """Return the values of those quoted arguments of a command that may be empty, because each list element may be missing."""
    values = {run.evaluate(text) for text, kind, _, _ in command.args if kind == QUOTED}
    return {value for value in values if MAYBE in value and not certainly_set(value)}


def _list_of(args: Sequence[str], possibly_empty: Container[str]) -> str:
    """Return arguments as one value, a CMake list.

    If an argument is in ``possibly_empty``, the list ends with an element that may be missing (MAYBE).
    """
    value = join(args)
    return f"{value};{MAYBE}" if possibly_empty and len(args) > 1 and any(arg in possibly_empty for arg in args) else value


def run_file(run: Run, commands: Sequence[Command], frame: CallFrame) -> Exit:
    """Run the commands of a file; return how they may end (Exit). A return() in the file ends only the file."""
    if len(run.frames) > DEEPEST:
        raise BudgetExceeded
    run.enter_file(frame)
    try:
        try:
            body = blocks(commands)
        except UnbalancedError as error:
            body = error.body
            if frame.own:
                run.add_problem("cmake-syntax", str(error), error.command.place(frame.path))
            run.hide(ALL_FACETS, str(error), error.command.place(frame.path) if frame.own else None)
        exits = run_body(run, body)
    finally:
        run.frames.pop()
        run.place_file()
    return NEXT | exits & STOP if exits & (NEXT | RETURN) else exits
