"""Running CMake code: blocks, conditions with an unknown outcome, loops, calls, files."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import Final, NamedTuple

from ros_lint.collectors.cmake_syntax import QUOTED, UNQUOTED, Argument, Command
from ros_lint.facts import ANYTHING, Facet
from ros_lint.interpret.cmake_blocks import (
    Body,
    Definition,
    If,
    Loop,
    Node,
    Scope,
    UnbalancedError,
    blocks,
    rewritten,
)
from ros_lint.interpret.cmake_conditions import FALSE, LIKELY, TRUE, UNKNOWN, UNLIKELY, Truth, condition
from ros_lint.interpret.cmake_regex import forget
from ros_lint.interpret.cmake_run import DEEPEST, MOST_STEPS, BudgetError, Handler, Run, substituted
from ros_lint.interpret.cmake_state import (
    BREAK,
    CONTINUE,
    NEXT,
    RETURN,
    STOP,
    TESTS,
    USUAL,
    Changes,
    Choice,
    Exit,
    Frame,
    Procedure,
    Variables,
)
from ros_lint.interpret.cmake_values import HOLE, MAYBE, elements, join, split, sure

HANDLERS: Final[dict[str, Handler]] = {}
"""What carries out each command of CMake. Filled by :mod:`ros_lint.interpret.cmake`."""


def run_body(run: Run, body: Sequence[Node], start: int = 0) -> Exit:
    """Run commands one after the other, and return how that can end."""
    for index in range(start, len(body)):
        node = body[index]
        ended = run_command(run, node) if type(node) is Command else _run_block(run, node)
        if ended == NEXT:
            continue
        if not ended & NEXT:
            return ended
        if ended == NEXT | STOP:
            continue  # only the ways that go on matter
        rest, changes = _perhaps(run, partial(run_body, run, body, index + 1), ended)
        run.join([{}, changes], 1 if ended & USUAL else None)
        return (ended & ~(NEXT | USUAL | TESTS)) | rest
    return NEXT


def _perhaps(run: Run, piece: partial[Exit], reached: Exit = NEXT) -> tuple[Exit, Changes]:
    """Run something that may also not run. ``reached`` says by USUAL and TESTS what is known of that."""
    unsure, testing = run.unsure, run.testing
    run.unsure += not reached & USUAL
    run.testing = testing or bool(reached & TESTS)
    try:
        return run.branch(piece)
    finally:
        run.unsure, run.testing = unsure, testing


def run_command(run: Run, command: Command) -> Exit:
    """Run a command that opens no block."""
    run.steps += 1
    if run.steps > MOST_STEPS:
        raise BudgetError
    run.frames[-1].command = command
    name = command.name
    if name in run.procedures:
        return run_named(run, name, run.arguments(command))
    run.calls.add(name)
    handler = HANDLERS.get(name)
    return (handler(run, run.arguments(command)) if handler else run.foreign(run, name, run.arguments(command))) or NEXT


def run_named(run: Run, name: str, args: list[str]) -> Exit:
    """Run a command given by its name in lower case and its evaluated arguments."""
    run.calls.add(name)
    procedure = run.procedures.get(name)
    if procedure is not None:
        return call(run, procedure, args)
    handler = HANDLERS.get(name)
    if handler is not None:
        return handler(run, args) or NEXT
    return run.foreign(run, name, args) or NEXT


def _run_block(run: Run, node: Node) -> Exit:
    run.steps += 1
    if run.steps > MOST_STEPS:
        raise BudgetError
    match node:
        case If():
            return _run_if(run, node)
        case Loop():
            run.frames[-1].command = node.command
            if node.command.name == "foreach":
                return _run_foreach(run, node)
            return _run_while(run, node)
        case Definition():
            run.frames[-1].command = node.command
            return _define(run, node)
        case Scope():
            run.frames[-1].command = node.command
            return _run_scope(run, node.body, run.arguments(node.command))
        case _:
            raise AssertionError(node)


# --- if ------------------------------------------------------------------------------------------------------------


class _Way(NamedTuple):
    body: Body
    usual: bool
    """Whether it is taken unless the user asks for something else."""
    testing: bool


def _run_if(run: Run, node: If) -> Exit:
    ways: list[_Way] = []
    open_end = True  # whether what was passed so far may all be false by default
    testing = run.testing
    certain = True
    for command, body in node.branches:
        if command is None:
            truth = Truth(TRUE, False, False)
        else:
            run.frames[-1].command = command
            truth = condition(run, command)
            if ways and any(text == "MATCHES" for text, *_ in command.args):
                forget(run)  # nobody knows whether this was asked at all
        if truth.value == FALSE:
            testing = testing or truth.test_if_false
            continue
        if truth.value == TRUE:
            ways.append(_Way(body, open_end, testing or truth.test_if_true))
            certain = False
            break
        ways.append(_Way(body, truth.value == LIKELY and open_end, testing or truth.test_if_true))
        open_end = open_end and truth.value == UNLIKELY
        testing = testing or truth.test_if_false
    if certain:
        ways.append(_Way((), open_end, testing))
    if len(ways) == 1:
        return _run_way(run, ways[0])
    if len(ways) == 2 and ways[0].usual and not ways[1].body:
        # What is done by default stays as it is when the other way does nothing.
        return _run_way(run, ways[0]) | NEXT
    return _run_ways(run, ways)


def _run_way(run: Run, way: _Way) -> Exit:
    if way.testing == run.testing:
        return run_body(run, way.body)
    run.testing = True
    try:
        return run_body(run, way.body)
    finally:
        run.testing = False


def _run_ways(run: Run, ways: Sequence[_Way]) -> Exit:
    ended: Exit = 0
    alive: list[tuple[Changes, bool]] = []
    onward: list[_Way] = []
    some_usual = any(way.usual for way in ways)
    for way in ways:
        run.unsure += not way.usual
        run.unusual += some_usual and not way.usual
        try:
            one, changes = run.branch(partial(_run_way, run, way))
        finally:
            run.unsure -= not way.usual
            run.unusual -= some_usual and not way.usual
        if one == STOP:
            continue
        if one & NEXT:
            onward.append(way)
        ended |= one & ~STOP
        alive.append((changes, way.usual))
    if not alive:
        return STOP
    default = next((index for index, (_, usual) in enumerate(alive) if usual), None)
    run.join([changes for changes, _ in alive], default)
    if ended != NEXT and onward:
        ended |= USUAL if any(way.usual for way in onward) else 0
        ended |= TESTS if all(way.testing for way in onward) and not run.testing else 0
    return ended


# --- loops ---------------------------------------------------------------------------------------------------------


def _run_foreach(run: Run, node: Loop) -> Exit:
    args = run.arguments(node.command)
    if not args:
        return NEXT
    rounds = _rounds(run, node.command, args)
    names = _loop_names(args)
    kept = [(name, run.scopes[-1].get(name, _ABSENT)) for name in names]
    seen = {name: run.get(name) or "" for name in names}
    ended = _run_rounds(run, node.body, names, rounds, 0)
    for name, value in kept:
        if value is _ABSENT and run.versions < (3, 21):  # policy CMP0124
            run.set(name, seen[name])
        elif value is _ABSENT:
            run.remove(run.scopes[-1], name)
        else:
            run.put(run.scopes[-1], name, value)
    return ended


_ABSENT: Final = object()


def _loop_names(args: list[str]) -> list[str]:
    if "ZIP_LISTS" in args:
        names = args[: args.index("IN")]
        lists = args[args.index("ZIP_LISTS") + 1 :]
        return names if len(names) > 1 else [f"{names[0]}_{index}" for index in range(len(lists))]
    return [args[0]]


def _rounds(run: Run, command: Command, args: list[str]) -> list[tuple[str, ...]]:
    """Return what the loop variables hold in each round. A single HOLE stands for any number of rounds."""
    if any(HOLE in arg for arg in args):
        # What is quoted is one round even if it is not known; other unknown words may be several.
        args = [HOLE if HOLE in arg and not quoted else arg for arg, quoted in zip(args, _quoted(run, command), strict=True)]
    rest = args[1:]
    if "IN" in args and "ZIP_LISTS" in args:
        lists = [elements(run.get(name) or "") for name in args[args.index("ZIP_LISTS") + 1 :]]
        if any(HOLE in item or item.startswith(MAYBE) for items in lists for item in items):
            return [(HOLE,)]
        longest = max(map(len, lists), default=0)
        return [tuple(items[index] if index < len(items) else "" for items in lists) for index in range(longest)]
    if rest[:1] == ["IN"]:
        values: list[str] = []
        mode = ""
        for word in rest[1:]:
            if word in ("LISTS", "ITEMS") and mode != "ITEMS":
                mode = word
            elif mode == "LISTS":
                values += _unknown_whole(elements(run.get(word) or "")) if HOLE not in word else [HOLE]
            else:
                values.append(word)
        return [(value,) for value in values]
    if rest[:1] == ["RANGE"]:
        return [(value,) for value in _range(rest[1:])]
    return [(value,) for value in rest]


def _unknown_whole(items: list[str]) -> list[str]:
    """Return list elements; those with an unknown piece may be several."""
    return [HOLE if HOLE in item else item for item in items]


def _quoted(run: Run, command: Command) -> list[bool]:
    """Return which of the evaluated arguments were quoted."""
    found: list[bool] = []
    for text, kind, _, _ in command.args:
        found += [False] * len(split(run.evaluated(text))) if kind == UNQUOTED else [True]
    return found


def _range(args: list[str]) -> list[str]:
    try:
        numbers = [int(arg) for arg in args]
    except ValueError:
        return [HOLE]
    start, stop, step = 0, 0, 0
    match numbers:
        case [stop]:
            step = 1
        case [start, stop]:
            step = 1 if start <= stop else -1
        case [start, stop, step]:
            pass
        case _:
            return [HOLE]
    if step == 0 or (step > 0) != (stop >= start) or abs(stop - start) // abs(step) > MOST_STEPS:
        return [HOLE]
    return [str(number) for number in range(start, stop + (1 if step > 0 else -1), step)]


def _run_rounds(run: Run, body: Body, names: list[str], rounds: list[tuple[str, ...]], start: int) -> Exit:
    for index in range(start, len(rounds)):
        items = rounds[index]
        if items[0] == HOLE:
            ended = _run_any_number(run, partial(_run_round, run, body, names, (HOLE,) * len(names)))
        else:
            plain = tuple(sure(item)[0] for item in items)
            if plain == items:
                ended = _run_round(run, body, names, items)
            else:
                ended, changes = _perhaps(run, partial(_run_round, run, body, names, plain))
                run.join([{}, changes])
                ended |= NEXT
        if ended & (RETURN | BREAK | STOP) and not ended & (NEXT | CONTINUE):
            return NEXT if ended & BREAK and not ended & RETURN else (ended & ~BREAK) | (NEXT if ended & BREAK else 0)
        leaves = ended & (RETURN | BREAK)
        if leaves:
            rest, changes = _perhaps(run, partial(_run_rounds, run, body, names, rounds, index + 1))
            run.join([{}, changes])
            return (ended & RETURN) | (NEXT if ended & BREAK else 0) | rest
    return NEXT


def _run_round(run: Run, body: Body, names: list[str], items: Sequence[str]) -> Exit:
    for name, item in zip(names, items, strict=True):
        run.set(name, item)
    return run_body(run, body)


def _run_any_number(run: Run, round_: partial[Exit]) -> Exit:
    """Run the body of a loop that runs an unknown number of times."""
    run.muted += 1
    try:
        _, changes = _perhaps(run, round_)
    finally:
        run.muted -= 1
    run.forget(changes)
    ended, changes = _perhaps(run, round_)
    run.join([{}, changes])
    return ended | NEXT


def _run_while(run: Run, node: Loop) -> Exit:
    while True:
        run.steps += 1
        if run.steps > MOST_STEPS:
            raise BudgetError
        run.frames[-1].command = node.command
        truth = condition(run, node.command)
        if truth.value in (FALSE, UNLIKELY):
            return NEXT
        if truth.value in (LIKELY, UNKNOWN):
            ended = _run_any_number(run, partial(run_body, run, node.body))
            return (ended & RETURN) | NEXT
        ended = run_body(run, node.body)
        if not ended & (NEXT | CONTINUE):
            return NEXT if ended == BREAK else (ended & ~BREAK) | (NEXT if ended & BREAK else 0)
        if ended & (BREAK | RETURN):
            rest, changes = _perhaps(run, partial(_run_while, run, node))
            run.join([{}, changes])
            return (ended & RETURN) | NEXT | rest


# --- functions and macros ------------------------------------------------------------------------------------------


def _define(run: Run, node: Definition) -> Exit:
    args = run.arguments(node.command)
    if not args or HOLE in args[0]:
        run.hide(Facet.USES, "the name of a function is not known")
        return NEXT
    frame = run.frames[-1]
    body = node.body
    if frame.given is not None:
        body = rewritten(body, partial(_substituted, frame.given))
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
        counts(body),
    )
    run.put(run.procedures, args[0].lower(), procedure)
    return NEXT


def counts(body: Body) -> bool:
    """Return whether a body may ask for the arguments of its function by number."""
    for node in body:
        if type(node) is Command:
            command = node
        elif isinstance(node, If):
            if any(counts(inner) for _, inner in node.branches):
                return True
            command = node.command
        else:
            command = node.command  # type: ignore[union-attr]
            if counts(node.body):  # type: ignore[union-attr]
                return True
        if command.name == "include" or any("ARGV" in text or "ARGC" in text for text, *_ in command.args):
            return True
    return False


def _substituted(given: dict[str, str], args: tuple[Argument, ...]) -> tuple[Argument, ...]:
    found = []
    for text, kind, start, end in args:
        changed = substituted(text, given) if kind in (UNQUOTED, QUOTED) else text
        found.append((changed, kind, start, end))
    return tuple(found)


def _without(run: Run, name: str, args: list[str]) -> Exit:
    """Run a command that CMake brings, in spite of a procedure of its name."""
    handler = HANDLERS.get(name)
    return (handler(run, args) or NEXT) if handler is not None else NEXT


def call(run: Run, procedure: Procedure | Choice, args: list[str]) -> Exit:
    """Call a function or macro."""
    if isinstance(procedure, Choice):
        name = next(option.name for option in procedure.procedures if option is not None).lower()
        ended: Exit = 0
        branches: list[Changes] = []
        for number, option in enumerate(procedure.procedures):
            piece = partial(call, run, option, args) if option is not None else partial(_without, run, name, args)
            one, changes = _perhaps(run, piece, USUAL if number == procedure.usual else NEXT)
            ended |= one
            branches.append(changes)
        run.join(branches, procedure.usual)
        return ended
    if not procedure.body:
        return NEXT
    if len(run.frames) > DEEPEST:
        raise BudgetError
    frame = Frame(procedure.own, procedure.path, procedure.folder, procedure)
    firm = None
    command = run.frames[-1].command
    given = "".join(args)
    if command is not None and (HOLE in given or MAYBE in given):
        firm = run.firm_arguments(command)
        if firm is not None:  # cmake_language(CALL) takes two words more than the command itself
            firm = max(0, firm - (len(run.arguments(command)) - len(args)))
    values = _call_values(procedure, args, len(args) if firm is None else firm)
    if procedure.macro:
        frame.given = values
        run.frames.append(frame)
        try:
            return run_body(run, procedure.body)
        finally:
            run.frames.pop()
    run.scopes.append(Variables(values))
    run.frames.append(frame)
    try:
        ended = run_body(run, procedure.body)
    finally:
        run.frames.pop()
        run.scopes.pop()
    return NEXT if ended & (NEXT | RETURN) else ended


def _call_values(procedure: Procedure, args: list[str], firm: int) -> dict[str, str]:
    """Return what the parameters, ARGC, ARGV, ARGN and ARGV0 and so on hold.

    ``firm`` is the index of the first argument that may be missing or be several: of those after it nobody knows which is
    the how many-th.
    """
    parameters = procedure.parameters
    if firm == len(args):
        values = dict(zip(parameters, args, strict=False))
        for name in parameters[len(args) :]:
            values[name] = ""
        values["ARGN"] = ";".join(args[len(parameters) :])
        if not procedure.counts:
            return values
        values["ARGC"] = str(len(args))
    else:
        values = {name: args[index] if index < firm else HOLE for index, name in enumerate(parameters)}
        values["ARGC"] = HOLE
        values["ARGN"] = join(args[len(parameters) :]) if firm >= len(parameters) else HOLE
        values.update({f"ARGV{index}": HOLE for index in range(firm, len(args) + 10)})
    values["ARGV"] = join(args)
    values.update({f"ARGV{index}": arg for index, arg in enumerate(args[:firm])})
    return values


def _run_scope(run: Run, body: Body, args: list[str]) -> Exit:
    """Run block(): what it sets is gone after it, unless it is propagated."""
    if "SCOPE_FOR" in args and "VARIABLES" not in args:
        return run_body(run, body)
    names = args[args.index("PROPAGATE") + 1 :] if "PROPAGATE" in args else []
    run.scopes.append(Variables())
    try:
        ended = run_body(run, body)
        kept = {name: run.scopes[-1][name] for name in names if name in run.scopes[-1]}
    finally:
        run.scopes.pop()
    for name, value in kept.items():
        run.set(name, value)
    return ended


# --- files ---------------------------------------------------------------------------------------------------------


def run_file(run: Run, commands: Sequence[Command], frame: Frame) -> Exit:
    """Run the commands of a file. A return() in it ends the file only."""
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
            run.hide(ANYTHING, str(error), error.command.place(frame.path) if frame.own else None)
        ended = run_body(run, body)
    finally:
        run.frames.pop()
        run.place_file()
    return NEXT if ended & (NEXT | RETURN) else ended
