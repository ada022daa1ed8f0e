"""
## What it finds

A launch file that starts something from a package, includes one of its files or looks the package up, although no package has
that name: not in the workspace, not in an underlay, and not in the release of the distribution.

The message suggests another package in these cases:

- A package with a similar name exists.
- The package of the launch file installs the executables that are started. It was renamed, or the launch file was copied.
- Exactly one package of the workspace installs the executables that are started.
- The name lacks the first word that the packages of a project share: `planner_utils` for `acme_planner_utils` in a launch file
  of `acme_bringup`. Nothing is suggested if `acme_planner_utils` lacks the executables and files that the launch file names.

## Why it matters

The launch file stops there: `package 'x' not found`. The usual reasons are a typo, a package that was renamed, and a package
that was never ported from ROS 1.

## How to fix it

Correct the name. The fix does this if only one name is possible. If the package is built from source in another workspace, name
that workspace with `--underlay`.

## Limitations

Not reported:

- There is no package index for the distribution.
- The distribution was not chosen, and another one has the package.
- The launch file checks first whether the package exists.
- The name contains a `$`, because the file is a template.
- The package may be in a repository that a `.repos` file, a `.rosinstall` file or `.gitmodules` lists and that is not cloned: the
  name of the package is that of the repository, or begins with it.
- `package.xml` declares the name as well, and no package has a similar name: `unknown-dependency` or `end-of-life-dependency`
  reports it.

Reported with medium confidence:

- The name is unknown and similar to no other, because vendors may not release their drivers. If the package is started
  unconditionally and `package.xml` does not declare it, not even for another distribution, it is a warning with high confidence
  instead: users who install this package do not get it.
- A `*.repos` or `*.rosinstall` file fetches a repository of that name.
- The name is the default of an argument.
- `package.xml` declares the name as well, a package has a similar name, and the name is valid for a package (REP 144: no
  dashes, no capitals).
- Launch files of examples, and of tests that the build script does not run. A launch file that only has a test-like name but is
  always installed is not affected.
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
    dependencies,
    first_related,
    launch,
    names,
)


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    if not workspace.world.knowledge.covered:
        return
    declared = frozenset(depend.name for depend in package.declared)
    for name, places in _unknown(package, workspace):
        verdict = _verdict(name, places, package, workspace)
        if verdict is None or (name in declared and not verdict.resembles):
            continue
        best, *_ = ordered = sorted(places)
        spans = list(dict.fromkeys([place.reference.package_span for place in ordered]))  # a path can name its package twice
        wanted = not (best.apart or best.by_default)
        left_out = (
            wanted
            and verdict.confidence is not Confidence.HIGH
            and not (best.idle or best.conditional or name in workspace.world.awaited.listed)
            and _is_outside_dependencies(name, package, workspace)
        )
        hint = _hint_to_declare(name, package, workspace) if left_out and not verdict.known else ""
        if not (hint or verdict.meant or verdict.known or verdict.hint.endswith("?")):
            hint = "; correct the name, or add the sources of the package to the workspace"
        yield Finding(
            f"there is no package '{name}'{_joined(verdict.hint, hint)}",
            best.reference.package_span,
            name,
            first_related(Related(f"'{name}' is also named here", span) for span in spans[1:]),
            launch.rename_fix(
                f"write '{verdict.meant}' instead of '{name}'",
                verdict.meant,
                [(place.reference.package_span, place.reference.package_exact) for place in places],
            ),
            Confidence.HIGH if left_out else verdict.confidence if wanted else Confidence.MEDIUM,
            severity=Severity.WARNING if left_out else None,
        )


class _Place(NamedTuple):
    """A place in a launch file that names an unknown package. In sorted order, the best place for the finding comes first."""

    apart: bool
    """True if the launch file is an example, or a test that the build script does not run."""
    by_default: bool
    """True if the name is the default of a launch argument."""
    idle: bool
    """True if the launch file is not installed."""
    conditional: bool
    span: Span
    reference: LaunchReference


def _joined(question: str, hint: str) -> str:
    """Return ``question`` followed by ``hint``. After a question mark, the hint is a sentence of its own."""
    if not (hint and question.endswith("?")):
        return f"{question}{hint}"
    first = hint.removeprefix("; ")
    return f"{question} {first[0].upper()}{first[1:]}"


def _hint_to_declare(name: str, package: Package, workspace: Workspace) -> str:
    """Return the end of the message for a package that may be available elsewhere: how to declare it in package.xml."""
    tag = dependencies.tag_for(package, workspace, name, Role.EXEC)
    if condition := dependencies.condition_for(workspace, name):
        return f'; add <{tag} condition="{condition}">{name}</{tag}>{dependencies.condition_format(package)}'
    return f"; if '{name}' is available elsewhere, add <{tag}>{name}</{tag}>"


def _is_outside_dependencies(name: str, package: Package, workspace: Workspace) -> bool:
    """Return whether ``package`` certainly does not depend on ``name``, directly or indirectly.

    A tag with a false condition counts as a declaration, because the package is not needed in this distribution. An unknown
    dependency is assumed not to depend on a package that ROS 2 replaced by another package.
    """
    manifest = package.manifest
    if manifest is None or manifest.problems or any(depend.name == name for depend in manifest.depends):
        return False
    closure = dependencies.declared_closure(package, workspace, Role.EXEC | Role.EXPORT)
    replaced = bool(workspace.world.successor(name))
    return name not in closure and (replaced or not dependencies.may_provide(closure.unknown, name, workspace))


class _Verdict(NamedTuple):
    hint: str
    confidence: Confidence
    meant: str = ""
    resembles: bool = True
    """True if the name is probably a typo or an old name, not a package that is unavailable."""
    known: bool = False
    """True if the hint names the replacement in ROS 2, or a package with the same words in another order.

    Then the unknown package is assumed not to be available elsewhere.
    """


def _unknown(package: Package, workspace: Workspace) -> Iterator[tuple[str, list[_Place]]]:
    """Yield each unknown package name with the places in launch files that name it.

    A name may be yielded twice: with the places that start executables of this package, and with all other places.
    """
    unknown: dict[tuple[str, bool], list[_Place]] = {}
    own = launch.installed_programs(package)
    hidden = bool(package.hidden(Facet.SHARE))
    for launch_file in launch.package_launch_files(package, apart=True):
        idle = not (launch_file.installed or hidden)
        for reference in launch_file.file.references:
            name = reference.package
            unknowable = workspace.world.resolution(name) == "unknowable" or name in workspace.world.awaited.uncloned
            if "$" in name or reference.kind == "program" or unknowable:
                continue  # a template, a program without a package, or a submodule that is not cloned
            if not workspace.world.is_package(name) and name != package.name and not reference.optional:
                place = _Place(
                    not launch_file.run, reference.from_default, idle, reference.conditional, reference.span, reference
                )
                is_own = own is not None and reference.kind == "node" and reference.name in own.names
                unknown.setdefault((name, is_own), []).append(place)
    yield from ((name, places) for (name, _), places in unknown.items())


def _verdict(name: str, places: Sequence[_Place], package: Package, workspace: Workspace) -> _Verdict | None:
    world = workspace.world
    meant = world.meant(name)
    if meant is not None and world.is_package(meant.name):
        return _Verdict(names.ask_if_meant([meant.name]), Confidence.HIGH, meant.name)
    renamed = [other for other in workspace.by_name if other.endswith(f"_{name}")]
    if len(renamed) == 1 and _may_have(renamed[0], places, workspace, all):
        return _Verdict(names.ask_if_meant([renamed[0]]), Confidence.HIGH, renamed[0])
    distro, date = workspace.target.distro, world.knowledge.date
    elsewhere = world.where_else(name)
    if elsewhere:
        if not workspace.target.explicit:
            return None
        return _Verdict(
            f" in {distro}, only in {', '.join(elsewhere)} (package index of {date})", Confidence.MEDIUM, resembles=False
        )
    own = launch.installed_programs(package)
    wanted = dict.fromkeys(place.reference.name for place in places)
    if own and own.names.issuperset(wanted) and places[0].reference.kind == "node":
        return _Verdict(
            f"; write '{package.name}', which installs {names.shorten_list(list(wanted))}", Confidence.HIGH, package.name
        )
    family = f"{package.name.partition('_')[0]}_{name}"
    if "_" in name and world.is_package(family) and _may_have(family, places, workspace, all):
        return _Verdict(names.ask_if_meant([family]), Confidence.HIGH, family)
    ended = world.knowledge.names.end_of_life(name)
    if ended:
        successor = world.successor(name)
        use = f"; use '{successor}'{_its_program(successor, places, workspace)}" if successor else ""
        hint = f" in {distro}; it was last released for {ended[0]} (package index of {date}){use}"
        return _Verdict(hint, Confidence.MEDIUM, resembles=False, known=bool(use))
    known = [other for other in world.suggest(name) if world.is_package(other)]
    near = [other for other in known if other not in workspace.by_name or _may_have(other, places, workspace)]
    reordered = [] if near else [other for other in _reordered(name, workspace) if _may_have(other, places, workspace)]
    nowhere = f" in the workspace, the underlays or {distro} (package index of {date})"
    # The same confidence as unknown-dependency has for a name in package.xml.
    invalid = package.declares(name) and not names.may_be_package(name)
    alike = near or reordered
    hint = f"{nowhere}{names.did_you_mean(alike) if alike else _ask_if_installer(places, package, workspace)}"
    confidence = Confidence.HIGH if invalid else Confidence.MEDIUM
    return _Verdict(hint, confidence, resembles=bool(known or reordered), known=bool(reordered))


def _ask_if_installer(places: Sequence[_Place], package: Package, workspace: Workspace) -> str:
    """Return the question whether the only package that installs all executables of ``places`` is meant.

    The result is "" if there is no such package, or it lacks a file that ``places`` look up.
    """
    wanted = list(dict.fromkeys(place.reference.name for place in places if place.reference.kind == "node"))
    other = launch.only_installer(wanted, package, workspace)
    if not other or not _may_have(other, places, workspace, all):
        return ""
    return f"; did you mean '{other}', which installs {names.shorten_list(wanted)}?"


def _its_program(successor: str, places: Sequence[_Place], workspace: Workspace) -> str:
    """Return the only executable of the released package ``successor`` as `` (executable 'x')``.

    The result is "" if the successor has several executables, or its executable has the name that launch files start.
    """
    programs = workspace.world.executables(successor).names
    wanted = {place.reference.name for place in places if place.reference.kind == "node"}
    return f" (executable '{programs[0]}')" if wanted and len(programs) == 1 and not wanted.intersection(programs) else ""


def _may_have(
    other: str, places: Sequence[_Place], workspace: Workspace, how_many: Callable[[Iterable[bool]], bool] = any
) -> bool:
    """Return whether package ``other`` may have the executables and files that the places look up in a missing package.

    ``how_many`` is ``any`` if one of the executables and files suffices, ``all`` if ``other`` must have all.
    """
    named = [place.reference for place in places if place.reference.name]
    return not named or how_many(_may_offer(other, reference, workspace) for reference in named)


def _may_offer(other: str, reference: LaunchReference, workspace: Workspace) -> bool:
    packages = workspace.by_name.get(other, ())
    name = reference.name
    if not packages:
        known = {"node": workspace.world.executables, "include": workspace.world.launch_files}.get(reference.kind)
        return known is None or known(other).ask(name) != "missing"
    if reference.kind == "node":
        return any(_may_start(package, name) for package in packages)
    if reference.kind not in ("include", "file"):
        return True
    return any(
        package.hidden(Facet.SHARE)
        or name in package.files
        or any(provided.path == f"share/{other}/{name}" for provided in package.built.products.installs)
        for package in packages
    )


def _may_start(package: Package, name: str) -> bool:
    installed = launch.installed_programs(package)
    return installed is None or _has_like(name, (*installed.names, *installed.elsewhere))


def _has_like(name: str, programs: Iterable[str]) -> bool:
    """Return whether the words of ``name`` are in the name of a program: ``talker`` in ``demo_talker_node``.

    Packages that are renamed often rename their programs as well.
    """
    return any(f"_{name}_" in f"_{program}_" for program in programs)


def _reordered(name: str, workspace: Workspace) -> list[str]:
    """Return the only package of the workspace that contains all words of a name in another order, or []."""
    words = set(name.split("_"))
    alike = [other for other in workspace.by_name if name not in other and words.issubset(other.split("_"))]
    return alike if len(words) > 1 and len(alike) == 1 else []


RULE = Rule(
    name="launch-unknown-package",
    code="ROS501",
    summary="packages that launch files name exist",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
