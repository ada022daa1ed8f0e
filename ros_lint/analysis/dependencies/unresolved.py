"""Declared names that do not resolve, in packages where that is a mistake: what several rules share."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

from ros_lint.analysis.memo import cached_by_package, cached_by_workspace
from ros_lint.facts.manifest import Depend, Role
from ros_lint.facts.sources import Use
from ros_lint.workspace.model import Declared, Package, Workspace

_BUILD_TYPES = frozenset({"ros.ament_cmake", "ros.ament_python", "ros.cmake"})


class UnresolvedDependency(NamedTuple):
    """A name that a package declares."""

    package: Package
    declared: Declared
    """The first tag with the name."""
    tags: tuple[Depend, ...]
    """All tags with the name."""
    called_so: tuple[Use, ...]
    """Where something is used that is called so, or that is in what is called so."""

    @property
    def name(self) -> str:
        return self.declared.depend.name

    @property
    def runs_python(self) -> bool:
        """Return whether it is needed to run Python code, for all that the tags say, and what uses it."""
        if self.package.builds_with == "ament_python":
            return True
        called_so = {use.via for use in self.called_so}
        if not self.package.declares(self.name) & (Role.BUILD | Role.EXPORT | Role.TOOL):
            return not called_so or "import" in called_so
        return called_so == {"import"}


@cached_by_workspace
def declared_names(workspace: Workspace) -> Mapping[str, Sequence[Package]]:
    """Return every name that has to resolve, with the packages that declare it.

    Left out are packages of ROS 1 (catkin) and those whose manifest nobody can use, and packages of the workspace that colcon
    does not see: other rules speak of these.
    """
    hidden = {package.name for package in workspace.unusable}
    for package in workspace.packages:
        hidden.update([nested.name for nested in package.nested])
    found: dict[str, list[Package]] = {}
    for package in workspace.packages:
        if package.manifest is None or package.manifest.problems or package.type not in _BUILD_TYPES:
            continue
        for name in dict.fromkeys([declared.depend.name for declared in package.declared]):
            if name not in hidden:
                found.setdefault(name, []).append(package)
    return found


def unresolved(name: str, packages: Iterable[Package]) -> Iterator[UnresolvedDependency]:
    """Yield a name once for each package that surely declares it: under no condition that nobody can evaluate."""
    for package in packages:
        tags = package.tags(name)
        first = next((declared for declared in tags if declared.certain), None)
        if first is not None:
            uses = [use for use in package.uses if use.name.startswith(name) and use.name.partition(".")[0] == name]
            yield UnresolvedDependency(package, first, tuple([declared.depend for declared in tags]), tuple(uses))


def resembles_ament_package(name: str, workspace: Workspace) -> bool:
    """Whether an unknown name is near one of ament: nearly everything of that is released, so it is a slip and no package."""
    return name.startswith("ament_") and any(near.startswith("ament_") for near in workspace.world.suggest(name))


@cached_by_package
def intended_names(package: Package, workspace: Workspace) -> frozenset[str]:
    """Return what a package must mean by those of its declared names that do not exist: nobody else need declare it."""
    found = (workspace.world.meant(each.name, python=each.runs_python) for each in _unknown(package, workspace))
    return frozenset([what.name for what in found if what]).union(misspelled_names(package, workspace).values())


@cached_by_package
def misspelled_names(package: Package, workspace: Workspace) -> Mapping[str, str]:
    """Return those of a package's declared names that must mean what it uses and does not declare, with what they mean."""
    found: dict[str, str] = {}
    for stranger in _unknown(package, workspace):
        if not workspace.world.meant(stranger.name, python=stranger.runs_python):
            found[stranger.name] = undeclared_match(stranger, workspace)
    return {name: what for name, what in found.items() if what}


def _unknown(package: Package, workspace: Workspace) -> Iterator[UnresolvedDependency]:
    known = declared_names(workspace)
    for name in dict.fromkeys([declared.name for declared in package.declared]):
        if workspace.world.standing(name) == "unknown" and package in known.get(name, ()):
            yield from unresolved(name, [package])


def undeclared_match(stranger: UnresolvedDependency, workspace: Workspace) -> str:
    """Return what a name must mean that CMake does not know: the only one like it that is used and not declared, or "".

    The same words, in whatever order and however joined, are meant for sure; another name is where nothing but the manifest has
    the wrong one.
    """
    package, name = stranger.package, stranger.name
    near = [use.package for use in package.uses if _is_same(use.package, name)]
    near += workspace.world.suggest(name, python=stranger.runs_python)
    lacking = [other for other in dict.fromkeys(near) if _is_lacking(package, other)]
    same = [other for other in lacking if _is_same(other, name)]
    if len(same) == 1 and name not in _mentioned(package):
        return same[0]
    return lacking[0] if len(lacking) == 1 and not is_used_in_sources(stranger) else ""


def is_used_in_sources(stranger: UnresolvedDependency) -> bool:
    """Whether anything but the manifest names it, so that there may be such a package after all."""
    package, name = stranger.package, stranger.name
    return name in _mentioned(package) or name in package.textual_mentions or any(name in use.providers for use in package.uses)


def _mentioned(package: Package) -> set[str]:
    return {mention.name.partition("::")[0] for mention in package.built.mentions}


def _is_same(one: str, other: str) -> bool:
    """Whether two names are of the same words, in any order, or joined otherwise: robot-talk, talk_robot and robottalk."""
    first, second = (name.lower().replace("-", "_") for name in (one, other))
    return sorted(first.split("_")) == sorted(second.split("_")) or first.replace("_", "") == second.replace("_", "")


def _is_lacking(package: Package, name: str) -> bool:
    """Whether a package needs another one for sure, and does not declare it."""
    needed = any(use.package == name and use.certain and not use.optional for use in package.uses)
    return needed and not package.declares(name)
