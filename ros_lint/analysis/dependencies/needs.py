"""The needs of a package: for each package or rosdep key, all uses together with the declared names that satisfy them.

The rules about dependencies share this module, so that only one of them reports each need.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from typing import NamedTuple

from ros_lint.analysis.dependencies.alternatives import stands_for
from ros_lint.analysis.dependencies.declared_closure import all_declared
from ros_lint.analysis.dependencies.remedy import cycle_through
from ros_lint.analysis.finding import Related
from ros_lint.analysis.memo import cached_by_package
from ros_lint.base.text import Span
from ros_lint.facts.manifest import Role
from ros_lint.facts.sources import Use, Via
from ros_lint.knowledge.closure import Closure
from ros_lint.knowledge.spelling import VENDOR, is_vendor
from ros_lint.workspace.model import Package, Workspace


class Need(NamedTuple):
    """A package or rosdep key that a package needs, with all its uses."""

    name: str
    """Name of the package or rosdep key to declare."""
    uses: tuple[Use, ...]
    """Places where the name is needed, best evidence first; never empty."""
    declared: tuple[str, ...]
    """Declared names that satisfy the need, with any tag. () if the need is not declared."""
    is_transitive: bool
    """True if a declared dependency provides the needed package transitively."""

    @property
    def sure(self) -> bool:
        """True if the first use is certain: its file is part of the build or installation, and its package is unambiguous."""
        return self.uses[0].certain

    @property
    def role(self) -> Role:
        """All roles (build, run, test ...) of the certain uses, or of all uses if no use is certain."""
        uses = [use for use in self.uses if use.certain] or self.uses
        role = last = uses[0].role
        for use in uses:
            if use.role is not last:  # members of enumerations are combined slowly
                last = use.role
                role |= last
        return role


_TELLING: tuple[Via, ...] = ("include", "import", "cmake", "interface", "symbol", "target", "macro", "package", "key", "launch")
_RANKS = {via: rank for rank, via in enumerate(_TELLING)}
_TEST = Role.TEST


@cached_by_package
def needs(package: Package, workspace: Workspace) -> tuple[Need, ...]:
    """Return the packages and rosdep keys that a package needs, each with its uses. Optional uses are left out.

    The needs are sorted by the position of their first use. The result is () for a package of ROS 1, because its
    dependencies are not analysed.
    """
    return _gathered(package, workspace, [use for use in package.uses if not use.optional])


@cached_by_package
def optional_needs(package: Package, workspace: Workspace) -> tuple[Need, ...]:
    """Return the undeclared packages and rosdep keys that only optional uses need, sorted by the position of their first use.

    An optional use is, for example, an import in a ``try`` block. Left out are:
    - uses of C++ symbols, because a header of another package may define the symbol,
    - packages that depend on this package, because declaring them would close a cycle.
    """
    needed = {name for use in package.uses if not use.optional for name in use.providers}
    uses = [use for use in package.uses if use.optional and use.via != "symbol" and needed.isdisjoint(use.providers)]
    undeclared = [need for need in _gathered(package, workspace, uses) if not need.declared]
    return tuple([need for need in undeclared if not cycle_through(package, workspace, need.name)])


def is_found_by_cmake(need: Need) -> bool:
    """Return whether CMake certainly searches for the needed package, by a find_package() that is required outside of tests."""
    return any(use.via == "cmake" and use.certain and not use.optional and use.role is not Role.TEST for use in need.uses)


def use_note(name: str, use: Use, how: str = "is also used here") -> Related:
    """Return the note at a further use of a package: "'std_msgs' is also used here: find_package(std_msgs)".

    ``name``: the name of the package in the message of the finding.
    """
    quotation = "" if use.what in (name, f"'{name}'") else f": {use.what}"
    return Related(f"'{name}' {how}{quotation}", use.span)


def _gathered(package: Package, workspace: Workspace, uses: Iterable[Use]) -> tuple[Need, ...]:
    if package.is_ros1:
        return ()
    uses_by_package: dict[str, list[Use]] = {}
    for use in uses:
        if use.package in uses_by_package:
            uses_by_package[use.package].append(use)
        else:
            uses_by_package[use.package] = [use]
    declared = frozenset([declared.depend.name for declared in package.declared])
    closure = all_declared(package, workspace)
    closure_of = workspace.world.closure
    is_runtime_library = workspace.world.is_runtime_library
    result = [
        need
        for name, uses in uses_by_package.items()
        for need in _needs(name, uses, declared, closure, closure_of, is_runtime_library)
    ]
    result.sort(key=_place)
    return tuple(result)


def _needs(
    name: str,
    uses: list[Use],
    declared: frozenset[str],
    closure: Closure,
    closure_of: Callable[[tuple[str, ...]], Closure],
    is_runtime_library: Callable[[str], bool],
) -> Iterator[Need]:
    """Yield the needs for the ``uses`` of a package: one for the uses that a declared name satisfies, one for the other uses.

    ``name`` is the name of the package. A declared name satisfies a use only if it is a provider of this use. Examples:
    find_package(Eigen3) needs the find module, but a header of Eigen only needs the library. A rosdep key of a runtime
    library (``is_runtime_library``) satisfies no build use.
    """
    if len(uses) > 1:
        uses.sort(key=_rank)
    answers = dict.fromkeys([use.providers for use in uses])
    vendors = (
        []
        if name in declared
        else [provider for provider in declared if provider.endswith(VENDOR) and name in closure_of((provider,))]
    )
    if not vendors and answers.keys() == {(name,)}:  # the common case
        yield Need(name, tuple(uses), (name,) if name in declared else (), name in closure)
        return
    matches = {
        names: [provider for provider in names if provider in declared and stands_for(provider, names[0], closure_of)]
        for names in answers
    }
    for names, direct in matches.items():
        direct += [provider for provider in sorted(vendors) if provider not in direct and is_vendor(provider, names[0])]
    built = {use.providers for use in uses if use.role & Role.BUILD} if not is_runtime_library(name) else set()
    for names in built:
        if matches[names] and all(map(is_runtime_library, matches[names])):
            matches[names] = []
    unprovided = [
        names
        for names, direct in matches.items()
        if not direct
        and not any(provider in closure and not (names in built and is_runtime_library(provider)) for provider in names)
    ]
    provided = [names for names, direct in matches.items() if not direct and names not in unprovided]
    if names := tuple(dict.fromkeys([provider for direct in matches.values() for provider in direct])):
        covered_elsewhere = {*unprovided, *provided}
        yield Need(name, tuple([use for use in uses if use.providers not in covered_elsewhere]), names, True)
    if unprovided:
        yield Need(name, tuple([use for use in uses if not names or use.providers in unprovided]), (), False)
    elif provided:
        yield Need(name, tuple([use for use in uses if use.providers in provided]), (), True)


def _rank(use: Use) -> int:
    """Return a sort key of a use, low for strong evidence: certain before uncertain, code before tests, includes first."""
    rank = _RANKS[use.via]
    if not use.certain:
        rank += 32
    return rank + 16 if use.role is _TEST else rank


def _place(need: Need) -> Span:
    return need.uses[0].span
