"""
## What it finds

A remapping of a name to itself, and one that no node takes: without a name on one side, or with white space in a name.
Where the launch file has an argument of that name, `$(var name)` was meant.

## Why it matters

A remapping to itself does nothing: it is left over, or one of the two names was meant to be another one. One that cannot be
read stops the node: `Couldn't parse remap rule`.

## How to fix it

Remove it, or correct the name.

## Limitations

- One side comes from an argument, or is computed in another way.
- People write such remappings to list what a node has: the confidence is medium where no argument has the name.
- Launch files of tests and examples.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import (
    Confidence,
    Finding,
    LaunchValue,
    Package,
    Rule,
    Severity,
    Span,
    Workspace,
    everything,
    is_plain,
    launchable,
)


def check(package: Package, _: Workspace) -> Iterator[Finding]:
    for launch in launchable(package):
        actions = list(everything(launch.file.actions))
        arguments = {name for one in actions if one.kind == "argument" and one.target is not None for name in one.target.texts}
        found: dict[Span, Finding] = {}  # a function that makes nodes may be called again and again
        for action in actions:
            pairs = list(action.remappings)
            if action.kind == "remap" and action.target is not None and action.value is not None:
                pairs.append((action.target, action.value))
            for before, after in pairs:
                for finding in _of_pair(before, after, arguments):
                    found.setdefault(finding.span, finding)
        yield from found.values()


def _of_pair(before: LaunchValue, after: LaunchValue, arguments: set[str]) -> Iterator[Finding]:
    for side, value in (("from", before), ("to", after)):
        if len(value.texts) == 1 and is_plain(value.texts[0]) and _is_none(value.texts[0]):
            yield Finding(
                f"a remapping {side} {value.texts[0]!r} is none: that is no name; write one, or remove the remapping",
                value.span,
                before.texts[0],
                severity=Severity.ERROR,
            )
            return
    if before.exact and after.exact and before.texts == after.texts:
        name = before.texts[0]
        meant = name in arguments
        way_out = "the argument of that name is meant" if meant else "remove it, or correct a name"
        yield Finding(
            f"{name} is remapped to itself, which does nothing; {way_out}",
            after.span,
            name,
            confidence=Confidence.HIGH if meant else Confidence.MEDIUM,
            severity=Severity.WARNING if meant else None,
        )


def _is_none(name: str) -> bool:
    return not name.strip() or any(letter.isspace() for letter in name.strip())


RULE = Rule(
    name="remap-no-effect",
    code="ROS512",
    summary="a remapping must lead from one name to another",
    severity=Severity.INFO,
    since="0.1",
    doc=__doc__,
    package=check,
)
