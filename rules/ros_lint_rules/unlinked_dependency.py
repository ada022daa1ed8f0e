"""
## What it finds

A source that includes headers of a package which CMake finds, but which the target that compiles the source is not given:
neither itself nor by anything that it is linked with.

## Why it matters

Each package has its headers in a folder of its own, and only what is linked adds that folder: the compiler stops with "No
such file or directory". That others of the targets are given the package does not help this one.

## How to fix it

Give it to the target: `ament_target_dependencies(target package)`, or `target_link_libraries(target ${package_TARGETS})`. The
fix adds it to the call that has the others.

## Limitations

- The script, or that of a package of the workspace which it finds, cannot be followed everywhere.
- The target may get include directories from elsewhere: folders outside of the package, options of the compiler, variables
  that nobody knows, imported targets.
- The package comes along, or may come along, with one that the target is given, itself or by targets of this package, under
  whatever condition.
- The include or the source is not part of every build, or serves tests only.
- Nothing finds the package: that is `missing-find-package`. Or it is a vendor package: what it brings has names of its own.

The confidence is medium for headers that need not lie in a folder of their own: those of released packages, generated ones
aside, and of packages of the workspace where the target is given another one of it.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from ros_lint.api import (
    VENDOR,
    BuildTarget,
    Confidence,
    Edit,
    Facet,
    Finding,
    Fix,
    Package,
    Related,
    Rule,
    Severity,
    Use,
    Workspace,
    called,
    cmake_edits,
    evaluated_name,
    finds_declared,
    found_along,
    found_names,
    given_for,
    may_bring,
    relative,
)


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    script = package.script
    if script is None or script.problems or script.reaches_out or package.builds_with != "ament_cmake":
        return
    if script.hides(Facet.USES) or finds_declared(package):
        return
    found = found_names(package, script)
    if any(each.hidden(Facet.USES) for name in found for each in workspace.by_name.get(name, ())):
        return  # what it does to those who find it is not seen
    interfaces = [mention.name for mention in given_for(script, "interfaces")]
    packages = [name for name in found if workspace.world.is_package(name) and not name.endswith(VENDOR)]
    uses = _includes(package, frozenset(packages))
    for target in script.targets:
        if target.headers is None or target.kind == "interface":
            continue
        needed: dict[str, list[Use]] = {}
        for source in target.sources:
            if source in package.compiled_along and source not in target.optional:
                for path in (source, *sorted(package.compiled_along[source])):
                    for use in uses.get(path, ()):
                        needed.setdefault(use.package, []).append(use)
        if not needed.keys() <= set(target.headers):
            yield from _not_given(package, workspace, target, [*target.headers, *interfaces], needed)


def _includes(package: Package, wanted: frozenset[str]) -> dict[str, list[Use]]:
    """Return the includes of some packages that every build compiles, by file."""
    found: dict[str, list[Use]] = {}
    for use in package.uses:
        compiled = use.via == "include" and use.sure and not use.optional
        if compiled and use.package in wanted and wanted.isdisjoint(use.providers[1:]):
            found.setdefault(relative(package, use.span.path), []).append(use)
    return found


def _not_given(
    package: Package, workspace: Workspace, target: BuildTarget, given: list[str], needed: dict[str, list[Use]]
) -> Iterator[Finding]:
    """Yield what a target is not given, of the packages that its sources include."""
    along = found_along(workspace, given)
    alone = not any(name in along for name in workspace.by_name)
    for name, uses in needed.items():
        if name in along or (not along.complete and may_bring(along.unknown, name, workspace)):
            continue
        first, *others = dict.fromkeys(uses)
        apart = _GENERATED.match(first.name) or (alone and name in workspace.by_name)
        way_out, edit = _way_out(package, workspace, target, name)
        places = [Related(f"{target.name} is built here", target.span)]
        places += [Related(f"also {use.what}", use.span) for use in others]
        yield Finding(
            f"{first.what} needs {name}, which {target.name} is not given, nor does it come with what it is given: add {way_out}",
            first.span,
            name,
            tuple(places),
            Fix.of(f"give {name} to {target.name}", edit),
            Confidence.HIGH if apart else Confidence.MEDIUM,
        )


_GENERATED = re.compile(r"\w+/(?:msg|srv|action)/\w+\.h(?:pp)?\Z")
"""Headers of interfaces, which rosidl installs to include/<package>/<package>."""


def _way_out(package: Package, workspace: Workspace, target: BuildTarget, name: str) -> tuple[str, Edit | None]:
    """Return the command that gives a target a package, and the edit that adds it to the one there is."""
    ways = [("ament_target_dependencies", name)]
    if cmake_edits.exports_targets(name, workspace):
        ways.append(("target_link_libraries", f"${{{name}_TARGETS}}"))
    for command, word in ways:
        for call in called(package, command):
            if len(call.args) > 1 and not call.blocks and evaluated_name(package, call.texts[0]) == target.name:
                return f"{command}({target.name} {word})", cmake_edits.add_argument(call, word)
    command, word = ways[0] if ways[0][0] in package.built.calls else ways[-1]
    return f"{command}({target.name} {word})", None


RULE = Rule(
    name="unlinked-dependency",
    code="ROS210",
    summary="targets must be given the packages whose headers their sources include",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
