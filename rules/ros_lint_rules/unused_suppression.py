"""
## What it finds

A comment such as `# ros-lint: ignore[unused-dependency] loaded by name` where the rule that it names finds nothing to
suppress.

## Why it matters

What it excused is mended, has moved, or was never there. The comment misleads whoever reads it, and hides the next
finding of that rule on its line.

## How to fix it

Remove it, or the one name in it that is not needed. The fix does this.

## Limitations

About rules that did not run, because they are off, not selected, or failed: what they would have found is not known.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ros_lint.api import Finding, Fix, Rule, Severity

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ros_lint.api import Outcome


def check(outcome: Outcome) -> Iterator[Finding]:
    for suppression, names in outcome.unused:
        words = " and ".join(name.text for name in names)
        whole = len(names) == len(suppression.names)
        yield Finding(
            f"nothing here needs the suppression of {words}, remove it",
            suppression.span if whole else names[0].span,
            words,
            fix=Fix(f"remove the suppression of {words}", (suppression.without(names),)),
        )


RULE = Rule(
    name="unused-suppression",
    code="ROS901",
    summary="a comment that suppresses findings must have something to suppress",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    fixable=True,
    suppressions=check,
)
