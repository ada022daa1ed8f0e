"""
## What it finds

A comment such as `# ros-lint: ignore[unused-dependency] loaded by name` that suppresses no finding of the rule it names.

## Why it matters

The finding was fixed, has moved, or never existed. The comment misleads readers, and would hide a new finding of the rule on
the same line.

## How to fix it

Remove the comment, or the rule name that is not needed. The fix does this.

## Limitations

Not reported: rules that did not run, because they are off, not selected or failed, so that their findings are unknown.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ros_lint.api import Finding, Fix, Rule, Severity

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ros_lint.api import SuppressionUse


def check(use: SuppressionUse) -> Iterator[Finding]:
    for suppression, names in use.unused:
        rules = " and ".join(f"'{name.text}'" for name in names)
        whole = len(names) == len(suppression.names)
        yield Finding(
            f"this comment suppresses no finding of {rules}; remove it",
            suppression.span if whole else names[0].span,
            " and ".join(name.text for name in names),
            fix=Fix(f"remove the suppression of {rules}", (suppression.without(names),)),
        )


RULE = Rule(
    name="unused-suppression",
    code="ROS901",
    summary="suppression comments suppress a finding",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    fixable=True,
    suppressions=check,
)
