"""What a package needs of others, all evidence for one name together, and how the manifest answers it.

The rules about dependencies share this, so that each need is judged once and named by one of them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from typing import NamedTuple

from ros_lint.analysis.dependencies.declared_closure import all_declared
from ros_lint.analysis.dependencies.remedy import cycle_through
from ros_lint.analysis.memo import cached_by_package
from ros_lint.base.text import Span
from ros_lint.facts.manifest import Role
from ros_lint.facts.sources import Use, Via
from ros_lint.knowledge.closure import Closure
from ros_lint.knowledge.spelling import VENDOR, is_part, is_vendor
from ros_lint.workspace.model import Package, Workspace


class Need(NamedTuple):
    """Something that a package does not do without."""

    name: str
    """What to declare for it."""
    uses: tuple[Use, ...]
    """Where it is needed, the surest and most telling place first; never empty."""
    declared: tuple[str, ...]
    """Those names that satisfy it and are declared, in whatever tag. What merely brings the best one is not among them."""
    brought: bool
    """Whether any name that satisfies it comes along with a declared dependency."""

    @property
    def sure(self) -> bool:
        """Return whether the best evidence is in a file that is alive, of a name that is known."""
        return self.uses[0].certain

    @property
    def role(self) -> Role:
        """Return all that it is needed for: by what is alive, if anything is."""
        alive = [use for use in self.uses if use.certain] or self.uses
        role = Role(0)
        for use in alive:
            role |= use.role
        return role


_TELLING: tuple[Via, ...] = ("include", "import", "cmake", "interface", "symbol", "target", "macro", "package", "key", "launch")
_RANKS = {via: rank for rank, via in enumerate(_TELLING)}
_TEST = Role.TEST


@cached_by_package
def needs(package: Package, workspace: Workspace) -> tuple[Need, ...]:
    """Return every need of a package, in the order of the best evidence. What it can do without is no need.

    A package of ROS 1 (build type catkin) has its own ways to get what it needs, and none that are known here.
    """
    return _gathered(package, workspace, [use for use in package.uses if not use.optional])


@cached_by_package
def optional_needs(package: Package, workspace: Workspace) -> tuple[Need, ...]:
    """Return what a package uses only if it is there and does not declare, in the order of the best evidence.

    Symbols are left out: in languages other than C++ they may as well come from elsewhere. So is what needs the package
    itself, and cannot be declared.
    """
    needed = {name for use in package.uses if not use.optional for name in use.providers}
    uses = [use for use in package.uses if use.optional and use.via != "symbol" and needed.isdisjoint(use.providers)]
    found = [need for need in _gathered(package, workspace, uses) if not need.declared]
    return tuple([need for need in found if not cycle_through(package, workspace, need.name)])


def _gathered(package: Package, workspace: Workspace, uses: Iterable[Use]) -> tuple[Need, ...]:
    if package.builds_with == "catkin" and not _is_ament(package):
        return ()
    found: dict[str, list[Use]] = {}
    for use in uses:
        if use.package in found:
            found[use.package].append(use)
        else:
            found[use.package] = [use]
    declared = frozenset([declared.depend.name for declared in package.declared])
    closure = all_declared(package, workspace)
    bring = workspace.world.closure
    only_runs = workspace.world.only_runs
    result = [need for name, uses in found.items() for need in _needs(name, uses, declared, closure, bring, only_runs)]
    result.sort(key=_place)
    return tuple(result)


def _is_ament(package: Package) -> bool:
    """Whether CMake takes a package for one of ROS 2, though its manifest says nothing of it."""
    mentions = package.built.mentions
    return any(mention.via == "cmake" and mention.name.startswith("ament_cmake") for mention in mentions)


def _needs(
    name: str,
    uses: list[Use],
    declared: frozenset[str],
    closure: Closure,
    bring: Callable[[tuple[str, ...]], Closure],
    only_runs: Callable[[str], bool],
) -> Iterator[Need]:
    """Yield what uses of a name amount to; they come sorted by place.

    Each place has to be satisfied: Eigen3 of CMake by its find module, a header of Eigen by the library, and what is built
    by more than a key that ``only_runs``.
    """
    if len(uses) > 1:
        uses.sort(key=_rank)
    answers = dict.fromkeys([use.providers for use in uses])
    vendors = [] if name in declared else [each for each in declared if each.endswith(VENDOR) and name in bring((each,))]
    if not vendors and answers.keys() == {(name,)}:  # nearly always
        yield Need(name, tuple(uses), (name,) if name in declared else (), name in closure)
        return
    found = {names: [each for each in names if each in declared and _is_meant(each, names[0], bring)] for names in answers}
    for names, direct in found.items():
        direct += [each for each in sorted(vendors) if each not in direct and is_vendor(each, names[0])]
    for names in {use.providers for use in uses if use.role & Role.BUILD}:
        if found[names] and all(map(only_runs, found[names])) and not only_runs(name):
            found[names] = []
    lacking = [
        names
        for names, direct in found.items()
        if not direct and not any(each in closure and not (each in declared and only_runs(each)) for each in names)
    ]
    brought = [names for names, direct in found.items() if not direct and names not in lacking]
    if names := tuple(dict.fromkeys([each for direct in found.values() for each in direct])):
        others = {*lacking, *brought}
        yield Need(name, tuple([use for use in uses if use.providers not in others]), names, True)
    if lacking:
        yield Need(name, tuple([use for use in uses if not names or use.providers in lacking]), (), False)
    elif brought:
        yield Need(name, tuple([use for use in uses if use.providers in brought]), (), True)


def _is_meant(name: str, best: str, bring: Callable[[tuple[str, ...]], Closure]) -> bool:
    """Whether a name that will do is declared for itself, and does not merely bring the best one along.

    A vendor package is declared for the library, which it brings where the system has it, and a library for all its parts.
    """
    return name == best or best not in bring((name,)) or is_vendor(name, best) or is_part(best, name)


def _rank(use: Use) -> int:
    """The surest and most telling evidence first."""
    rank = _RANKS[use.via]
    if not use.certain:
        rank += 32
    return rank + 16 if use.role is _TEST else rank


def _place(need: Need) -> Span:
    return need.uses[0].span
