"""
## What it finds

Everything for which `catkin_pkg` rejects a `package.xml`:

- XML that is not well-formed, and unresolved merge conflicts;
- bytes that are not UTF-8;
- tags or attributes that do not exist in the format, such as `<run_depend>` in format 3, `<exec_depend>` in format 1, or
  `condition` in format 2;
- a missing or repeated `<name>`, `<version>`, `<description>`, `<maintainer>` or `<license>`;
- a version that is not of the form `1.2.3`, and an invalid e-mail address;
- a package that depends on itself;
- a `<depend>` and an equal `<exec_depend>`.

Every problem is reported with its place; `catkin_pkg` stops at the first one.

One rule reports all of them, because one of them is enough for colcon to ignore the whole file.

## Why it matters

colcon does not fail on such a file. It prints a warning or nothing, and treats the folder as a plain CMake or Python package,
or as no package at all. Then the package is missing from the environment, its dependencies do not determine the build order,
and `rosdep install` does not install them.

## How to fix it

Follow the message. There is a fix where only one correction is possible:

- It removes duplicates and dependencies of a package on itself.
- It replaces `<run_depend>` by `<exec_depend>` and the reverse.
- It completes versions such as `1.0`, and escapes `&`.
- It raises the format if a tag or attribute needs a newer one. This fix is unsafe.

## Limitations

- Manifests below another package and below markers such as `COLCON_IGNORE` are not checked, because colcon does not read them.
- A manifest that declares XML entities or nests elements more than 200 levels deep is reported, although `catkin_pkg` may
  accept it.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from ros_lint.api import Depend, Edit, Finding, Fix, Manifest, Problem, Rule, Severity, Workspace, edits

_SHORT_VERSION = re.compile(r"v?(\d+)(?:\.(\d+))?(?:\.(\d+))?")
_OF_FORMAT_1 = frozenset(("build_depend", "buildtool_depend", "test_depend", "conflict", "replace", "run_depend", "exec_depend"))
"""Dependency tags of format 1, and in addition <exec_depend>, which is called <run_depend> in format 1."""


def check(workspace: Workspace) -> Iterator[Finding]:
    for package in (*workspace.packages, *workspace.unusable):
        manifest = package.manifest
        if manifest is None:
            continue
        depends = {depend.span: depend for depend in reversed(manifest.depends)}
        for problem in manifest.problems:
            depend = depends.get(problem.span)
            yield Finding(
                f"colcon rejects this package.xml: {problem.message}",
                problem.span,
                depend.name if depend else problem.kind,
                fix=_fix(manifest, problem, depend),
                package=package.name,
            )


def _fix(manifest: Manifest, problem: Problem, depend: Depend | None) -> Fix | None:
    if problem.kind in ("duplicate-dependency", "self-dependency") and depend:
        return Fix(f"remove <{depend.tag}>{depend.name}</{depend.tag}>", (edits.manifest.remove(manifest, depend),))
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
    """Return the fix for a dependency tag that the format of the manifest does not have: another tag, or another format."""
    if depend.tag == "run_depend":
        if any(_equal(depend, other) for other in manifest.depends if other.tag in ("depend", "exec_depend")):
            return Fix(f"remove <run_depend>{depend.name}</run_depend>", (edits.manifest.remove(manifest, depend),))
        return Fix("replace <run_depend> by <exec_depend>", edits.manifest.change_tag(depend, "exec_depend"))
    if depend.tag == "exec_depend" and all(other.tag in _OF_FORMAT_1 for other in manifest.depends):
        return Fix("replace <exec_depend> by <run_depend>", edits.manifest.change_tag(depend, "run_depend"))
    return _raised(manifest, problem)


def _equal(first: Depend, second: Depend) -> bool:
    return (first.name, first.condition, first.versions) == (second.name, second.condition, second.versions)


def _raised(manifest: Manifest, problem: Problem) -> Fix | None:
    """Return the fix that raises the format of the manifest; None if a <run_depend> needs format 1."""
    form = problem.subject
    if not form or (manifest.format == 1 and any(depend.tag == "run_depend" for depend in manifest.depends)):
        return None
    return Fix(f"raise the format to {form}", (edits.manifest.raise_format(manifest, int(form)),), safe=False)


def _whole_version(manifest: Manifest, problem: Problem) -> Fix | None:
    element = next(element for element in manifest.elements if element.tag == "version")
    text = element.text if element.text_span == problem.span else element.get("compatibility")
    numbers = _SHORT_VERSION.fullmatch(text)
    if not numbers:
        return None
    version = ".".join(number or "0" for number in numbers.groups())
    return Fix(f"write '{version}'", (Edit(problem.span, version),))


RULE = Rule(
    name="rejected-manifest",
    code="ROS101",
    summary="every package.xml is accepted by catkin_pkg",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    fixable=True,
    workspace=check,
)
