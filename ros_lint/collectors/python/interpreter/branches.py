"""Interpretation of branches and loops.

If the condition of an if statement is unknown, the interpreter runs both branches. A value that a branch adds exists only
under the condition of the branch. A name with different values in the branches gets both values as alternatives. If a
branch ends with ``return``, ``break`` or ``continue``, the rest of the block runs under the opposite condition.
"""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, NamedTuple

from ros_lint.base.budget import BudgetExceeded
from ros_lint.collectors.python.interpreter.alternatives import alternatives, cause, plain, same
from ros_lint.collectors.python.interpreter.assignments import bind
from ros_lint.collectors.python.interpreter.complements import complement, opposite_of
from ros_lint.collectors.python.interpreter.methods import items
from ros_lint.collectors.python.interpreter.operations import truth
from ros_lint.collectors.python.interpreter.values import (
    PERHAPS,
    Conditions,
    Exit,
    Frame,
    Guarded,
    Names,
    Pending,
    ProgramRaised,
    Value,
    settled,
)
from ros_lint.collectors.python.string_values import callee
from ros_lint.facts.launch import LaunchCondition

if TYPE_CHECKING:
    from ros_lint.collectors.python.interpreter.protocol import Interpreter

_MOST_CONDITIONS = 32
"""Maximum number of conditions that statements of a block, such as early returns, add for the rest of the block.

If there are more, the rest of the block runs under a single unknown condition in their place.
"""
_NAMES_A_STEP = 50
"""The number of names that are copied and joined for one step of the budget, which limits the work of the interpreter."""
_MOST_EXITS = 100
"""The number of conditional exits (``break``, ``return``) after which an endless loop counts as ended."""

NEXT, CONTINUE, BREAK, LEAVE = range(4)
"""How a statement ends: normally, or by leaving an iteration (``continue``), a loop (``break``) or a function (``return``)."""


def forget_conditions(machine: Interpreter, depth: int) -> None:
    """Limit the number of conditions under which the interpreted code runs.

    If there are too many after the first ``depth`` conditions, a single unknown condition replaces these later conditions.
    """
    if len(machine.conditions) > depth + _MOST_CONDITIONS:
        machine.conditions = (*machine.conditions[:depth], machine.fresh(PERHAPS))


class _Side(NamedTuple):
    """One branch of a statement, such as the body of an if statement, and the state of the interpreter at its end."""

    block: Sequence[ast.stmt]
    taken: LaunchCondition
    """The condition under which the branch runs."""
    signal: int
    names: Names
    conditions: Conditions
    """All conditions that hold at the end of the branch."""
    exits: list[Exit]
    """The exits in the branch (such as ``return``) that are taken only under conditions."""


def either(
    machine: Interpreter,
    body: Sequence[ast.stmt],
    other: Sequence[ast.stmt],
    condition: LaunchCondition,
    frame: Frame,
    *,
    loop: bool = False,
    test: ast.expr | None = None,
) -> int:
    """Interpret both branches of a statement whose condition is unknown. Return how it ends: NEXT, CONTINUE, BREAK or LEAVE.

    ``body`` runs under ``condition``, ``other`` under the opposite condition. A name with different values in the branches
    gets both values as alternatives. ``test`` is the tested expression. ``loop`` is True if ``body`` is the body of a loop
    that runs any number of times.
    """
    condition = machine.fresh(condition, test)
    before, start = machine.conditions, frame.names
    machine.budget.step(len(start) // _NAMES_A_STEP)
    first = _follow(machine, body, condition, before, start, frame, loop=loop)
    second = _follow(machine, other, opposite_of(condition), before, start, frame)
    # If the branches end differently, the rest runs only after the branch that continues, or that leaves fewer blocks.
    signal = min(first.signal, second.signal)
    _note_fallbacks(machine, condition, *((first, second) if condition.wanted else (second, first)))
    rest: list[LaunchCondition] = []
    for side in (first, second):
        if side.signal == signal:
            rest += _bars(machine, side.exits, len(before))
            frame.exits += side.exits
            continue
        stops = side.signal == LEAVE and _stops(side.block)
        if stops:
            machine.asked.pop(condition.texts, None)  # the program does not continue without the file
        if stops and gives_up(side.block, everywhere=not before):
            continue
        rest.append(opposite_of(side.taken))
        if stops:
            continue  # the exit is not recorded: code around the block runs only if nothing fails
        if side.signal == LEAVE and all(way_out.signal == LEAVE for way_out in side.exits):
            frame.exits.append(Exit(LEAVE, (*before, side.taken), side.names))
        else:
            frame.exits += [*side.exits, Exit(side.signal, side.conditions, side.names)]
    machine.conditions = (*before, *rest)
    frame.names = start
    for name in {**first.names.changed, **second.names.changed}:
        sides = [side for side in (first, second) if name in side.names]
        if len(sides) == 2 and first.signal == second.signal:
            held = (condition,), (opposite_of(condition),)
            start[name] = _joined(machine, first.names[name], held[0], second.names[name], held[1])
        elif sides:
            start[name] = min(sides, key=lambda side: side.signal).names[name]
        else:
            start.discard(name)
    return signal


def _note_fallbacks(machine: Interpreter, condition: LaunchCondition, present: _Side, absent: _Side) -> None:
    """Record the texts that the program uses in place of a missing file, if ``condition`` tests whether the file exists.

    ``present`` is the branch for an existing file, ``absent`` the branch for a missing file.
    """
    tested = machine.asked.get(condition.texts, ())
    if tested:
        for name, value in absent.names.items():
            if name in present.names and value is not present.names[name]:
                machine.fallbacks += [(text, tested) for text in machine.texts(settled(value))]


def _follow(
    machine: Interpreter,
    block: Sequence[ast.stmt],
    taken: LaunchCondition,
    before: Conditions,
    start: Names,
    frame: Frame,
    *,
    loop: bool = False,
) -> _Side:
    machine.conditions, frame.names, known = (*before, taken), Names(start), len(frame.exits)
    try:
        signal = machine.execute(block, frame)
    except ProgramRaised:
        signal = LEAVE
    exits = frame.exits[known:]
    del frame.exits[known:]
    if loop:
        signal = LEAVE if signal == LEAVE else NEXT
        for way_out in exits:
            if way_out.signal != LEAVE:
                _join_exit(machine, frame, way_out, (*before, taken))
        exits = [way_out for way_out in exits if way_out.signal == LEAVE]
    return _Side(block, taken, signal, frame.names, machine.conditions, exits)


def _join(machine: Interpreter, frame: Frame, held: Conditions, names: Names, conditions: Conditions) -> None:
    """Add ``names`` to the names of a function (``frame``). A name with different values gets both values as alternatives.

    The values in ``names`` hold under ``conditions``, the values in the frame under ``held``.
    """
    for name, value in names.items():
        if name not in frame.names:
            frame.names[name] = value
        elif frame.names[name] is not value:
            frame.names[name] = _joined(machine, frame.names[name], held, value, conditions)


def _joined(machine: Interpreter, first: Value, held: Conditions, second: Value, conditions: Conditions) -> Value:
    if same(first, second):
        return first
    return Pending((Guarded(first, held), Guarded(second, conditions)), machine.joined)


def _join_exit(machine: Interpreter, frame: Frame, way_out: Exit, around: Conditions) -> None:
    taken = _beyond(way_out, around)
    _join(machine, frame, (complement(taken, machine.fresh),), way_out.names, taken)


def _beyond(way_out: Exit, around: Iterable[LaunchCondition]) -> Conditions:
    """Return the conditions of an exit, such as a ``return`` in a branch, without the conditions ``around``."""
    known = list(around)
    return tuple([condition for condition in way_out.conditions if condition not in known])


def _bars(machine: Interpreter, exits: Iterable[Exit], depth: int) -> list[LaunchCondition]:
    """Return the conditions under which the program takes none of ``exits`` (such as a ``return`` in a branch).

    The first ``depth`` conditions of each exit are ignored, because they hold in any case.
    """
    bars: list[LaunchCondition] = []
    exits = list(exits)
    if len(exits) > _MOST_CONDITIONS:
        return [machine.fresh(PERHAPS)]
    for way_out in exits:
        bars.append(complement(_beyond(way_out, (*way_out.conditions[:depth], *bars)), machine.fresh))
    return bars


def gives_up(body: Sequence[ast.stmt], *, everywhere: bool) -> bool:
    """Return whether a block of an if or try statement ends the launch file, so that the code after it is unconditional.

    A block with ``raise`` or ``exit()`` as its last statement ends the launch file. ``everywhere`` is True if no conditions hold
    around the statement. If ``everywhere`` is False, ``raise Error("...")`` does not count, because its message says what
    the users of that branch have to install.
    """
    last = body[-1] if body else None
    return _stops(body) and (everywhere or not (isinstance(last, ast.Raise) and isinstance(last.exc, ast.Call)))


def _stops(body: Sequence[ast.stmt]) -> bool:
    """Return whether a block ends with ``raise`` or a call of exit(), quit() or _exit().

    Code outside of the block may catch the exception.
    """
    last = body[-1] if body else None
    if isinstance(last, ast.Raise):
        return True
    return isinstance(last, ast.Expr) and isinstance(last.value, ast.Call) and callee(last.value) in ("exit", "quit", "_exit")


class _Loop:
    """A loop whose iterations are interpreted one by one."""

    def __init__(self, machine: Interpreter, frame: Frame) -> None:
        self._machine = machine
        self._frame = frame
        self._before = machine.conditions
        self._known = len(frame.exits)
        self._bars: list[LaunchCondition] = []
        """The conditions under which the loop continues after the iterations so far."""
        self.exits: list[Exit] = []
        """The exits of the loop so far: ``break`` and ``return``, with their conditions."""
        self.ended = False
        """True if the program certainly takes one of the exits."""

    def turn(self, body: Sequence[ast.stmt], guards: Conditions = ()) -> None:
        """Interpret the body for one iteration, which runs only under the conditions ``guards``."""
        machine, frame = self._machine, self._frame
        around = machine.conditions = (*self._before, *self._bars, *guards)
        before = Names(frame.names) if guards else Names()
        signal = machine.execute(body, frame)
        exits = frame.exits[self._known :]
        del frame.exits[self._known :]
        if signal in (BREAK, LEAVE):
            exits.append(Exit(signal, machine.conditions, Names(frame.names)))
        for way_out in exits:
            if way_out.signal == CONTINUE:
                _join_exit(machine, frame, way_out, around)
                continue
            taken = _beyond(way_out, (*self._before, *self._bars))
            self.exits.append(way_out)
            self.ended = self.ended or not taken
            self._bars.append(complement(taken, machine.fresh))
        if len(self._bars) > _MOST_CONDITIONS:
            self._bars = [machine.fresh(PERHAPS)]
        if guards:
            _join(machine, frame, guards, before, (complement(guards, machine.fresh),))
        machine.conditions = (*self._before, *self._bars)

    def end(self, orelse: Sequence[ast.stmt]) -> int:
        """Interpret the else block of the loop, join the values of the names at all exits, and return how the loop ends.

        The result is NEXT, CONTINUE, BREAK or LEAVE, because the else block may contain ``break`` of an outer loop.
        """
        machine, frame = self._machine, self._frame
        breaks = [way_out for way_out in self.exits if way_out.signal == BREAK]
        leaves = [way_out for way_out in self.exits if way_out.signal == LEAVE]
        signal = LEAVE if self.ended else machine.execute(orelse, frame)
        if not breaks and (signal or not leaves):
            machine.conditions = self._before
            frame.exits += leaves
            return signal
        if signal:
            frame.names.become(breaks.pop().names)
            if not self.ended:
                leaves.append(Exit(signal, machine.conditions, Names(frame.names)))
        for way_out in breaks:
            _join_exit(machine, frame, way_out, self._before)
        machine.conditions = (*self._before, *_bars(machine, leaves, len(self._before)))
        frame.exits += leaves
        return NEXT


def follow_for(machine: Interpreter, node: ast.For | ast.AsyncFor, frame: Frame) -> int:
    """Interpret a for loop, and return how it ends: NEXT, CONTINUE, BREAK or LEAVE. Raises ProgramRaised and BudgetExceeded."""
    of = machine.evaluate(node.iter, frame)
    values: Iterable[Value] | None = plain(of)
    if type(values) is not list and not isinstance(values, Iterator):  # these may change in the body
        values = items(machine, of)
    if values is None:
        bind(machine, node.target, cause(of, "element of an unknown value"), frame)
        return _perhaps(machine, node.body, frame, node.iter)
    loop = _Loop(machine, frame)
    for turn, value in enumerate(values):
        if turn > machine.most_turns:
            raise BudgetExceeded
        machine.budget.step()
        if not machine.is_here(value):
            continue
        guards = next(alternatives(value)).conditions if isinstance(value, Guarded) else ()
        bind(machine, node.target, plain(value), frame)
        loop.turn(node.body, guards)
        if loop.ended:
            break
    return loop.end(node.orelse)


def follow_while(machine: Interpreter, node: ast.While, frame: Frame) -> int:
    """Interpret a while loop, and return how it ends: NEXT, CONTINUE, BREAK or LEAVE. Raises ProgramRaised and BudgetExceeded."""
    loop = _Loop(machine, frame)
    for _ in range(machine.most_turns):
        machine.budget.step()
        answer, _condition = truth(machine, machine.evaluate(node.test, frame))
        if answer is None:
            signal = _perhaps(machine, node.body, frame, node.test)
            return loop.end(()) if signal == NEXT else signal
        if answer:
            loop.turn(node.body)
            loop.ended = loop.ended or (isinstance(node.test, ast.Constant) and len(loop.exits) > _MOST_EXITS)
        if loop.ended or not answer:
            return loop.end(node.orelse)
    raise BudgetExceeded


def _perhaps(machine: Interpreter, body: Sequence[ast.stmt], frame: Frame, test: ast.expr) -> int:
    """Interpret the body of a loop that runs an unknown number of times, and return how the loop ends.

    The result is NEXT (the statement after the loop runs), because the body may not run at all.
    """
    return either(machine, body, (), PERHAPS, frame, loop=True, test=test)
