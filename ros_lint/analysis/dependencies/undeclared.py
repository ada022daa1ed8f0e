"""The packages that a package needs, but neither declares nor gets transitively through a declared dependency."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from ros_lint.analysis.dependencies.declared_closure import all_declared
from ros_lint.analysis.dependencies.find_package import names_searched
from ros_lint.analysis.dependencies.needs import _TEST, Need, _rank, needs
from ros_lint.analysis.dependencies.traceless import only_brings
from ros_lint.analysis.dependencies.unknown_closure import may_provide
from ros_lint.analysis.dependencies.unresolved import intended_names, misspelled_names
from ros_lint.analysis.memo import cached_by_package
from ros_lint.facts.launch import LAUNCH_RUNTIME
from ros_lint.facts.manifest import Role
from ros_lint.facts.sources import Use
from ros_lint.knowledge.spelling import is_part
from ros_lint.workspace.model import Package, Workspace


def manifest_is_complete(package: Package) -> bool:
    """Return whether package.xml was read to its end, even if colcon rejects it."""
    manifest = package.manifest
    return manifest is not None and all(problem.kind not in _CUT_SHORT for problem in manifest.problems)


_CUT_SHORT = frozenset({"bare-ampersand", "encoding", "entity", "invalid-xml", "merge-conflict", "no-package", "too-deep"})
"""Kinds of errors in package.xml after which the rest of the file is unread or unreliable."""


@cached_by_package
def undeclared(package: Package, workspace: Workspace) -> tuple[tuple[Need, bool], ...]:
    """Return the needed packages that no declared dependency provides, each with True if the need is certain.

    Left out are:
    - packages named only in launch files outside of tests, because another rule reports them,
    - packages declared by another name, such as a rosdep key,
    - packages named only by CMake macros, if another undeclared package provides them.

    Not certain are:
    - packages named only in modules that launch files import, because the package of the launch file may declare them,
    - packages declared under a false condition, unless CMake needs them, because the files that use them may be unused then,
    - metapackages whose files are looked up, because a metapackage has no files, so the name is probably wrong,
    - packages that package.xml probably declares by a misspelled name, because another rule reports that name,
    - packages that the workspace has only for ROS 1, because a package of ROS 2 cannot depend on them,
    - packages that a declared dependency may provide, because its own dependencies are unknown,
    - packages whose headers are included without find_package(), if the script finds a dependency with unknown dependencies.
    """
    unknown = all_declared(package, workspace).unknown
    result = []
    otherwise = intended_names(package, workspace).difference(misspelled_names(package, workspace).values())
    missing = [
        need
        for need in needs(package, workspace)
        if not (need.declared or need.is_transitive or any(otherwise.intersection(use.providers) for use in need.uses))
    ]
    joined = _joined([need for need in missing if not only_launched(package, need.uses)])
    elsewhere = (
        frozenset([depend.name for depend in package.manifest.depends if depend.condition]) if package.manifest else frozenset()
    )
    for need in joined:
        if all(use.via == "macro" for use in need.uses) and _comes_with(need, joined, workspace):
            continue
        sure = need.sure and any(use.via != "launch" or use.role is _TEST for use in need.uses)
        sure = sure and (need.name not in elsewhere or any(use.via in _BUILT and use.certain for use in need.uses))
        sure = sure and not (_looks_into_nothing(need, workspace) or _is_only_for_ros1(need.name, workspace))
        sure = sure and not is_declared_misspelled(package, workspace, need)
        if workspace.world.resolution(need.name) != "known":
            if distros_providing(package, workspace, need.name) or _is_declared_as_key(package, workspace, need.name):
                continue
            sure = sure and not (workspace.target.explicit and workspace.world.where_else(need.name))
        uses = uses_not_explained_by(unknown, need.uses, workspace) if sure and unknown else need.uses
        sure = sure and bool(uses) and not (unknown and _must_come_with(unknown, package, workspace, need))
        result.append((need._replace(uses=uses or need.uses), sure))
    return tuple(result)


def _must_come_with(unknown: Iterable[str], package: Package, workspace: Workspace, need: Need) -> bool:
    """Return whether one of the packages ``unknown`` must provide the needed package.

    ``unknown`` are declared packages with unknown dependencies. The result is True if compiled files only include headers of the
    needed package: the compiler finds them only after find_package() of the package or of another package that exports it.
    """
    name = need.name
    if not workspace.world.is_package(name) or any(use.via != "include" for use in need.uses if use.certain):
        return False
    compiled = any(use.certain and use.role & Role.BUILD for use in need.uses)
    searched = names_searched(package, package.built)
    found = [unknown_name for unknown_name in unknown if unknown_name in searched]
    return compiled and may_provide(found, name, workspace, improbable=True)


def is_declared_misspelled(package: Package, workspace: Workspace, need: Need) -> bool:
    """Return whether package.xml probably declares the needed package by a misspelled name, which another rule reports."""
    names = set(misspelled_names(package, workspace).values())
    return any(names.intersection(use.providers) for use in need.uses)


_BUILT = frozenset({"cmake", "macro", "target"})


def _looks_into_nothing(need: Need, workspace: Workspace) -> bool:
    """Return whether only launch files and look-ups of files use the package, although it is a metapackage without files.

    Probably another package is intended.
    """
    if need.name in workspace.by_name or any(use.via not in ("package", "launch") for use in need.uses):
        return False
    return only_brings(workspace.world, need.name)


def _is_only_for_ros1(name: str, workspace: Workspace) -> bool:
    """Return whether the workspace has a package of ROS 1 with this name, and ROS 2 has no such package."""
    namesakes = workspace.by_name.get(name, ())
    return bool(namesakes) and all(package.is_ros1 for package in namesakes) and workspace.world.released(name) is None


def _is_declared_as_key(package: Package, workspace: Workspace, name: str) -> bool:
    """Return whether the package declares a rosdep key for the library ``name``, e.g. libnlopt-dev for ``nlopt``."""
    return any(workspace.world.is_key(declared.name) and is_part(declared.name, name) for declared in package.declared)


def exists_in_any_distro(name: str, workspace: Workspace) -> bool:
    """Return whether a package exists in the target distribution or, if the user chose no distribution, in any distribution."""
    world = workspace.world
    return world.is_package(name) or (not workspace.target.explicit and bool(world.where_else(name)))


def distros_providing(package: Package, workspace: Workspace, name: str) -> tuple[str, ...]:
    """Return the distributions other than the target in which a declared dependency provides ``name`` transitively."""
    return workspace.world.knowledge.distros_providing(_declared_around(package, workspace), name)


@cached_by_package
def _declared_around(package: Package, workspace: Workspace) -> frozenset[str]:
    """Return the names that the package declares, and the run-time and exported ones of its dependencies in the workspace.

    Packages of the workspace are left out, because their released versions may have other dependencies.
    """
    closure = all_declared(package, workspace)
    around = [namesake for name, namesakes in workspace.by_name.items() if name in closure for namesake in namesakes]
    handed_on = [declared.name for other in around for declared in other.declared if declared.role & (Role.EXEC | Role.EXPORT)]
    return frozenset([*(declared.name for declared in package.declared), *handed_on]).difference(workspace.by_name)


def _joined(missing: Sequence[Need]) -> list[Need]:
    """Return the ``missing`` needs (packages with their uses), with two needs for one package joined into one.

    Example: find_package(Eigen3) and an include of ``Eigen/Dense`` give two needs for one package.
    """
    result: list[Need] = []
    common: list[frozenset[str]] = []  # the packages that provide all uses of a need of the result
    places: dict[str, list[int]] = {}  # indexes of the needs that have, or had, a name or a common provider
    for need in missing:
        providers = frozenset.intersection(*(frozenset(use.providers) for use in need.uses))
        candidates = sorted({number for name in (need.name, *providers) for number in places.get(name, ())})
        for number in candidates:
            earlier = result[number]
            before = earlier.name in providers
            if before or need.name in common[number]:
                best = earlier if before else need
                uses = sorted((*earlier.uses, *need.uses), key=lambda use: (_rank(use), not _names(use, best.name)))
                result[number] = best._replace(uses=tuple(uses))
                common[number] &= providers
                places.setdefault(best.name, []).append(number)
                break
        else:
            for name in {need.name, *providers}:
                places.setdefault(name, []).append(len(result))
            result.append(need)
            common.append(providers)
    return result


def _names(use: Use, name: str) -> bool:
    """Return whether the text of a use contains ``name`` itself, rather than the name of a library or module in it."""
    return name in (use.package, use.name.partition("/")[0])


def _comes_with(need: Need, others: Iterable[Need], workspace: Workspace) -> bool:
    return any(need.name in workspace.world.closure((sibling.name,)) for sibling in others if sibling is not need)


def uses_not_explained_by(unknown: Sequence[str], uses: Iterable[Use], workspace: Workspace) -> tuple[Use, ...]:
    """Return ``uses`` if the unknown dependencies cannot satisfy every certain use, else ().

    ``unknown`` are the declared names whose dependencies are unknown. The uses that no unknown name could satisfy come first.
    Each use counts separately: an unknown package may provide a library, but not the file that find_package() needs.
    """
    uses = tuple(uses)
    answers = dict.fromkeys([use.providers for use in uses])
    satisfied = {names: any(may_provide(unknown, name, workspace) for name in names) for names in answers}
    if all(satisfied[use.providers] for use in uses if use.certain):
        return ()
    return tuple(sorted(uses, key=lambda use: satisfied[use.providers]))


def only_launched(package: Package, uses: Sequence[Use]) -> bool:
    """Return whether all uses of a package are in launch files, and at least one of them is not for tests.

    Helper modules that launch files import count as ordinary code.
    """
    if any(use.via != "launch" for use in uses) or all(use.role is _TEST for use in uses):
        return False
    helpers = {launch.path for launch in package.launch if launch.helper}
    return not all(use.span.path in helpers for use in uses)


def is_part_of_launch(package: Package, workspace: Workspace, uses: Iterable[Use]) -> bool:
    """Return whether all uses are imports, in launch files, of packages that are installed together with ``ros2 launch``.

    These packages are the libraries of launch and, outside tests, their dependencies, such as ``python3-yaml``.
    """
    launched = {launch.path for launch in package.launch}
    installed = workspace.world.closure(LAUNCH_RUNTIME)
    return all(
        use.via == "import"
        and use.span.path in launched
        and (use.package in LAUNCH_RUNTIME or (use.role is not Role.TEST and use.package in installed))
        for use in uses
    )
