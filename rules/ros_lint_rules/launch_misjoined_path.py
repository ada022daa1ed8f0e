"""
## What it finds

A path that lacks a part because of how it is joined:

- There is no slash after the share folder of a package: `[FindPackageShare('robot'), 'config', 'a.yaml']` is
  `.../share/robotconfiga.yaml` if nothing joins the parts.
- It is joined with an absolute path: `os.path.join(share, '/config/a.yaml')` is `/config/a.yaml`, without the share folder.

## Why it matters

The file is not found when the launch file uses it.

## How to fix it

Use `PathJoinSubstitution([FindPackageShare('robot'), 'config', 'a.yaml'])`, and remove the slash at the beginning of joined
parts.

## Limitations

Absolute paths that drop no other path are not reported, and neither are launch files of tests, examples and templates.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import Finding, Package, Problem, Related, Rule, Severity, Workspace, first_related, launch


def check(package: Package, _: Workspace) -> Iterator[Finding]:
    for launch_file in launch.package_launch_files(package):
        misjoined = [problem for problem in launch_file.file.problems if problem.kind in ("forgotten-path", "no-slash")]
        if not misjoined:
            continue
        first, *others = sorted(misjoined, key=lambda problem: problem.span)
        related = first_related(Related(_also(first, other), other.span) for other in others)
        yield Finding(first.message, first.span, launch_file.path, related)


def _also(first: Problem, other: Problem) -> str:
    """Return the message of a further problem, without the advice if the message of the finding has the same advice."""
    return other.message.partition("; ")[0] if other.message == first.message else other.message


RULE = Rule(
    name="launch-misjoined-path",
    code="ROS521",
    summary="launch files join paths with a slash and without absolute parts",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    package=check,
)
