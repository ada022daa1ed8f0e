"""Choose the dependency tag for a needed package, and make the edits of package.xml, for several rules."""

from __future__ import annotations

from collections.abc import Collection, Sequence

from ros_lint.analysis.dependencies.find_package import finds_declared
from ros_lint.analysis.dependencies.traceless import is_mostly_runtime
from ros_lint.base.edit import Edit
from ros_lint.collectors.manifest import edits as manifest_edits
from ros_lint.facts.manifest import Depend, Role
from ros_lint.workspace.model import Package, Workspace


def tag_for(package: Package, workspace: Workspace, name: str, role: Role) -> str:
    """Return the tag that covers all roles (build, run, test ...) of a dependency (REP 149), e.g. "exec_depend".

    Exceptions:
    - The result is "depend" instead of "exec_depend" if package.xml declares even run-time dependencies by ``<depend>``, unless
      CMake finds and links all declared dependencies.
    - Format 1 has no tag for building and running. The result is "build_depend", and :func:`add_dependency` adds the
      ``<run_depend>``.
    """
    form = package.manifest.format if package.manifest else 3
    if role == Role.TEST:
        return "test_depend"
    needed = _without(role, Role.TEST)
    if needed == Role.EXEC or (form > 1 and needed == Role.EXPORT and _is_only_run(workspace, name)):
        if form == 1:
            return "run_depend"
        habit = _always_depend(package) and _depends_on_runs(package, workspace) and not finds_declared(package)
        return "depend" if habit else "exec_depend"
    if needed == Role.TOOL or (_has(needed, Role.BUILD) and _is_tool(workspace, name, needed)):
        return "buildtool_depend"
    return "build_depend" if form == 1 or (needed == Role.BUILD and _is_only_for_building(workspace, name)) else "depend"


def _always_depend(package: Package) -> bool:
    """Return whether package.xml uses ``<depend>`` for all of its build and run dependencies, of which there are at least two."""
    tags = [declared.depend.tag for declared in package.declared if declared.role & (Role.BUILD | Role.EXEC | Role.EXPORT)]
    return len(tags) > 1 and set(tags) == {"depend"}


def _depends_on_runs(package: Package, workspace: Workspace) -> bool:
    """Return whether package.xml contains a ``<depend>`` tag for a dependency that is only needed at run time.

    The uses of the dependency decide. If there are none, the tags by which most released packages declare it decide.
    """
    roles: dict[str, Role] = {}
    for use in package.uses:
        for name in use.providers:
            roles[name] = roles.get(name, use.role) | use.role
    names = [declared.depend.name for declared in package.declared if declared.depend.tag == "depend"]
    return any(not roles[name] & _BUILDS if name in roles else is_mostly_runtime(workspace, name) for name in names)


_BUILDS = Role.BUILD | Role.EXPORT | Role.TOOL


def _has(role: Role, part: Role) -> bool:
    return bool(role & part)


def _without(role: Role, part: Role) -> Role:
    return role & ~part


def tags_for(package: Package, tag: str) -> tuple[str, ...]:
    """Return the tags to write instead of ``tag``: in format 1, each ``build_depend`` needs a ``run_depend``, too."""
    assert package.manifest is not None
    return (tag, "run_depend") if package.manifest.format == 1 and tag == "build_depend" else (tag,)


def add_dependency(package: Package, tag: str, name: str) -> tuple[Edit, ...]:
    """Return the edits that declare a dependency. The package must have a package.xml."""
    assert package.manifest is not None
    return tuple(manifest_edits.add(package.manifest, needed_tag, name) for needed_tag in tags_for(package, tag))


def change_dependency(package: Package, depends: Sequence[Depend], tag: str, alike: Collection[Depend]) -> tuple[Edit, ...]:
    """Return the edits that replace all tags of a dependency by one ``tag``. The package must have a package.xml.

    ``depends`` are the tags of the dependency, ``alike`` the tags of all dependencies that the fix changes to ``tag``.
    """
    assert package.manifest is not None
    changed = next((depend for depend in depends if depend.tag == tag), depends[0])
    edits = () if changed.tag == tag else manifest_edits.change_kind(package.manifest, changed, tag, alike)
    return (*edits, *(manifest_edits.remove(package.manifest, depend) for depend in depends if depend is not changed))


def remove_dependency(package: Package, depend: Depend) -> tuple[Edit, ...]:
    """Return the edits that remove a dependency tag. The package must have a package.xml."""
    assert package.manifest is not None
    return (manifest_edits.remove(package.manifest, depend),)


def _is_tool(workspace: Workspace, name: str, needed: Role) -> bool:
    """Return whether most released packages that declare a name declare it as a build tool.

    Packages that declare the name only for tests do not count, unless the needed roles include exporting.
    """
    counts = workspace.world.knowledge.index.declared_as(name)
    declared = {kinds: count for kinds, count in counts.items() if kinds != "s" or _has(needed, Role.EXPORT)}
    return 2 * sum(count for kinds, count in declared.items() if "t" in kinds) > sum(declared.values())


def _is_only_run(workspace: Workspace, name: str) -> bool:
    """Return whether many released packages declare a name, and most of them only for run time."""
    declared = workspace.world.knowledge.index.declared_as(name)
    return 2 * declared.get("x", 0) > max(_FEW, sum(declared.values()))


_FEW = 40
"""More than half this number of released packages must declare a name only for run time to show a common practice."""


def _is_only_for_building(workspace: Workspace, name: str) -> bool:
    """Return whether most released packages that declare a name declare it only for building."""
    declared = workspace.world.knowledge.index.declared_as(name)
    return 2 * sum(count for kinds, count in declared.items() if set(kinds) <= {"b", "t"}) > sum(declared.values())


TEST_LIBRARIES = frozenset({
    "ament_cmake_gmock", "ament_cmake_google_benchmark", "ament_cmake_gtest", "benchmark", "gmock_vendor", "google-mock",
    "google_benchmark_vendor", "gtest", "gtest_vendor", "libgmock-dev", "libgtest-dev",
})  # fmt: skip
"""Packages and rosdep keys that provide test libraries for C++."""

TEST_TOOLS = TEST_LIBRARIES | {"ament_cmake_pytest", "python3-pytest"}
"""Packages and rosdep keys that run tests. Packages for a kind of test depend on them: ``ament_cmake_gtest`` on ``gtest``."""

TEST_MODULES = TEST_TOOLS | {
    "launch", "launch_pytest", "launch_ros", "launch_testing", "launch_testing_ament_cmake", "launch_testing_ros",
}  # fmt: skip
"""Packages and rosdep keys that tests use. Packages for a kind of test depend on them: ``launch_testing`` on ``launch``."""
