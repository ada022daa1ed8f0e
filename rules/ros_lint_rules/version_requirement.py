"""
## What it finds

A dependency with a version limit (`version_gte`, `version_lt` and so on) that the package in the workspace or in an underlay
does not satisfy.

## Why it matters

colcon ignores the limit and builds. The attribute states that the package does not work with this version, and a Debian package
of it cannot be installed.

## How to fix it

Check out or install a suitable version, or correct the attribute.

## Limitations

Not reported:

- Packages that are only known from the index of the distribution.
- Names of more than one package of the workspace.
- Versions that are not numbers with dots.
- Tags under a condition that is false or cannot be evaluated.
"""

from __future__ import annotations

import operator
import re
from collections.abc import Callable, Iterable, Iterator

from ros_lint.api import Finding, Package, Related, Rule, Severity, Workspace

_Version = tuple[tuple[int, str], ...]
"""A version as pairs of the number of digits and the digits of each component: ``((1, "2"), (2, "10"))`` for 2.10.

The components are no integers, because package.xml allows numbers of any length.
"""
_TESTS: dict[str, tuple[str, Callable[[_Version, _Version], bool]]] = {
    "version_lt": ("<", operator.lt),
    "version_lte": ("<=", operator.le),
    "version_eq": ("==", operator.eq),
    "version_gte": (">=", operator.ge),
    "version_gt": (">", operator.gt),
}


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    for declared in package.declared:
        depend = declared.depend
        if not depend.versions or not declared.certain:
            continue
        if workspace.world.layer(depend.name) not in ("workspace", "underlay"):
            continue
        version = workspace.world.version(depend.name) or ""
        packages = workspace.by_name.get(depend.name, ())
        failed = [
            f"{symbol} {limit}"
            for attribute, limit in depend.versions
            for symbol, test in (_TESTS[attribute],)
            if _numbers(version) and _numbers(limit) and not test(_numbers(version), _numbers(limit))
        ]
        if failed and len(packages) < 2:
            message = (
                f"'{depend.name}' has version {version}, but '{package.name}' requires version {' and '.join(failed)}; "
                f"use another version of '{depend.name}', or correct the attribute"
            )
            if not _is_possible(depend.versions):
                limits = " and ".join(f"{_TESTS[attribute][0]} {limit}" for attribute, limit in depend.versions)
                message = f"no version of '{depend.name}' is {limits}, as '{package.name}' requires; correct the attributes"
            yield Finding(
                message,
                depend.span,
                depend.name,
                tuple(Related(f"'{depend.name}' has version {version}", package.span) for package in packages),
            )


def _is_possible(versions: Iterable[tuple[str, str]]) -> bool:
    """Return whether a version can satisfy all version attributes of a tag; attributes without a valid number are ignored."""
    tests = [(_TESTS[attribute][1], _numbers(limit)) for attribute, limit in versions if _numbers(limit)]
    # If any version fits, one of these does: a limit, a version just above a limit, or one below all limits.
    candidates = [(), *(limit for _, limit in tests), *((*limit, (1, "1")) for _, limit in tests)]
    return any(all(test(candidate, limit) for test, limit in tests) for candidate in candidates)


def _numbers(version: str) -> _Version:
    """Return a version as four components, missing ones 0; () if the version is not numbers with dots."""
    if not re.fullmatch(r"[0-9]+(\.[0-9]+){0,3}", version):
        return ()
    digits = [part.lstrip("0") for part in version.split(".")]
    return tuple((len(part), part) for part in [*digits, *[""] * (4 - len(digits))])


RULE = Rule(
    name="version-requirement",
    code="ROS114",
    summary="packages have the versions that other packages require",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    package=check,
)
