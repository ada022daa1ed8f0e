"""What a launch file of the workspace starts when it is launched without arguments."""

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
    """A file that a launch file names which another one includes, as it is with what that one passes on."""

    package: str
    path: str
    """Below share/<package>."""
    kind: Literal["include", "file"]
    """Whether it is included, or a file of parameters."""
    span: Span
    """Of the action that names it."""
    via: Span
    """Of the include in the file that is launched."""
    depth: int
    """How many includes lie between."""
    sure: bool
    """False when it depends on something that is not known."""


def expand_defaults(
    file: LaunchFile, workspace: Workspace, follow: Callable[[LaunchFile], bool], given: Mapping[str, str] = _NOTHING
) -> Expansion:
    """Return what a launch file starts by itself, in brief, with those of the files that it includes that are to be followed."""
    from ros_lint.collectors.launch.expand import expand  # noqa: PLC0415  (most runs need nothing of it)

    place = include_resolver(workspace).place(file)
    if place is not None:
        file = file._replace(path=f"{share(place.package.name)}/{place.path}")

    def included(path: str) -> LaunchFile | None:
        found = include_resolver(workspace).included(path)
        return found if found is not None and follow(found) else None

    return expand(file, given, included, workspace.target.distro, brief=True)


def passed_files(file: LaunchFile, workspace: Workspace, *, settled: bool = False) -> Iterator[PassedFile]:
    """Yield the files that included launch files name when a file is launched.

    With ``settled`` only those that are the same whatever arguments it is launched with.
    """
    found = expand_defaults(file, workspace, lambda inner: True)
    if settled:
        open_ = {argument.name: UNKNOWN for argument in found.arguments if not argument.given}
        found = expand_defaults(file, workspace, lambda inner: True, open_)
    for started in found.started:
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
    """An expression that Python cannot evaluate as long as an argument has its default."""

    argument: str
    """The launch configuration whose default it is."""
    expression: str
    """With the defaults in it, for people."""
    name: str
    """What Python does not know of it, "" where all of it is no Python."""
    span: Span
    conditional: bool
    """Whether it lies in something that is done only under a condition."""


def failing_expressions(file: LaunchFile) -> Iterator[FailingExpression]:
    """Yield the expressions of a launch file that fail, for the defaults in them, when it is launched without arguments."""
    asked = list(_with_expressions(file))
    defaults = assigned_configurations(file) if asked else {}
    for text, span, conditional in asked:
        for argument, expression, name in _broken(text, defaults):
            yield FailingExpression(argument, readable(expression), name, span, conditional)


def _with_expressions(file: LaunchFile) -> Iterator[tuple[str, Span, bool]]:
    """Yield the texts with expressions, each with its place and whether it lies in something done only under a condition."""
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
    """Yield of each expression in a text that fails the argument, the expression, and the name that is not known."""
    from ros_lint.collectors.launch.expressions import evaluate, refused  # noqa: PLC0415  (it takes the parser of Python)

    given = {name: texts for name, _, one in configurations(text) if len(texts := fill(one, defaults.get, evaluate)) == 1}
    whole, without = _expressions(text, defaults.get), _expressions(text, lambda name: ("_",))
    for expression, itself in zip(whole, without, strict=True) if len(whole) == len(without) else ():
        own, strange = refused(itself), refused(expression)
        if own is None or strange == () or (evaluate(expression) != UNKNOWN and not _TRUTHS.intersection(strange or ())):
            continue
        for name, (value,) in given.items():
            inside = refused(value)
            missing = "" if strange is None else next((one for one in strange if one not in own and one in (inside or ())), "")
            if missing or (strange is None and inside is None):
                yield name, expression, missing
                break


_TRUTHS = frozenset({"true", "false"})
"""What is meant as a truth, and what Python does not know."""


def _expressions(text: str, values_of: Callable[[str], tuple[str, ...] | None]) -> list[str]:
    """Return the expressions in a text, those in others left in, with values for the configurations."""
    found: list[str] = []

    def take(expression: str) -> str:
        found.append(expression)
        return UNKNOWN

    fill(text, values_of, take)
    return found
