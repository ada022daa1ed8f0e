"""What a package needs of others, all evidence for one name together, and how the manifest answers it.

The rules about dependencies share this, so that each need is judged once and named by one of them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import NamedTuple

from ros_lint.analysis.dependencies.remedy import circle
from ros_lint.analysis.dependencies.tags import only_brings
from ros_lint.analysis.dependencies.unknown_closure import may_bring
from ros_lint.analysis.dependencies.unresolved import meant, misspelt
from ros_lint.base.text import Span
from ros_lint.facts.manifest import Role
from ros_lint.facts.sources import Use, Via
from ros_lint.knowledge.closure import Closure
from ros_lint.knowledge.spelling import VENDOR, is_part, is_vendor
from ros_lint.workspace.model import Package, Workspace, per_package


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
        return self.uses[0].sure

    @property
    def role(self) -> Role:
        """Return all that it is needed for: by what is alive, if anything is."""
        alive = [use for use in self.uses if use.sure] or self.uses
        role = Role(0)
        for use in alive:
            role |= use.role
        return role


_TELLING: tuple[Via, ...] = ("include", "import", "cmake", "interface", "symbol", "target", "macro", "package", "key", "launch")
_RANKS = {via: rank for rank, via in enumerate(_TELLING)}
_TEST = Role.TEST


@per_package
def needs(package: Package, workspace: Workspace) -> tuple[Need, ...]:
    """Return every need of a package, in the order of the best evidence. What it can do without is no need.

    A package of ROS 1 (build type catkin) has its own ways to get what it needs, and none that are known here.
    """
    return _gathered(package, workspace, [use for use in package.uses if not use.optional])


@per_package
def wishes(package: Package, workspace: Workspace) -> tuple[Need, ...]:
    """Return what a package uses only if it is there and does not declare, in the order of the best evidence.

    Symbols are left out: in languages other than C++ they may as well come from elsewhere. So is what needs the package
    itself, and cannot be declared.
    """
    needed = {name for use in package.uses if not use.optional for name in use.providers}
    uses = [use for use in package.uses if use.optional and use.via != "symbol" and needed.isdisjoint(use.providers)]
    found = [need for need in _gathered(package, workspace, uses) if not need.declared]
    return tuple([need for need in found if not circle(package, workspace, need.name)])


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
    if not use.sure:
        rank += 32
    return rank + 16 if use.role is _TEST else rank


def _place(need: Need) -> Span:
    return need.uses[0].span


_ANY = ~Role(0)


@per_package
def all_declared(package: Package, workspace: Workspace) -> Closure:
    """Return all that comes along with what is declared, members of groups included."""
    return declared_closure(package, workspace, _ANY)


def declared_closure(package: Package, workspace: Workspace, role: Role) -> Closure:
    """Return all that comes along with what is declared for any part of a role, members of groups included."""
    starts = [each.name for each in package.declared if role is _ANY or each.role & role]
    for group in package.group_depends:
        starts += workspace.world.group_members(group.name)
    return workspace.world.closure(starts)


def covered(package: Package, workspace: Workspace, names: Iterable[str], role: Role, *, surely: bool = False) -> bool:
    """Whether one of the names comes along with something else that is declared for any part of a role.

    Or whether it may, unless ``surely``.
    """
    names = frozenset(names)
    starts = {each.name for each in package.declared if each.role & role and each.name not in names}
    closure = workspace.world.closure(sorted(starts))
    if any(name in closure for name in names):
        return True
    unknown = () if surely else closure.unknown
    return bool(unknown) and any(may_bring(unknown, name, workspace) for name in names)


def tells(package: Package) -> bool:
    """Whether the manifest tells all that is declared. One that colcon rejects does, if it was read to its end."""
    manifest = package.manifest
    return manifest is not None and all(problem.kind not in _CUT_SHORT for problem in manifest.problems)


_CUT_SHORT = frozenset({"bare-ampersand", "encoding", "entity", "invalid-xml", "merge-conflict", "no-package", "too-deep"})
"""Problems of manifests after which nothing more was read, or something that is not meant."""


@per_package
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
    otherwise = meant(package, workspace).difference(misspelt(package, workspace).values())
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
        sure = sure and (need.name not in elsewhere or any(use.via in _BUILT and use.sure for use in need.uses))
        sure = sure and not (_looks_into_nothing(need, workspace) or is_miswritten(package, workspace, need))
        if workspace.world.standing(need.name) != "known":
            if comes_elsewhere(package, workspace, need.name) or _is_declared_as_key(package, workspace, need.name):
                continue
            sure = sure and not (workspace.target.told and workspace.world.where_else(need.name))
        uses = despite(unknown, need.uses, workspace) if sure and unknown else need.uses
        found.append((need._replace(uses=uses or need.uses), sure and bool(uses)))
    return tuple(found)


def is_miswritten(package: Package, workspace: Workspace, need: Need) -> bool:
    """Whether a slip in a declared name must mean what is needed: then that name is told, and what it means."""
    names = set(misspelt(package, workspace).values())
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


def is_somewhere(name: str, workspace: Workspace) -> bool:
    """Whether there is a package of a name. If nobody said which distribution is meant, it may be one of any."""
    world = workspace.world
    return world.is_package(name) or (not workspace.target.told and bool(world.where_else(name)))


def comes_elsewhere(package: Package, workspace: Workspace, name: str) -> bool:
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


def despite(unknown: Sequence[str], uses: Iterable[Use], workspace: Workspace) -> tuple[Use, ...]:
    """Return uses of a name, first those that no declared name of which nothing is known could satisfy.

    None at all if no sure one is among these. Each place has to be satisfied: a library may come with anything, which helps no
    script that finds the package.
    """
    uses = tuple(uses)
    answers = dict.fromkeys([use.providers for use in uses])
    satisfied = {names: any(may_bring(unknown, name, workspace) for name in names) for names in answers}
    if all(satisfied[use.providers] for use in uses if use.sure):
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


_LAUNCH = frozenset({"launch", "launch_ros", "launch_xml", "launch_yaml", "ament_index_python"})
"""What ``ros2 launch`` brings along."""


def comes_with_launching(package: Package, uses: Iterable[Use]) -> bool:
    """Whether only launch files import it, and it is part of whatever can launch them (reference, section E2, row 15)."""
    launched = {launch.path for launch in package.launch}
    return all(use.via == "import" and use.package in _LAUNCH and use.span.path in launched for use in uses)
