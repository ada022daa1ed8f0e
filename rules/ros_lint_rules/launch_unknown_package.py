"""
## What it finds

A launch file that starts something from a package, includes a file of it or looks it up, while no package has that
name: none of the workspace, none of an underlay, none that is released for the distribution.

Where the package of the launch file installs what is started from the unknown one, it is taken for that package: it was
renamed, or the launch file was copied.

A name without the first word that the packages of a project share, `planner_utils` for `acme_planner_utils` in a package
`acme_bringup`, is taken for that package where it exists, unless nothing of what is named is in there.

## Why it matters

The launch file stops there: `package 'x' not found`. The usual reasons are a slip of the pen, a package that was
renamed, and one that was never ported from ROS 1.

## How to fix it

Correct the name; the fix does this where the name that was meant is beyond doubt. If the package is built from source
elsewhere, check with the workspace that holds it as `--underlay`.

## Limitations

- There are no data about the distribution.
- Nobody said which distribution is meant, and another one has the package.
- The launch file asks first if the package is there.
- The name has a dollar in it: it stands in a template.
- A git submodule that is not cloned has a folder of the name. Where a `*.repos` or `*.rosinstall` has a repository of the name
  fetched, the confidence is medium.
- The name is that of a default which an argument can replace: then the confidence is medium.
- The name is merely unknown: that may be a driver that its vendor does not release. Then the confidence is medium, unless
  the package is started under no condition and `package.xml` does not declare it either: wherever it comes from, whoever
  installs this package does not get it. That is a warning.
- `package.xml` declares the name as well, and it resembles no other: then `unknown-dependency` or
  `end-of-life-dependency` tells of it, once. If it resembles one, the confidence is medium for what a package may be called
  (REP 144: no dashes, no capitals).
- In launch files of examples, and of tests that the build script is not seen to run, the confidence is medium; one that is
  merely called a test and always installed counts like any other.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import NamedTuple

from ros_lint.api import (
    Confidence,
    Facet,
    Finding,
    LaunchReference,
    Package,
    Related,
    Role,
    Rule,
    Severity,
    Span,
    Workspace,
    corrected,
    declared_closure,
    did_you_mean,
    few,
    launchable,
    may_be_package,
    may_bring,
    programs,
    several,
    tag_for,
)


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    if not workspace.world.knowledge.covered:
        return
    declared = frozenset(one.name for one in package.declared)
    for name, places in _unknown(package, workspace):
        verdict = _verdict(name, places, package, workspace)
        if verdict is None or (name in declared and not verdict.resembles):
            continue
        best, *_ = ordered = sorted(places)
        spans = list(dict.fromkeys([place.reference.package_span for place in ordered]))  # what is made of a path names it again
        wanted = not (best.apart or best.by_default)
        left_out = (
            wanted
            and verdict.confidence is not Confidence.HIGH
            and not (best.idle or best.conditional or name in workspace.world.awaited.listed)
            and _never_comes(name, package, workspace)
        )
        told = _undeclared(name, package, workspace) if left_out and not verdict.known else ""
        yield Finding(
            f"there is no package {name}{verdict.hint}{told}",
            best.reference.package_span,
            name,
            several(Related("also named here", span) for span in spans[1:]),
            corrected(
                f"say {verdict.meant} instead of {name}",
                verdict.meant,
                [(place.reference.package_span, place.reference.package_exact) for place in places],
            ),
            Confidence.HIGH if left_out else verdict.confidence if wanted else Confidence.MEDIUM,
            severity=Severity.WARNING if left_out else None,
        )


class _Place(NamedTuple):
    """Where a package is named; the most telling place is the least."""

    apart: bool
    """Whether the launch file is an example, or a test that nothing is seen to run."""
    by_default: bool
    idle: bool
    """Whether the launch file is not installed."""
    conditional: bool
    span: Span
    reference: LaunchReference


def _undeclared(name: str, package: Package, workspace: Workspace) -> str:
    """Return how a message goes on about a package that may be had elsewhere, and that is not declared either."""
    tag = tag_for(package, workspace, name, Role.EXEC)
    return f"; if it comes from elsewhere, declare it: add <{tag}>{name}</{tag}>"


def _never_comes(name: str, package: Package, workspace: Workspace) -> bool:
    """Whether nothing that is declared is a package of some name, or may bring it along.

    What took another name in ROS 2 is not brought by what nobody knows.
    """
    manifest = package.manifest
    if manifest is None or manifest.problems or package.tags(name):
        return False
    closure = declared_closure(package, workspace, Role.EXEC | Role.EXPORT)
    replaced = bool(workspace.world.successor(name))
    return name not in closure and (replaced or not may_bring(closure.unknown, name, workspace))


class _Verdict(NamedTuple):
    hint: str
    confidence: Confidence
    meant: str = ""
    resembles: bool = True
    """Whether it is a slip, or was renamed, rather than a package that is nowhere to be had."""
    known: bool = False
    """Whether the hint names what does the same in ROS 2, or is of these words: then it is not to be had elsewhere."""


def _unknown(package: Package, workspace: Workspace) -> Iterator[tuple[str, list[_Place]]]:
    """Yield the names that are no package, where they stand; those apart that are to start what this package installs."""
    found: dict[tuple[str, bool], list[_Place]] = {}
    own = programs(package)
    hidden = bool(package.hidden(Facet.SHARE))
    for launch in launchable(package, apart=True):
        idle = not (launch.installed or hidden)
        for reference in launch.file.references:
            name = reference.package
            unknowable = workspace.world.standing(name) == "unknowable" or name in workspace.world.awaited.uncloned
            if "$" in name or reference.kind == "program" or unknowable:
                continue  # a template, for whoever fills it in; no package at all; a submodule that is not cloned
            if not workspace.world.is_package(name) and name != package.name and not reference.optional:
                place = _Place(not launch.run, reference.by_default, idle, reference.conditional, reference.span, reference)
                is_own = own is not None and reference.kind == "node" and reference.name in own.names
                found.setdefault((name, is_own), []).append(place)
    yield from ((name, places) for (name, _), places in found.items())


def _verdict(name: str, places: Sequence[_Place], package: Package, workspace: Workspace) -> _Verdict | None:
    world = workspace.world
    meant = world.meant(name)
    if meant is not None and world.is_package(meant.name):
        return _Verdict(f": {meant.name} is meant", Confidence.HIGH, meant.name)
    renamed = [other for other in workspace.by_name if other.endswith(f"_{name}")]
    if len(renamed) == 1 and _may_have(renamed[0], places, workspace, all):
        return _Verdict(f": the workspace has {renamed[0]}", Confidence.HIGH, renamed[0])
    distro, date = workspace.target.distro, world.knowledge.date
    elsewhere = world.where_else(name)
    if elsewhere:
        if not workspace.target.told:
            return None
        return _Verdict(f" in {distro}, only in {', '.join(elsewhere)} (data of {date})", Confidence.MEDIUM, resembles=False)
    own = programs(package)
    wanted = dict.fromkeys(place.reference.name for place in places)
    if own and own.names.issuperset(wanted) and places[0].reference.kind == "node":
        return _Verdict(f": {package.name} itself installs {few(list(wanted))}", Confidence.HIGH, package.name)
    family = f"{package.name.partition('_')[0]}_{name}"
    if "_" in name and world.is_package(family) and _may_have(family, places, workspace, all):
        return _Verdict(f": {family} is meant", Confidence.HIGH, family)
    ended = world.knowledge.names.end_of_life(name)
    if ended:
        successor = world.successor(name)
        use = f": use {successor}" if successor else ""
        hint = f" in {distro}, it was last released for {ended[0]} (data of {date}){use}"
        return _Verdict(hint, Confidence.MEDIUM, resembles=False, known=bool(use))
    known = [other for other in world.suggest(name) if world.is_package(other)]
    near = [other for other in known if other not in workspace.by_name or _may_have(other, places, workspace)]
    reordered = [] if near else [other for other in _reordered(name, workspace) if _may_have(other, places, workspace)]
    nowhere = f" in the workspace, the underlays or {distro} (data of {date})"
    # As sure as unknown-dependency is of what package.xml declares.
    strange = package.declares(name) and not may_be_package(name)
    hint = f"{nowhere}{did_you_mean(near or reordered)}"
    confidence = Confidence.HIGH if strange else Confidence.MEDIUM
    return _Verdict(hint, confidence, resembles=bool(known or reordered), known=bool(reordered))


def _may_have(
    other: str, places: Sequence[_Place], workspace: Workspace, how_many: Callable[[Iterable[bool]], bool] = any
) -> bool:
    """Whether a package may have what is named of one that does not exist, any or all of it, if there is something."""
    named = [place.reference for place in places if place.reference.name]
    return not named or how_many(_may_offer(other, reference, workspace) for reference in named)


def _may_offer(other: str, reference: LaunchReference, workspace: Workspace) -> bool:
    packages = workspace.by_name.get(other, ())
    name = reference.name
    if not packages:
        known = {"node": workspace.world.executables, "include": workspace.world.launch_files}.get(reference.kind)
        return known is None or known(other).ask(name) != "missing"
    if reference.kind == "node":
        return any((found := programs(one)) is None or _has_like(name, (*found.names, *found.elsewhere)) for one in packages)
    if reference.kind not in ("include", "file"):
        return True
    return any(
        one.hidden(Facet.SHARE) or name in one.files or any(each.path == f"share/{other}/{name}" for each in one.built.provides)
        for one in packages
    )


def _has_like(name: str, programs: Iterable[str]) -> bool:
    """Whether one of some programs has a name, alone or with more words: what renames a package renames its programs, too."""
    return any(f"_{name}_" in f"_{program}_" for program in programs)


def _reordered(name: str, workspace: Workspace) -> list[str]:
    """Return the one package of the workspace that has all the words of a name, in another order."""
    words = set(name.split("_"))
    alike = [other for other in workspace.by_name if name not in other and words.issubset(other.split("_"))]
    return alike if len(words) > 1 and len(alike) == 1 else []


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
