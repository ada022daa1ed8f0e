"""Needs that no declared dependency covers."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from ros_lint.analysis.dependencies.declared_closure import all_declared
from ros_lint.analysis.dependencies.needs import _TEST, Need, _rank, needs
from ros_lint.analysis.dependencies.traceless import only_brings
from ros_lint.analysis.dependencies.unknown_closure import may_provide
from ros_lint.analysis.dependencies.unresolved import intended_names, misspelled_names
from ros_lint.analysis.memo import cached_by_package
from ros_lint.facts.launch import LAUNCH_RUNTIME
from ros_lint.facts.sources import Use
from ros_lint.knowledge.spelling import is_part
from ros_lint.workspace.model import Package, Workspace


def manifest_is_complete(package: Package) -> bool:
    """Whether the manifest tells all that is declared. One that colcon rejects does, if it was read to its end."""
    manifest = package.manifest
    return manifest is not None and all(problem.kind not in _CUT_SHORT for problem in manifest.problems)


_CUT_SHORT = frozenset({"bare-ampersand", "encoding", "entity", "invalid-xml", "merge-conflict", "no-package", "too-deep"})
"""Problems of manifests after which nothing more was read, or something that is not meant."""


@cached_by_package
def undeclared(package: Package, workspace: Workspace) -> tuple[tuple[Need, bool], ...]:
    """Return the needs that nothing declared brings along, and whether that is sure.

    What only launch files name, to start, include or look it up, is left out, unless these are tests: it has a rule of its
    own. So is what is declared by another name, and a command of CMake that comes with what is to be declared anyway. Of what
    modules with parts of launch files name, nobody knows who takes it. Nor is it known of files that need what is declared under
    a condition, which does not hold here, whether they are for here; what CMake asks for is. A metapackage has no files that
    could be looked up. What a slip in a declared name must mean is told with that name already, so it is not sure, either.
    """
    unknown = all_declared(package, workspace).unknown
    found = []
    otherwise = intended_names(package, workspace).difference(misspelled_names(package, workspace).values())
    missing = [
        need
        for need in needs(package, workspace)
        if not (need.declared or need.brought or any(otherwise.intersection(use.providers) for use in need.uses))
    ]
    joined = _joined([need for need in missing if not only_launched(package, need.uses)])
    elsewhere = frozenset([each.name for each in package.manifest.depends if each.condition]) if package.manifest else frozenset()
    for need in joined:
        if all(use.via == "macro" for use in need.uses) and _comes_with(need, joined, workspace):
            continue
        sure = need.sure and any(use.via != "launch" or use.role is _TEST for use in need.uses)
        sure = sure and (need.name not in elsewhere or any(use.via in _BUILT and use.certain for use in need.uses))
        sure = sure and not (_looks_into_nothing(need, workspace) or is_declared_misspelled(package, workspace, need))
        if workspace.world.standing(need.name) != "known":
            if provided_in_other_distros(package, workspace, need.name) or _is_declared_as_key(package, workspace, need.name):
                continue
            sure = sure and not (workspace.target.explicit and workspace.world.where_else(need.name))
        uses = uses_not_explained_by(unknown, need.uses, workspace) if sure and unknown else need.uses
        found.append((need._replace(uses=uses or need.uses), sure and bool(uses)))
    return tuple(found)


def is_declared_misspelled(package: Package, workspace: Workspace, need: Need) -> bool:
    """Whether a slip in a declared name must mean what is needed: then that name is told, and what it means."""
    names = set(misspelled_names(package, workspace).values())
    return any(names.intersection(use.providers) for use in need.uses)


_BUILT = frozenset({"cmake", "macro", "target"})


def _looks_into_nothing(need: Need, workspace: Workspace) -> bool:
    """Whether only files of a metapackage are looked up, which has none: another package of its name is meant."""
    if need.name in workspace.by_name or any(use.via not in ("package", "launch") for use in need.uses):
        return False
    return only_brings(workspace.world, need.name)


def _is_declared_as_key(package: Package, workspace: Workspace, name: str) -> bool:
    """Whether what once was a package is now a library of the system, and declared by a key of its name: libnlopt-dev."""
    return any(workspace.world.is_key(each.name) and is_part(each.name, name) for each in package.declared)


def exists_in_any_distro(name: str, workspace: Workspace) -> bool:
    """Whether there is a package of a name. If nobody said which distribution is meant, it may be one of any."""
    world = workspace.world
    return world.is_package(name) or (not workspace.target.explicit and bool(world.where_else(name)))


def provided_in_other_distros(package: Package, workspace: Workspace, name: str) -> bool:
    """Whether a package that only other distributions have comes along there with something that is declared."""
    starts = {each.name for each in package.declared}
    closure = all_declared(package, workspace)
    for name_here, having in workspace.by_name.items():
        if name_here in closure:
            starts.update(each.name for other in having for each in other.declared)
    return workspace.world.knowledge.comes_elsewhere(starts, name)


def _joined(found: Sequence[Need]) -> list[Need]:
    """Return needs without those that another one satisfies: what CMake finds and what is included may have two names."""
    result: list[Need] = []
    for need in found:
        for number, other in enumerate(result):
            before = all(other.name in use.providers for use in need.uses)
            if before or all(need.name in use.providers for use in other.uses):
                kept = other if before else need
                uses = sorted((*other.uses, *need.uses), key=lambda use: (_rank(use), not _names(use, kept.name)))
                result[number] = kept._replace(uses=tuple(uses))
                break
        else:
            result.append(need)
    return result


def _names(use: Use, name: str) -> bool:
    """Whether a use names what it needs, and not what that merely brings."""
    return name in (use.package, use.name.partition("/")[0])


def _comes_with(need: Need, others: Iterable[Need], workspace: Workspace) -> bool:
    return any(need.name in workspace.world.closure((other.name,)) for other in others if other is not need)


def uses_not_explained_by(unknown: Sequence[str], uses: Iterable[Use], workspace: Workspace) -> tuple[Use, ...]:
    """Return uses of a name, first those that no declared name of which nothing is known could satisfy.

    None at all if no sure one is among these. Each place has to be satisfied: a library may come with anything, which helps no
    script that finds the package.
    """
    uses = tuple(uses)
    answers = dict.fromkeys([use.providers for use in uses])
    satisfied = {names: any(may_provide(unknown, name, workspace) for name in names) for names in answers}
    if all(satisfied[use.providers] for use in uses if use.certain):
        return ()
    return tuple(sorted(uses, key=lambda use: satisfied[use.providers]))


def only_launched(package: Package, uses: Sequence[Use]) -> bool:
    """Whether only launch files name a package, and not for tests alone.

    Modules with parts of launch files, which others call, are code like any other.
    """
    if any(use.via != "launch" for use in uses) or all(use.role is _TEST for use in uses):
        return False
    helpers = {launch.path for launch in package.launch if launch.helper}
    return not all(use.span.path in helpers for use in uses)


def is_part_of_launch(package: Package, uses: Iterable[Use]) -> bool:
    """Whether only launch files import it, and it is part of whatever can launch them (reference, section E2, row 15)."""
    launched = {launch.path for launch in package.launch}
    return all(use.via == "import" and use.package in LAUNCH_RUNTIME and use.span.path in launched for use in uses)
