"""
## What it finds

Entry points that are not of the form `name = package.module:function`:

- The target ends with `()`.
- Two entries are joined to one, because the comma between them is missing.

## Why it matters

The build succeeds or fails late. Joined entries install neither program. A program whose target ends with `()` stops when it is
started.

## How to fix it

Write `name = package.module:function`. The fix removes the `()` or adds the missing comma.

## Limitations

A target that is of this form but does not exist is reported by `entry-point-target`.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from ros_lint.api import BuildScript, Edit, EntryPoint, Finding, Fix, Package, Rule, Severity, Workspace, build

_GLUED = re.compile(r"[:=].*=")


def check(package: Package, _: Workspace) -> Iterator[Finding]:
    script = package.built
    for entry in script.products.entry_points:
        if build.entry_point_target(entry) is None:
            yield _malformed(script, entry)
    for problem in script.problems:
        if problem.kind == "entry-point-form":
            yield Finding(problem.message, problem.span, problem.subject)


def _malformed(script: BuildScript, entry: EntryPoint) -> Finding:
    if _GLUED.search(entry.target):
        message = f"'{entry.name} = {entry.target}' looks like two entries; is a comma missing between them?"
        gaps = [
            Edit(text.span, ",") for text in script.python.editable_texts if text.kind == "gap" and entry.span.covers(text.span)
        ]
        return Finding(message, entry.span, entry.name, fix=Fix.of("add a comma between the two entries", *gaps))
    if entry.target.rstrip().endswith("()"):
        message = f"the target of entry point '{entry.name}' ends with (); write {entry.target.rstrip()[:-2]}"
        return Finding(message, entry.span, entry.name, fix=_without_call(entry))
    message = f"'{entry.name} = {entry.target}' is not of the form 'name = module:function'; write it in this form"
    return Finding(message, entry.span, entry.name)


def _without_call(entry: EntryPoint) -> Fix | None:
    """Return the fix that removes the () at the end of an entry point; None unless the entry point is a string on one line."""
    span = entry.span
    blanks = span.end_column - span.column - len(entry.name) - len(entry.target) - len("'='")
    if span.line != span.end_line or not 0 <= blanks <= 2:  # around the equals sign
        return None
    place = span._replace(column=span.end_column - 3, end_column=span.end_column - 1)
    return Fix(f"write {entry.target.rstrip()[:-2]}", (Edit(place, ""),))


RULE = Rule(
    name="invalid-entry-point",
    code="ROS420",
    summary="entry points are of the form 'name = module:function'",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
