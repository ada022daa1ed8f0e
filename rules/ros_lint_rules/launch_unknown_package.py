"""
## What it finds

A launch file that starts something from a package, includes a file of it or looks it up, while no package has that
name: none of the workspace, none of an underlay, none that is released for the distribution.

## Why it matters

The launch file stops there: `package 'x' not found`. The usual reasons are a slip of the pen, a package that was
renamed, and one that was never ported from ROS 1.

## How to fix it

Correct the name; the fix does this where the name that was meant is beyond doubt. If the package is built from source
elsewhere, check with the workspace that holds it as `--underlay`.

## When it keeps silent

- There are no data about the distribution.
- Nobody said which distribution is meant, and another one has the package.
- The launch file asks first if the package is there.
- The name is that of a default which an argument can replace: then the confidence is medium.
- The name is merely unknown, resembling no other: that may be a driver that its vendor does not release. Then the
  confidence is medium.
- `package.xml` declares the name as well, and it resembles no other: then `unknown-dependency` or
  `end-of-life-dependency` tells of it, once.
- In launch files of tests and examples, which may not run at all, the confidence is medium.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

from ros_lint.api import (
    Confidence,
    Edit,
    Finding,
    Fix,
    LaunchReference,
    Package,
    Related,
    Rule,
    Severity,
    Workspace,
    launchable,
)

_MOST_RELATED = 4


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    if not workspace.world.knowledge.covered:
        return
    apart = frozenset(launch.file.path for launch in launchable(package, apart=True) if launch.apart)
    declared = frozenset(one.name for one in package.declared)
    for name, references in _unknown(package, workspace).items():
        verdict = _verdict(name, workspace)
        if verdict is None or (name in declared and not verdict.resembles):
            continue
        best, *others = sorted(references, key=lambda one: (one.span.path in apart, one.by_default, one.span))
        yield Finding(
            f"there is no package {name}{verdict.hint}",
            best.package_span,
            name,
            tuple(Related("also named here", other.package_span) for other in others[:_MOST_RELATED]),
            _fix(name, verdict.meant, references),
            Confidence.MEDIUM if best.by_default or best.span.path in apart else verdict.confidence,
        )


def _fix(name: str, meant: str, references: Sequence[LaunchReference]) -> Fix | None:
    if not meant or not all(reference.package_exact for reference in references):
        return None
    spans = dict.fromkeys(reference.package_span for reference in references)
    return Fix(f"say {meant} instead of {name}", tuple(Edit(span, meant) for span in spans), safe=False)


class _Verdict(NamedTuple):
    hint: str
    confidence: Confidence
    meant: str = ""
    resembles: bool = True
    """Whether it is a slip, or was renamed, rather than a package that is nowhere to be had."""


def _unknown(package: Package, workspace: Workspace) -> Mapping[str, list[LaunchReference]]:
    found: dict[str, list[LaunchReference]] = {}
    for launch in launchable(package, apart=True):
        for reference in launch.file.references:
            name = reference.package
            if not workspace.world.is_package(name) and name != package.name and not reference.optional:
                found.setdefault(name, []).append(reference)
    return found


def _verdict(name: str, workspace: Workspace) -> _Verdict | None:
    world = workspace.world
    meant = world.meant(name)
    if meant is not None and world.is_package(meant.name):
        return _Verdict(f": {meant.name} is meant", Confidence.HIGH, meant.name)
    renamed = [other for other in workspace.by_name if other.endswith(f"_{name}")]
    if len(renamed) == 1:
        return _Verdict(f": the workspace has {renamed[0]}", Confidence.HIGH, renamed[0])
    distro, date = workspace.target.distro, world.knowledge.date
    elsewhere = world.where_else(name)
    if elsewhere:
        if not workspace.target.told:
            return None
        return _Verdict(f" in {distro}, only in {', '.join(elsewhere)} (data of {date})", Confidence.MEDIUM, resembles=False)
    ended = world.knowledge.names.end_of_life(name)
    if ended:
        hint = f" in {distro}, only in {', '.join(ended)}, which are no longer supported"
        return _Verdict(hint, Confidence.MEDIUM, resembles=False)
    near = [other for other in world.suggest(name) if world.is_package(other)]
    hint = f"; did you mean {' or '.join(near)}?" if near else ""
    nowhere = f" in the workspace, the underlays or {distro} (data of {date})"
    return _Verdict(f"{nowhere}{hint}", Confidence.MEDIUM, resembles=bool(near))


RULE = Rule(
    name="launch-unknown-package",
    code="ROS501",
    summary="a package that a launch file names must exist",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
