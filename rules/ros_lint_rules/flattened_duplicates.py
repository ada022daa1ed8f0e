"""
## What it finds

Two different files that are installed to one path: `data_files` drops the folders of its sources, so that `a/params.yaml`
and `b/params.yaml` in one entry are both `share/<package>/params.yaml`; `install(FILES)` does the same.

## Why it matters

The second one overwrites the first, and nothing is said.

## How to fix it

One entry for each folder: `('share/' + package_name + '/a', ['a/params.yaml'])`; or `install(DIRECTORY)`, which keeps
folders.

## When it keeps silent

Where one of them is installed under a condition, and where it is the same file twice.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import Finding, Package, Provided, Related, Rule, Severity, Workspace


def check(package: Package, _: Workspace) -> Iterator[Finding]:
    script = package.script
    if script is None or package.builds_with not in ("ament_cmake", "ament_python"):
        return
    first: dict[str, Provided] = {}
    for provided in script.provides:
        if not provided.source or provided.conditional:
            continue
        earlier = first.setdefault(provided.path, provided)
        if earlier.source != provided.source and not provided.path.endswith("__init__.py"):
            yield Finding(
                f"{earlier.source} and {provided.source} are both installed as {provided.path}; the last one wins",
                provided.span,
                provided.path,
                (Related(f"{earlier.source} is installed here", earlier.span),),
            )


RULE = Rule(
    name="flattened-duplicates",
    code="ROS414",
    summary="two files must not be installed to one path",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    package=check,
)
