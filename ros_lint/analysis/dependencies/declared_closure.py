"""The packages that the declared dependencies of a package provide transitively."""

from __future__ import annotations

from collections.abc import Iterable

from ros_lint.analysis.dependencies.unknown_closure import may_provide
from ros_lint.analysis.memo import cached_by_package
from ros_lint.facts.manifest import Role
from ros_lint.knowledge.closure import Closure
from ros_lint.workspace.model import Package, Workspace

_ANY = ~Role(0)


@cached_by_package
def all_declared(package: Package, workspace: Workspace) -> Closure:
    """Return all declared dependencies of a package with their transitive dependencies, members of groups included."""
    return declared_closure(package, workspace, _ANY)


def declared_closure(package: Package, workspace: Workspace, role: Role, others: Iterable[str] = ()) -> Closure:
    """Return the dependencies that a package declares for any role (build, run, test ...) in ``role``, and the transitive ones.

    The packages ``others`` and the members of the groups that the package depends on are added, with their transitive
    dependencies.
    """
    starts = [declared.name for declared in package.declared if role is _ANY or declared.role & role]
    starts += others
    for group in package.group_depends:
        starts += workspace.world.group_members(group.name)
    return workspace.world.closure(starts)


def provided_transitively(
    package: Package, workspace: Workspace, names: Iterable[str], role: Role, *, surely: bool = False
) -> bool:
    """Return whether the package gets one of ``names`` through the declared dependencies that are not in ``names``.

    Only dependencies declared for a role (build, run, test ...) in ``role`` count. If the dependencies of a package are
    unknown, it is assumed to provide the names that it could provide; ``surely`` turns this assumption off.
    """
    names = frozenset(names)
    starts = {declared.name for declared in package.declared if declared.role & role and declared.name not in names}
    closure = workspace.world.closure(sorted(starts))
    if any(name in closure for name in names):
        return True
    unknown = () if surely else closure.unknown
    return bool(unknown) and any(may_provide(unknown, name, workspace) for name in names)
