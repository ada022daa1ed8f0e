"""
## What it finds

- A CMake script that uses a ROS package without having found it: a target `package::library`, an argument of
  `ament_target_dependencies()`, or a macro of the package.
- A declared package that nothing finds, while a compiled source includes its headers.
- What `ament_target_dependencies()` and `ament_export_dependencies()` are given for a package and is none: a target, a slip
  for the name of a package that is found, or two such names with no blank between them; the first of them also the package
  itself. What is exported and unknown otherwise is told with medium confidence.
- A `find_package()` of the package itself.

## Why it matters

CMake stops: the target, the package or the command is not known. Where it happens under a condition, it stops for
those for whom the condition holds. What is exported stops those who find this package.

## How to fix it

Add `find_package(package REQUIRED)`, before the first use. The fix corrects what is a slip for
packages that are found.

## Limitations

- The package comes along with one that is found, so that it is mostly found, too, or nobody knows what comes along: the
  confidence is medium. Packages that are there for their commands, such as `ament_cmake_gtest`, come along by design.
- The script cannot be followed everywhere, or the use hangs on a condition that cannot be decided.
- The name belongs to no ROS package that is known, to no target either, and looks like no name that is found; or it is that
  of a package that is found, in other capitals. Not so for a declared one under `DEPENDENCIES` of
  `rosidl_generate_interfaces()`: only packages can stand there.
- What is exported and not found is declared, or something in the package finds it.
- A command that comes from another package of the workspace uses the package: that other one has to find it.
- The script adds a folder outside of the package to its include directories: headers may be found there.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from ros_lint.api import (
    VENDOR,
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
    called,
    cmake_edits,
    come_along,
    config_names,
    few,
    found_names,
    is_cut_short,
    is_meant,
    misspelt,
    relative,
    several,
    similar,
)

_NOT_SOUGHT = ("export", "plugins", "helper")
"""What names packages without asking whether they have been found here."""
_INCLUDING = ("include_directories", "target_include_directories")


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    script = package.script
    if script is None or package.builds_with != "ament_cmake":
        return
    yield from (Finding(it.message, it.span, it.subject) for it in script.refused if it.kind == "no-package")
    if is_cut_short(script) or script.hides(Facet.USES):
        return
    found = found_names(package, script)
    spelt = {name.lower() for name in found}  # namespaces of targets may be spelt another way: RTABMap, rtabmap::core
    along = come_along(workspace, found)
    yield from _no_packages(package, found, workspace)
    missing: dict[str, list[tuple[str, Related]]] = {}
    hoped: set[str] = set()
    for mention in script.mentions:
        name = mention.name.partition("::")[0]
        if mention.via not in ("target", "macro") or mention.optional or name.lower() in spelt or name == package.name:
            continue
        if mention.via == "macro" and (along is None or not along.isdisjoint(workspace.world.by_macro(name).names)):
            if _gives_commands(name):
                continue
            hoped.add(name)
        stated = mention.purpose == "interfaces" and package.declares(name)
        if mention.purpose in _NOT_SOUGHT or not (stated or workspace.world.is_package(name)):
            continue
        what = mention.what or mention.name
        missing.setdefault(name, []).append((what, Related(f"also needed here: {what}", mention.span)))
    for name, places in missing.items():
        (what, first), *others = places
        sure = along is not None and name not in along and name not in hoped
        where = "which nothing finds" if sure else "which comes along with what is found, if at all"
        yield Finding(
            f"{what} needs {name}, {where}: add find_package({name} REQUIRED) before",
            first.span,
            name,
            several(place for _, place in others),
            confidence=Confidence.HIGH if sure else Confidence.MEDIUM,
            severity=None if sure else Severity.INFO,
        )
    yield from (finding for finding in _included(package, along, workspace) if finding.subject not in missing)


def _gives_commands(name: str) -> bool:
    """Whether a package is called like those that are there for their commands, and come along with the build tool."""
    return "cmake" in name or name.startswith(("ament_", "rosidl_")) or name.endswith(VENDOR)


def _included(package: Package, along: frozenset[str] | None, workspace: Workspace) -> Iterator[Finding]:
    """Yield the declared packages whose headers compiled sources include, and that are certainly not found."""
    if along is None:
        return
    folders = (text for call in called(package, *_INCLUDING, anywhere=True) for text in call.texts)
    if any(text.startswith("/") or ".." in text for text in folders):
        return  # headers are taken from sources of others, or from where they are installed
    world = workspace.world
    targets = package.built.targets
    compiled = {source for target in targets for source in target.sources if source not in target.optional}
    places: dict[str, list[Use]] = {}
    for use in package.uses:
        if use.via == "include" and not use.optional and relative(package, use.span.path) in compiled:
            places.setdefault(use.package, []).append(use)
    for name, uses in places.items():
        providers = {provider for use in uses for provider in use.providers}
        if package.declares(name) and world.is_package(name) and providers.isdisjoint(along):
            first, *others = uses
            yield Finding(
                f"{first.what} needs {name}, which is declared and which nothing finds: add find_package({name} REQUIRED), and "
                "link it where it is included",
                first.span,
                name,
                several(Related(f"also included here: {use.what}", use.span) for use in others),
            )


def _no_packages(package: Package, found: frozenset[str], workspace: Workspace) -> Iterator[Finding]:
    """Yield what is given for a package and is none for sure: a target, or a slip for what is found.

    What is exported need not be found here. Who declares it, or has a module that finds it, knows more of it than is known.
    What the manifest has by a wrong name is found once that is mended, which is told.
    """
    script = package.script
    assert script is not None
    world = workspace.world
    targets = {target.name for target in script.targets}
    spelt = {name.lower() for name in found}.union(name.lower() for name in misspelt(package, workspace).values())
    for call in called(package, *_GIVEN, anywhere=True):
        if _REPEATED.intersection(call.blocks):
            continue
        given = {name: index for index, name in enumerate(call.texts) if index or call.name == _EXPORTS}
        odd = {name: at for name, at in given.items() if name.lower() not in spelt and not world.is_package(name)}
        if call.name == _EXPORTS:
            odd = {name: at for name, at in odd.items() if not _is_findable(package, name, workspace)}
        yield from _targets(call, {name: index for name, index in odd.items() if name in targets})
        for name, index in odd.items():
            if name not in targets and (meant := _meant(name, found)):
                hint = f"; are {' and '.join(meant)} meant?" if len(meant) > 1 else is_meant(meant)
                yield Finding(
                    f"{call.name}() takes packages, and {name} is no package that is found{hint}",
                    call.span(index),
                    name,
                    fix=Fix.of(f"write {' '.join(meant)}", cmake_edits.write(call, index, " ".join(meant)), safe=False),
                )
            elif name not in targets and call.name == _EXPORTS and _is_plain(name):
                yield Finding(
                    f"{name} is exported, but nothing finds it here, and no package is called so as far as is known: whoever "
                    f"finds {package.name} stops",
                    call.span(index),
                    name,
                    confidence=Confidence.MEDIUM,
                )


def _is_findable(package: Package, name: str, workspace: Workspace) -> bool:
    """Whether there may be something that CMake finds by a name which nothing finds in this package, or it has been told of."""
    if "::" in name:
        return True  # CMake refuses it, which is told
    world = workspace.world
    modules = (f"Find{name}.cmake", *config_names(name))
    if package.declares(name) or any(file.endswith(modules) for file in package.files):
        return True
    return world.standing(name) != "unknown" or world.by_cmake(name).known


def _is_plain(name: str) -> bool:
    """Whether an argument is the name that it looks like: no variable, no text, and no target of another package."""
    return bool(name) and name.replace("-", "_").isidentifier()


def _meant(name: str, found: frozenset[str]) -> tuple[str, ...]:
    """Return what must be meant by a name that nothing has: two that are found with no blank between them, or a like one."""
    for end in range(1, len(name)):
        if name[:end] in found and name[end:] in found:
            return name[:end], name[end:]
    return tuple(similar(name, sorted(found), 1, 0.9))


def _targets(call: Call, given: Mapping[str, int]) -> Iterator[Finding]:
    """Yield one finding for the targets of the package that a call is given, by their names with their arguments."""
    if given:
        (name, at), *others = given.items()
        are, it = ("are targets", "them") if others else ("is a target", "it")
        way_out = "export" if call.name == _EXPORTS else "link"
        yield Finding(
            f"{call.name}() takes packages, and {few(given)} {are} of this package: {way_out} {it} with {_GIVEN[call.name]}()",
            call.span(at),
            name,
            several(Related(f"and {other}", call.span(index)) for other, index in others),
        )


_EXPORTS = "ament_export_dependencies"
_GIVEN = {"ament_target_dependencies": "target_link_libraries", _EXPORTS: "ament_export_targets"}
"""Commands that are given packages, and those that are given targets for the same."""
_REPEATED = frozenset({"foreach", "while", "function", "macro"})
"""In these a name may be one that is put together elsewhere."""


RULE = Rule(
    name="missing-find-package",
    code="ROS206",
    summary="a package that a CMake script uses must be found",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
