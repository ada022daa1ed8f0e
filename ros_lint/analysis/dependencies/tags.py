"""What to write into a manifest for a need, and which declared needs leave no trace: advice that several rules share."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import TYPE_CHECKING

from ros_lint.analysis.dependencies.find_package import finds_declared
from ros_lint.analysis.rule import Edit
from ros_lint.collectors.interfaces import naming as interface_names
from ros_lint.collectors.manifest import edits as manifest_edits
from ros_lint.facts.manifest import Depend, Role
from ros_lint.facts.visibility import Facet
from ros_lint.workspace.model import Package, Workspace

if TYPE_CHECKING:
    from ros_lint.knowledge.index import Released
    from ros_lint.knowledge.world import World


def tag_for(package: Package, workspace: Workspace, name: str, role: Role) -> str:
    """Return the one tag that a careful maintainer writes for all that a name is needed for (reference, section E2).

    Where the manifest says ``<depend>`` of everything, and of something that is only run, it goes on saying so, unless CMake
    finds and links all that it says it of. For a manifest of format 1, where nothing means "build and run", it is the tag for
    building, see :func:`add_dependency`.
    """
    form = package.manifest.format if package.manifest else 3
    if role == Role.TEST:
        return "test_depend"
    needed = _without(role, Role.TEST)
    if needed == Role.EXEC or (form > 1 and needed == Role.EXPORT and _is_only_run(workspace, name)):
        if form == 1:
            return "run_depend"
        habit = _always_depend(package) and _depends_on_runs(package, workspace) and not finds_declared(package)
        return "depend" if habit else "exec_depend"
    if needed == Role.TOOL or (_has(needed, Role.BUILD) and _is_tool(workspace, name, needed)):
        return "buildtool_depend"
    return "build_depend" if form == 1 or (needed == Role.BUILD and _is_only_for_building(workspace, name)) else "depend"


def _always_depend(package: Package) -> bool:
    """Whether a manifest knows no other tag than ``<depend>``, and that one well, for what is built or run."""
    tags = [declared.depend.tag for declared in package.declared if declared.role & (Role.BUILD | Role.EXEC | Role.EXPORT)]
    return len(tags) > 1 and set(tags) == {"depend"}


def _depends_on_runs(package: Package, workspace: Workspace) -> bool:
    """Whether something that is declared is only run, as far as the package uses it, or else by what others declare it as."""
    roles: dict[str, Role] = {}
    for use in package.uses:
        for name in use.providers:
            roles[name] = roles.get(name, use.role) | use.role
    names = [declared.depend.name for declared in package.declared if declared.depend.tag == "depend"]
    return any(not roles[name] & _BUILDS if name in roles else is_mostly_run(workspace, name) for name in names)


_BUILDS = Role.BUILD | Role.EXPORT | Role.TOOL


def _has(role: Role, part: Role) -> bool:
    return bool(role & part)


def _without(role: Role, part: Role) -> Role:
    return role & ~part


def tags_for(package: Package, tag: str) -> tuple[str, ...]:
    """Return all tags that it takes to say what a tag means: in format 1, what is built is run as well. It has a manifest."""
    assert package.manifest is not None
    return (tag, "run_depend") if package.manifest.format == 1 and tag == "build_depend" else (tag,)


def add_dependency(package: Package, tag: str, name: str) -> tuple[Edit, ...]:
    """Return the edits that declare a name. The package has a manifest."""
    assert package.manifest is not None
    return tuple(manifest_edits.add(package.manifest, each, name) for each in tags_for(package, tag))


def change_dependency(package: Package, depends: Sequence[Depend], tag: str, alike: Collection[Depend]) -> tuple[Edit, ...]:
    """Return the edits that make one tag of all those that a name is declared in. The package has a manifest.

    ``alike`` are all that change to this tag.
    """
    assert package.manifest is not None
    kept = next((depend for depend in depends if depend.tag == tag), depends[0])
    edits = () if kept.tag == tag else manifest_edits.change_kind(package.manifest, kept, tag, alike)
    return (*edits, *(manifest_edits.remove(package.manifest, depend) for depend in depends if depend is not kept))


def remove_dependency(package: Package, depend: Depend) -> tuple[Edit, ...]:
    """Return the edits that take a dependency out. The package has a manifest."""
    assert package.manifest is not None
    return (manifest_edits.remove(package.manifest, depend),)


def is_unseen_by_name(world: World, name: str) -> bool:
    """Whether a name alone says that it may do its work unseen: it is no package that is known, or a linter, a generator ..."""
    return not world.is_package(name) or world.is_key(name) or sounds_unseen(world, name)


def sounds_unseen(world: World, name: str) -> bool:
    """Whether a package is called like those that do their work unseen. Whether one of the workspace gives macros is seen."""
    names = world.knowledge.names
    return names.works_unseen(name) and not (world.layer(name) == "workspace" and names.sounds_like_macros(name))


def is_library(world: World, name: str) -> bool:
    """Whether a name is a key of something that is compiled against, which launch files cannot use."""
    return world.is_key(name) and not name.startswith("python")


def works_unseen(package: Package, workspace: Workspace, name: str) -> bool:
    """Whether a dependency of a package on a name can do its work without the name standing anywhere (reference, section F2).

    True for what is no package that is known; for packages that bring others, give macros or plugins, or are not there whole;
    for those whose name says that they stand for something else; and for what generated interfaces need. See
    :func:`is_mostly_run`, too.
    """
    world = workspace.world
    if is_unseen_by_name(workspace.world, name):
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


def is_mostly_run(workspace: Workspace, name: str) -> bool:
    """Whether released packages mostly declare a name without building against it, so that it may well leave no trace.

    Not so of packages that give nothing but interfaces: this tells that Python code uses them, which has to name them.
    """
    world = workspace.world
    if name in workspace.by_name or not world.is_package(name):
        return False
    released = world.released(name)
    if released and released.interfaces and not runs(world, name):
        return False
    declared = world.knowledge.index.declared_as(name)
    return 2 * sum(count for kinds, count in declared.items() if "b" not in kinds) > sum(declared.values())


def runs(world: World, name: str) -> bool:
    """Whether a package is known to have something to start or to load."""
    offers = (world.executables, world.programs, world.launch_files, world.components, world.plugins)
    return any(offer(name).names for offer in offers)


def leaves_trace(package: Package, workspace: Workspace, name: str) -> bool:
    """Whether a dependency leaves a trace if it is of any use: messages, and modules where no Python code could import them."""
    world = workspace.world
    released = world.released(name)
    if released is None:
        return False
    no_python = not any(file.endswith(PYTHON_LIKE) for file in package.files)
    return bool(released.interfaces) or (no_python and not runs(world, name) and bool(world.python_modules(name).names))


PYTHON_LIKE = (".py", ".py.in", ".launch", ".launch.xml", ".launch.yaml")
"""Files that can run Python code, or have it run."""


def is_seen_whole(package: Package) -> bool:
    """Whether so much is seen of a package that no more packages can be used in it than those that are found."""
    return is_built_in_sight(package) and not package.hidden(Facet.USES)


def is_built_in_sight(package: Package) -> bool:
    """Whether so much is seen of a package that no more libraries can be used in it: launch files need none."""
    manifest, script = package.manifest, package.script
    if manifest is None or manifest.problems or script is None or script.problems:
        return False
    launched = {launch.path for launch in package.launch}
    if any(opaque.span.path not in launched for opaque in package.hidden(Facet.USES)):
        return False
    return package.builds_with in ("ament_cmake", "ament_python") and builds_something(package)


def makes_something(package: Package) -> bool:
    """Whether a package builds or installs anything of its own, so that it does more than bring others along."""
    script = package.script
    if script is None or package.opaque or builds_something(package):
        return True
    by_rote = ("share/ament_index/", f"share/{package.name}/package.xml", f"share/{package.name}/cmake/")
    return any(not provided.path.startswith(by_rote) for provided in script.provides)


def builds_something(package: Package) -> bool:
    """Whether a package has code: a package with launch files and data only may declare what these need in their own way."""
    script = package.script
    if script is None:
        return False
    made = script.targets or script.interfaces or script.python_packages or script.components
    return bool(made) or any(provided.path.startswith("include/") for provided in script.provides)


def _lacks_parts(package: Package, world: World) -> bool:
    """Whether a submodule that is not cloned lies in a package: what that has may be called anything."""
    return any(folder.rpartition("/")[2] in world.awaited.uncloned for folder in package.unseen)


def _gives_macros(package: Package) -> bool:
    return package.script is None or any(file.endswith((".cmake", ".cmake.in")) for file in package.files)


def _is_tool(workspace: Workspace, name: str, needed: Role) -> bool:
    """Whether released packages mostly declare a name as a build tool.

    What public headers have is exported, and else those do not count that have it for tests.
    """
    every = workspace.world.knowledge.index.declared_as(name)
    declared = {kinds: count for kinds, count in every.items() if kinds != "s" or _has(needed, Role.EXPORT)}
    return 2 * sum(count for kinds, count in declared.items() if "t" in kinds) > sum(declared.values())


def _is_only_run(workspace: Workspace, name: str) -> bool:
    """Whether released packages, many of them, mostly declare a name for running alone."""
    declared = workspace.world.knowledge.index.declared_as(name)
    return 2 * declared.get("x", 0) > max(_FEW, sum(declared.values()))


_FEW = 40
"""Of so few packages the habits say nothing."""


def _is_only_for_building(workspace: Workspace, name: str) -> bool:
    """Whether released packages mostly declare a name for building alone."""
    declared = workspace.world.knowledge.index.declared_as(name)
    return 2 * sum(count for kinds, count in declared.items() if set(kinds) <= {"b", "t"}) > sum(declared.values())
