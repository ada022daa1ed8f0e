"""
## What it finds

A launch configuration that is read before its argument is declared. A launch file is processed in order.

## Why it matters

The launch file stops: `launch configuration 'x' does not exist`. Only `LaunchConfigurationEquals` continues, and is never true.

## How to fix it

Declare the argument before its first use.

## Limitations

Not reported:

- Configurations that a file which includes this one declares or sets.
- Configurations that may be declared by a file that this one includes earlier.
- All configurations, if a file of the workspace cannot be read, because that file may include this one.

The confidence is medium for configurations that are read under a condition, and if the file requires other arguments, because
it is then probably included by other launch files.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from typing import NamedTuple

from ros_lint.api import (
    Confidence,
    Finding,
    LaunchAction,
    LaunchFile,
    Package,
    Related,
    Rule,
    Severity,
    Span,
    Workspace,
    first_related,
    launch,
)


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    if workspace.unread():
        return
    for launch_file in launch.package_launch_files(package):
        above = launch.include_tree(workspace).above(launch_file.file)
        if above is not None:
            known = {name for configurations in above for name in (*configurations.set_or_passed, *configurations.declared)}
            yield from _too_early(launch_file.file, launch.include_resolver(workspace), known)


def _too_early(file: LaunchFile, resolver: launch.IncludeResolver, above: Collection[str]) -> Iterator[Finding]:
    """Yield a finding for each argument that is read before it is declared, because a launch file is processed in order.

    ``above``: names of the configurations declared or set by files that include ``file``.
    """
    declared: dict[str, tuple[int, Span]] = {}
    for index, action in enumerate(file.actions):
        if action.kind == "argument" and action.target is not None:
            for name in action.target.texts:
                declared.setdefault(name, (index, action.span))
    places: dict[tuple[str, bool | None], list[tuple[Span, bool]]] = {}
    for early in _read_early(file, resolver, {name: at for name, (at, _) in declared.items()}, above):
        places.setdefault((early.name, early.holds), []).append((early.span, early.sure))
    for (name, holds), reads in places.items():
        (first, _), *others = reads
        yield Finding(
            f"launch argument '{name}' is read before it is declared, so {_OUTCOMES[holds]} unless the argument is passed; "
            "declare it earlier",
            first,
            name,
            first_related(
                [
                    Related(f"launch argument '{name}' is declared here", declared[name][1]),
                    *(Related(f"launch argument '{name}' is also read here", span) for span, _ in others),
                ]
            ),
            confidence=Confidence.HIGH if any(sure for _, sure in reads) else Confidence.MEDIUM,
        )


class _Early(NamedTuple):
    """A launch configuration that is read before it is declared."""

    name: str
    span: Span
    sure: bool
    """True if the configuration is certainly read at ``span``."""
    holds: bool | None
    """The result of the condition that compares the missing configuration; None if launch stops, as outside of conditions."""


_OUTCOMES = {None: "the launch file stops", False: "the condition is never true", True: "the condition is always true"}


def _read_early(
    file: LaunchFile, resolver: launch.IncludeResolver, declared: Mapping[str, int], above: Collection[str]
) -> Iterator[_Early]:
    """Yield the configurations that are read before their declaration.

    ``declared``: the index of the action of ``file`` that declares each configuration. ``above``: names of the configurations
    that including files declare or set.
    """
    known = set(above)
    last = max(declared.values(), default=-1)
    part = bool(resolver.takes(file).required)
    for index, action in enumerate(file.actions):
        if index >= last:
            return
        found: set[str] = set()
        for text, span, conditional, holds in _questions(action) if action.kind != "later" else ():
            for name, has_default, _ in launch.configurations(text):
                if declared.get(name, -1) > index and name not in known and name not in found and not has_default:
                    found.add(name)
                    yield _Early(name, span, not part and not conditional, holds)
        for inner in launch.walk_actions((action,)):
            if inner.kind == "include" and (target := resolver.target(inner.target, file)) is not None:
                takes = resolver.takes(target.file)
                if not takes.complete:
                    return  # a file below may declare anything
                known |= takes.known
            elif inner.kind == "include":
                return  # the included file may declare anything
            known.update(name for name, _ in inner.arguments)
            if inner.kind in ("argument", "set") and inner.target is not None:
                known.update(inner.target.texts)


def _questions(action: LaunchAction) -> Iterator[tuple[str, Span, bool, bool | None]]:
    """Yield each text of an action that launch evaluates: the text, its place, whether it is under a condition, and ``holds``.

    The texts of a condition itself are not under this condition. If a text belongs to a condition that compares values,
    ``holds`` is the result of the condition without the configuration. For all other texts ``holds`` is None, because launch
    stops if the configuration is missing.
    """
    asking = {text for condition in action.conditions if condition.equals is None for text in condition.texts}
    comparing = [condition for condition in action.conditions if condition.equals is not None]
    for text, span in launch.values_of_action(action):
        if text in asking or not any(text in condition.texts for condition in comparing):
            yield text, span, bool(action.conditions) and text not in asking, None
    for condition in comparing:
        for text in condition.texts:
            yield text, action.span, False, not condition.wanted


RULE = Rule(
    name="launch-used-before-declaration",
    code="ROS516",
    summary="launch arguments are declared before they are read",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    package=check,
)
