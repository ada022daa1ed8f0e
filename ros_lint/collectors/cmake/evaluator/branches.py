"""Evaluation of if(): each branch that may run starts from the state before the if(), and the final states are merged."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import Any, Final, NamedTuple

from ros_lint.collectors.cmake.evaluator.blocks import Body, If
from ros_lint.collectors.cmake.evaluator.conditions import condition
from ros_lint.collectors.cmake.evaluator.flow import run_body
from ros_lint.collectors.cmake.evaluator.regex import forget
from ros_lint.collectors.cmake.evaluator.run import Run
from ros_lint.collectors.cmake.evaluator.state import BY_DEFAULT, IF_TESTING, NEXT, STOP, Changes, Exit
from ros_lint.collectors.cmake.evaluator.truth import FALSE, LIKELY, TRUE, UNLIKELY, Truth


class _Branch(NamedTuple):
    """A branch of an if() that may run."""

    body: Body
    by_default: bool
    """True if the branch runs with default options."""
    testing: bool
    number: int = 0
    """The index of the branch among all branches of the if()."""


def _run_if(run: Run, node: If) -> Exit:
    if len(node.branches) == 1:
        return _run_single(run, node)
    branches: list[_Branch] = []
    is_default = True  # whether all conditions so far are false with default options
    testing = run.testing
    may_skip_all = True
    for number, (command, body) in enumerate(node.branches):
        if command is None:
            truth = Truth(TRUE, False, False)
        else:
            run.frames[-1].command = command
            truth = condition(run, command)
            if branches and any(text == "MATCHES" for text, *_ in command.args):
                forget(run)  # it is unknown whether this condition is evaluated
        if truth.value == FALSE:
            testing = testing or truth.test_if_false
            continue
        if truth.value == TRUE:
            branches.append(_Branch(body, is_default, testing or truth.test_if_true, number))
            may_skip_all = False
            break
        branches.append(_Branch(body, truth.value == LIKELY and is_default, testing or truth.test_if_true, number))
        is_default = is_default and truth.value == UNLIKELY
        testing = testing or truth.test_if_false
    if may_skip_all:
        branches.append(_Branch((), is_default, testing))
    if len(branches) == 1:
        return _run_branch(run, branches[0])
    if len(branches) == 2 and branches[0].by_default and not branches[1].body:
        # The other branch is empty, so the default branch need not be joined with it.
        return _run_branch(run, branches[0]) | NEXT
    return _run_branches(run, node, branches)


def _run_single(run: Run, node: If) -> Exit:
    """Run an if() without elseif() and else(), the most frequent form; return how it may end (Exit)."""
    ((command, body),) = node.branches
    assert command is not None
    run.frames[-1].command = command
    truth = condition(run, command)
    if truth.value == FALSE:
        return NEXT
    testing = run.testing
    branch = _Branch(body, truth.value >= LIKELY, testing or truth.test_if_true)
    if truth.value == TRUE:
        return _run_branch(run, branch)
    if truth.value == LIKELY:
        # There is no other branch, so the default branch need not be joined.
        return _run_branch(run, branch) | NEXT
    return _run_branches(run, node, [branch, _Branch((), truth.value == UNLIKELY, testing or truth.test_if_false)])


def _required_packages(node: If, number: int) -> tuple[str, ...]:
    """Return the packages that are certainly found if the branch ``number`` of an if() does not run.

    Examples: X and Y for the first branch of ``if(NOT X_FOUND OR NOT Y_FOUND)``, and for the else() of ``if(X_FOUND AND
    Y_FOUND)``. The result is () for any other if().
    """
    first = node.branches[0][0]
    assert first is not None
    words = [text.removeprefix("${").removesuffix("}") for text, *_ in first.args]
    if number == 0 and words[::3] == ["NOT"] * len(words[::3]) and all(word == "OR" for word in words[2::3]):
        tested = words[1::3]
    elif number == 1 and len(node.branches) == 2 and node.branches[1][0] is None and all(word == "AND" for word in words[1::2]):
        tested = words[::2]
    else:
        return ()
    return tuple([word[: -len(_FOUND)] for word in tested]) if all(word.endswith(_FOUND) for word in tested) else ()


_FOUND: Final = "_FOUND"


def _run_branch(run: Run, branch: _Branch) -> Exit:
    if branch.testing == run.testing:
        return run_body(run, branch.body)
    run.testing = True
    try:
        return run_body(run, branch.body)
    finally:
        run.testing = False


def _run_branches(run: Run, node: If, branches: Sequence[_Branch]) -> Exit:
    exits: Exit = 0
    completed: list[tuple[Changes, bool]] = []
    continuing: list[tuple[_Branch, Exit]] = []
    some_by_default = any(branch.by_default for branch in branches)
    for branch in branches:
        run.uncertain_conditions += not branch.by_default
        run.non_default_conditions += some_by_default and not branch.by_default
        try:
            outcome, changes = run.branch(partial(_run_branch, run, branch))
        finally:
            run.uncertain_conditions -= not branch.by_default
            run.non_default_conditions -= some_by_default and not branch.by_default
        if outcome == STOP:
            if not run.conditional:
                run.packages.required_by_check.update(_required_packages(node, branch.number))
            continue
        if outcome & NEXT:
            continuing.append((branch, outcome))
        exits |= outcome & ~STOP
        completed.append((changes, branch.by_default))
    if not completed:
        return STOP
    default = next((index for index, (_, usual) in enumerate(completed) if usual), None)
    run.join([changes for changes, _ in completed], default)
    if exits != NEXT and continuing:
        # The default branch usually continues if no command in it can leave, or if leaving is the exception there.
        exits &= ~BY_DEFAULT
        if any(branch.by_default and (outcome & ~STOP == NEXT or outcome & BY_DEFAULT) for branch, outcome in continuing):
            exits |= BY_DEFAULT
        exits |= IF_TESTING if all(branch.testing for branch, _ in continuing) and not run.testing else 0
    return exits


BLOCKS: Final[dict[type, Callable[[Run, Any], Exit]]] = {If: _run_if}
