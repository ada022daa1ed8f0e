"""
## What it finds

- A CMake script that uses a ROS package without `find_package()`: a target `package::library`, an argument of
  `ament_target_dependencies()`, or a macro of the package.
- A declared package without `find_package()` whose headers a compiled source includes.

## Why it matters

CMake stops because the target, package or command is unknown, or the compiler does not find the header. Under a condition, it
stops only for users for whom the condition holds.

## How to fix it

Add `find_package(package REQUIRED)` before the first use.

## Limitations

Not reported:

- Scripts that cannot be fully analysed, and uses under a condition that cannot be decided.
- Names that are no known ROS package (see `invalid-ament-dependency`). Exceptions: a declared package that other distributions
  have, and a declared name that is listed under `DEPENDENCIES` of `rosidl_generate_interfaces()`, which accepts only packages.
- Packages that a command of another workspace package uses: that package has to find them.
- Included headers, if the script adds a folder outside of the package to its include directories.
- Packages that provide commands, such as `ament_cmake_gtest`, if they come with a found package.

If a found package provides the missing one transitively, or its dependencies are unknown, the confidence is medium and the
severity info.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from functools import cache

from ros_lint.api import (
    Confidence,
    Facet,
    Finding,
    Package,
    Related,
    Rule,
    Severity,
    Use,
    Workspace,
    build,
    dependencies,
    first_related,
    names,
)

_NO_EVIDENCE = ("export", "plugins", "helper")
"""Purposes for which a script can name a package without find_package() (``Mention.purpose``)."""
_INCLUDING = ("include_directories", "target_include_directories")


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    script = package.script
    if script is None or package.builds_with != "ament_cmake":
        return
    if build.stops_early(script) or script.hides(Facet.USES):
        return
    found = dependencies.names_searched(package, script)
    spelt = {name.lower() for name in found}  # namespaces of targets may differ in case: RTABMap, rtabmap::core
    along = cache(lambda: dependencies.find_package_closure(workspace, found))  # many packages need no closure
    missing: dict[str, list[tuple[str, Related]]] = {}
    probable: set[str] = set()
    for mention in script.mentions:
        name = mention.name.partition("::")[0]
        if mention.via not in ("target", "macro") or mention.optional or name.lower() in spelt or name == package.name:
            continue
        if mention.via == "macro" and _finds_any(along(), workspace.world.by_macro(name).names):
            if _gives_commands(name):
                continue
            probable.add(name)
        is_declared = package.declares(name) and (mention.purpose == "interfaces" or workspace.world.where_else(name))
        if mention.purpose in _NO_EVIDENCE or not (is_declared or workspace.world.is_package(name)):
            continue
        what = mention.what or f"'{mention.name}'"
        missing.setdefault(name, []).append((what, Related(f"'{name}' is also needed here: {what}", mention.span)))
    for name, places in missing.items():
        (what, first), *others = places
        sure = name not in probable and not _finds_any(along(), (name,))
        why = "but there is no find_package() for it" if sure else "but only another package calls find_package() for it"
        yield Finding(
            f"{what} needs '{name}', {why}; add find_package({name} REQUIRED) before this use",
            first.span,
            name,
            first_related(place for _, place in others),
            confidence=Confidence.HIGH if sure else Confidence.MEDIUM,
            severity=None if sure else Severity.INFO,
        )
    yield from (finding for finding in _included(package, found, along, workspace) if finding.subject not in missing)


def _finds_any(along: frozenset[str] | None, wanted: Iterable[str]) -> bool:
    """Return whether CMake finds, or may find, one of the packages ``wanted`` along with those that the script finds."""
    return along is None or not along.isdisjoint(wanted)


def _gives_commands(name: str) -> bool:
    """Return whether the name of a package suggests that the package only provides CMake commands: ``ament_cmake_python``."""
    return "cmake" in name or name.startswith(("ament_", "rosidl_")) or name.endswith(names.VENDOR)


def _included(
    package: Package, found: frozenset[str], along: Callable[[], frozenset[str] | None], workspace: Workspace
) -> Iterator[Finding]:
    """Yield findings for declared packages whose headers the sources include, although no find_package() finds the package.

    ``found`` has the names that the script finds. ``along`` returns the packages that CMake finds, directly or through other
    packages; None if unknown.
    """
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
        candidate = package.declares(name) and world.is_package(name) and providers.isdisjoint(found)
        if candidate and not _finds_any(along(), providers):
            first, *others = uses
            yield Finding(
                f"{first.what} needs '{name}', which is declared, but there is no find_package({name} REQUIRED); add it and link "
                "the package to the target",
                first.span,
                name,
                first_related(dependencies.use_note(name, use, "is also included here") for use in others),
            )


RULE = Rule(
    name="missing-find-package",
    code="ROS206",
    summary="a CMake script finds the packages that it uses",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    package=check,
)
