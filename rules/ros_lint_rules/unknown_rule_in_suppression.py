"""
## What it finds

A comment that is meant to suppress findings and does not: it names a rule that does not exist, names no rule at all,
says something other than `ignore` and `ignore-file`, or is an `ignore-file` below the first comments of its file.

## Why it matters

The comment looks as if it did something. The finding that it was written for is still reported, or the comment has
outlived a rule.

## How to fix it

Write `ros-lint: ignore[rule-name] reason`, with names or codes from `ros-lint rules`, several of them separated by
commas. Move `ros-lint: ignore-file[rule-name] reason` above the first line that is no comment.

## Limitations

About comments that only mention ros-lint, and about whatever looks like a comment and stands in a string.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ros_lint.api import Finding, Rule, Severity, did_you_mean

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ros_lint.api import Outcome


def check(outcome: Outcome) -> Iterator[Finding]:
    for suppression in outcome.broken:
        yield Finding(suppression.problem, suppression.span, ", ".join(name.text for name in suppression.names))
    for _, name, suggestion in outcome.unknown:
        hint = did_you_mean([suggestion] if suggestion else [], ", ") or ", ros-lint rules lists what there is"
        yield Finding(f"there is no rule {name.text}{hint}", name.span, name.text)


RULE = Rule(
    name="unknown-rule-in-suppression",
    code="ROS902",
    summary="a comment that suppresses findings must name rules that exist",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    suppressions=check,
)
