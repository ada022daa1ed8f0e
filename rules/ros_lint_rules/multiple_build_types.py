"""
## What it finds

Two tags `<build_type>` that apply at the same time.

## Why it matters

colcon does not recognize the folder as a ROS package.

## How to fix it

Keep one of the tags, or give each a condition.

## Limitations

Types under a condition that is false or has an unknown variable do not count.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import Finding, Related, Rule, Severity, Workspace, build


def check(workspace: Workspace) -> Iterator[Finding]:
    for package, exports in build.build_types(workspace):
        if len(exports) < 2:
            continue
        *earlier, last = exports
        types = " and ".join(f"'{export.text}'" if export.text else "an empty one" for export in exports)
        yield Finding(
            f"{len(exports)} build types apply to {workspace.target.distro}: {types}; keep one, or give each a condition",
            last.span,
            "build_type",
            tuple(Related(_also(export.text), export.span) for export in earlier),
            package=package.name,
        )


def _also(build_type: str) -> str:
    return f"the build type '{build_type}' also applies" if build_type else "the empty build type also applies"


RULE = Rule(
    name="multiple-build-types",
    code="ROS120",
    summary="one build type applies to a package",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    workspace=check,
)
