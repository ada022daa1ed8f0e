"""Conversion of the objects that a Python launch file returns, or adds to its launch description, to actions."""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING

from ros_lint.base.budget import Budget
from ros_lint.base.text import Span, file_start
from ros_lint.collectors import conditional_text
from ros_lint.collectors.launch.python.substitutions import TextEvaluation, conditions_of, texts
from ros_lint.collectors.python import syntax as python_syntax
from ros_lint.collectors.python.interpreter.alternatives import alternatives, plain, union
from ros_lint.collectors.python.interpreter.values import (
    Conditions,
    Context,
    Frame,
    Function,
    Guarded,
    Instance,
    LaunchObject,
    ProgramRaised,
    Union,
    Unknown,
    Value,
    Written,
)
from ros_lint.collectors.symbolic_text import UNKNOWN, installed
from ros_lint.facts.launch import LaunchAction, LaunchValue
from ros_lint.facts.visibility import Problem

if TYPE_CHECKING:
    from ros_lint.collectors.python.interpreter.protocol import Interpreter
    from ros_lint.collectors.python.interpreter.values import Source

_MAX_DEPTH = 60
_MAX_ACTIONS = 5_000


def _with_text_for_none(value: Guarded | Union, text: str) -> Value:
    """Return a value with ``text`` in place of each alternative that is None."""
    parts = alternatives(value)
    return union(Guarded(text, part.conditions) if part.value is None else part for part in parts)


def span_of(node: python_syntax.Node, source: Source) -> Span:
    """Return the span of a syntax node in a module.

    In ros-lint's model of a helper function of a released package, it is the span of the call of the helper function.
    """
    if not source.ascii:
        return python_syntax.span_of(source.text, node)
    # Columns of the syntax tree count bytes. In ASCII files these are characters, which is the fast case.
    end = node.end_lineno or node.lineno, (node.end_col_offset or node.col_offset) + 1
    return Span(source.text.path, node.lineno, node.col_offset + 1, *end)


def place_of(launch_object: LaunchObject) -> Span:
    """Return the span of the call that creates a launch object (an object of a launch class)."""
    return span_of(launch_object.node, launch_object.source)


class Walker:
    """Converts the objects that a Python launch file launches to actions."""

    def __init__(
        self, machine: Interpreter, source: Source, builders: Mapping[str, ActionBuilder], otherwise: ActionBuilder
    ) -> None:
        """Create a walker for one launch file.

        ``builders`` have a function for each class name that converts objects of this class. ``otherwise`` converts the
        objects of all other classes.
        """
        self.machine = machine
        self._builders = builders
        self._otherwise = otherwise
        self._source = source
        self.problems: list[Problem] = []
        self.unknown_launches: list[tuple[str, Span]] = []
        """Places where an unknown object is launched, each with a reason."""
        self._depth = 0
        self._active: set[int] = set()
        self._budget = Budget(_MAX_ACTIONS)
        self._stopped = False

    def actions(self, value: Value, conditions: Conditions = (), at: Span | None = None) -> list[LaunchAction]:
        """Return the actions that launching ``value`` starts, under ``conditions``. ``at`` is the span for an unknown value."""
        actions: list[LaunchAction] = []
        if self._depth > _MAX_DEPTH:
            self._stop("the actions are nested too deeply", at)
            return actions
        if not self._budget.affords():
            self._stop("there are too many actions", at)
            return actions
        self._depth += 1
        try:
            if not isinstance(value, (Union, Guarded)):
                return self._convert(value, conditions, at)
            for alternative in alternatives(value, conditions):
                actions += self._convert(alternative.value, alternative.conditions, at)
        finally:
            self._depth -= 1
        return actions

    def _convert(self, value: Value, conditions: Conditions, at: Span | None) -> list[LaunchAction]:
        if isinstance(value, Instance) and value.made is not None:
            value = value.made
        if isinstance(value, LaunchObject):
            if id(value) in self._active:
                return []
            value.seen = True
            self._active.add(id(value))
            try:
                return self._build(value, conditions)
            finally:
                self._active.discard(id(value))
        if isinstance(value, (list, tuple)):
            return [action for item in value for action in self.actions(item, conditions, at)]
        if isinstance(value, Unknown) and value.reason:
            self.unknown_launches.append((value.reason, at or file_start(self._source.text.path)))
        return []

    def _build(self, launch_object: LaunchObject, conditions: Conditions) -> list[LaunchAction]:
        conditions = _merged(conditions, launch_object.conditions)
        condition = launch_object.get(-1, "condition")
        if condition is not None:
            conditions = (*conditions, *conditions_of(condition, TextEvaluation(self.machine.budget)))
        if isinstance(condition, Function):  # launch rejects a function as condition, but the package look-ups in it count
            self.run(condition, [Context()], {}, launch_object)
        if launch_object.name == "LaunchDescription":
            return self._description(launch_object, conditions)
        return self._builders.get(launch_object.name, self._otherwise)(self, launch_object, conditions)

    def split_by_conditions(self, action: LaunchAction, target: Value, package: Value = None) -> list[LaunchAction]:
        """Return one action for each alternative of ``target`` if the conditions of all alternatives are known.

        Otherwise, the result is ``action`` alone.
        """
        if action.target is None or len(action.target.texts) == 1:
            return [action]
        targets = self._alternatives(target)
        if not all(_depends(text) for text in targets):
            return [action]
        packages = self._alternatives(package)
        actions: list[LaunchAction] = []
        for text in targets:
            conditions = conditional_text.conditions_of(text)
            together = tuple(
                str(name)
                for name in packages
                if conditional_text.are_consistent((*conditions, *conditional_text.conditions_of(name)))
            )
            actions.append(
                action._replace(
                    target=LaunchValue((str(text),), action.target.span),
                    package=action.package._replace(texts=together, guards=()) if action.package and together else action.package,
                    conditions=_merged(action.conditions, conditions),
                )
            )
        return actions

    def _alternatives(self, value: Value) -> tuple[str, ...]:
        return texts(value, TextEvaluation(self.machine.budget)) if value is not None else ()

    def _description(self, launch_object: LaunchObject, conditions: Conditions) -> list[LaunchAction]:
        actions: list[LaunchAction] = []
        index = 0
        # Functions that are called in the meantime may add entities.
        at = span_of(launch_object.node, launch_object.source)
        while index < len(launch_object.entities) and self._budget.steps > 0:
            actions += self.actions(launch_object.entities[index], conditions, at)
            index += 1
        if index < len(launch_object.entities):
            self._stop("there are too many actions", at)
        return actions

    def _stop(self, reason: str, at: Span | None) -> None:
        """Record, only once, that the conversion is incomplete, with the reason and its span."""
        if not self._stopped:
            self._stopped = True
            self.unknown_launches.append((reason, at or file_start(self._source.text.path)))

    def value(self, launch_object: LaunchObject, position: int, *names: str, absent: str = UNKNOWN) -> LaunchValue | None:
        """Return the possible texts of an argument of a launch object (such as a Node), None if the argument is missing.

        An argument that unknown ``**keywords`` may contain has the text UNKNOWN. ``absent`` is the text of an alternative
        that is None, as in ``name="a" if condition else None``.
        """
        argument = launch_object.get(position, *names)
        if argument is None:
            return self.unknown(launch_object) if launch_object.may_hide(*names) else None
        if isinstance(argument, (Guarded, Union)):
            argument = _with_text_for_none(argument, absent)
        return self.text(argument, launch_object.written(position, *names), launch_object.source)

    def unknown(self, launch_object: LaunchObject) -> LaunchValue:
        """Return the value that represents an unknown argument of a launch object (such as a Node)."""
        return LaunchValue((UNKNOWN,), place_of(launch_object))

    def text(self, value: Value, node: ast.expr, source: Source) -> LaunchValue:
        """Return the possible texts of a value.

        Their span is that of the string literal from which the value comes, else that of ``node``.
        """
        symbolic = (value,) if isinstance(value, str) else texts(value, TextEvaluation(self.machine.budget))
        choices = _plain(symbolic)
        guards = _guards(symbolic, choices)
        origin = plain(value)
        while isinstance(origin, LaunchObject) and origin.name in ("TextSubstitution", "ParameterFile", "ParameterValue"):
            origin = plain(origin.get(0, "text", "param_file", "value"))
        if isinstance(origin, (list, tuple)) and len(origin) == 1:
            origin = plain(origin[0])
        if isinstance(origin, Written):
            node, source = origin.node, origin.source
        span = span_of(node, source)
        if not isinstance(node, ast.Constant) or len(choices) != 1 or not choices[0] or node.value != choices[0]:
            return LaunchValue(choices, span, guards=guards)
        path, line, column, last, end = span
        if line == last and end - column == len(choices[0]) + 2:  # the literal contains no escapes
            return LaunchValue(choices, Span(path, line, column + 1, last, end - 1), exact=True)
        at = source.text.text.find(choices[0], *python_syntax.range_of(source.text, node))
        if at < 0:
            return LaunchValue(choices, span)
        return LaunchValue(choices, source.text.span(at, at + len(choices[0])), exact=True)

    def each_text(self, value: Value, node: ast.expr, source: Source) -> list[LaunchValue]:
        """Return the possible texts of a value as separate results, each with its conditions.

        If one of the texts has no conditions, the list contains a single result with all texts.
        """
        combined = self.text(value, node, source)
        if len(combined.texts) == 1:
            return [combined]
        pairs = [(text, conditional_text.conditions_of(text)) for text in self._alternatives(value)]
        if not all(conditions for _, conditions in pairs):
            return [combined]
        return [combined._replace(texts=(str(text),), conditions=conditions, guards=()) for text, conditions in pairs]

    def package_span(self, value: LaunchValue | None) -> Span | None:
        """Return the span of the first look-up of a package whose install path is in a value, None if there is none."""
        for text in value.texts if value is not None else ():
            if text.isascii():
                continue
            for place in installed(text):
                if place.package in self.machine.named:
                    return self.look_up_span(place.package)
        return None

    def look_up_span(self, package: str) -> Span:
        """Return the span of the first look-up of a package. Raises KeyError if the file does not look it up."""
        node, source = self.machine.named[package]
        return self.text(package, node, source).span if isinstance(node, ast.Constant) else span_of(node, source)

    def run(
        self, function: Value, arguments: Sequence[Value], keywords: Mapping[str, Value], launch_object: LaunchObject
    ) -> Value:
        """Return the result of a function that launch calls with the arguments ``arguments``, for example at an event."""
        frame = Frame(launch_object.source, None, {})
        try:
            return self.machine.call(plain(function), list(arguments), dict(keywords), launch_object.node, frame)
        except ProgramRaised:
            return Unknown("the result of a function that raises an exception")


def _plain(texts: Iterable[str]) -> tuple[str, ...]:
    return tuple(dict.fromkeys([str(text) for text in texts]))


def _guards(texts: Iterable[str], choices: tuple[str, ...]) -> tuple[Conditions, ...]:
    """Return the conditions of each of ``choices``, which are ``texts`` without duplicates.

    The result is () if there is only one choice, or if no choice has conditions. The conditions of a choice that occurs in
    ``texts`` with different conditions are ().
    """
    if len(choices) < 2:
        return ()
    conditions: dict[str, Conditions] = {}
    for text in texts:
        own = conditional_text.conditions_of(text)
        conditions[str(text)] = own if conditions.get(str(text), own) == own else ()
    guards = tuple([conditions[choice] for choice in choices])
    return guards if any(guards) else ()


def _merged(left: Conditions, right: Conditions) -> Conditions:
    return (*left, *(condition for condition in right if condition not in left))


def _depends(text: str) -> bool:
    """Return whether a text has conditions, and all of them can be evaluated once the launch arguments have values."""
    conditions = conditional_text.conditions_of(text)
    return bool(conditions) and not any(UNKNOWN in part for condition in conditions for part in condition.texts)


ActionBuilder = Callable[[Walker, LaunchObject, Conditions], list[LaunchAction]]
