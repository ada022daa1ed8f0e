"""Dependencies that a package can use without a trace in its sources."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ros_lint.collectors.interfaces import naming as interface_names
from ros_lint.workspace.model import Package, Workspace
from ros_lint.workspace.usage.visibility import is_traceless_by_name, makes_something

if TYPE_CHECKING:
    from ros_lint.knowledge.index import Released
    from ros_lint.knowledge.world import World


def is_library(world: World, name: str) -> bool:
    """Whether a name is a key of something that is compiled against, which launch files cannot use."""
    return world.is_key(name) and not name.startswith("python")


def may_be_used_without_trace(package: Package, workspace: Workspace, name: str) -> bool:
    """Whether a dependency of a package on a name can do its work without the name standing anywhere (reference, section F2).

    True for what is no package that is known; for packages that bring others, give macros or plugins, or are not there whole;
    for those whose name says that they stand for something else; and for what generated interfaces need. See
    :func:`is_mostly_runtime`, too.
    """
    world = workspace.world
    if is_traceless_by_name(workspace.world, name):
        return True
    if package.script and package.script.interfaces and name in interface_names.UNDERLYING:
        return True
    if world.plugins(name).names:
        return True
    mine = workspace.by_name.get(name, ())
    if mine:
        return any(_gives_macros(each) or not makes_something(each) or _lacks_parts(each, world) for each in mine)
    return only_brings(world, name) or _stands_for_others(package, world, name)


def only_brings(world: World, name: str) -> bool:
    """Whether a released package is a metapackage: it says so, or has nothing but what it brings to be run."""
    released = world.released(name)
    if released is None or "m" in released.flags[1:]:
        return released is not None
    return bool(released.on("x")) and not released.on("beu") and _offers_nothing(world, released)


def _stands_for_others(package: Package, world: World, name: str) -> bool:
    """Whether a released metapackage that declares its members by ``<depend>`` brings one that the package uses.

    It has the name of its repository, and what it brings is mostly from there.
    """
    released = world.released(name)
    if released is None or released.repository != name or not _offers_nothing(world, released):
        return False
    brought = released.on("x")
    members = {each for each in brought if (found := world.released(each)) and found.repository == name}
    return 2 * len(members) > len(brought) and any(use.package in members for use in package.uses)


def _offers_nothing(world: World, released: Released) -> bool:
    """Whether nothing is known that a package of ament_cmake installs."""
    if released.build_type != "ament_cmake" or released.interfaces:
        return False
    known = (world.executables, world.launch_files, world.components, world.plugins, world.python_modules, world.programs)
    return not any(provides(released.name).possible for provides in known)


def is_mostly_runtime(workspace: Workspace, name: str) -> bool:
    """Whether released packages mostly declare a name without building against it, so that it may well leave no trace.

    Not so of packages that give nothing but interfaces: this tells that Python code uses them, which has to name them.
    """
    world = workspace.world
    if name in workspace.by_name or not world.is_package(name):
        return False
    released = world.released(name)
    if released and released.interfaces and not has_programs(world, name):
        return False
    declared = world.knowledge.index.declared_as(name)
    return 2 * sum(count for kinds, count in declared.items() if "b" not in kinds) > sum(declared.values())


def has_programs(world: World, name: str) -> bool:
    """Whether a package is known to have something to start or to load."""
    offers = (world.executables, world.programs, world.launch_files, world.components, world.plugins)
    return any(offer(name).names for offer in offers)


def usage_is_visible(package: Package, workspace: Workspace, name: str) -> bool:
    """Whether a dependency leaves a trace if it is of any use: messages, and modules where no Python code could import them."""
    world = workspace.world
    released = world.released(name)
    if released is None:
        return False
    no_python = not any(file.endswith(PYTHON_LIKE) for file in package.files)
    return bool(released.interfaces) or (no_python and not has_programs(world, name) and bool(world.python_modules(name).names))


PYTHON_LIKE = (".py", ".py.in", ".launch", ".launch.xml", ".launch.yaml")
"""Files that can run Python code, or have it run."""


def _lacks_parts(package: Package, world: World) -> bool:
    """Whether a submodule that is not cloned lies in a package: what that has may be called anything."""
    return any(folder.rpartition("/")[2] in world.awaited.uncloned for folder in package.unvisited_folders)


def _gives_macros(package: Package) -> bool:
    return package.script is None or any(file.endswith((".cmake", ".cmake.in")) for file in package.files)
