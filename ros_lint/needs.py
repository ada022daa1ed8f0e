"""What a package needs of others, all evidence for one name together, and how the manifest answers it.

The rules about dependencies share this, so that each need is judged once and named by one of them.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import NamedTuple

from ros_lint.facts import Role, Use, Via
from ros_lint.text import Span
from ros_lint.workspace import Package, Workspace, per_package
from ros_lint.world import Closure


class Need(NamedTuple):
    """Something that a package does not do without."""

    name: str
    """What to declare for it."""
    uses: tuple[Use, ...]
    """Where it is needed, the surest and most telling place first; never empty."""
    declared: tuple[str, ...]
    """Those names that satisfy it and are declared, in whatever tag."""
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
    if package.builds_with == "catkin":
        return ()
    found: dict[str, list[Use]] = {}
    for use in package.uses:
        if not use.optional:
            if use.package in found:
                found[use.package].append(use)
            else:
                found[use.package] = [use]
    declared = frozenset([declared.depend.name for declared in package.declared])
    closure = all_declared(package, workspace)
    result = [_need(name, uses, declared, closure) for name, uses in found.items()]
    result.sort(key=_place)
    return tuple(result)


def _need(name: str, uses: list[Use], declared: frozenset[str], closure: Closure) -> Need:
    """Return what uses of a name amount to; they come sorted by place."""
    if len(uses) > 1:
        uses.sort(key=_rank)
    answers = dict.fromkeys([use.providers for use in uses])
    direct: list[str] = []
    left = set()
    for names in answers:
        brought = False
        for each in names:
            brought = brought or each in closure
            if each in declared and each not in direct:
                direct.append(each)
        if not brought:
            left.add(names)
    # Each place has to be satisfied: Eigen3 of CMake by its find module, a header of Eigen by the library.
    if not left or not direct:
        return Need(name, tuple(uses), tuple(direct), not left)
    return Need(name, tuple([use for use in uses if use.providers in left]), (), False)


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


def covered(package: Package, workspace: Workspace, names: Iterable[str], role: Role) -> bool:
    """Whether one of the names comes along, or may come along, with something else that is declared for any part of a role."""
    names = frozenset(names)
    starts = {each.name for each in package.declared if each.role & role and each.name not in names}
    closure = workspace.world.closure(sorted(starts))
    if any(name in closure for name in names):
        return True
    unknown = closure.unknown
    return bool(unknown) and any(may_bring(unknown, name, workspace) for name in names)


@per_package
def undeclared(package: Package, workspace: Workspace) -> tuple[tuple[Need, bool], ...]:
    """Return the needs that nothing declared brings along, and whether that is sure.

    What only launch files name, to start, include or look it up, is left out, unless these are tests: it has a rule of its
    own.
    """
    unknown = all_declared(package, workspace).unknown
    found = []
    for need in needs(package, workspace):
        if need.declared or need.brought or only_launched(need.uses):
            continue
        found.append((need, need.sure and not (unknown and may_bring(unknown, need.name, workspace))))
    return tuple(found)


def only_launched(uses: Sequence[Use]) -> bool:
    """Whether only launch files name a package, and not for tests alone."""
    return all(use.via == "launch" for use in uses) and any(use.role is not _TEST for use in uses)


_LAUNCH = frozenset({"launch", "launch_ros", "ament_index_python"})
"""What ``ros2 launch`` brings along."""


def comes_with_launching(package: Package, uses: Iterable[Use]) -> bool:
    """Whether only launch files import it, and it is part of whatever can launch them (reference, section E2, row 15)."""
    launched = {launch.path for launch in package.launch}
    return all(use.via == "import" and use.package in _LAUNCH and use.span.path in launched for use in uses)


def may_bring(unknown: Sequence[str], name: str, workspace: Workspace) -> bool:
    """Whether one of the declared names of which nothing is known could bring a package along.

    What comes from elsewhere needs none of this workspace: repositories do not need each other in a circle. A package of
    messages brings messages, and build tools and linters come with others of their kind.
    """
    if name in workspace.by_name:
        return False
    tool = name.startswith("ament_") and not name.startswith("ament_index")
    released = workspace.world.released(name)
    messages = bool(released and released.interfaces)
    plumbing = name.startswith(("rosidl_", "builtin_", "action_msgs", "service_msgs", "unique_identifier_msgs"))
    for each in unknown:
        if _is_no_package(each, workspace) or (tool and not any(word in each for word in _OF_TOOLS)):
            continue
        if each.endswith(("_msgs", "_interfaces", "_srvs", "_msg")) and not (messages or plumbing):
            continue
        return True
    return False


_OF_TOOLS = ("ament", "cmake", "lint", "common", "tools", "test")
"""Parts of the names of packages that bring build tools, linters or what runs tests."""


def _is_no_package(name: str, workspace: Workspace) -> bool:
    """Whether an unknown name can stand for no package of ROS 2: it is spelt like a key, a slip, or one of ROS 1."""
    if "-" in name or name != name.lower() or name == "ament_python":
        return True
    gone = workspace.world.knowledge.names.end_of_life(name)
    if gone:
        return all(distro.startswith("ROS 1 ") for distro in gone)
    return workspace.world.meant(name) is not None
