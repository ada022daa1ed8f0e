"""Side effects that are recorded while a program is interpreted: package look-ups, read files, conditions, variables."""

from __future__ import annotations

import ast
from collections.abc import Iterable, Sequence
from typing import Literal, NamedTuple

from ros_lint.base.budget import Budget
from ros_lint.collectors.conditional_text import are_consistent
from ros_lint.collectors.python.interpreter.alternatives import alternatives, around, union
from ros_lint.collectors.python.interpreter.complements import complement
from ros_lint.collectors.python.interpreter.values import (
    PERHAPS,
    Conditions,
    Guarded,
    Instance,
    LaunchObject,
    Source,
    Union,
    Unknown,
    Value,
    environment,
)
from ros_lint.collectors.symbolic_text import UNKNOWN, named_in
from ros_lint.facts.launch import LaunchCondition

How = Literal["added", "joined", "formatted", "compared", "tested", "combined"]
"""The operation by which a program wrongly uses a launch substitution or condition as a text or truth value."""


_MOST_ESCAPING = 1_000
"""The maximum number of values that one call of Recorder.escape() marks as passed to code that is not interpreted."""
_VALUES_A_STEP = 10
"""The number of values that Recorder.escape() marks for one step of the budget, which limits the work of the interpreter."""


class Misused(NamedTuple):
    """An operation that uses a substitution or condition of launch as a text or truth value."""

    how: How
    made: LaunchObject
    node: ast.expr
    source: Source


def are_unknown(conditions: Conditions) -> bool:
    """Return whether any of ``conditions`` depends on an unknown value."""
    return any(UNKNOWN in text for condition in conditions for text in condition.texts)


class Recorder:
    """The effects of a program that are recorded while it is interpreted, and the conditions under which its code runs."""

    def __init__(self, budget: Budget) -> None:
        self.budget = budget
        self._branches = 0
        self._variables: dict[str, Value] = {}
        self._removed: dict[tuple[str, ...], frozenset[LaunchCondition]] = {}
        """The conditions under which an element was removed, by the texts of the condition under which the element remains."""
        self.conditions: Conditions = ()
        self.cut_off: list[tuple[str, ast.expr | ast.stmt, Source]] = []
        """Calls that are not interpreted to their end: why, and the statement or expression where their interpretation ends."""
        self.stopped_at: tuple[ast.stmt, Source] | None = None
        """The statement at which the budget was exceeded: of nested statements, the innermost one in the outermost module."""
        self.tests: dict[tuple[str, ...], ast.expr] = {}
        """The expressions that the program tests, by the texts of the conditions under which they are true."""
        self.made: list[LaunchObject] = []
        """All objects of the classes of the launch libraries, in order of creation."""
        self.looked_up: list[tuple[str, ast.expr, Source, Conditions]] = []
        """Packages that the program itself looks up, not launch, with expression, module and conditions of the look-up."""
        self.unbound: list[tuple[ast.Name, Source]] = []
        """Names that were not bound when they were evaluated."""
        self.misused: list[Misused] = []
        """Operations that use a launch substitution or condition as a text or truth value."""
        self.divided: list[tuple[ast.expr, Source]] = []
        """Operations ``text / text``, which raise TypeError."""
        self.wanted: set[str] = set()
        """Modules and files that the program reads, but that are unavailable to the interpreter."""
        self.opened: list[tuple[str, ast.expr, Source, Conditions]] = []
        """Paths of the files that the program has to read, with expression and conditions of each read.

        Reads in a try statement that catches the error of a missing file are omitted.
        """
        self.asked: dict[tuple[str, ...], tuple[str, ...]] = {}
        """Possible paths of a file whose existence the program tests, by the texts of the condition that represents the test.

        The program handles the case that such a file is missing.
        """
        self.fallbacks: list[tuple[str, tuple[str, ...]]] = []
        """Texts that a program uses in place of the path of a file that does not exist, with the possible paths of that file."""
        self.raises: list[tuple[ast.Raise, Source, Conditions]] = []
        """Statements that raise an exception outside of any try statement, with module and conditions, in order."""
        self.borrows = False
        """True if the program imports a module of a released package that is represented by a model, which is incomplete."""
        self.caught = 0
        """The number of try statements with handlers around the interpreted statement."""
        self.guarded = 0
        """The number of try statements around the interpreted statement that catch the error of a missing file."""
        self.read: dict[str, None] = {}
        """Launch configurations whose values functions of the program read while launch runs, in order."""
        self.reads: list[tuple[str, ast.expr, Source, Conditions]] = []
        """Texts with launch configurations that have to be set then, with expression, module and conditions of each reading."""
        self.lazily: set[str] = set()
        """Packages that launch looks up while it runs the launch description, for example for ``FindPackageShare``."""
        self.named: dict[str, tuple[ast.expr, Source]] = {}
        """The first expression that names each looked-up package, a literal if possible, by the name or symbolic text."""
        self.variables: list[LaunchObject] = []
        """Actions that set environment variables of the launch process or launch configurations, in order."""

    def note_read(self, texts: Iterable[str], at: ast.expr | None = None, source: Source | None = None) -> None:
        """Record the launch configurations in texts that the program reads while launch runs.

        ``at`` is the expression that raises an exception if a configuration without default has no value, None if there is none.
        """
        for text in texts:
            names = () if text.isascii() else named_in(text) or ()
            self.read.update(dict.fromkeys(names))
            if names and at is not None and source is not None and not self.caught:
                self.reads.append((text, at, source, self.conditions))

    # --- conditions -----------------------------------------------------------------------------------------------

    def fresh(self, condition: LaunchCondition, test: ast.expr | None = None) -> LaunchCondition:
        """Return ``condition``, or a new unknown condition if ``condition`` is PERHAPS, which represents any unknown condition.

        A new condition differs from all earlier conditions, so that it can be distinguished from its opposite. ``test`` is the
        expression that is true under the condition.
        """
        if condition is PERHAPS:
            condition = LaunchCondition((self.another(),), None)
        if test is not None:
            self.tests.setdefault(condition.texts, test)
        return condition

    def another(self) -> str:
        """Return an unknown text that differs from all earlier unknown texts."""
        self._branches += 1
        return f"{UNKNOWN}{self._branches}"

    def guard(self, value: Value) -> Value:
        """Return ``value`` as an element that a collection has only if the interpreted code runs, as in a branch.

        If the code runs in any case, ``value`` is returned unchanged.
        """
        return Guarded(value, self.conditions) if self.conditions else value

    def is_here(self, value: Value) -> bool:
        """Return whether an element of a collection may exist where the interpreted code runs."""
        if not isinstance(value, Guarded):
            return True
        conditions = around(value)
        removals = [self._removed[condition.texts] for condition in conditions if condition.texts in self._removed]
        return not any(removal.issubset(self.conditions) for removal in removals) and are_consistent(
            (*self.conditions, *conditions)
        )

    def possible(self, value: Value) -> Value:
        """Return a value without the alternatives that contradict the conditions under which the interpreted code runs."""
        if not self.conditions or not isinstance(value, Union):
            return value
        here = [alternative for alternative in alternatives(value) if self.is_here(alternative)]
        return union(here) if here else value

    def present(self, values: Sequence[Value]) -> list[Value]:
        """Return the elements of ``values`` that may exist where the interpreted code runs."""
        return [value for value in values if self.is_here(value)] if self.conditions else list(values)

    def any_perhaps(self, values: Iterable[Value]) -> bool:
        """Return whether an element of a list may be missing where the interpreted code runs."""
        return any(isinstance(value, Guarded) and not set(around(value)) <= {*self.conditions} for value in values)

    def is_at(self, values: Sequence[Value], key: int | slice) -> bool:
        """Return whether it is certain which elements an index or slice of a list selects, although elements may be missing."""
        if isinstance(key, slice):
            return not self.any_perhaps(values)
        return not self.any_perhaps(values[: key + 1] if key >= 0 else values[key:])

    def removed(self, value: Value) -> Value:
        """Return an element that the interpreted code removes, as a value that still exists where this code does not run.

        That is where at least one condition of the code is false.
        """
        first, *others = self.conditions
        remains = first._replace(wanted=not first.wanted)
        if others:
            remains = complement(self.conditions, self.fresh)
            self._removed[remains.texts] = frozenset(self.conditions)
        return Guarded(value, (remains,))

    def stop_at(self, statement: ast.stmt, source: Source) -> None:
        """Record a statement at which the budget was exceeded. Call this method for inner statements before outer statements."""
        if self.stopped_at is None or self.stopped_at[1] is not source:
            self.stopped_at = statement, source

    def joined(self, values: Sequence[Guarded]) -> Value:
        """Return one value with ``values`` as alternatives, Unknown if there are too many alternatives.

        If the result is Unknown, the launch objects in ``values`` are marked as escaped: they may be launched.
        """
        joined_value = union(values)
        if isinstance(joined_value, Unknown):
            self.escape(values)
        return joined_value

    def escape(self, value: Value) -> None:
        """Mark the launch objects in a value as escaped: code that is not interpreted gets the value, and may launch them."""
        waiting, count = [value], 0
        while waiting and count < _MOST_ESCAPING:
            item = waiting.pop()
            count += 1
            if count % _VALUES_A_STEP == 0:
                self.budget.step()
            if isinstance(item, LaunchObject):
                if not item.escaped:
                    item.escaped = True
                    waiting += [*item.arguments, *item.keywords.values(), *item.entities]
            elif isinstance(item, Guarded):
                waiting.append(item.value)
            elif isinstance(item, Union):
                waiting += item.values
            elif isinstance(item, (list, tuple)):
                waiting += item
            elif isinstance(item, dict):
                waiting += item.values()
            elif isinstance(item, Instance):
                waiting += [item.made, *item.attributes.values()] if item.made is not None else item.attributes.values()

    # --- what is asked for, and set -------------------------------------------------------------------------------

    def ask(self, paths: tuple[str, ...]) -> Value:
        """Return the unknown result of a test whether a file exists, and record the possible ``paths`` of the file as tested."""
        answer = LaunchCondition((self.another(),), None)
        self.asked[answer.texts] = paths
        return Unknown("whether a file is there", answer)

    def look_up(self, package: str, at: ast.expr, source: Source, eager: bool, conditions: Conditions) -> None:
        """Record that the expression ``at`` looks up a package by the name ``package``, if ``conditions`` hold.

        ``eager`` is True if the program itself looks up the package, False if launch looks it up later.
        """
        if UNKNOWN not in package and not source.lent:
            known = self.named.get(package)
            if known is None or (_says(at, package) and not _says(known[0], package)):
                self.named[package] = (at, source)
        if eager:
            self.looked_up.append((package, at, source, (*self.conditions, *conditions)))
        else:
            self.lazily.add(package)

    def set_variable(self, name: str, value: Value, at: ast.Call, source: Source) -> None:
        """Record that the call ``at`` sets an environment variable, for all code that is interpreted after the call."""
        made = LaunchObject("SetEnvironmentVariable", [name, value], {}, at, source)
        made.conditions = self.conditions
        self.variables.append(made)
        self._variables[name] = union([self.variable(name), self.guard(value)]) if self.conditions else value

    def set_configuration(self, name: str, value: Value, at: ast.Call, source: Source) -> None:
        """Record that the assignment ``at``, in a function to which launch passes its context, sets a launch configuration."""
        made = LaunchObject("SetLaunchConfiguration", [name, value], {}, at, source)
        made.conditions = self.conditions
        self.variables.append(made)

    def variable(self, name: str, default: str | None = None) -> Value:
        """Return the value of an environment variable: the value that the program set, else a text known only at launch."""
        return self._variables[name] if name in self._variables else environment(name, default)

    def sets(self, names: Iterable[str]) -> bool:
        """Return whether the program has set any of the environment variables ``names``."""
        return not self._variables.keys().isdisjoint(names)


def _says(node: ast.expr, text: str) -> bool:
    return isinstance(node, ast.Constant) and node.value == text
