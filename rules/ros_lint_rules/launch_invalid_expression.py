"""
## What it finds

A launch argument whose default makes an expression fail: with `false` or `fast` for `$(var x)`, `$(eval 'not $(var x)')` and
`$(eval '$(var x) == 0')` are not valid Python expressions.

## Why it matters

The launch file stops unless the argument is passed.

## How to fix it

Write `False` or `True`, or put `$(var x)` in quotes.

## Limitations

The confidence is medium:

- for expressions under a condition;
- for expressions with an argument that files of the workspace pass;
- if a file of the workspace cannot be read, because it may pass the argument.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import Confidence, Finding, Package, Rule, Severity, Workspace, launch


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    for launch_file in launch.package_launch_files(package):
        above = launch.include_tree(workspace).above(launch_file.file)
        passed = {name for configurations in above or () for name in configurations.set_or_passed}
        for failing in launch.failing_expressions(launch_file.file):
            sure = not (workspace.unread() or above is None or failing.argument in passed or failing.conditional)
            yield _finding(failing, Confidence.HIGH if sure else Confidence.MEDIUM)


def _finding(failing: launch.FailingExpression, confidence: Confidence) -> Finding:
    reason = "which is not a valid Python expression; change the default or the expression"
    if failing.name:
        remedy = f"write {failing.name.capitalize()}" if failing.name in ("true", "false") else "put it in quotes"
        reason = f"but Python has no name '{failing.name}'; {remedy}"
    return Finding(
        f"with the default of '{failing.argument}' this expression becomes `{failing.expression}`, {reason}",
        failing.span,
        failing.argument,
        confidence=confidence,
    )


RULE = Rule(
    name="launch-invalid-expression",
    code="ROS518",
    summary="expressions are valid with the defaults of launch arguments",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    package=check,
)
