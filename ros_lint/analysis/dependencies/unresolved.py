"""Declared dependencies that are neither packages nor rosdep keys. :func:`declared_names` lists the exceptions."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from typing import Final, NamedTuple

from ros_lint.analysis.finding import Consequence
from ros_lint.analysis.memo import cached_by_package, cached_by_workspace
from ros_lint.facts.manifest import Depend, Role
from ros_lint.facts.sources import Use, Via
from ros_lint.workspace.model import Declared, Package, Workspace

_BUILD_TYPES = frozenset({"ros.ament_cmake", "ros.ament_python", "ros.cmake"})


class UnresolvedDependency(NamedTuple):
    """A declared name that is neither a package nor a rosdep key."""

    package: Package
    """The package that declares the name."""
    declared: Declared
    """The first tag with the name."""
    tags: tuple[Depend, ...]
    """All tags with the name."""
    matching_uses: tuple[Use, ...]
    """Uses of the declared name or of a module in it (``name.module``)."""
    runs_python: bool
    """True if only Python code may need the name at run time, according to its tags and its uses."""

    @property
    def name(self) -> str:
        """The declared name."""
        return self.declared.depend.name


@cached_by_workspace
def declared_names(workspace: Workspace) -> Mapping[str, Sequence[Package]]:
    """Return every declared name that must be a package or a rosdep key, with the packages that declare it.

    Left out, because other rules report them, are:
    - packages of ROS 1 (catkin),
    - packages with an unusable package.xml,
    - packages of the workspace that colcon does not find.
    """
    hidden = {package.name for package in workspace.unusable}
    for package in workspace.packages:
        hidden.update([nested.name for nested in package.nested])
    result: dict[str, list[Package]] = {}
    for package in workspace.packages:
        if package.manifest is None or package.manifest.problems or package.type not in _BUILD_TYPES:
            continue
        for name in dict.fromkeys([declared.depend.name for declared in package.declared]):
            if name not in hidden:
                result.setdefault(name, []).append(package)
    return result


def unresolved(name: str, packages: Iterable[Package]) -> Iterator[UnresolvedDependency]:
    """Yield an unresolved dependency for each of ``packages`` that certainly declares ``name``.

    ``name`` is neither a package nor a rosdep key. A declaration is not certain if the value of its condition is unknown.
    """
    for package in packages:
        tags = package.tags(name)
        first = next((declared for declared in tags if declared.certain), None)
        if first is not None:
            uses = tuple([use for use in package.uses if use.name.startswith(name) and use.name.partition(".")[0] == name])
            runs_python = _runs_python(package, name, {use.via for use in uses})
            yield UnresolvedDependency(package, first, tuple([declared.depend for declared in tags]), uses, runs_python)


def _runs_python(package: Package, name: str, vias: Collection[Via]) -> bool:
    """Return whether only Python code may need a declared name at run time. ``vias`` are the kinds of its uses."""
    if package.builds_with == "ament_python":
        return True
    if not package.declares(name) & (Role.BUILD | Role.EXPORT | Role.TOOL):
        return not vias or "import" in vias
    return vias == {"import"}


def resembles_ament_package(name: str, workspace: Workspace) -> bool:
    """Return whether an unknown name is probably a misspelled package of ament.

    Nearly all packages whose names begin with "ament_" are released.
    """
    return name.startswith("ament_") and any(near.startswith("ament_") for near in workspace.world.suggest(name))


MOST_CORRECTED: Final = 500
"""Greatest number of unresolved dependencies of a package for which the intended names are searched."""


def are_corrected(package: Package, workspace: Workspace) -> bool:
    """Return whether the intended names of the unresolved dependencies of a package are searched.

    They are not if there are more than :data:`MOST_CORRECTED`: then the names are not misspelled, and the search takes long.
    """
    return len(_unknown(package, workspace)) <= MOST_CORRECTED


@cached_by_package
def intended_names(package: Package, workspace: Workspace) -> frozenset[str]:
    """Return the packages that the unresolved names in package.xml probably mean: ``rclcpp`` for ``rclcp``.

    These packages are not reported as undeclared, because the unresolved name is reported.
    """
    if not are_corrected(package, workspace):
        return frozenset()
    result = (
        workspace.world.meant(unresolved_dependency.name, python=unresolved_dependency.runs_python)
        for unresolved_dependency in _unknown(package, workspace)
    )
    return frozenset([what.name for what in result if what]).union(misspelled_names(package, workspace).values())


@cached_by_package
def misspelled_names(package: Package, workspace: Workspace) -> Mapping[str, str]:
    """Return the declared names that are probably misspelled, each with the intended package."""
    result: dict[str, str] = {}
    for dependency in _unknown(package, workspace) if are_corrected(package, workspace) else ():
        if not workspace.world.meant(dependency.name, python=dependency.runs_python):
            result[dependency.name] = undeclared_match(dependency, workspace)
    return {name: what for name, what in result.items() if what}


@cached_by_package
def _unknown(package: Package, workspace: Workspace) -> tuple[UnresolvedDependency, ...]:
    known = declared_names(workspace)
    names = dict.fromkeys([declared.name for declared in package.declared])
    unknown = [name for name in names if workspace.world.resolution(name) == "unknown" and package in known.get(name, ())]
    return tuple([dependency for name in unknown for dependency in unresolved(name, [package])])


def undeclared_match(dependency: UnresolvedDependency, workspace: Workspace) -> str:
    """Return the package that an unresolved name probably means, or "" if there is no such package or more than one.

    The result has a similar name, and is used but not declared. If both names have the same words (``robot-talk``,
    ``talk_robot``), the build script must not contain the unresolved name. Otherwise no file except package.xml may contain it.
    """
    package, name = dependency.package, dependency.name
    near = [used for used in dict.fromkeys(use.package for use in package.uses) if _is_same(used, name)]
    near += workspace.world.suggest(name, python=dependency.runs_python)
    undeclared = [undeclared_name for undeclared_name in dict.fromkeys(near) if _is_lacking(package, undeclared_name)]
    same = [undeclared_name for undeclared_name in undeclared if _is_same(undeclared_name, name)]
    if len(same) == 1 and name not in _mentioned(package):
        return same[0]
    return undeclared[0] if len(undeclared) == 1 and not is_used_in_sources(dependency) else ""


def wrong_name_explains(name: str, intended: str = "") -> tuple[Consequence, ...]:
    """Return the further findings that a wrong name in package.xml explains: they disappear when the name is corrected.

    The wrong name is reported as unused, and the package ``intended`` as undeclared. If ``intended`` is "", the wrong name
    has to be removed.
    """
    lacking = ("undeclared-dependency", "launch-outside-closure") if intended else ()
    return (Consequence("unused-dependency", name), *(Consequence(rule, intended) for rule in lacking))


def is_used_in_sources(dependency: UnresolvedDependency) -> bool:
    """Return whether a file other than package.xml contains the name of the dependency. If so, the dependency may exist."""
    package, name = dependency.package, dependency.name
    return name in _mentioned(package) or name in package.textual_mentions or any(name in use.providers for use in package.uses)


def _mentioned(package: Package) -> set[str]:
    return {mention.name.partition("::")[0] for mention in package.built.mentions}


def _is_same(name_a: str, name_b: str) -> bool:
    """Return whether two names have the same words: robot-talk, talk_robot, robottalk."""
    first, second = (name.lower().replace("-", "_") for name in (name_a, name_b))
    return sorted(first.split("_")) == sorted(second.split("_")) or first.replace("_", "") == second.replace("_", "")


def _is_lacking(package: Package, name: str) -> bool:
    """Return whether a package certainly needs a dependency that it does not declare."""
    needed = any(use.package == name and use.certain and not use.optional for use in package.uses)
    return needed and not package.declares(name)
