"""What to say of a name that ought to be declared: which tag to write, where it resolves, or why it cannot be declared."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from ros_lint.declare import add_dependency, tag_for, tags_for
from ros_lint.rule import Fix

if TYPE_CHECKING:
    from ros_lint.facts.manifest import Role
    from ros_lint.rule import Edit
    from ros_lint.workspace import Package, Workspace


class Advice(NamedTuple):
    """The way out of a need, as far as there is one."""

    written: str
    """The element to add, followed by what is to be known of it."""
    fix: Fix | None
    """None when it cannot be declared, or when colcon rejects the manifest, which has to be mended first."""
    obstacle: str
    """Why it cannot be declared: goes on from "it cannot be declared: ". "" when it can."""
    circular: bool
    """Whether the obstacle is that it needs the package itself."""
    certain: bool = True
    """Whether the need is as certain as its evidence: not where it is circular or colcon rejects the manifest."""

    @property
    def ending(self) -> str:
        """Return how a message goes on that has said what is amiss."""
        return f", and it cannot be declared: {self.obstacle}" if self.obstacle else f": add {self.written}"


def advice(package: Package, workspace: Workspace, name: str, role: Role) -> Advice:
    """Return what to do about a package or key that is needed and is to be declared. The package has a manifest."""
    tag = tag_for(package, workspace, name, role)
    written = " and ".join(f"<{each}>{name}</{each}>" for each in tags_for(package, tag))
    if way := circle(package, workspace, name):
        between = f", by way of {' > '.join(way[1:-1])}" if len(way) > 2 else ""
        return Advice(written, None, f"it needs this package itself{between}", circular=True, certain=False)
    usable = not (package.manifest and package.manifest.problems)
    if (bare := workspace.by_name.get(name)) and all(each.manifest is None for each in bare):
        obstacle = f"{bare[0].path} has no package.xml, so rosdep does not know it; give it one"
        return Advice(written, None, obstacle, circular=False, certain=usable)
    if lacks_rule(workspace, name):
        obstacle = f"rosdep has no rule for it{_where(workspace, name)}"
        return Advice(written, None, obstacle, circular=False, certain=usable)
    if is_of_pip(workspace, name):
        written += " (from pip: what is released cannot depend on it)"
    written += availability(workspace, name)
    if _is_exported(package, name):
        written += " (the one in <export> declares nothing)"
    edits = add_dependency(package, tag, name) if usable else ()
    fix = naming(workspace, name, f"declare {name} as <{tag}>", *edits)
    return Advice(written, fix, "", circular=False, certain=usable)


def naming(workspace: Workspace, name: str, title: str, *edits: Edit, safe: bool = True) -> Fix | None:
    """Return the fix that writes a name into a dependency tag, None where there are no edits.

    Every fix that does so is made here: it is safe only where rosdep resolves the name wherever the workspace is meant to be
    built, see :func:`availability`.
    """
    return Fix.of(title, *edits, safe=safe and not availability(workspace, name))


def availability(workspace: Workspace, name: str) -> str:
    """Return the remark on where a name resolves, such as " (only in humble)", "" where it does so wherever it has to.

    It has to in the stated distribution, or in every active one where none was stated. A package of the workspace or of an
    underlay is there for all of them; any other name must be a released package or a rosdep key.
    """
    world, target = workspace.world, workspace.target
    if world.layer(name) in ("workspace", "underlay"):
        return ""
    knowledge = world.knowledge
    here = knowledge.rosdep_resolves(name, target.distro)
    if here and target.told:
        return ""
    if not knowledge.covered:
        return f" (there are no data about {target.distro})"
    there = [distro for distro in knowledge.active if knowledge.rosdep_resolves(name, distro)]
    lacking = [distro for distro in knowledge.active if distro not in there]
    if not there:
        return " (no distribution has it)"
    if not here:
        return f" ({target.distro} has none, only {', '.join(there)})"
    if len(lacking) < len(there):
        return f" (not in {', '.join(lacking)})" if lacking else ""
    return f" (only in {', '.join(there)})"


def circle(package: Package, workspace: Workspace, name: str) -> tuple[str, ...]:
    """Return a way by which a name needs a package itself, both ends included, or ().

    Either as colcon orders the workspace, where each tag counts (reference, section B2.2), or when it is installed: in
    another distribution, too, where this one has no such package.
    """
    graph = workspace.graph if name in workspace.by_name else None
    if graph is not None and name in graph.arcs and package.colcon_name in graph.closure(name):
        from ros_lint.graph_paths import paths  # noqa: PLC0415  (few needs are circular)

        return paths(lambda each: sorted(graph.arcs[each]), name, package.colcon_name, 1).found[0]
    world = workspace.world
    if not world.is_package(name) and world.knowledge.brings_elsewhere(name, package.name):
        return (name, package.name)
    return world.path((name,), package.name)


def _is_exported(package: Package, name: str) -> bool:
    """Whether a tag for a name stands in <export>, where catkin_pkg takes it for nobody's."""
    exports = package.manifest.exports if package.manifest else ()
    return any(element.tag.endswith("depend") and element.text.strip() == name for element in exports)


def lacks_rule(workspace: Workspace, name: str) -> bool:
    """Whether a name is a key that resolves nowhere where the workspace is meant to run.

    If nobody said for which distribution it is, any of them will do.
    """
    world, knowledge = workspace.world, workspace.world.knowledge
    if world.is_package(name) or not world.is_key(name) or knowledge.resolves(name) is not False:
        return False
    return workspace.target.told or not knowledge.resolving(name)


def is_of_pip(workspace: Workspace, name: str) -> bool:
    """Whether a name is a key that only pip installs, which the build farm does not take."""
    key = None if workspace.world.is_package(name) else workspace.world.knowledge.rosdep.get(name)
    return key is not None and bool(key.pip) and not key.apt


def _where(workspace: Workspace, name: str) -> str:
    knowledge = workspace.world.knowledge
    return f" on {knowledge.platform}, where {workspace.target.distro} runs" if knowledge.resolving(name) else ""
