"""What is found out while a Python launch file is followed, besides what it makes: what it looks up, reads, asks for and sets."""

from __future__ import annotations

import ast
from collections.abc import Iterable, Sequence
from typing import Literal, NamedTuple

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
    union,
)
from ros_lint.collectors.symbolic_text import UNKNOWN
from ros_lint.facts.launch import LaunchCondition

How = Literal["added", "joined", "formatted", "compared", "tested", "combined"]
"""The operation that takes a substitution for a text."""


class Misused(NamedTuple):
    """A place where a substitution is taken for a text."""

    how: How
    made: LaunchObject
    node: ast.expr
    source: Source


def are_unknown(conditions: Conditions) -> bool:
    """Return whether any of some conditions depends on an unknown value."""
    return any(UNKNOWN in text for condition in conditions for text in condition.texts)


class Recorder:
    """What is found out about one launch file and the modules that it imports, and the conditions that hold just now."""

    def __init__(self) -> None:
        self._branches = 0
        self._variables: dict[str, Value] = {}
        self.conditions: Conditions = ()
        self.made: list[LaunchObject] = []
        """Everything made of the classes of the launch libraries, in order."""
        self.looked_up: list[tuple[str, ast.expr, Source, Conditions]] = []
        """Packages looked up at once, where, and under which conditions."""
        self.unbound: list[tuple[ast.Name, Source]] = []
        """Names met that nothing has bound so far."""
        self.misused: list[Misused] = []
        """Substitutions that were taken for texts."""
        self.wanted: set[str] = set()
        """Modules and files that are read and were not at hand."""
        self.opened: list[tuple[str, ast.expr, Source, Conditions]] = []
        """Paths of files that are opened at once to be read, where, and under which conditions: those that must be there."""
        self.asked: dict[tuple[str, ...], tuple[str, ...]] = {}
        """Paths of files that it asks for, by what stands for the answer: it does without those that are not there."""
        self.borrows = False
        """Whether it calls helpers of released packages, of which not everything is known."""
        self.guarded = 0
        """How many statements around would catch that a file is missing."""
        self.lazily: set[str] = set()
        """Packages that are looked up when something is launched."""
        self.named: dict[str, tuple[ast.expr, Source]] = {}
        """Where each package that is looked up is written first, by its name or, if it hangs on arguments, by its text."""
        self.variables: list[LaunchObject] = []
        """What sets environment variables of the process that launches, in order."""

    # --- conditions -----------------------------------------------------------------------------------------------

    def fresh(self, condition: LaunchCondition) -> LaunchCondition:
        """Return a condition of which nothing is known as one that its own opposite can be told from."""
        return condition if condition is not PERHAPS else LaunchCondition((self.another(),), None)

    def another(self) -> str:
        """Return a text of which nothing is known but that it is no other one."""
        self._branches += 1
        return f"{UNKNOWN}{self._branches}"

    def guard(self, value: Value) -> Value:
        """Return a value as it goes into a collection now."""
        return Guarded(value, self.conditions) if self.conditions else value

    def joined(self, values: Sequence[Guarded]) -> Value:
        """Return one of several values. Where these are too many to be kept apart, what they hold may be launched."""
        found = union(values)
        if isinstance(found, Unknown):
            self.escape(values)
        return found

    def escape(self, value: Value) -> None:
        """Note that a value goes where it cannot be followed: what it holds may be launched."""
        waiting, count = [value], 0
        while waiting and count < 1_000:
            one = waiting.pop()
            count += 1
            if isinstance(one, LaunchObject):
                if not one.escaped:
                    one.escaped = True
                    waiting += [*one.arguments, *one.keywords.values(), *one.entities]
            elif isinstance(one, Guarded):
                waiting.append(one.value)
            elif isinstance(one, Union):
                waiting += one.values
            elif isinstance(one, (list, tuple)):
                waiting += one
            elif isinstance(one, dict):
                waiting += one.values()
            elif isinstance(one, Instance):
                waiting += [one.made, *one.attributes.values()] if one.made is not None else one.attributes.values()

    # --- what is asked for, and set -------------------------------------------------------------------------------

    def ask(self, paths: tuple[str, ...]) -> Value:
        """Return whether a file is there, which is not known."""
        answer = LaunchCondition((self.another(),), None)
        self.asked[answer.texts] = paths
        return Unknown("whether a file is there", answer)

    def look_up(self, package: str, at: ast.expr, source: Source, eager: bool, conditions: Conditions) -> None:
        """Note that a package is looked up; ``conditions`` are those under which it is this one."""
        if UNKNOWN not in package and not source.lent:
            known = self.named.get(package)
            if known is None or (_says(at, package) and not _says(known[0], package)):
                self.named[package] = (at, source)
        if eager:
            self.looked_up.append((package, at, source, (*self.conditions, *conditions)))
        else:
            self.lazily.add(package)

    def set_variable(self, name: str, value: Value, at: ast.Call, source: Source) -> None:
        """Note that an environment variable is set for all that comes after it."""
        made = LaunchObject("SetEnvironmentVariable", [name, value], {}, at, source)
        made.conditions = self.conditions
        self.variables.append(made)
        self._variables[name] = union([self.variable(name), self.guard(value)]) if self.conditions else value

    def variable(self, name: str, default: str | None = None) -> Value:
        """Return the value of an environment variable."""
        return self._variables[name] if name in self._variables else environment(name, default)

    def sets(self, names: Iterable[str]) -> bool:
        """Return whether any of some environment variables has been set."""
        return not self._variables.keys().isdisjoint(names)


def _says(node: ast.expr, text: str) -> bool:
    return isinstance(node, ast.Constant) and node.value == text
