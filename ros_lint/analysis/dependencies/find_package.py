"""The packages that a CMake script searches by find_package(), or passes to macros such as ament_export_dependencies()."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from typing import TYPE_CHECKING

from ros_lint.analysis.build.commands import FINDS_TESTS
from ros_lint.analysis.dependencies.alternatives import standing_for_first
from ros_lint.facts.build import BuildScript
from ros_lint.facts.manifest import Role
from ros_lint.facts.sources import Mention, Purpose
from ros_lint.workspace.model import Package, Workspace

if TYPE_CHECKING:
    from ros_lint.knowledge.closure import Closure

_FIND_DECLARED = frozenset({"ament_auto_find_build_dependencies", "autoware_package"})
_AT_BUILD = ("depend", "build_depend", "buildtool_depend")


def names_searched(package: Package, script: BuildScript) -> frozenset[str]:
    """Return the names that CMake searches by find_package(), which the script calls directly or through a macro."""
    names = {mention.name for mention in script.mentions if mention.via == "cmake"}
    calls = frozenset(script.commands.names)
    if calls & _FIND_DECLARED:
        names.update(declared.name for declared in package.declared if declared.depend.tag in _AT_BUILD)
    if calls & FINDS_TESTS:
        names.update(declared.name for declared in package.declared if declared.depend.tag == "test_depend")
    return frozenset(names)


def finds_declared(package: Package) -> bool:
    """Return whether a CMake macro finds all declared build dependencies and links them to every target (ament_cmake_auto)."""
    return package.script is not None and not _FIND_DECLARED.isdisjoint(package.script.commands.names)


def find_package_closure(workspace: Workspace, names: Iterable[str]) -> frozenset[str] | None:
    """Return the packages that ``find_package()`` of each name finds, their transitive dependencies, and the names themselves.

    The result is None if a name belongs to no known package, or if the dependencies of a found package are unknown.
    """
    closure = partial_closure(workspace, names)
    return closure.names.union(names) if closure.complete else None


Passes = Callable[[Package, BuildScript], Iterable[str]]
"""A function that returns the CMake names which the build script of a package passes on, such as :func:`names_exported`."""


def partial_closure(workspace: Workspace, names: Iterable[str], passes: Passes = lambda package, script: ()) -> Closure:
    """Return the packages that ``find_package()`` of each name finds, with their transitive dependencies.

    ``passes`` adds what packages of the workspace pass on in CMake, even indirectly, because a manifest need not declare it.
    ``Closure.unknown`` has the names without a known package, and the packages with unknown dependencies.
    """
    starts: set[str] = set()
    for name in _with_passed_on(workspace, names, passes):
        providers = workspace.world.by_cmake(name)
        mapped = providers.known and not workspace.world.is_package(name)
        starts.update(set(standing_for_first(workspace, providers.names)).intersection(providers.packages) if mapped else (name,))
    return workspace.world.closure(sorted(starts))


def names_exported(package: Package, script: BuildScript) -> frozenset[str]:
    """Return the CMake names of the packages that a package exports as dependencies, without the package itself."""
    exported = {mention.name for mention in macro_packages(script, "export", "interfaces")}
    return frozenset(exported.union(mention.name for mention, _ in script.exports.packages) - {package.name})


def _with_passed_on(workspace: Workspace, names: Iterable[str], passes: Passes) -> tuple[str, ...]:
    """Return CMake names, and the names that packages of the workspace with these names pass on, even indirectly."""
    result = dict.fromkeys(names)
    waiting = list(result)
    while waiting:
        for package in workspace.by_name.get(waiting.pop(), ()):
            new = [name for name in sorted(passes(package, package.script)) if name not in result] if package.script else []
            result.update(dict.fromkeys(new))
            waiting += new
    return tuple(result)


def finding_others(package: Package, workspace: Workspace, names: Iterable[str]) -> frozenset[str]:
    """Return the elements of ``names`` whose find_package() has to stay, because it may also find a package in use.

    ``names`` are unused packages of one build script, and the calls for all of them are to be removed. Example: the sources
    include ``<Eigen/Dense>``, and CMake finds Eigen only because find_package(tf2_eigen) finds it, too. A package with
    unknown dependencies may find any package.
    """
    unused = frozenset(names)
    is_found = _found(workspace, names_searched(package, package.built) - unused)
    needed = dict.fromkeys([use.providers for use in package.uses if not use.optional and use.role & _BUILT])
    lacking = [providers for providers in needed if unused.isdisjoint(providers) and not any(map(is_found, providers))]
    closures = {name: partial_closure(workspace, [name]) for name in unused}
    return frozenset(
        [
            name
            for name, closure in closures.items()
            if not closure.complete or any(provider in closure for providers in lacking for provider in providers)
        ]
    )


def _found(workspace: Workspace, names: Iterable[str]) -> Callable[[str], bool]:
    """Return a function that returns whether ``find_package()`` of ``names`` finds a given package or rosdep key.

    Packages that are found transitively count, too.
    """
    all_names = sorted(names)
    direct = frozenset([provider for name in all_names for provider in workspace.world.by_cmake(name).names])
    closure = partial_closure(workspace, all_names)
    return lambda name: name in closure or name in direct


def found_only_through(package: Package, workspace: Workspace, unused: Iterable[str]) -> frozenset[str]:
    """Return the elements of ``unused`` through which ament_cmake_auto may find a library that the package uses.

    ``unused`` are declared packages that the package does not use. ament_cmake_auto calls find_package() for declared
    names, which fails for rosdep keys. Example: ``libpcl-all-dev`` is declared for the headers of PCL, but CMake finds
    PCL only because the declared ``pcl_conversions`` exports it. The result is empty without ament_cmake_auto.
    """
    names = frozenset(unused)
    if not names or not finds_declared(package):
        return frozenset()
    world = workspace.world
    searched = names_searched(package, package.built) - names
    is_found = _found(workspace, [name for name in searched if world.is_package(name) or not world.is_key(name)])
    included = [use.providers for use in package.uses if use.via == "include" and not use.optional and use.role & _BUILT]
    lacking = [providers for providers in dict.fromkeys(included) if not any(map(is_found, providers))]
    closures = {name: world.closure((name,)) for name in names}
    return frozenset([name for name in names if any(provider in closures[name] for use in lacking for provider in use)])


_BUILT = Role.BUILD | Role.EXPORT | Role.TEST


def macro_packages(script: BuildScript, *purposes: Purpose) -> Iterator[Mention]:
    """Yield the places where a macro such as ament_export_dependencies() gets a package name, for a purpose such as "export"."""
    for mention in script.mentions:
        if mention.via == "target" and mention.purpose in purposes:
            yield mention
