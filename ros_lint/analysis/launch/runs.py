"""The processes that a launch file of the workspace starts, and the files that it uses, if launch arguments have defaults."""

from __future__ import annotations

from types import MappingProxyType
from typing import TYPE_CHECKING, Literal, NamedTuple

from ros_lint.analysis.launch.includes import assigned_configurations, include_resolver
from ros_lint.analysis.launch.workspace_files import launch_file
from ros_lint.analysis.memo import cached_by_name
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
    from ros_lint.collectors.launch.expansion import Expansion
    from ros_lint.facts.launch import LaunchFile
    from ros_lint.workspace.model import Workspace

_NOTHING: Mapping[str, str] = MappingProxyType({})


class PassedFile(NamedTuple):
    """A launch file or parameter file to which an included launch file refers, given the arguments of the include."""

    package: str
    """Package whose share folder contains the file."""
    path: str
    """Path below share/<package>."""
    kind: Literal["include", "file"]
    """"include" for an included launch file, "file" for a parameter file."""
    span: Span
    """The place of the action that refers to the file."""
    via: Span
    """The place of the include in the launched file."""
    depth: int
    """Number of includes between the launched file and the reference."""
    sure: bool
    """False if the reference depends on a value that is unknown."""


def expand_defaults(
    file: LaunchFile, workspace: Workspace, follow: Callable[[LaunchFile], bool], arguments: Mapping[str, str] = _NOTHING
) -> Expansion:
    """Return the processes and includes that result from launching a file with ``arguments``.

    Other launch arguments have their defaults. ``follow`` returns True for each included file that is to be launched, too.
    """
    from ros_lint.collectors.launch.expand import expand  # noqa: PLC0415  (few runs need it)

    place = include_resolver(workspace).place(file)
    if place is not None:
        file = file._replace(path=f"{share(place.package.name)}/{place.path}")

    def included(path: str) -> LaunchFile | None:
        inner = include_resolver(workspace).included(path)
        return inner if inner is not None and follow(inner) else None

    return expand(file, arguments, included, workspace.target.distro, brief=True)


def passed_files(file: LaunchFile, workspace: Workspace, *, settled: bool = False) -> tuple[PassedFile, ...]:
    """Return the files to which the included files refer if a launch file of the workspace is launched without arguments.

    They are launch files and parameter files. ``settled`` limits the result to files that do not depend on the launch arguments.
    """
    return (_passed_settled if settled else _passed)(workspace, file.path)


@cached_by_name
def _passed(workspace: Workspace, path: str) -> tuple[PassedFile, ...]:
    file = launch_file(workspace, path)
    return tuple(_passed_in(expand_defaults(file, workspace, lambda inner: True))) if file is not None else ()


@cached_by_name
def _passed_settled(workspace: Workspace, path: str) -> tuple[PassedFile, ...]:
    file = launch_file(workspace, path)
    if file is None:
        return ()
    declared = expand_defaults(file, workspace, lambda inner: True).arguments
    arguments = {argument.name: UNKNOWN for argument in declared if not argument.given}
    return tuple(_passed_in(expand_defaults(file, workspace, lambda inner: True, arguments)))


def _passed_in(expansion: Expansion) -> Iterator[PassedFile]:
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
    """A Python expression (``$(eval ...)``) that fails if a launch argument has its default."""

    argument: str
    """Name of the launch argument or configuration with that default."""
    expression: str
    """The expression with the defaults filled in, for a message."""
    name: str
    """The undefined name in the expression; "" if the text is not a Python expression."""
    span: Span
    """Place of the expression."""
    conditional: bool
    """True if the action with the expression runs only under a condition."""


def failing_expressions(file: LaunchFile) -> Iterator[FailingExpression]:
    """Yield the Python expressions of a launch file that fail if launch arguments have their defaults."""
    sites = list(_with_expressions(file))
    defaults = assigned_configurations(file) if sites else {}
    for text, span, conditional in sites:
        for argument, expression, name in _broken(text, defaults):
            yield FailingExpression(argument, readable(expression), name, span, conditional)


def _with_expressions(file: LaunchFile) -> Iterator[tuple[str, Span, bool]]:
    """Yield the texts of a launch file that contain a Python expression.

    Each text comes with its place, and with True if its action runs only under a condition.
    """
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
    """Yield each Python expression in a launch text that fails because a launch argument has its default.

    Each result has the argument, the expression, and the undefined name ("" if the expression is no valid Python).
    """
    from ros_lint.collectors.launch.expressions import evaluate, unresolved_names  # noqa: PLC0415  (imports the Python parser)

    known = {
        name: texts for name, _, candidate in configurations(text) if len(texts := fill(candidate, defaults.get, evaluate)) == 1
    }
    filled, bare = _expressions(text, defaults.get), _expressions(text, lambda name: ("_",))
    for expression, bare_expression in zip(filled, bare, strict=True) if len(filled) == len(bare) else ():
        undefined_always, undefined = unresolved_names(bare_expression), unresolved_names(expression)
        if undefined_always is None or undefined == ():
            continue
        if evaluate(expression) != UNKNOWN and not _TRUTHS.intersection(undefined or ()):
            continue
        for name, (value,) in known.items():
            undefined_in_value = unresolved_names(value)
            missing = next(
                (
                    candidate
                    for candidate in undefined or ()
                    if candidate not in undefined_always and candidate in (undefined_in_value or ())
                ),
                "",
            )
            if missing or (undefined is None and undefined_in_value is None):
                yield name, expression, missing
                break


_TRUTHS = frozenset({"true", "false"})
"""Boolean values of launch that Python does not know."""


def _expressions(text: str, values_of: Callable[[str], tuple[str, ...] | None]) -> list[str]:
    """Return the Python expressions in a launch text. ``values_of`` returns the values that replace a launch configuration.

    Nested expressions are included.
    """
    result: list[str] = []

    def take(expression: str) -> str:
        result.append(expression)
        return UNKNOWN

    fill(text, values_of, take)
    return result
