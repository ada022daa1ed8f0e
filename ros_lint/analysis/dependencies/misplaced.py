"""Undeclared packages that a declared dependency provides, but not where they are needed.

Where a package is built, only its ``build_depend``, ``buildtool_depend`` and ``depend`` are certainly installed; where it
runs, only its ``exec_depend``, ``build_export_depend`` and ``depend`` (REP 149; bloom/generators/debian/generator.py).
The run-time and export dependencies of an installed package are always installed with it, because bloom writes them
into ``Depends`` of its binary package. So only the tag in the package.xml of the analysed package matters.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from ros_lint.analysis.build.commands import unguarded_tests
from ros_lint.analysis.dependencies.declared_closure import declared_closure
from ros_lint.analysis.dependencies.needs import Need, needs
from ros_lint.analysis.dependencies.undeclared import is_part_of_launch
from ros_lint.analysis.dependencies.unknown_closure import may_provide
from ros_lint.analysis.memo import cached_by_package
from ros_lint.base.auxiliary_files import is_for_tests
from ros_lint.facts.manifest import Role

if TYPE_CHECKING:
    from collections.abc import Iterable

    from ros_lint.facts.manifest import Depend
    from ros_lint.facts.sources import Use, Via
    from ros_lint.knowledge.closure import Closure
    from ros_lint.workspace.model import Package, Workspace


class Misplaced(NamedTuple):
    """A needed package that only dependencies with the wrong tag provide."""

    need: Need
    """The needed package with all of its uses."""
    uses: tuple[Use, ...]
    """The uses that no dependency with the right tag satisfies, best evidence first; never empty."""
    depend: Depend
    """Tag of the dependency that provides the needed package, but is not installed for ``purpose``."""
    purpose: str
    """Purpose for which the dependency is not installed: "to build this package"."""


class _Phase(NamedTuple):
    """A situation in which only some dependencies are installed: the build of the package, or its execution.

    ``tags`` has the roles of the dependencies that are installed then. A use needs its package then if its role is in
    ``uses`` and its kind is in ``vias``, such as "include" or "cmake".
    """

    purpose: str
    uses: Role
    vias: frozenset[Via]
    tags: Role


_PHASES = (
    _Phase(
        "to build this package",
        Role.BUILD | Role.TOOL,
        frozenset({"include", "cmake", "interface", "symbol", "target"}),
        Role.BUILD | Role.TOOL,
    ),
    _Phase("with this package", Role.EXEC, frozenset({"import", "package"}), Role.EXEC | Role.EXPORT),
)
"""The situations that are checked. Uses in launch files are left out, because another rule reports them."""


@cached_by_package
def misplaced(package: Package, workspace: Workspace) -> tuple[Misplaced, ...]:
    """Return the needed but undeclared packages that only dependencies with the wrong tag provide.

    Left out are:
    - all packages that are needed by a package for tests, because all of its dependencies serve tests,
    - packages needed by tests outside of ``if(BUILD_TESTING)``, because the tests have to be moved into it,
    - parts of launch that only launch files import, because ``ros2 launch`` provides them,
    - packages that a declared dependency will provide as soon as its own wrong tag, which is also reported, is corrected,
    - packages that a dependency with the right tag may provide: its dependencies are unknown, or it provides the package in
      another distribution and the user chose no distribution.
    """
    every = needs(package, workspace)
    waiting = [need for need in every if need.is_transitive and not need.declared]
    if not waiting or is_for_tests(package.name):
        return ()
    unguarded = unguarded_tests(package)
    result: list[Misplaced] = []
    for phase in _PHASES:
        closure = declared_closure(package, workspace, phase.tags)
        if not any(_outside(closure, _of_phase(phase, need.uses)) for need in waiting):
            continue  # the common case
        repaired = [name for need in every if need.declared and _of_phase(phase, need.uses) for name in need.declared]
        closure = declared_closure(package, workspace, phase.tags, repaired)
        for need in waiting:
            uses = _outside(closure, _of_phase(phase, need.uses))
            if (
                not uses
                or need.name in unguarded
                or is_part_of_launch(package, workspace, uses)
                or any(need is other.need for other in result)
            ):
                continue
            if any(_may_provide(closure, name, workspace) for use in uses for name in use.providers):
                continue
            if depend := _provider(package, workspace, uses[0].providers):
                result.append(Misplaced(need, tuple(uses), depend, phase.purpose))
    return tuple(result)


def _outside(closure: Closure, uses: Iterable[Use]) -> list[Use]:
    """Return the uses for which no package of the closure is a provider."""
    return [use for use in uses if not any(name in closure for name in use.providers)]


def _may_provide(closure: Closure, name: str, workspace: Workspace) -> bool:
    """Return whether a package of a closure may provide ``name``, although the closure does not contain it.

    A package with unknown dependencies may provide ``name``. If the user chose no distribution, so may a package that
    provides ``name`` in another distribution.
    """
    if may_provide(closure.unknown, name, workspace):
        return True
    provides = workspace.world.knowledge.provides_elsewhere
    return not workspace.target.explicit and any(provides(dependency, name) for dependency in closure)


def _of_phase(phase: _Phase, uses: Iterable[Use]) -> list[Use]:
    """Return the certain uses that belong to a phase (build or execution)."""
    return [use for use in uses if use.certain and use.via in phase.vias and use.role & phase.uses]


def _provider(package: Package, workspace: Workspace, names: Iterable[str]) -> Depend | None:
    """Return the first tag of a declared dependency that provides one of the names transitively, or None."""
    starts = tuple(dict.fromkeys(declared.name for declared in package.declared))
    for name in names:
        if path := workspace.world.path(starts, name):
            return package.tags(path[0])[0].depend
    return None
