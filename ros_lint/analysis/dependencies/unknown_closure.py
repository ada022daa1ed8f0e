"""Determine whether an unknown declared dependency may provide a package. If so, an undeclared need is not certain."""

from __future__ import annotations

from collections.abc import Sequence

from ros_lint.analysis.dependencies.unresolved import MOST_CORRECTED, resembles_ament_package
from ros_lint.analysis.memo import cached_by_workspace
from ros_lint.knowledge.spelling import VENDOR, may_be_package
from ros_lint.workspace.model import Workspace


def may_provide(unknown: Sequence[str], name: str, workspace: Workspace, *, improbable: bool = False) -> bool:
    """Return whether one of the declared names ``unknown``, about which there are no data, could provide the package ``name``.

    These assumptions are made. ``improbable`` turns off the last one, so that an improbable provider counts, too:

    - Unknown packages do not depend on packages of this workspace, because repositories do not depend on each other in
      a cycle.
    - Unknown packages that are named like packages of interfaces (``*_msgs``) provide only interfaces.
    - Only unknown packages that are named like build tools or linters provide build tools and linters.
    - Any unknown package may provide a library.
    - If few released packages depend on ``name``, an unknown package with a quite different name does not depend on it.

    More than :data:`MOST_CORRECTED` unknown names are not examined: one of them may provide the package.
    """
    if name in workspace.by_name:
        return False
    if len(unknown) > MOST_CORRECTED:
        return True
    tool = "cmake" in name or (name.startswith("ament_") and not name.startswith("ament_index"))
    released = workspace.world.released(name)
    messages = bool(released and released.interfaces)
    unexplained = []
    library = (workspace.world.is_key(name) and not name.startswith("python3-")) or name.endswith(VENDOR)
    plumbing = name.startswith(("rosidl_", "builtin_", "action_msgs", "service_msgs", "unique_identifier_msgs"))
    for unknown_name in unknown:
        brings = workspace.world.knowledge.provides_elsewhere(unknown_name, name)
        if brings:
            return True
        if brings is None and (
            _is_no_package(unknown_name, workspace) or (tool and not any(word in unknown_name for word in _OF_TOOLS))
        ):
            continue
        if unknown_name.endswith(("_msgs", "_interfaces", "_srvs", "_msg")) and not (messages or plumbing):
            continue
        if library:
            return True
        if brings is False:  # the dependencies in another distribution are known, and probably the same
            continue
        if workspace.world.knowledge.elsewhere(unknown_name):
            return True
        unexplained.append(unknown_name)
    return bool(unexplained) and (tool or improbable or not _is_far(unexplained, name, workspace))


def _is_far(unknown: Sequence[str], name: str, workspace: Workspace) -> bool:
    """Return whether it is unlikely that one of the unknown names provides the package ``name``. All of these must hold:

    - Few released packages provide ``name``.
    - The target distribution has ``name``.
    - No other package of this workspace provides ``name``.
    - ``name`` has no word in common with the unknown names.
    """
    words = _words(name)
    if any(words & _words(unknown_name) for unknown_name in unknown):
        return False
    world = workspace.world
    if world.resolution(name) == "elsewhere":
        return False  # packages of another distribution provide the name
    most = int(len(world.knowledge.index) * _CHANCE / len(unknown))
    if most < 1 or any(name in world.closure((local,)) for local in workspace.by_name if local != name):
        return False
    return world.knowledge.index.count_providers(name, most) <= most


_CHANCE = 0.05
"""If at most this share of the released packages provide a package, an unknown dependency probably does not provide it.

Measured on packages without unknown dependencies, each dependency in turn treated as unknown. Up to this share, the dependency
provided an undeclared package in 0 of 180 cases (build tools aside); up to twice this share, in 10 of 268 cases, mostly launch.
"""

_EVERYDAY = frozenset({"ros", "ament", "cmake", "python", "lib", "dev", "msgs", "common", "utils", "tools"})


def _words(name: str) -> frozenset[str]:
    """Return the significant words of a name, without version numbers: ``mrpt2_tools`` -> {"mrpt"}."""
    return frozenset([word.rstrip("0123456789")[:8] or word for word in name.replace("-", "_").split("_")]) - _EVERYDAY


_OF_TOOLS = ("ament", "cmake", "lint", "common", "tools", "test")
"""Parts of the names of packages that provide build tools, linters or test runners."""


@cached_by_workspace
def _found(workspace: Workspace) -> frozenset[str]:
    """Return the names that build scripts of ROS 2 packages require by find_package()."""
    scripts = [package.script for package in workspace.packages if package.builds_with == "ament_cmake" and package.script]
    return frozenset(
        {mention.name for script in scripts for mention in script.mentions if mention.via == "cmake" and not mention.optional}
    )


def _is_no_package(name: str, workspace: Workspace) -> bool:
    """Return whether an unknown name is probably not the name of a ROS 2 package. The name is then one of these:

    - a name that is not valid for a package, such as that of a rosdep key,
    - the build type ament_python,
    - a dependency group,
    - a misspelled name,
    - a package that was only released for ROS 1. Exception: a build script finds the package, and it has no ROS 2
      successor; then it was probably ported without a release.
    """
    if not may_be_package(name) or name == "ament_python" or workspace.world.group_members(name):
        return True
    names = workspace.world.knowledge.names
    old_distros = names.end_of_life(name)
    if old_distros:
        ported = name in _found(workspace) and not names.successor(name)
        return not ported and all(distro.startswith("ROS 1 ") for distro in old_distros)
    return workspace.world.meant(name) is not None or resembles_ament_package(name, workspace)
