"""Dependencies that a package can use without naming them in its sources."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ros_lint.collectors.interfaces import naming as interface_names
from ros_lint.workspace.model import Package, Workspace
from ros_lint.workspace.usage.visibility import is_traceless_by_name, makes_something

if TYPE_CHECKING:
    from ros_lint.knowledge.index import Released
    from ros_lint.knowledge.world import World


def is_library(world: World, name: str) -> bool:
    """Return whether a name is a rosdep key of a compiled library. All keys count, except for ``python...``."""
    return world.is_key(name) and not name.startswith("python")


def may_be_used_without_trace(package: Package, workspace: Workspace, name: str) -> bool:
    """Return whether a package can use a dependency without naming it in its sources.

    The result is True for:
    - names that are no known package, and rosdep keys,
    - packages whose name suggests it, such as linters and generators,
    - packages with plugins, and packages of the workspace with CMake macros or without any content,
    - metapackages,
    - packages of the workspace with a submodule that is not cloned,
    - packages that the code generated from the interfaces of this package needs.

    See also :func:`is_mostly_runtime`.
    """
    world = workspace.world
    if is_traceless_by_name(workspace.world, name):
        return True
    if package.script and package.script.products.interfaces and name in interface_names.UNDERLYING:
        return True
    if world.plugins(name).names:
        return True
    local = workspace.by_name.get(name, ())
    if local:
        return any(_gives_macros(member) or not makes_something(member) or _lacks_parts(member, world) for member in local)
    return is_metapackage(package, workspace, name)


def is_metapackage(package: Package, workspace: Workspace, name: str) -> bool:
    """Return whether ``name`` is a metapackage, or has no content and depends on packages that ``package`` uses."""
    if local := workspace.by_name.get(name, ()):
        return not any(makes_something(member) for member in local)
    return only_brings(workspace.world, name) or _stands_for_others(package, workspace.world, name)


def only_brings(world: World, name: str) -> bool:
    """Return whether a released package is a metapackage, which only installs other packages.

    Its package.xml says so, or it has only run-time dependencies and no known content.
    """
    released = world.released(name)
    if released is None or "m" in released.flags[1:]:
        return released is not None
    return bool(released.on("x")) and not released.on("beu") and _offers_nothing(world, released)


def _stands_for_others(package: Package, world: World, name: str) -> bool:
    """Return whether a released metapackage provides a package that this package uses.

    Only a metapackage with the name of its repository counts, and only if most of its run-time dependencies are packages
    of that repository.
    """
    released = world.released(name)
    if released is None or released.repository != name or not _offers_nothing(world, released):
        return False
    runtime = released.on("x")
    members = {member for member in runtime if (released_member := world.released(member)) and released_member.repository == name}
    return 2 * len(members) > len(runtime) and any(use.package in members for use in package.uses)


def _offers_nothing(world: World, released: Released) -> bool:
    """Return whether a released ament_cmake package certainly contains no interfaces, programs, launch files or other content."""
    if released.build_type != "ament_cmake" or released.interfaces:
        return False
    known = (world.executables, world.launch_files, world.components, world.plugins, world.python_modules, world.programs)
    return not any(provides(released.name).possible for provides in known)


def is_mostly_runtime(workspace: Workspace, name: str) -> bool:
    """Return whether most released packages that declare a name declare it without a build tag.

    Code may use such a package without a mention in the sources. The result is False for packages of the workspace, and for
    packages with interfaces but no programs, because code has to name interfaces.
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
    """Return whether a package is known to have executables, launch files, components or plugins."""
    offers = (world.executables, world.programs, world.launch_files, world.components, world.plugins)
    return any(offer(name).names for offer in offers)


def usage_is_visible(package: Package, workspace: Workspace, name: str) -> bool:
    """Return whether every use of the dependency ``name`` in the sources of a package would be visible to ros-lint.

    That is so in two cases. If the dependency is a released package with interfaces, sources name it to use them. If it only
    has Python modules, and the package has no Python code, the package cannot use it at all.
    """
    world = workspace.world
    released = world.released(name)
    if released is None:
        return False
    no_python = not any(file.endswith(PYTHON_LIKE) for file in package.files)
    return bool(released.interfaces) or (no_python and not has_programs(world, name) and bool(world.python_modules(name).names))


PYTHON_LIKE = (".py", ".py.in", ".launch", ".launch.xml", ".launch.yaml")
"""Ends of the names of files that can contain or run Python code."""


def _lacks_parts(package: Package, world: World) -> bool:
    """Return whether the package contains a git submodule that is not cloned, so that its contents are unknown."""
    return any(folder.rpartition("/")[2] in world.awaited.uncloned for folder in package.unvisited_folders)


def _gives_macros(package: Package) -> bool:
    return package.script is None or any(file.endswith((".cmake", ".cmake.in")) for file in package.files)
