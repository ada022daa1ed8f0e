"""How far the build of a package and its use of dependencies can be seen."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ros_lint.facts.visibility import Facet
from ros_lint.workspace.model import Package

if TYPE_CHECKING:
    from ros_lint.knowledge.world import World


def is_traceless_by_name(world: World, name: str) -> bool:
    """Whether a name alone says that it may do its work unseen: it is no package that is known, or a linter, a generator ..."""
    return not world.is_package(name) or world.is_key(name) or name_suggests_no_trace(world, name)


def name_suggests_no_trace(world: World, name: str) -> bool:
    """Whether a package is called like those that do their work unseen. Whether one of the workspace gives macros is seen."""
    names = world.knowledge.names
    return names.works_unseen(name) and not (world.layer(name) == "workspace" and names.sounds_like_macros(name))


def is_fully_visible(package: Package) -> bool:
    """Whether so much is seen of a package that no more packages can be used in it than those that are found."""
    return is_build_visible(package) and not package.hidden(Facet.USES)


def is_build_visible(package: Package) -> bool:
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
    return any(not provided.path.startswith(by_rote) for provided in script.installs)


def builds_something(package: Package) -> bool:
    """Whether a package has code: a package with launch files and data only may declare what these need in their own way."""
    script = package.script
    if script is None:
        return False
    made = script.targets or script.interfaces or script.python_packages or script.components
    return bool(made) or any(provided.path.startswith("include/") for provided in script.installs)
