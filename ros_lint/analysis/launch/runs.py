"""The processes that a launch file of the workspace starts if it is launched without arguments."""

from __future__ import annotations

from types import MappingProxyType
from typing import TYPE_CHECKING, Literal, NamedTuple

from ros_lint.analysis.launch.includes import assigned_configurations, include_resolver
from ros_lint.collectors.symbolic_text import (
    UNKNOWN,
    configurations,
    fill,
    has_expression,
    installed_place,
    is_settled,
    readable,
    share,
)
from ros_lint.facts.launch import values

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping

    from ros_lint.base.text import Span
    from ros_lint.collectors.launch.expand import Expansion
    from ros_lint.facts.launch import LaunchFile
    from ros_lint.workspace.model import Workspace

_NOTHING: Mapping[str, str] = MappingProxyType({})


class PassedFile(NamedTuple):
    """A file that an included launch file refers to, resolved with the arguments of the including file."""

    package: str
    """Package whose share folder contains the file."""
    path: str
    """The path below share/<package>."""
    kind: Literal["include", "file"]
    """"include" for an included launch file, "file" for a parameter file."""
    span: Span
    """The place of the action that refers to it."""
    via: Span
    """The place of the include in the launched file."""
    depth: int
    """Number of includes between the launched file and the reference."""
    sure: bool
    """False if the reference depends on an unknown value."""


def expand_defaults(
    file: LaunchFile, workspace: Workspace, follow: Callable[[LaunchFile], bool], given: Mapping[str, str] = _NOTHING
) -> Expansion:
    """Return what a launch file starts by default.

    ``follow`` selects the included files that are expanded.
    """
    from ros_lint.collectors.launch.expand import expand  # noqa: PLC0415  (few runs need it)

    place = include_resolver(workspace).place(file)
    if place is not None:
        file = file._replace(path=f"{share(place.package.name)}/{place.path}")

    def included(path: str) -> LaunchFile | None:
        inner = include_resolver(workspace).included(path)
        return inner if inner is not None and follow(inner) else None

    return expand(file, given, included, workspace.target.distro, brief=True)


def passed_files(file: LaunchFile, workspace: Workspace, *, settled: bool = False) -> Iterator[PassedFile]:
    """Yield the files that included launch files refer to when a file is launched.

    With ``settled``, only files that do not depend on the launch arguments.
    """
    expansion = expand_defaults(file, workspace, lambda inner: True)
    if settled:
        open_ = {argument.name: UNKNOWN for argument in expansion.arguments if not argument.given}
        expansion = expand_defaults(file, workspace, lambda inner: True, open_)
    for started in expansion.started:
        if started.via is None:
            continue
        kind: Literal["include", "file"] = "include" if started.kind == "include" else "file"
        named = [started.target] if kind == "include" else [texts for name, texts in started.parameters if not name]
        for texts in named:
            for text in texts:
                place = installed_place(text) if is_settled(text) else None
                if place is not None and place.known and place.share:
                    sure = started.certain and len(texts) == 1
                    yield PassedFile(place.package, place.share, kind, started.span, started.via, started.depth, sure)


class FailingExpression(NamedTuple):
    """An expression that Python cannot evaluate if an argument has its default."""

    argument: str
    """The launch configuration with that default."""
    expression: str
    """The expression with the defaults filled in, for messages."""
    name: str
    """The name that Python does not know; "" if the text is no Python expression."""
    span: Span
    """Place of the expression."""
    conditional: bool
    """True if its action runs only under a condition."""


def failing_expressions(file: LaunchFile) -> Iterator[FailingExpression]:
    """Yield the expressions of a launch file that fail with its default arguments."""
    asked = list(_with_expressions(file))
    defaults = assigned_configurations(file) if asked else {}
    for text, span, conditional in asked:
        for argument, expression, name in _broken(text, defaults):
            yield FailingExpression(argument, readable(expression), name, span, conditional)


def _with_expressions(file: LaunchFile) -> Iterator[tuple[str, Span, bool]]:
    """Yield the texts with expressions, each with its place and whether its action is conditional."""
    waiting = [(action, False) for action in reversed(file.actions)]
    while waiting:
        action, conditional = waiting.pop()
        inner = conditional or bool(action.conditions) or action.kind == "later"
        if action.children:
            waiting += [(child, inner) for child in reversed(action.children)]
        for condition in action.conditions:
            yield from ((text, action.span, conditional) for text in condition.texts if has_expression(text))
        for value in values(action):
            for text in value.texts:
                if has_expression(text):
                    yield text, value.span, inner


def _broken(text: str, defaults: Mapping[str, tuple[str, ...]]) -> Iterator[tuple[str, str, str]]:
    """Yield the argument, the expression and the unknown name of each failing expression in a text."""
    from ros_lint.collectors.launch.expressions import evaluate, refused  # noqa: PLC0415  (imports the Python parser)

    known = {
        name: texts for name, _, candidate in configurations(text) if len(texts := fill(candidate, defaults.get, evaluate)) == 1
    }
    whole, without = _expressions(text, defaults.get), _expressions(text, lambda name: ("_",))
    for expression, itself in zip(whole, without, strict=True) if len(whole) == len(without) else ():
        own, strange = refused(itself), refused(expression)
        if own is None or strange == () or (evaluate(expression) != UNKNOWN and not _TRUTHS.intersection(strange or ())):
            continue
        for name, (value,) in known.items():
            inside = refused(value)
            missing = (
                ""
                if strange is None
                else next((candidate for candidate in strange if candidate not in own and candidate in (inside or ())), "")
            )
            if missing or (strange is None and inside is None):
                yield name, expression, missing
                break


_TRUTHS = frozenset({"true", "false"})
"""Boolean values of launch that Python does not know."""


def _expressions(text: str, values_of: Callable[[str], tuple[str, ...] | None]) -> list[str]:
    """Return the expressions in a text with the values of configurations, nested ones included."""
    result: list[str] = []

    def take(expression: str) -> str:
        result.append(expression)
        return UNKNOWN

    fill(text, values_of, take)
    return result
