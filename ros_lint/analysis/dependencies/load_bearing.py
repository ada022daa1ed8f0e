"""Dependencies that nothing uses: what they bring all the same, declared in place of it, and what is found for nothing."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from ros_lint.analysis.dependencies.needs import needs
from ros_lint.analysis.dependencies.traceless import is_mostly_runtime, may_be_used_without_trace
from ros_lint.analysis.memo import cached_by_package, cached_by_workspace
from ros_lint.facts.manifest import Role
from ros_lint.workspace.usage.unused_find_package import unused_in_sight

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from ros_lint.facts.sources import Mention, Use
    from ros_lint.workspace.model import Declared, Package, Workspace

_BUILD: Role = Role.BUILD | Role.TOOL | Role.EXPORT
_RUN: Role = Role.EXEC | Role.EXPORT
_TEST: Role = Role.TEST


class LostProvision(NamedTuple):
    """Something that comes along with nothing else."""

    name: str
    package: str
    """Who uses it and does not declare it."""


def needed_transitively(package: Package, workspace: Workspace, unused: Sequence[Declared]) -> Mapping[str, LostProvision]:
    """Return the names among unused dependencies that cannot go without a loss, each with what would be lost.

    A loss is something that this package, or another one of the workspace, uses without declaring it, and that comes along
    with nothing else. Where one of several will do, all but the last can go.
    """
    found: dict[str, LostProvision] = {}
    if not _lost(package, workspace, unused):  # nearly always: when all can go, each can
        return found
    by_name: dict[str, list[Declared]] = {}
    for each in unused:
        by_name.setdefault(each.name, []).append(each)
    for name, tags in by_name.items():
        if lost := _lost(package, workspace, tags):
            found[name] = lost
    gone: list[Declared] = []
    for name, tags in by_name.items():
        if name not in found and (lost := _lost(package, workspace, [*gone, *tags]) if gone else None):
            found[name] = lost
        elif name not in found:
            gone += tags
    return found


def _lost(package: Package, workspace: Workspace, removed: Sequence[Declared]) -> LostProvision | None:
    """Return something that is lost when dependency tags go, or None."""
    spans = {each.depend.span for each in removed}
    left = [each for each in package.declared if each.depend.span not in spans]
    return _lost_here(package, workspace, left, removed) or _lost_above(package, workspace, left, removed)


def _lost_here(
    package: Package, workspace: Workspace, left: Sequence[Declared], removed: Sequence[Declared]
) -> LostProvision | None:
    bring = workspace.world.closure
    brought = bring([each.name for each in removed])
    members = [name for group in package.group_depends for name in workspace.world.group_members(group.name)]
    for role, names in dict.fromkeys((use.role, use.providers) for use in hanging(package, workspace)):
        name = next((name for name in names if name in brought), None)
        if name is None:
            continue
        wider = role | _BUILD if role & _BUILD else role
        starts = [each.name for each in left if role is _TEST or each.role & wider]
        rest = bring([*starts, *members])
        if not any(each in rest for each in names):
            return LostProvision(name, package.name)
    return None


def _lost_above(
    package: Package, workspace: Workspace, left: Sequence[Declared], removed: Sequence[Declared]
) -> LostProvision | None:
    world = workspace.world
    still = [each.name for each in left if each.role & _RUN]
    gone = frozenset(each.name for each in removed if each.role & _RUN).difference(still)
    if not gone:
        return None
    hung = _hanging_by_name(workspace)
    for name in sorted(name for name in world.closure(gone).less(world.closure(still)) if name in hung):
        for other, use in hung[name]:
            starts = [each.name for each in other.declared]
            if other.name == package.name or package.name not in world.closure(starts):
                continue
            rest = world.closure_without(starts, package.name, gone)
            if not any(each in rest for each in use.providers):
                return LostProvision(name, other.name)
    return None


@cached_by_package
def hanging(package: Package, workspace: Workspace) -> tuple[Use, ...]:
    """Return the uses of what merely comes along with something that is declared."""
    return tuple([use for need in needs(package, workspace) if need.brought and not need.declared for use in need.uses])


@cached_by_workspace
def _hanging_by_name(workspace: Workspace) -> Mapping[str, Sequence[tuple[Package, Use]]]:
    """Return who hangs on what: for each name, one use of each package."""
    found: dict[str, list[tuple[Package, Use]]] = {}
    for package in workspace.packages:
        answers = {use.providers: use for use in hanging(package, workspace)}
        for use in answers.values():
            for name in use.providers:
                found.setdefault(name, []).append((package, use))
    return found


@cached_by_package
def unused_find_packages(package: Package, workspace: Workspace) -> tuple[Mention, ...]:
    """Return each find_package() of a package that the code does not use, in no way that can be seen."""
    return tuple(
        [
            mention
            for mention in unused_in_sight(package)
            if mention.name not in package.possibly_used
            and not may_be_used_without_trace(package, workspace, mention.name)
            and not is_mostly_runtime(workspace, mention.name)
        ]
    )
