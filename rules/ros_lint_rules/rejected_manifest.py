"""
## What it finds

Everything for which `catkin_pkg` rejects a `package.xml`: XML that is not well-formed, merge conflicts, tags or attributes
that the format has not (`<run_depend>` in format 3, `<exec_depend>` in format 1, `condition` in format 2), a missing or
repeated `<name>`, `<version>`, `<description>`, `<maintainer>` or `<license>`, a version that is not of the form `1.2.3`,
an e-mail address that is none, a package that depends on itself, `<depend>` beside an equal `<exec_depend>`, bytes that
are no UTF-8. Every case is named, with its place; `catkin_pkg` stops at the first.

## Why it matters

colcon does not fail on such a file. It says nothing, or prints a warning, and takes the folder for a plain CMake or Python
package, or for none at all: the package is missing from the environment, its dependencies do not order the build any
more, and `rosdep install` does not install them.

## How to fix it

As the message says. The fix does it where there is only one way: it removes duplicates and dependencies on oneself, writes
`<exec_depend>` for `<run_depend>` and the reverse, completes versions such as `1.0`, escapes `&`, and raises the format
where a tag or attribute needs a newer one (an unsafe fix).

## Limitations

For manifests below another package and below markers such as `COLCON_IGNORE`, which colcon does not read. A manifest that
declares XML entities, or that nests elements more than 200 levels deep, is reported although `catkin_pkg` may read it.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from ros_lint.api import (
    Depend,
    Edit,
    Finding,
    Fix,
    Manifest,
    Problem,
    Rule,
    Severity,
    Workspace,
    manifest_edits,
)

_SHORT_VERSION = re.compile(r"v?(\d+)(?:\.(\d+))?(?:\.(\d+))?")
_OF_FORMAT_1 = frozenset(("build_depend", "buildtool_depend", "test_depend", "conflict", "replace", "run_depend", "exec_depend"))
"""Tags that format 1 has, and the one for which it has another name."""


def check(workspace: Workspace) -> Iterator[Finding]:
    for package in (*workspace.packages, *workspace.unusable):
        manifest = package.manifest
        if manifest is None:
            continue
        for problem in manifest.problems:
            depend = _depend_at(manifest, problem)
            yield Finding(
                f"colcon rejects this package.xml: {problem.message}",
                problem.span,
                depend.name if depend else problem.kind,
                fix=_fix(manifest, problem, depend),
                package=package.name,
            )


def _depend_at(manifest: Manifest, problem: Problem) -> Depend | None:
    return next((depend for depend in manifest.depends if depend.span == problem.span), None)


def _fix(manifest: Manifest, problem: Problem, depend: Depend | None) -> Fix | None:
    if problem.kind in ("duplicate-dependency", "self-dependency") and depend:
        return Fix(f"remove <{depend.tag}>{depend.name}</{depend.tag}>", (manifest_edits.remove(manifest, depend),))
    if problem.kind == "unknown-tag":
        return _other_tag(manifest, problem, depend) if depend else None
    if problem.kind == "unknown-attribute":
        return _raised(manifest, problem)
    if problem.kind == "invalid-version":
        return _whole_version(manifest, problem)
    if problem.kind == "bare-ampersand":
        return Fix("write &amp;", (Edit(problem.span, "&amp;"),))
    return None


def _other_tag(manifest: Manifest, problem: Problem, depend: Depend) -> Fix | None:
    """Return the fix for a dependency tag that another format has."""
    if depend.tag == "run_depend":
        if any(_equal(depend, other) for other in manifest.depends if other.tag in ("depend", "exec_depend")):
            return Fix(f"remove <run_depend>{depend.name}</run_depend>", (manifest_edits.remove(manifest, depend),))
        return Fix("write <exec_depend>", manifest_edits.change_tag(depend, "exec_depend"))
    if depend.tag == "exec_depend" and all(other.tag in _OF_FORMAT_1 for other in manifest.depends):
        return Fix("write <run_depend>", manifest_edits.change_tag(depend, "run_depend"))
    return _raised(manifest, problem)


def _equal(one: Depend, other: Depend) -> bool:
    return (one.name, one.condition, one.versions) == (other.name, other.condition, other.versions)


def _raised(manifest: Manifest, problem: Problem) -> Fix | None:
    """Return the fix that gives the manifest the format that it needs, unless it has a tag that only the oldest has."""
    form = problem.subject
    if not form or (manifest.format == 1 and any(depend.tag == "run_depend" for depend in manifest.depends)):
        return None
    return Fix(f"raise the format to {form}", (manifest_edits.raise_format(manifest, int(form)),), safe=False)


def _whole_version(manifest: Manifest, problem: Problem) -> Fix | None:
    element = next(element for element in manifest.elements if element.tag == "version")
    text = element.text if element.text_span == problem.span else element.get("compatibility")
    numbers = _SHORT_VERSION.fullmatch(text)
    if not numbers:
        return None
    version = ".".join(number or "0" for number in numbers.groups())
    return Fix(f"write {version}", (Edit(problem.span, version),))


RULE = Rule(
    name="rejected-manifest",
    code="ROS101",
    summary="catkin_pkg must accept every package.xml",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    fixable=True,
    workspace=check,
)
