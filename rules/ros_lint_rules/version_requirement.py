"""
## What it finds

A dependency that asks for a version (`version_gte`, `version_lt` and so on) which the package of that name in the
workspace or in an underlay does not have.

## Why it matters

colcon builds all the same. The attribute says that the package does not work with this version, and a Debian package made
from it cannot be installed.

## How to fix it

Check out or install a version that fits, or correct the attribute.

## Limitations

For packages that are only known from the index of the distribution, for names that the workspace has twice, for versions
that are not numbers with dots, and for tags under a condition that is false or cannot be evaluated.
"""

from __future__ import annotations

import operator
import re
from collections.abc import Callable, Iterator

from ros_lint.api import Finding, Package, Related, Rule, Severity, Workspace

_Version = tuple[tuple[int, str], ...]
"""Components as numbers of digits and these digits, because there is no limit to a number in package.xml."""
_TESTS: dict[str, tuple[str, Callable[[_Version, _Version], bool]]] = {
    "version_lt": ("below", operator.lt),
    "version_lte": ("at most", operator.le),
    "version_eq": ("exactly", operator.eq),
    "version_gte": ("at least", operator.ge),
    "version_gt": ("above", operator.gt),
}


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    for declared in package.declared:
        depend = declared.depend
        if not depend.versions or not declared.certain:
            continue
        if workspace.world.layer(depend.name) not in ("workspace", "underlay"):
            continue
        version = workspace.world.version(depend.name) or ""
        there = workspace.by_name.get(depend.name, ())
        failed = [
            f"{word} {limit}"
            for attribute, limit in depend.versions
            for word, test in (_TESTS[attribute],)
            if _numbers(version) and _numbers(limit) and not test(_numbers(version), _numbers(limit))
        ]
        if failed and len(there) < 2:
            yield Finding(
                f"{depend.name} {' and '.join(failed)} is asked for, but {version} is there; "
                "get another version, or correct the attribute",
                depend.span,
                depend.name,
                tuple(Related(f"{depend.name} {version}", found.place) for found in there),
            )


def _numbers(version: str) -> _Version:
    """Return a version as numbers, missing ones 0; empty when it has anything else."""
    if not re.fullmatch(r"[0-9]+(\.[0-9]+){0,3}", version):
        return ()
    digits = [part.lstrip("0") for part in version.split(".")]
    return tuple((len(part), part) for part in [*digits, *[""] * (4 - len(digits))])


RULE = Rule(
    name="version-requirement",
    code="ROS114",
    summary="a package must have the version that others ask for",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    package=check,
)
