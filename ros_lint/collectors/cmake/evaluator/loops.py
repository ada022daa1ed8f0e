"""Evaluation of foreach() and while(), even if the number of rounds is unknown."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import Any, Final

from ros_lint.collectors.cmake.evaluator.blocks import Body, Loop
from ros_lint.collectors.cmake.evaluator.conditions import condition
from ros_lint.collectors.cmake.evaluator.flow import run_body, run_conditionally
from ros_lint.collectors.cmake.evaluator.run import Run
from ros_lint.collectors.cmake.evaluator.state import BREAK, CONTINUE, MOST_STEPS, NEXT, RETURN, STOP, Exit
from ros_lint.collectors.cmake.evaluator.truth import FALSE, LIKELY, UNKNOWN, UNLIKELY
from ros_lint.collectors.cmake.evaluator.values import (
    ELEMENT,
    HOLE,
    MAYBE,
    UNPAIRED_HOLE,
    elements,
    split,
    split_cost,
    strip_mark,
)
from ros_lint.collectors.cmake.syntax import UNQUOTED, Command


def _run_loop(run: Run, node: Loop) -> Exit:
    run.frames[-1].command = node.command
    return _run_foreach(run, node) if node.command.name == "foreach" else _run_while(run, node)


def _run_foreach(run: Run, node: Loop) -> Exit:
    args = run.arguments(node.command)
    if not args:
        return NEXT
    rounds = _rounds(run, node.command, args)
    if not rounds:
        return NEXT
    run.budget.charge(ELEMENT * len(rounds))
    names = _loop_names(args)
    values_before = [(name, run.scopes[-1].get(name, _ABSENT)) for name in names]
    visible_before = {name: run.get(name) or "" for name in names}
    exits = _run_rounds(run, node.body, names, rounds)
    for name, value in values_before:
        if value in (_ABSENT, None) and run.policy_version < (3, 21):  # policy CMP0124
            run.set(name, visible_before[name])
        elif value is _ABSENT:
            run.remove(run.scopes[-1], name)
        else:
            run.put(run.scopes[-1], name, value)
    return exits


_ABSENT: Final = object()


def _loop_names(args: list[str]) -> list[str]:
    if "ZIP_LISTS" in args:
        names = args[: args.index("IN")]
        lists = args[args.index("ZIP_LISTS") + 1 :]
        return names if len(names) > 1 else [f"{names[0]}_{index}" for index in range(len(lists))]
    return [args[0]]


def _rounds(run: Run, command: Command, args: list[str]) -> list[tuple[str, ...]]:
    """Return the values of the loop variables of a foreach(), one tuple for each round.

    A tuple with the single value HOLE (an unknown text) means an unknown number of rounds.
    """
    if any(HOLE in arg for arg in args):
        # A quoted argument is one round even if its value is unknown; an unquoted unknown argument may be several rounds.
        args = [HOLE if HOLE in arg and not quoted else arg for arg, quoted in zip(args, _quoted(run, command), strict=True)]
    rest = args[1:]
    if "IN" in args and "ZIP_LISTS" in args:
        lists = [_elements(run, name) for name in args[args.index("ZIP_LISTS") + 1 :]]
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
                values += _unknown_whole(_elements(run, word)) if HOLE not in word else [HOLE]
            else:
                values.append(word)
        return [(value,) for value in values]
    if rest[:1] == ["RANGE"]:
        return [(value,) for value in _range(rest[1:])]
    return [(value,) for value in rest]


def _elements(run: Run, name: str) -> list[str]:
    value = run.get(name) or ""
    run.budget.charge(split_cost(value))
    return elements(value)


def _unknown_whole(items: list[str]) -> list[str]:
    """Return list elements in which HOLE (an unknown text) replaces each element that has an unknown part.

    The whole element becomes unknown, because its unknown part may contain semicolons.
    """
    return [UNPAIRED_HOLE if UNPAIRED_HOLE in item else HOLE if HOLE in item else item for item in items]


def _quoted(run: Run, command: Command) -> list[bool]:
    """Return, for each evaluated argument of a command, whether it was quoted."""
    flags: list[bool] = []
    for text, kind, _, _ in command.args:
        flags += [False] * len(split(run.evaluate(text))) if kind == UNQUOTED else [True]
    return flags


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


def _run_rounds(run: Run, body: Body, names: list[str], rounds: list[tuple[str, ...]], start: int = 0) -> Exit:
    for index in range(start, len(rounds)):
        items = rounds[index]
        if items[0] in (HOLE, UNPAIRED_HOLE):
            if index > start and rounds[index - 1] == items:
                continue  # any number of rounds, twice, is any number of rounds
            exits = _run_any_number(run, partial(_run_round, run, body, names, items[:1] * len(names)))
        else:
            plain = tuple(strip_mark(item)[0] for item in items)
            if plain == items:
                exits = _run_round(run, body, names, items)
            else:
                exits, changes = run_conditionally(run, partial(_run_round, run, body, names, plain))
                run.join([{}, changes])
                exits |= NEXT
        if exits & (RETURN | BREAK | STOP) and not exits & (NEXT | CONTINUE):
            return NEXT if exits & BREAK and not exits & RETURN else (exits & ~BREAK) | (NEXT if exits & BREAK else 0)
        may_leave = exits & (RETURN | BREAK)
        if may_leave:
            rest, changes = run_conditionally(run, partial(_run_rounds, run, body, names, rounds, index + 1))
            run.join([{}, changes])
            return (exits & RETURN) | (NEXT if exits & BREAK else 0) | rest
    return NEXT


def _run_round(run: Run, body: Body, names: list[str], items: Sequence[str]) -> Exit:
    for name, item in zip(names, items, strict=True):
        run.set(name, item)
    return run_body(run, body)


def _run_any_number(run: Run, round_: partial[Exit]) -> Exit:
    """Run the body of a loop whose number of rounds is unknown; return how the loop may end (Exit).

    The body runs twice. The first round records no results; it shows which variables change. Before the second round, these
    variables become unknown.
    """
    run.muted += 1
    try:
        _, changes = run_conditionally(run, round_)
    finally:
        run.muted -= 1
    run.forget(changes)
    exits, changes = run_conditionally(run, round_)
    run.join([{}, changes])
    return exits | NEXT


def _run_while(run: Run, node: Loop) -> Exit:
    while True:
        run.budget.step()
        run.frames[-1].command = node.command
        truth = condition(run, node.command)
        if truth.value in (FALSE, UNLIKELY):
            return NEXT
        if truth.value in (LIKELY, UNKNOWN):
            exits = _run_any_number(run, partial(run_body, run, node.body))
            return (exits & RETURN) | NEXT
        exits = run_body(run, node.body)
        if not exits & (NEXT | CONTINUE):
            return NEXT if exits == BREAK else (exits & ~BREAK) | (NEXT if exits & BREAK else 0)
        if exits & (BREAK | RETURN):
            rest, changes = run_conditionally(run, partial(_run_while, run, node))
            run.join([{}, changes])
            return (exits & RETURN) | NEXT | rest


BLOCKS: Final[dict[type, Callable[[Run, Any], Exit]]] = {Loop: _run_loop}
