"""
## What it finds

A Python launch file that uses a substitution or condition as if it were a Python value:

- It formats, compares or tests a substitution.
- It joins conditions with `and` or `or`.

## Why it matters

Python accepts it without an error message, because substitutions get their values when the launch file runs. An f-string contains
`<launch.substitutions... object at 0x7f...>`, `LaunchConfiguration('mode') == 'real'` is never true, and of two conditions only
one has an effect.

## How to fix it

Write a list of strings and substitutions, `EqualsSubstitution(a, b)`, `IfCondition(a)`, or `AndSubstitution(a, b)`. In a function
of `OpaqueFunction`, use `perform(context)`.

## Limitations

Not reported:

- Substitutions in code that catches errors or only prints, such as `print()`.
- A substitution tested in a function that has it as a parameter, because the function may test whether a value was passed.
- Launch files of tests, examples and templates.
- What Python rejects, such as `'robot_' + LaunchConfiguration('name')`: `launch-invalid` reports it.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import Finding, Package, Problem, Related, Rule, Severity, Workspace, first_related, launch


def check(package: Package, _: Workspace) -> Iterator[Finding]:
    for launch_file in launch.package_launch_files(package):
        misused = [problem for problem in launch_file.file.problems if problem.kind == "substitution-as-text"]
        if not misused:
            continue
        first, *others = sorted(misused, key=lambda problem: problem.span)
        related = first_related(Related(_also(first, other), other.span) for other in others)
        yield Finding(first.message, first.span, launch_file.path, related)


def _also(first: Problem, other: Problem) -> str:
    """Return the message of a further problem, without the advice if the message of the finding has the same advice."""
    return other.message.partition("; ")[0] if other.message == first.message else other.message


RULE = Rule(
    name="launch-substitution-as-value",
    code="ROS522",
    summary="substitutions and conditions are not used as Python values",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    package=check,
)
