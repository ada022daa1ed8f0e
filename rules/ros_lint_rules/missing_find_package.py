"""
## What it finds

- A CMake script that uses a ROS package without `find_package()`: a target `package::library`, an argument of
  `ament_target_dependencies()`, or a macro of the package.
- A declared package without `find_package()` whose headers a compiled source includes.
- Arguments of `ament_target_dependencies()` and `ament_export_dependencies()` that are not packages: a target, a typo of a found
  package, or two package names without a blank between them. For `ament_target_dependencies()` also the package itself.
- An argument of `ament_export_dependencies()` that is otherwise unknown, with medium confidence.
- A `find_package()` of the package itself.

## Why it matters

CMake stops because the target, package or command is unknown. Under a condition, it stops only for users for whom the condition
holds. A wrong export makes `find_package()` of this package fail in other packages.

## How to fix it

Add `find_package(package REQUIRED)` before the first use. The fix corrects typos of found packages.

## Limitations

Not reported:

- Scripts that cannot be fully analysed, and uses under a condition that cannot be decided.
- Names that are neither a known ROS package nor a target and resemble no found package, unless they are declared and listed under
  `DEPENDENCIES` of `rosidl_generate_interfaces()`, which accepts only packages.
- Names that differ from a found package only in upper and lower case.
- Exported names that are declared or that a module of the package finds.
- Packages that a command of another workspace package uses: that package has to find them.
- Included headers, if the script adds a folder outside of the package to its include directories.
- Packages that provide commands, such as `ament_cmake_gtest`, if they come with a found package.

If a found package provides the missing one transitively, or its dependencies are unknown, the confidence is medium.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from ros_lint.api import (
    Call,
    Confidence,
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
    first_related,
    names,
)

_NO_EVIDENCE = ("export", "plugins", "helper")
"""Purposes of mentions that do not require find_package() in this script."""
_INCLUDING = ("include_directories", "target_include_directories")


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    script = package.script
    if script is None or package.builds_with != "ament_cmake":
        return
    wrong = (problem for problem in script.cmake.errors if problem.kind == "no-package")
    yield from (Finding(problem.message, problem.span, problem.subject) for problem in wrong)
    if build.stops_early(script) or script.hides(Facet.USES):
        return
    found = dependencies.names_searched(package, script)
    spelt = {name.lower() for name in found}  # namespaces of targets may differ in case: RTABMap, rtabmap::core
    along = dependencies.find_package_closure(workspace, found)
    yield from _no_packages(package, found, workspace)
    missing: dict[str, list[tuple[str, Related]]] = {}
    probable: set[str] = set()
    for mention in script.mentions:
        name = mention.name.partition("::")[0]
        if mention.via not in ("target", "macro") or mention.optional or name.lower() in spelt or name == package.name:
            continue
        if mention.via == "macro" and (along is None or not along.isdisjoint(workspace.world.by_macro(name).names)):
            if _gives_commands(name):
                continue
            probable.add(name)
        is_declared = mention.purpose == "interfaces" and package.declares(name)
        if mention.purpose in _NO_EVIDENCE or not (is_declared or workspace.world.is_package(name)):
            continue
        what = mention.what or mention.name
        missing.setdefault(name, []).append((what, Related(f"also needed here: {what}", mention.span)))
    for name, places in missing.items():
        (what, first), *others = places
        sure = along is not None and name not in along and name not in probable
        why = "but there is no find_package() for it" if sure else "which is found only if another package finds it"
        yield Finding(
            f"{what} needs '{name}', {why}; add find_package({name} REQUIRED) before it",
            first.span,
            name,
            first_related(place for _, place in others),
            confidence=Confidence.HIGH if sure else Confidence.MEDIUM,
            severity=None if sure else Severity.INFO,
        )
    yield from (finding for finding in _included(package, along, workspace) if finding.subject not in missing)


def _gives_commands(name: str) -> bool:
    """Return whether the name is that of a package which only provides commands and comes with the build tool."""
    return "cmake" in name or name.startswith(("ament_", "rosidl_")) or name.endswith(names.VENDOR)


def _included(package: Package, along: frozenset[str] | None, workspace: Workspace) -> Iterator[Finding]:
    """Yield the declared packages whose headers compiled sources include, but for which there is certainly no find_package()."""
    if along is None:
        return
    folders = (text for call in package.calls(*_INCLUDING, anywhere=True) for text in call.texts)
    if any(text.startswith("/") or ".." in text for text in folders):
        return  # the headers may be in the sources or install folder of another package
    world = workspace.world
    targets = package.built.products.targets
    compiled = {source for target in targets for source in target.sources if source not in target.optional_sources}
    places: dict[str, list[Use]] = {}
    for use in package.uses:
        if use.via == "include" and not use.optional and package.relative(use.span.path) in compiled:
            places.setdefault(use.package, []).append(use)
    for name, uses in places.items():
        providers = {provider for use in uses for provider in use.providers}
        if package.declares(name) and world.is_package(name) and providers.isdisjoint(along):
            first, *others = uses
            yield Finding(
                f"{first.what} needs '{name}', which is declared, but there is no find_package({name} REQUIRED); add it and link "
                "the package to the target",
                first.span,
                name,
                first_related(Related(f"also included here: {use.what}", use.span) for use in others),
            )


def _no_packages(package: Package, found: frozenset[str], workspace: Workspace) -> Iterator[Finding]:
    """Yield arguments that are certainly not packages: targets, and typos of found packages.

    Exported packages need not be found here; declared ones and those with a find module are accepted. Another rule reports
    misspelt names in the manifest, and once they are fixed, their packages are found.
    """
    script = package.script
    assert script is not None
    world = workspace.world
    targets = {target.name for target in script.products.targets}
    spelt = {name.lower() for name in found}.union(
        name.lower() for name in dependencies.misspelled_names(package, workspace).values()
    )
    for call in package.calls(*_TARGET_COMMANDS, anywhere=True):
        if _REPEATED.intersection(call.blocks):
            continue
        arguments = {name: index for index, name in enumerate(call.texts) if index or call.name == _EXPORTS}
        unknown = {name: at for name, at in arguments.items() if name.lower() not in spelt and not world.is_package(name)}
        if call.name == _EXPORTS:
            unknown = {name: at for name, at in unknown.items() if not _is_findable(package, name, workspace)}
        yield from _targets(call, {name: index for name, index in unknown.items() if name in targets})
        for name, index in unknown.items():
            if name not in targets and (all_names := _suggested(name, found)):
                hint = (
                    f"; did you mean '{all_names[0]}' and '{all_names[1]}'?"
                    if len(all_names) > 1
                    else names.ask_if_meant(all_names)
                )
                yield Finding(
                    f"{call.name}() expects packages, but there is no find_package({name}){hint}",
                    call.span(index),
                    name,
                    fix=Fix.of(f"write '{' '.join(all_names)}'", edits.cmake.write(call, index, " ".join(all_names)), safe=False),
                )
            elif name not in targets and call.name == _EXPORTS and _is_plain(name):
                yield Finding(
                    f"'{name}' is exported, but it is neither found here nor a known package, so find_package({package.name}) "
                    "fails in other packages",
                    call.span(index),
                    name,
                    confidence=Confidence.MEDIUM,
                )


def _is_findable(package: Package, name: str, workspace: Workspace) -> bool:
    """Return whether ``find_package(name)`` may succeed for unknown reasons, or the name is reported elsewhere."""
    if "::" in name:
        return True  # reported when the command is evaluated
    world = workspace.world
    modules = (f"Find{name}.cmake", *build.config_names(name))
    if package.declares(name) or any(file.endswith(modules) for file in package.files):
        return True
    return world.resolution(name) != "unknown" or world.by_cmake(name).known


def _is_plain(name: str) -> bool:
    """Return whether an argument is a plain name: not a variable, not text, and not a target of another package."""
    return bool(name) and name.replace("-", "_").isidentifier()


def _suggested(name: str, found: frozenset[str]) -> tuple[str, ...]:
    """Return the found packages for an unknown name: two names without a blank between them, or one similar name."""
    for end in range(1, len(name)):
        if name[:end] in found and name[end:] in found:
            return name[:end], name[end:]
    return tuple(names.similar_names(name, sorted(found), 1, 0.9))


def _targets(call: Call, all_names: Mapping[str, int]) -> Iterator[Finding]:
    """Yield one finding for all arguments of a call that are targets of this package."""
    if all_names:
        (name, at), *others = all_names.items()
        are, it = ("are targets", "them") if others else ("is a target", "it")
        verb = "export" if call.name == _EXPORTS else "link"
        yield Finding(
            f"{call.name}() expects packages, but {names.shorten_list(all_names)} {are} of this package; {verb} {it} with "
            f"{_TARGET_COMMANDS[call.name]}()",
            call.span(at),
            name,
            first_related(Related(f"also '{other}'", call.span(index)) for other, index in others),
        )


_EXPORTS = "ament_export_dependencies"
_TARGET_COMMANDS = {"ament_target_dependencies": "target_link_libraries", _EXPORTS: "ament_export_targets"}
"""Commands that take packages, with the commands that do the same for targets."""
_REPEATED = frozenset({"foreach", "while", "function", "macro"})
"""Blocks in which an argument may have several values."""


RULE = Rule(
    name="missing-find-package",
    code="ROS206",
    summary="a CMake script finds the packages that it uses",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
