"""
## What it finds

A source file that includes headers of a package, although the target that compiles it does not link the package, directly or
through what it links. CMake finds the package.

## Why it matters

Each package has its headers in its own folder, and only linking the package adds that folder. The compiler stops with "No such
file or directory". It does not help that other targets link the package.

## How to fix it

Link the package: `ament_target_dependencies(target package)`, or `target_link_libraries(target ${package_TARGETS})`. The fix
adds it to the existing call for the target.

## Limitations

Not reported:

- The build script of the package, or of a package of the workspace that it finds, cannot be fully evaluated.
- The target may get include directories in other ways: folders outside of the package, compiler options, unknown variables,
  imported targets.
- A package that the target links, directly or through targets of this package, provides or may provide the package with the
  headers, even under a condition.
- The include or the source is not part of every build, or is for tests only.
- No `find_package()` finds the package: see `missing-find-package`.
- Vendor packages, because their targets have other names.

Reported with medium confidence, because the headers may not be in a folder of their own:

- headers of released packages, except generated ones;
- headers of packages of the workspace, if the target links another package of the workspace.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from ros_lint.api import (
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
    build,
    dependencies,
    edits,
    names,
)


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    script = package.script
    if script is None or script.problems or script.cmake.includes_outside_package or package.builds_with != "ament_cmake":
        return
    if script.hides(Facet.USES) or dependencies.finds_declared(package):
        return
    all_names = dependencies.names_searched(package, script)
    if any(other.hidden(Facet.USES) for name in all_names for other in workspace.by_name.get(name, ())):
        return  # its effect on packages that find it is unknown
    interfaces = [mention.name for mention in dependencies.macro_packages(script, "interfaces")]
    packages = [name for name in all_names if workspace.world.is_package(name) and not name.endswith(names.VENDOR)]
    uses = _includes(package, frozenset(packages))
    for target in script.products.targets:
        if target.headers is None or target.kind == "interface":
            continue
        needed: dict[str, list[Use]] = {}
        for source in target.sources:
            if source in package.compiled_headers and source not in target.optional_sources:
                for path in (source, *sorted(package.compiled_headers[source])):
                    for use in uses.get(path, ()):
                        needed.setdefault(use.package, []).append(use)
        if not needed.keys() <= set(target.headers):
            yield from _unlinked(package, workspace, target, [*target.headers, *interfaces], needed)


def _includes(package: Package, wanted: frozenset[str]) -> dict[str, list[Use]]:
    """Return the #include lines of headers of the ``wanted`` packages, by file. Lines that a build may skip are left out."""
    includes: dict[str, list[Use]] = {}
    for use in package.uses:
        compiled = use.via == "include" and use.certain and not use.optional
        if compiled and use.package in wanted and wanted.isdisjoint(use.providers[1:]):
            includes.setdefault(package.relative(use.span.path), []).append(use)
    return includes


def _unlinked(
    package: Package, workspace: Workspace, target: BuildTarget, linked: list[str], needed: dict[str, list[Use]]
) -> Iterator[Finding]:
    """Yield a finding for each package that a target does not link, although its sources include headers of the package.

    ``needed``: the includes of these headers, by package.
    """
    closure = dependencies.partial_closure(workspace, linked, dependencies.names_searched)
    alone = not any(name in closure for name in workspace.by_name)
    for name, uses in needed.items():
        if name in closure or (not closure.complete and dependencies.may_provide(closure.unknown, name, workspace)):
            continue
        first, *others = dict.fromkeys(uses)
        has_own_folder = _GENERATED.match(first.name) or (alone and name in workspace.by_name)
        remedy, edit = _remedy(package, workspace, target, name)
        places = [Related(f"'{target.name}' is built here", target.span)]
        places += [dependencies.use_note(name, use, "is also needed here") for use in others]
        yield Finding(
            f"the target '{target.name}' includes this header, but does not link '{name}', directly or indirectly; add {remedy}",
            first.span,
            name,
            tuple(places),
            Fix.of(f"link '{name}' to '{target.name}'", edit),
            Confidence.HIGH if has_own_folder else Confidence.MEDIUM,
        )


_GENERATED = re.compile(r"\w+/(?:msg|srv|action)/\w+\.h(?:pp)?\Z")
"""Headers of interfaces, which rosidl installs to include/<package>/<package>."""


def _remedy(package: Package, workspace: Workspace, target: BuildTarget, name: str) -> tuple[str, Edit | None]:
    """Return the command that links a package to a target, and the edit that adds it to an existing call."""
    commands = [("ament_target_dependencies", name)]
    if edits.cmake.exports_targets(name, workspace):
        commands.append(("target_link_libraries", f"${{{name}_TARGETS}}"))
    for command, word in commands:
        for call in package.calls(command):
            if len(call.args) > 1 and not call.blocks and build.evaluated_name(package, call.texts[0]) == target.name:
                return f"{command}({target.name} {word})", edits.cmake.add_argument(call, word)
    command, word = commands[0] if commands[0][0] in package.built.commands.names else commands[-1]
    return f"{command}({target.name} {word})", None


RULE = Rule(
    name="unlinked-dependency",
    code="ROS210",
    summary="targets link the packages whose headers their sources include",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
