"""
## What it finds

A `condition` in `package.xml` that does not parse: `$ROS_VERSION` without a comparison, `&&` for `and`, a number with a
dot that is not quoted. Less surely, one that depends on a variable which is not `ROS_VERSION`, `ROS_DISTRO` or
`ROS_PYTHON_VERSION`.

## Why it matters

colcon fails on a condition that does not parse, says so in a traceback at most, and takes the folder for no ROS package.
A variable that is not set is the empty string, so what is built depends on the environment of whoever calls colcon, and
the build farm sets none but these three.

## How to fix it

Write comparisons of `$VARIABLES` and words or quoted strings, joined by `and` and `or` (REP 149). Values are compared as
strings: `"10" < "9"` is true.

## Limitations

About unknown variables that cannot change the outcome: one side of an `and` is false anyway. Findings about unknown
variables are of medium confidence and shown with `--pedantic` only; the other rules take such dependencies for declared
and never for unused.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import Confidence, Finding, Manifest, Rule, Severity, Workspace, conditions


def check(workspace: Workspace) -> Iterator[Finding]:
    for package in (*workspace.packages, *workspace.unusable):
        manifest = package.manifest
        if manifest is None:
            continue
        broken = conditions.problems(manifest)
        for problem in broken:
            message = f"colcon cannot use this package.xml: {problem.message}"
            yield Finding(message, problem.span, problem.kind, package=package.name)
        if not broken:
            for finding in _unknown(manifest, workspace):
                yield finding._replace(package=package.name)


def _unknown(manifest: Manifest, workspace: Workspace) -> Iterator[Finding]:
    context = workspace.target.context
    conditional = [(depend.condition, depend.name, depend.span) for depend in manifest.depends]
    conditional += [(conditions.of(export), export.text or export.tag, export.span) for export in manifest.exports]
    for text, name, span in conditional:
        if conditions.truth(text, context) is not None:
            continue
        unknown = sorted(conditions.variables(conditions.parse(text)) - context.keys())
        yield Finding(
            f"whether {name} counts depends on {' and '.join(unknown)}, which only the caller's environment knows; "
            "compare ROS_VERSION or ROS_DISTRO",
            span,
            name,
            confidence=Confidence.MEDIUM,
            severity=Severity.INFO,
        )


RULE = Rule(
    name="undecidable-condition",
    code="ROS113",
    summary="conditions in a manifest must parse, and be the same for everybody",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    workspace=check,
)
