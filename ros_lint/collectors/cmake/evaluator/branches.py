"""if(): each possible branch runs from the same initial state, and the final states are joined."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import Any, Final, NamedTuple

from ros_lint.collectors.cmake.evaluator.blocks import Body, If
from ros_lint.collectors.cmake.evaluator.conditions import condition
from ros_lint.collectors.cmake.evaluator.flow import run_body
from ros_lint.collectors.cmake.evaluator.regex import forget
from ros_lint.collectors.cmake.evaluator.run import Run
from ros_lint.collectors.cmake.evaluator.state import NEXT, STOP, TESTS, USUAL, Changes, Exit
from ros_lint.collectors.cmake.evaluator.truth import FALSE, LIKELY, TRUE, UNLIKELY, Truth


class _Way(NamedTuple):
    """A branch that may run."""

    body: Body
    usual: bool
    """True if the branch runs with default options."""
    testing: bool


def _run_if(run: Run, node: If) -> Exit:
    if len(node.branches) == 1:
        return _run_single(run, node)
    ways: list[_Way] = []
    open_end = True  # whether all conditions so far may be false with default options
    testing = run.testing
    certain = True
    for command, body in node.branches:
        if command is None:
            truth = Truth(TRUE, False, False)
        else:
            run.frames[-1].command = command
            truth = condition(run, command)
            if ways and any(text == "MATCHES" for text, *_ in command.args):
                forget(run)  # it is unknown whether this condition is evaluated
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
        # The other branch is empty, so the default branch need not be joined with it.
        return _run_way(run, ways[0]) | NEXT
    return _run_ways(run, ways)


def _run_single(run: Run, node: If) -> Exit:
    """Run an if() without elseif() and else(), which is the most frequent form."""
    ((command, body),) = node.branches
    assert command is not None
    run.frames[-1].command = command
    truth = condition(run, command)
    if truth.value == FALSE:
        return NEXT
    testing = run.testing
    way = _Way(body, truth.value >= LIKELY, testing or truth.test_if_true)
    if truth.value == TRUE:
        return _run_way(run, way)
    if truth.value == LIKELY:
        # There is no other branch, so the default branch need not be joined.
        return _run_way(run, way) | NEXT
    return _run_ways(run, [way, _Way((), truth.value == UNLIKELY, testing or truth.test_if_false)])


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
    onward: list[tuple[_Way, Exit]] = []
    some_usual = any(way.usual for way in ways)
    for way in ways:
        run.uncertain_conditions += not way.usual
        run.non_default_conditions += some_usual and not way.usual
        try:
            outcome, changes = run.branch(partial(_run_way, run, way))
        finally:
            run.uncertain_conditions -= not way.usual
            run.non_default_conditions -= some_usual and not way.usual
        if outcome == STOP:
            continue
        if outcome & NEXT:
            onward.append((way, outcome))
        ended |= outcome & ~STOP
        alive.append((changes, way.usual))
    if not alive:
        return STOP
    default = next((index for index, (_, usual) in enumerate(alive) if usual), None)
    run.join([changes for changes, _ in alive], default)
    if ended != NEXT and onward:
        # The default branch usually continues if no command in it can leave, or if leaving is the exception there.
        ended &= ~USUAL
        ended |= USUAL if any(way.usual and (outcome & ~STOP == NEXT or outcome & USUAL) for way, outcome in onward) else 0
        ended |= TESTS if all(way.testing for way, _ in onward) and not run.testing else 0
    return ended


BLOCKS: Final[dict[type, Callable[[Run, Any], Exit]]] = {If: _run_if}
