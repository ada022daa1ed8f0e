"""
## What it finds

A launch argument whose default is not one of its choices.

## Why it matters

The launch file stops: `Provided default_value "x" is not in provided choices`.

## How to fix it

Correct the default, or add it to the choices.

## Limitations

Defaults and choices that cannot be evaluated are not reported.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import Finding, Package, Rule, Severity, Workspace, launch


def check(package: Package, _: Workspace) -> Iterator[Finding]:
    for launch_file in launch.package_launch_files(package):
        for action in launch.walk_actions(launch_file.file.actions):
            value = action.value
            if action.kind != "argument" or value is None or not action.choices:
                continue
            if not all(map(launch.is_plain, (*action.choices, *value.texts))):
                continue
            if len(value.texts) == 1 and value.texts[0] not in action.choices:
                name = action.target.texts[0] if action.target is not None else ""
                choices = ", ".join(f"'{choice}'" for choice in action.choices)
                message = (
                    f"the default '{value.texts[0]}' of launch argument '{name}' is not one of its choices {choices}; "
                    "change the default, or add it to the choices"
                )
                yield Finding(message, value.span, name)


RULE = Rule(
    name="launch-invalid-default",
    code="ROS517",
    summary="defaults of launch arguments are among their choices",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    package=check,
)
