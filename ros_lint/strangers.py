"""Declared names that do not resolve, in packages where that is a mistake: what three rules share."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from ros_lint.facts import Depend, Role
from ros_lint.workspace import Declared, Package, Workspace

_BUILD_TYPES = frozenset({"ros.ament_cmake", "ros.ament_python", "ros.cmake"})


class Stranger(NamedTuple):
    """A name that a package declares."""

    package: Package
    declared: Declared
    """The first tag with the name."""
    tags: tuple[Depend, ...]
    """All tags with the name."""

    @property
    def name(self) -> str:
        return self.declared.depend.name

    @property
    def runs_python(self) -> bool:
        """Return whether it is needed to run Python code, for all that the tags say."""
        if self.package.builds_with == "ament_python":
            return True
        return not self.package.declares(self.name) & (Role.BUILD | Role.EXPORT | Role.TOOL)


def declared_names(workspace: Workspace) -> Iterator[Stranger]:
    """Yield every name that a package surely declares, once, where it has to resolve.

    Left out are packages of ROS 1 (catkin) and those whose manifest nobody can use, tags under a condition that nobody can
    evaluate, and packages of the workspace that colcon does not see: other rules speak of these.
    """
    hidden = {package.name for package in workspace.unusable}
    for package in workspace.packages:
        hidden.update(nested.name for nested in package.nested)
    for package in workspace.packages:
        if package.manifest is None or package.manifest.problems or package.type not in _BUILD_TYPES:
            continue
        tags: dict[str, list[Declared]] = {}
        for declared in package.declared:
            tags.setdefault(declared.name, []).append(declared)
        for name, found in tags.items():
            sure = [declared for declared in found if declared.certain]
            if sure and name not in hidden:
                yield Stranger(package, sure[0], tuple(declared.depend for declared in found))
