"""Remedies for undeclared dependencies: the tag to write, or the reason why a name cannot be declared."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from ros_lint.analysis.dependencies.tags import add_dependency, tag_for, tags_for
from ros_lint.analysis.finding import Fix
from ros_lint.analysis.graph.dependency_graph import dependency_graph
from ros_lint.analysis.memo import cached_by_name
from ros_lint.base.suggestions import and_list

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ros_lint.base.edit import Edit
    from ros_lint.facts.manifest import Role
    from ros_lint.workspace.model import Package, Workspace


class Remedy(NamedTuple):
    """The remedy for an undeclared dependency: a tag to add, or the reason why there is none."""

    written: str
    """The element to add, followed by remarks: "<depend>x</depend> (available only in humble)"."""
    fix: Fix | None
    """The fix that adds the element.

    None if the name cannot be declared, if the tag needs a condition, or if colcon rejects the package.xml, which must be
    corrected first.
    """
    obstacle: str
    """Reason why the name cannot be declared, to complete the message "cannot be declared: ..."; "" if it can be declared."""
    circular: bool
    """True if the reason is that the needed package depends on this package."""
    certain: bool = True
    """False if the needed package depends on this package, or if colcon rejects the package.xml."""
    conditional: bool = False
    """True if the tag needs a condition, because a distribution to check for lacks the package. Then there is no fix."""

    @property
    def ending(self) -> str:
        """End of a message: ": add <depend>x</depend>", or the reason why the name cannot be declared."""
        return f", and it cannot be declared: {self.obstacle}" if self.obstacle else f": add {self.written}"


def remedy(package: Package, workspace: Workspace, name: str, role: Role) -> Remedy:
    """Return the remedy for a needed package or rosdep key that is not declared. The package must have a package.xml."""
    tag = tag_for(package, workspace, name, role)
    availability = _availability(workspace, name)
    only_in = availability.only_in
    condition = f' condition="{_condition(only_in, workspace.world.knowledge.active)}"' if only_in else ""
    written = " and ".join(f"<{needed_tag}{condition}>{name}</{needed_tag}>" for needed_tag in tags_for(package, tag))
    if way := cycle_through(package, workspace, name):
        between = f", through {' > '.join(map(repr, way[1:-1]))}" if len(way) > 2 else ""
        obstacle = f"'{name}' depends on this package itself{between}; move what uses '{name}' to another package"
        return Remedy(written, None, obstacle, circular=True, certain=False)
    usable = not (package.manifest and package.manifest.problems)
    if (bare := workspace.by_name.get(name)) and all(namesake.manifest is None for namesake in bare):
        obstacle = f"the folder '{bare[0].path}' has no package.xml, so rosdep cannot resolve '{name}'; add package.xml"
        return Remedy(written, None, obstacle, circular=False, certain=usable)
    if is_unresolvable_key(workspace, name) and not condition_for(workspace, name):
        obstacle = f"rosdep has no rule for '{name}'{_where(workspace, name)}"
        return Remedy(written, None, obstacle, circular=False, certain=usable)
    of_pip = is_of_pip(workspace, name)
    if of_pip:
        written += " (installed by pip: a released package cannot depend on it)"
    if only_in:
        written += condition_format(package)
    written += f", because {_lack(availability.without)} no '{name}'" if only_in else availability_remark(workspace, name)
    if _is_exported(package, name):
        written += " (the tag in <export> declares nothing)"
    edits = add_dependency(package, tag, name) if usable and not only_in else ()
    fix = naming_fix(workspace, name, f"declare '{name}' as <{tag}>", *edits, safe=not of_pip)
    return Remedy(written, fix, "", circular=False, certain=usable, conditional=bool(only_in))


def _lack(distros: Sequence[str]) -> str:
    return f"{and_list(distros)} {'has' if len(distros) == 1 else 'have'}"


def _condition(distros: Sequence[str], active: Sequence[str]) -> str:
    """Return the condition of a tag (REP 149) that is true for ``distros`` and false for all other active distributions."""
    others = [distro for distro in active if distro not in distros]
    if len(others) < len(distros):
        return " and ".join(f"$ROS_DISTRO != {distro}" for distro in others)
    return " or ".join(f"$ROS_DISTRO == {distro}" for distro in distros)


def condition_format(package: Package) -> str:
    """Return the remark that a condition (REP 149) needs format 3 of package.xml, with a leading space; "" for format 3."""
    manifest = package.manifest
    return " (a condition needs format 3 of package.xml)" if manifest and manifest.format < 3 else ""


def naming_fix(workspace: Workspace, name: str, title: str, *edits: Edit, safe: bool = True) -> Fix | None:
    """Return the fix that makes ``edits``, which write ``name`` into a dependency tag; None if there are no edits.

    Every such fix must be made by this function. The fix is safe only if rosdep resolves the name in every distribution for
    which the workspace has to build, see :func:`availability_remark`.
    """
    return Fix.of(title, *edits, safe=safe and not availability_remark(workspace, name))


def availability_remark(workspace: Workspace, name: str) -> str:
    """Return a remark if a name does not resolve in every needed distribution, such as " (available only in humble)", else "".

    The name has to resolve in the distributions that the user chose and in those that the repository builds for, or in every
    active one if the user chose none. Packages of the workspace and of underlays resolve in all distributions.
    """
    return _availability(workspace, name).remark


class _Availability(NamedTuple):
    remark: str = ""
    only_in: tuple[str, ...] = ()
    """Active distributions that have the name, if a distribution to check for lacks it; else ()."""
    without: tuple[str, ...] = ()
    """Distributions to check for that lack the name, if other active distributions have it; else ()."""


@cached_by_name
def _availability(workspace: Workspace, name: str) -> _Availability:
    """Return whether a package or rosdep key is available in the distributions of a workspace."""
    world, target = workspace.world, workspace.target
    if world.layer(name) in ("workspace", "underlay"):
        return _Availability()
    knowledge = world.knowledge
    if target.explicit and all(knowledge.rosdep_resolves(name, distro) for distro in target.distros):
        lacking = [
            named.distro
            for named in workspace.named_distros
            if named.indexed and not knowledge.rosdep_resolves(name, named.distro)
        ]
        too = f" (not available in {', '.join(lacking)}, for which this repository builds, too)"
        return _Availability(too if lacking else "")
    if not knowledge.covered:
        return _Availability(f" (there are no data about {target.distro})")
    distros = tuple([distro for distro in knowledge.active if knowledge.rosdep_resolves(name, distro)])
    if not distros:
        return _Availability(" (not released in any active distribution)")
    needed = target.distros if target.explicit else knowledge.active
    without = tuple([distro for distro in needed if distro not in distros])
    if not without:
        return _Availability()
    if target.explicit:
        return _Availability(f" (not available in {', '.join(without)}, only in {', '.join(distros)})", distros, without)
    if target.distro in without:
        return _Availability(f" (not available in {target.distro}, only in {', '.join(distros)})", distros, (target.distro,))
    few = len(without) < len(distros)
    return _Availability(f" (not available in {', '.join(without)})" if few else f" (available only in {', '.join(distros)})")


def cycle_through(package: Package, workspace: Workspace, name: str) -> tuple[str, ...]:
    """Return the packages on a dependency path from ``name`` to this package, both included, or () if there is no path.

    Declaring ``name`` would close a cycle then. Between packages of the workspace every dependency tag counts, because colcon
    orders packages by all tags. Between released packages only run-time dependencies count: those in the target distribution, or
    in any distribution if the target distribution lacks ``name``.
    """
    graph = dependency_graph(workspace) if name in workspace.by_name else None
    if graph is not None and name in graph.arcs and package.colcon_name in graph.closure(name):
        from ros_lint.base.graph_paths import paths  # noqa: PLC0415  (few needs are circular)

        return paths(lambda package_name: sorted(graph.arcs[package_name]), name, package.colcon_name, 1).paths[0]
    world = workspace.world
    if not world.is_package(name) and world.knowledge.provides_elsewhere(name, package.name):
        return (name, package.name)
    return world.path((name,), package.name)


def _is_exported(package: Package, name: str) -> bool:
    """Return whether a dependency tag with the name is inside of <export>, where catkin_pkg ignores it."""
    exports = package.manifest.exports if package.manifest else ()
    return any(element.tag.endswith("depend") and element.text.strip() == name for element in exports)


def is_unresolvable_key(workspace: Workspace, name: str) -> bool:
    """Return whether a name is a rosdep key without a rule for the platform of the target distribution.

    If the user did not choose a distribution, a rule for the platform of any distribution is enough.
    """
    world, knowledge = workspace.world, workspace.world.knowledge
    if world.is_package(name) or not world.is_key(name) or knowledge.resolves(name) is not False:
        return False
    return workspace.target.explicit or not knowledge.distros_resolving(name)


def condition_for(workspace: Workspace, name: str) -> str:
    """Return the condition for the tag of a dependency that some distributions lack, "" if the tag needs no condition.

    The tag needs a condition only if one of the checked distributions has the dependency.
    """
    only_in = _availability(workspace, name).only_in
    is_in_run = not set(only_in).isdisjoint(workspace.target.distros)
    return _condition(only_in, workspace.world.knowledge.active) if is_in_run else ""


def is_of_pip(workspace: Workspace, name: str) -> bool:
    """Return whether a name is a rosdep key for pip and not for apt. The build farm does not accept such a key."""
    key = None if workspace.world.is_package(name) else workspace.world.knowledge.rosdep.get(name)
    return key is not None and bool(key.pip) and not key.apt


def _where(workspace: Workspace, name: str) -> str:
    knowledge = workspace.world.knowledge
    return f" on {knowledge.platform}, the platform of {workspace.target.distro}" if knowledge.distros_resolving(name) else ""
