"""Unused dependencies that must not be removed, because they transitively provide a used but undeclared package."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from ros_lint.analysis.dependencies.needs import needs
from ros_lint.analysis.dependencies.traceless import is_mostly_runtime, may_be_used_without_trace
from ros_lint.analysis.memo import cached_by_package, cached_by_workspace
from ros_lint.facts.manifest import Role
from ros_lint.workspace.usage.unused_find_package import unused_finds

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from ros_lint.facts.sources import Mention, Use
    from ros_lint.workspace.model import Declared, Package, Workspace

_BUILD: Role = Role.BUILD | Role.TOOL | Role.EXPORT
_RUN: Role = Role.EXEC | Role.EXPORT
_TEST: Role = Role.TEST


class LostProvision(NamedTuple):
    """A used but undeclared package that no declared dependency provides after the removal of a tag."""

    name: str
    """Name of the undeclared package."""
    package: str
    """Name of the package that uses the undeclared package."""


def needed_transitively(package: Package, workspace: Workspace, unused: Sequence[Declared]) -> Mapping[str, LostProvision]:
    """Return the names of unused dependencies that must not be removed, each with a package that would no longer be provided.

    Example: this package uses ``b`` without declaring it, and only its unused dependency ``a`` depends on ``b``. Then the
    result has the key ``a`` with ``b`` as the lost package. Packages of the workspace that get ``b`` through this package count,
    too. If several unused dependencies provide ``b``, only the last of them is returned.
    """
    result: dict[str, LostProvision] = {}
    if not _lost(package, workspace, unused):  # the common case: if all tags together can be removed, each tag can be removed
        return result
    by_name: dict[str, list[Declared]] = {}
    for declared in unused:
        by_name.setdefault(declared.name, []).append(declared)
    for name, tags in by_name.items():
        if lost := _lost(package, workspace, tags):
            result[name] = lost
    removable: list[Declared] = []
    for name, tags in by_name.items():
        if name not in result and (lost := _lost(package, workspace, [*removable, *tags]) if removable else None):
            result[name] = lost
        elif name not in result:
            removable += tags
    return result


def _lost(package: Package, workspace: Workspace, removed: Sequence[Declared]) -> LostProvision | None:
    """Return a package that is used but undeclared, and that only the tags ``removed`` provide; None if there is none."""
    spans = {declared.depend.span for declared in removed}
    remaining = [declared for declared in package.declared if declared.depend.span not in spans]
    return _lost_here(package, workspace, remaining, removed) or _lost_above(package, workspace, remaining, removed)


def _lost_here(
    package: Package, workspace: Workspace, remaining: Sequence[Declared], removed: Sequence[Declared]
) -> LostProvision | None:
    closure_of = workspace.world.closure
    lost_closure = closure_of([declared.name for declared in removed])
    members = [name for group in package.group_depends for name in workspace.world.group_members(group.name)]
    for role, names in dict.fromkeys((use.role, use.providers) for use in undeclared_uses(package, workspace)):
        name = next((name for name in names if name in lost_closure), None)
        if name is None:
            continue
        wider = role | _BUILD if role & _BUILD else role
        starts = [declared.name for declared in remaining if role is _TEST or declared.role & wider]
        rest = closure_of([*starts, *members])
        if not any(provider in rest for provider in names):
            return LostProvision(name, package.name)
    return None


def _lost_above(
    package: Package, workspace: Workspace, remaining: Sequence[Declared], removed: Sequence[Declared]
) -> LostProvision | None:
    world = workspace.world
    remaining_names = [declared.name for declared in remaining if declared.role & _RUN]
    removed_names = frozenset(declared.name for declared in removed if declared.role & _RUN).difference(remaining_names)
    if not removed_names:
        return None
    uses_by_name = _undeclared_uses_by_name(workspace)
    lost_names = world.closure(removed_names).difference(world.closure(remaining_names))
    for name in sorted(uses_by_name.keys() & set(lost_names)):
        for dependent, use in uses_by_name[name]:
            starts = [declared.name for declared in dependent.declared]
            if dependent.name == package.name or package.name not in world.closure(starts):
                continue
            rest = world.closure_without(starts, package.name, removed_names)
            if not any(provider in rest for provider in use.providers):
                return LostProvision(name, dependent.name)
    return None


@cached_by_package
def undeclared_uses(package: Package, workspace: Workspace) -> tuple[Use, ...]:
    """Return the uses of undeclared packages that a declared dependency provides transitively."""
    return tuple([use for need in needs(package, workspace) if need.is_transitive and not need.declared for use in need.uses])


@cached_by_workspace
def _undeclared_uses_by_name(workspace: Workspace) -> Mapping[str, Sequence[tuple[Package, Use]]]:
    """Return the undeclared uses in all packages of the workspace (:func:`undeclared_uses`), by possible provider.

    Each item is a pair of a package and a use in this package. If a package has several uses with the same providers,
    only the last of these uses is listed.
    """
    result: dict[str, list[tuple[Package, Use]]] = {}
    for package in workspace.packages:
        answers = {use.providers: use for use in undeclared_uses(package, workspace)}
        for use in answers.values():
            for name in use.providers:
                result.setdefault(name, []).append((package, use))
    return result


@cached_by_package
def unused_find_packages(package: Package, workspace: Workspace) -> tuple[Mention, ...]:
    """Return the calls of find_package() for packages that the package does not use.

    Left out are packages that can be used without any mention in the sources.
    """
    return tuple(
        [
            mention
            for mention in unused_finds(package)
            if mention.name not in package.possibly_used
            and not may_be_used_without_trace(package, workspace, mention.name)
            and not is_mostly_runtime(workspace, mention.name)
        ]
    )
