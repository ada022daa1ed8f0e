"""Determine whether ros-lint can find all places in a package that use other packages."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from ros_lint.facts.build import BuildScript
from ros_lint.facts.visibility import Facet
from ros_lint.workspace.model import Package

if TYPE_CHECKING:
    from ros_lint.knowledge.world import World


def is_traceless_by_name(world: World, name: str) -> bool:
    """Return whether the name of a package suggests that no file of its dependents mentions it.

    The result is True for a rosdep key, for the name of a linter, a generator or a similar package, and for a name that is
    neither in the workspace nor in ROS.
    """
    return not world.is_package(name) or world.is_key(name) or name_suggests_no_trace(world, name)


def name_suggests_no_trace(world: World, name: str) -> bool:
    """Return whether a package is one that dependents use without mentioning it in any file, such as a linter.

    The name decides. The result is False for a package of the workspace that provides macros, because ros-lint evaluates the
    macros and so finds its uses.
    """
    names = world.knowledge.names
    return names.leaves_no_trace(name) and not (world.layer(name) == "workspace" and names.provides_macros(name))


def problems_hide_uses(script: BuildScript) -> bool:
    """Return whether an error in a build script leaves unknown which packages the script uses.

    A missing folder, mesh or documentation page hides no use. Git keeps no empty folders, so most missing folders are empty.
    """
    return any(
        problem.kind not in _HIDING_NOTHING and not (problem.kind == "missing-file" and problem.subject.endswith(_WITHOUT_USES))
        for problem in script.problems
    )


_HIDING_NOTHING: Final = frozenset({
    "absolute-destination", "dashed-key", "directory-in-data-files", "directory-is-file", "empty-glob", "entry-point-form",
    "file-is-directory", "undefined-target",
})  # fmt: skip
"""Kinds of problems in commands and options whose effect on the used packages is known."""
_WITHOUT_USES: Final = ("/", ".dae", ".md", ".obj", ".pcd", ".pgm", ".png", ".rst", ".stl", ".STL")
"""Ends of the paths of missing files and folders that cannot contain the name of a package."""


def uses_code_outside(script: BuildScript) -> bool:
    """Return whether a package compiles sources or includes headers outside of its folder, which may use any package."""
    return script.cmake.compiles_outside_package or script.cmake.includes_outside_package


def is_fully_visible(package: Package) -> bool:
    """Return whether ros-lint can evaluate everything in the build and the launch files that may use another package."""
    return is_build_visible(package) and not package.hidden(Facet.USES)


def is_build_visible(package: Package) -> bool:
    """Return whether ros-lint can evaluate everything in the build of a package that may use a library.

    The result is False if the package builds nothing, or not with ament_cmake or ament_python. Launch files use no libraries, so
    they are ignored.
    """
    manifest, script = package.manifest, package.script
    if manifest is None or manifest.problems or script is None or problems_hide_uses(script) or uses_code_outside(script):
        return False
    launched = {launch.path for launch in package.launch}
    if any(opaque.span.path not in launched for opaque in package.hidden(Facet.USES)):
        return False
    return package.builds_with in ("ament_cmake", "ament_python") and builds_something(package)


def makes_something(package: Package) -> bool:
    """Return whether a package builds or installs files of its own, unlike a metapackage."""
    script = package.script
    if script is None or package.opaque or builds_something(package):
        return True
    always_installed = ("share/ament_index/", f"share/{package.name}/package.xml", f"share/{package.name}/cmake/")
    return any(not file.path.startswith(always_installed) for file in script.products.installs)


def builds_something(package: Package) -> bool:
    """Return whether a package builds targets, interfaces, Python packages or components, or installs headers."""
    script = package.script
    if script is None:
        return False
    products = (
        script.products.targets or script.products.interfaces or script.products.python_packages or script.products.components
    )
    return bool(products) or any(provided.path.startswith("include/") for provided in script.products.installs)
