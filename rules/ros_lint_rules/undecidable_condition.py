"""
## What it finds

- A `condition` in `package.xml` that does not parse, for example because of `$ROS_VERSION` without a comparison, `&&` instead
  of `and`, or an unquoted number with a dot.
- With medium confidence: a condition that depends on a variable other than `ROS_VERSION`, `ROS_DISTRO` and
  `ROS_PYTHON_VERSION`.

## Why it matters

If a condition does not parse, colcon treats the folder as if it were not a ROS package, and prints a traceback at most. A
variable that is not set is the empty string, so the result depends on the environment in which colcon runs. The build farm sets
only these three variables.

## How to fix it

Write comparisons of `$VARIABLES` and words or quoted strings, joined by `and` and `or` (REP 149). Values are compared as
strings: `"10" < "9"` is true.

## Limitations

- Unknown variables that cannot change the result are not reported, for example if the other side of an `and` is false.
- Findings about unknown variables are shown only with `--pedantic`. The other rules treat these dependencies as declared and
  never as unused.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import Confidence, Finding, Manifest, Rule, Severity, Workspace, dependencies


def check(workspace: Workspace) -> Iterator[Finding]:
    for package in (*workspace.packages, *workspace.unusable):
        manifest = package.manifest
        if manifest is None:
            continue
        broken = dependencies.conditions.problems(manifest)
        for problem in broken:
            message = f"colcon cannot use this package.xml: {problem.message}"
            yield Finding(message, problem.span, problem.kind, package=package.name)
        if not broken:
            for finding in _unknown(manifest, workspace):
                yield finding._replace(package=package.name)


def _unknown(manifest: Manifest, workspace: Workspace) -> Iterator[Finding]:
    context = workspace.target.context
    conditional = [(depend.condition, depend.name, depend.span) for depend in manifest.depends]
    conditional += [(dependencies.conditions.of(export), export.text or export.tag, export.span) for export in manifest.exports]
    for text, name, span in conditional:
        if dependencies.conditions.truth(text, context) is not None:
            continue
        unknown = sorted(dependencies.conditions.variables(dependencies.conditions.parse(text)) - context.keys())
        yield Finding(
            f"the condition of '{name}' uses {' and '.join(unknown)}, which the build farm does not set; "
            "use ROS_VERSION or ROS_DISTRO",
            span,
            name,
            confidence=Confidence.MEDIUM,
            severity=Severity.INFO,
        )


RULE = Rule(
    name="undecidable-condition",
    code="ROS113",
    summary="conditions in manifests parse and do not depend on the environment",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    workspace=check,
)
