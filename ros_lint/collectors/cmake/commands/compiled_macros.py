"""Compiled forms of the macros of released packages, because a workspace calls these macros very often.

Most macros have a cmake_parse_arguments() and a few commands. Such a macro runs in compiled form if its arguments are plain
text. All other macros, and all functions, are interpreted.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from functools import cache, partial
from typing import Final, NamedTuple

from ros_lint.base.text import Text
from ros_lint.collectors.cmake.evaluator.arguments import parse_keywords
from ros_lint.collectors.cmake.evaluator.blocks import Body, Definition, If, blocks
from ros_lint.collectors.cmake.evaluator.definitions import reads_argument_variables
from ros_lint.collectors.cmake.evaluator.expansion import Template, expand, template
from ros_lint.collectors.cmake.evaluator.flow import HANDLERS, call, run_conditionally, run_named
from ros_lint.collectors.cmake.evaluator.run import Run
from ros_lint.collectors.cmake.evaluator.state import BY_DEFAULT, IF_TESTING, NEXT, STOP, CallFrame, Exit, Procedure
from ros_lint.collectors.cmake.evaluator.values import join, split
from ros_lint.collectors.cmake.released_macros import macros
from ros_lint.collectors.cmake.syntax import QUOTED, UNQUOTED, Command, parse

_NOT_PLAIN = re.compile(r"[\0\2$\\;\[]")
_TESTS: Final = "BUILD_TESTING"


_Reference = tuple[str, Template, bool]
"""An argument with variable references: the variable's name, the parsed argument, and True if it is quoted.

The name is "" unless the argument is a single reference such as ``${name}``."""
_Conditions = tuple[tuple[str, bool], ...]
"""Keywords of a macro call (or BUILD_TESTING), each with True if it must be present, False if it must be absent."""
_Step = tuple[str, tuple[str | _Reference, ...], _Conditions]
"""A command of a compiled macro: its name, its arguments, and the conditions under which it runs."""
_Keywords = tuple[str, str, str, str]
"""The first arguments of cmake_parse_arguments(): prefix, options, one-value keywords and multi-value keywords."""


class ReleasedMacros(NamedTuple):
    """A macro or function of a released package, with its compiled form."""

    procedure: Procedure
    direct: tuple[str, list[str]] | None
    """For a macro that only passes its arguments on to one command ``ros_lint_*``: the command and its first arguments.

    The first arguments are those before the passed arguments. None for any other macro."""
    keywords: _Keywords | None
    steps: tuple[_Step, ...] | None
    """The commands of the compiled macro, None if the macro cannot be compiled."""
    frame: CallFrame


@cache
def released(name: str) -> ReleasedMacros | None:
    """Return the CMake macro or function ``name`` (in lower case) of a released package, None if no package has it."""
    macro = macros().get(name)
    if macro is None:
        return None
    (node,) = blocks(parse(Text("ros_macros.cmake", macro.text)).commands)
    assert isinstance(node, Definition)
    _, *parameters = [argument[0] for argument in node.command.args]
    is_macro = node.command.name == "macro"
    procedure = Procedure(
        name, is_macro, tuple(parameters), node.body, False, "", "", macro.package, reads_argument_variables(node.body)
    )
    keywords, body = _split_keywords(node.body)
    steps = tuple(_steps(body, keywords[0] if keywords else "", ())) if is_macro else (None,)
    compiled = None if None in steps else tuple(step for step in steps if step is not None)
    return ReleasedMacros(procedure, _direct(node.body, parameters), keywords, compiled, CallFrame(False, "", "", procedure))


def _direct(body: Body, parameters: Sequence[str]) -> tuple[str, list[str]] | None:
    if len(body) == 1 and isinstance(only := body[0], Command) and only.name.startswith("ros_lint_"):
        words = [argument[0] for argument in only.args]
        forwarded = [f"${{{parameter}}}" for parameter in (*parameters, "ARGN")]
        first = len(words) - len(forwarded)
        if words[first:] == forwarded and not any("$" in word for word in words[:first]):
            return only.name, words[:first]
    return None


def _split_keywords(body: Body) -> tuple[_Keywords | None, Body]:
    if body and isinstance(first := body[0], Command) and first.name == "cmake_parse_arguments":
        texts = [argument[0] for argument in first.args]
        if texts[4:] == ["${ARGN}"]:
            return (texts[0], texts[1], texts[2], texts[3]), body[1:]
    return None, body


def _steps(body: Body, prefix: str, conditions: _Conditions) -> Iterator[_Step | None]:
    """Yield each command of a macro with its conditions, the enclosing if(). Yield None for code that cannot be compiled."""
    for node in body:
        if isinstance(node, Command):
            if node.name == "set" and prefix and node.args[0][0].startswith(f"{prefix}_"):
                yield None  # the values of keywords must not change
            yield node.name, tuple([_argument(text, kind) for text, kind, _, _ in node.args]), conditions
        elif isinstance(node, If) and len(node.branches) <= 2 and node.branches[-1][0] in (None, node.command):
            words = [argument[0] for argument in node.command.args]
            name, expected = words[-1], words[0] != "NOT"
            if len(words) != 2 - expected or not (name == _TESTS or (prefix and name.startswith(f"{prefix}_"))):
                yield None
            for (_, branch_body), value in zip(node.branches, (expected, not expected), strict=False):
                yield from _steps(branch_body, prefix, (*conditions, (name, value)))
        else:
            yield None


def _argument(text: str, kind: int) -> str | _Reference:
    if kind not in (UNQUOTED, QUOTED):
        return text
    parts = template(text)
    if isinstance(parts, str):
        return parts, (("", (parts,)),), kind == QUOTED
    return "", parts, kind == QUOTED


def run_released(run: Run, macro: ReleasedMacros, args: list[str]) -> Exit:
    """Run a macro or function of a released package with evaluated arguments. Return the ways in which it may end."""
    text = "".join(args)
    if macro.direct is not None and ";" not in text:
        primitive, words = macro.direct
        run.command_names.add(primitive)
        return HANDLERS[primitive](run, [*words, *args]) or NEXT
    if macro.steps is None or _NOT_PLAIN.search(text):
        return call(run, macro.procedure, args)
    parameters = macro.procedure.parameters
    rest = [arg for arg in args[len(parameters) :] if arg]
    values: dict[str, str | None] = parse_keywords(*macro.keywords, rest) if macro.keywords else {}
    values.update(zip(parameters, args, strict=False))
    for name in parameters[len(args) :]:
        values[name] = ""
    values["ARGN"] = join(rest)
    run.frames.append(macro.frame)
    try:
        return _run_steps(run, macro.steps, values, 0)
    finally:
        run.frames.pop()


def _run_steps(run: Run, steps: Sequence[_Step], values: dict[str, str | None], start: int) -> Exit:
    run.budget.step(len(steps) - start)
    for index in range(start, len(steps)):
        name, arguments, conditions = steps[index]
        tests = False
        if conditions:
            if not all(_is_met(values, *condition) for condition in conditions):
                continue
            tests = not run.testing and (_TESTS, True) in conditions
        args = _evaluate(run, arguments, values)
        if tests:
            run.testing = True
        try:
            handler = HANDLERS.get(name)
            if handler is None or name in run.procedures:
                exits = run_named(run, name, args)
            else:
                run.command_names.add(name)
                exits = handler(run, args) or NEXT
        finally:
            if tests:
                run.testing = False
        if exits == NEXT or exits == NEXT | STOP:
            continue
        if not exits & NEXT:
            return exits
        run.budget.steps += len(steps) - index - 1  # _run_steps() counts the rest again
        rest, changes = run_conditionally(run, partial(_run_steps, run, steps, values, index + 1), exits)
        run.join([{}, changes], 1 if exits & BY_DEFAULT else None)
        return (exits & ~(NEXT | BY_DEFAULT | IF_TESTING)) | rest
    return NEXT


def _is_met(values: dict[str, str | None], name: str, expected: bool) -> bool:
    return expected == (name == _TESTS or values.get(name) not in (None, "", "FALSE"))


def _evaluate(run: Run, arguments: Sequence[str | _Reference], values: dict[str, str | None]) -> list[str]:
    values_of_arguments: list[str] = []
    value: str | None
    for arg in arguments:
        if isinstance(arg, str):
            values_of_arguments.append(arg)
            continue
        name, parts, quoted = arg
        if name:
            value = values[name] if name in values else run.get(name)
        else:
            value = expand(parts, lambda name, space: values[name] or "" if name in values else run.lookup(name, space))
        if quoted:
            values_of_arguments.append(value or "")
        elif value and ";" in value:
            values_of_arguments += split(value)
        elif value:
            values_of_arguments.append(value)
    return values_of_arguments
