"""
## What it finds

A comment that looks like a suppression but has no effect, because it

- names a rule that does not exist, was divided or was removed, or no rule at all;
- uses a word other than `ignore` and `ignore-file`;
- is an `ignore-file` below the first comments of its file.

## Why it matters

The comment seems to work, but the finding is still reported, or the rule no longer exists.

## How to fix it

Write `ros-lint: ignore[rule-name] reason`, with names or codes from `ros-lint rules`, separated by commas. For a rule that was
divided, the message names the new rules. For a rule of a plugin, run ros-lint with `--plugins`.
Move `ros-lint: ignore-file[rule-name] reason` above the first line that is not a comment.

## Limitations

Not reported: comments that only mention ros-lint, and text in a string that looks like a comment.

Without `--plugins` the rules of plugins do not exist, so a suppression of such a rule is reported. If only some of your runs
load plugins, use `--ignore unknown-rule-in-suppression` in the others.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ros_lint.api import Finding, Rule, Severity, names

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ros_lint.api import SuppressionUse


def check(use: SuppressionUse) -> Iterator[Finding]:
    for suppression in use.malformed:
        yield Finding(suppression.problem, suppression.span, ", ".join(name.text for name in suppression.names))
    for _, name, suggestion, fate in use.unknown:
        hint = names.did_you_mean([suggestion] if suggestion else []) or "; `ros-lint rules` lists all rules"
        unknown = f"there is no rule '{name.text}'{hint} (rules of plugins need --plugins)"
        message = f"rule '{name.text}' {fate}" if fate else unknown
        yield Finding(message, name.span, name.text)


RULE = Rule(
    name="unknown-rule-in-suppression",
    code="ROS902",
    summary="suppression comments name existing rules",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    suppressions=check,
)
