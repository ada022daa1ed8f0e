"""
## What it finds

Two entry points of a `setup.py` with the same name.

## Why it matters

The build fails: "Duplicate entry point".

## How to fix it

Rename one of the two programs. If both start the same function, remove one.

## Limitations

Programs that are not part of every build are not reported.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import EntryPoint, Finding, Package, Related, Rule, Severity, Workspace


def check(package: Package, _: Workspace) -> Iterator[Finding]:
    script = package.built
    always = {(p.path.rpartition("/")[2], p.span) for p in script.products.installs if p.program and not p.conditional}
    first: dict[tuple[str, str], EntryPoint] = {}
    for entry in script.products.entry_points:
        if (entry.name, entry.span) not in always:
            continue
        earlier = first.setdefault((entry.group, entry.name), entry)
        if earlier.span != entry.span:
            change = "remove" if earlier.target == entry.target else "rename"
            message = (
                f"entry point '{entry.name}' is already defined as '{earlier.target}'; setuptools stops at a second definition: "
                f"{change} one of them"
            )
            yield Finding(message, entry.span, entry.name, (Related(f"the first definition of '{entry.name}'", earlier.span),))


RULE = Rule(
    name="duplicate-entry-point",
    code="ROS421",
    summary="entry points have different names",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    package=check,
)
