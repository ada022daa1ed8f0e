"""What a declared name of which nothing is known may bring along: that it may keeps rules from claiming what is lacking."""

from __future__ import annotations

from collections.abc import Sequence

from ros_lint.analysis.dependencies.unresolved import resembles_ament_package
from ros_lint.analysis.memo import cached_by_workspace
from ros_lint.knowledge.spelling import VENDOR, may_be_package
from ros_lint.workspace.model import Workspace


def may_provide(unknown: Sequence[str], name: str, workspace: Workspace) -> bool:
    """Whether one of the declared names of which nothing is known could bring a package along.

    What comes from elsewhere needs none of this workspace: repositories do not need each other in a circle. A package of
    messages brings messages, and build tools and linters come with others of their kind. Of a library
    nobody knows in which ways it comes. What hardly any package brings is not brought by one of which nothing is known but a
    name that sounds quite different.
    """
    if name in workspace.by_name:
        return False
    tool = "cmake" in name or (name.startswith("ament_") and not name.startswith("ament_index"))
    released = workspace.world.released(name)
    messages = bool(released and released.interfaces)
    strange = []
    library = (workspace.world.is_key(name) and not name.startswith("python3-")) or name.endswith(VENDOR)
    plumbing = name.startswith(("rosidl_", "builtin_", "action_msgs", "service_msgs", "unique_identifier_msgs"))
    for each in unknown:
        brings = workspace.world.knowledge.brings_elsewhere(each, name)
        if brings:
            return True
        if brings is None and (_is_no_package(each, workspace) or (tool and not any(word in each for word in _OF_TOOLS))):
            continue
        if each.endswith(("_msgs", "_interfaces", "_srvs", "_msg")) and not (messages or plumbing):
            continue
        if library:
            return True
        if brings is False:  # then it is known well enough, if the name is the same there
            continue
        if workspace.world.knowledge.elsewhere(each):
            return True
        strange.append(each)
    return bool(strange) and (tool or not _is_far(strange, name, workspace))


def _is_far(unknown: Sequence[str], name: str, workspace: Workspace) -> bool:
    """Whether it would be a strange chance if one of the unknown names brought a package along.

    Few released packages bring it, of those of a distribution that has it, no other package of this workspace does, and its
    name has nothing in common with theirs.
    """
    words = _words(name)
    if any(words & _words(each) for each in unknown):
        return False
    world = workspace.world
    if world.standing(name) == "elsewhere":
        return False  # it is brought where it is
    most = int(len(world.knowledge.index) * _CHANCE / len(unknown))
    if most < 1 or any(name in world.closure((other,)) for other in workspace.by_name if other != name):
        return False
    return world.knowledge.index.bringing(name, most) <= most


_CHANCE = 0.05
"""How likely it may be that one of the unknown names brings a package along, going by how many released packages do.

Measured on packages that declare nothing strange, each dependency taken for unknown in turn: what else they lack it brings
in none of 180 cases below this, tools of the build aside, and in 10 of 268, mostly launch, up to twice as much.
"""

_EVERYDAY = frozenset({"ros", "ament", "cmake", "python", "lib", "dev", "msgs", "common", "utils", "tools"})


def _words(name: str) -> frozenset[str]:
    """Return how the telling words of a name begin, without the number of a generation: mrpt2 is akin to mrpt_libobs."""
    return frozenset([word.rstrip("0123456789")[:8] or word for word in name.replace("-", "_").split("_")]) - _EVERYDAY


_OF_TOOLS = ("ament", "cmake", "lint", "common", "tools", "test")
"""Parts of the names of packages that bring build tools, linters or what runs tests."""


@cached_by_workspace
def _found(workspace: Workspace) -> frozenset[str]:
    """Return what build scripts of ROS 2 do not do without."""
    scripts = [package.script for package in workspace.packages if package.builds_with == "ament_cmake" and package.script]
    return frozenset({each.name for script in scripts for each in script.mentions if each.via == "cmake" and not each.optional})


def _is_no_package(name: str, workspace: Workspace) -> bool:
    """Whether an unknown name can stand for no package of ROS 2: it is spelt like a key, a slip, a group, or one of ROS 1.

    What a build script finds, and nothing took the place of in ROS 2, was ported without a release.
    """
    if not may_be_package(name) or name == "ament_python" or workspace.world.group_members(name):
        return True
    names = workspace.world.knowledge.names
    gone = names.end_of_life(name)
    if gone:
        ported = name in _found(workspace) and not names.successor(name)
        return not ported and all(distro.startswith("ROS 1 ") for distro in gone)
    return workspace.world.meant(name) is not None or resembles_ament_package(name, workspace)
