"""
## What it finds

A package that is used directly but not declared: it is only available because a declared dependency depends on it. The message
names the path of dependencies.

## Why it matters

The package works until the declared dependency drops its own dependency on the used package, which may happen at any time. Then
this package breaks without any change of its own.

## How to fix it

Declare the used package with the tag that the message names. The fix adds the tag. It is unsafe if the message says that some
distributions do not have the package.

## Limitations

The severity depends on the use:

- a warning if CMake finds the package outside of tests, because nine of ten packages declare what they find;
- an info for all other uses: headers, imports, interfaces, launch files, tests. It does not change the exit code, unless
  `--fail-on info` is given. The `text` format shows all infos of a package together.

Not reported:

- Packages that only provide CMake commands, if they come with the build tool.
- Packages that only CMake commands of another package find, link and export.
- `action_msgs`, if only the code that is generated for actions needs it.
- Parts of launch that only launch files import, if `ros2launch` is declared.
- Packages that CMake finds but no code uses: see `unused-find-package`.
- Packages for which `package.xml` declares a wrong name: see `unknown-dependency`.
- A library of a declared vendor package, or of a declared key that stands for the whole library.
- Packages that no declared dependency provides, or only one with a tag for another purpose: see `undeclared-dependency` and
  `launch-outside-closure`.
- Optional uses of a package that depends on this one.

Reported with medium confidence:

- Packages that Python files import but do not use.
- All files that use the package may not be built or installed, or colcon rejects `package.xml`.
- The package depends on this one, with any tag, so declaring it would close a cycle that colcon rejects. There is no fix.

Reported with low confidence, because packages rarely declare it:

- Parts of launch that launch files import.
- Tools that run tests, such as GoogleTest, pytest and `launch_testing`, if a test dependency or build tool provides them.
- `ament_cmake_core`, because every build tool provides it, and `ament_cmake`, if another build tool such as `ament_cmake_auto`
  provides it.
- Linters that `ament_lint_common` contains, and their Python modules.
- Packages that launch files use, if a declared metapackage such as `navigation2` depends on them.
- Optional uses. They have no fix.

The confidence is also medium if:

- a single find_package() names the package and no source does, because the call may be unused;
- a single source names a type of the package and includes no header of it, because the interface of another package has the type.

There is also no fix if no rosdep key resolves for the distribution.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import cache

from ros_lint.api import (
    Confidence,
    Facet,
    Finding,
    Package,
    Role,
    Rule,
    Severity,
    Use,
    Workspace,
    cached_by_package,
    dependencies,
    first_related,
)

_LAUNCHER = "ros2launch"
_LINTERS = "ament_lint_common"
_BUILD_TOOL, _CORE = "ament_cmake", "ament_cmake_core"


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    if not dependencies.manifest_is_complete(package):
        return
    unused = {mention.name for mention in dependencies.unused_find_packages(package, workspace)}
    misnamed = dependencies.intended_names(package, workspace)
    uses_are_hidden = package.hidden(Facet.USES)  # then a package that find_package() finds may be unused
    misplaced = {lack.need.name for lack in dependencies.misplaced(package, workspace)}
    for need in dependencies.needs(package, workspace):
        if need.declared or not need.is_transitive or need.name in unused or need.name in misplaced or _is_command(need):
            continue
        if any(misnamed.intersection(use.providers) for use in need.uses):
            continue
        if not (package.declares(_LAUNCHER) and dependencies.is_part_of_launch(package, workspace, need.uses)):
            may_be_unused = all(map(_is_in_cmake, need.uses)) and (uses_are_hidden or len(need.uses) == 1)
            is_unused = all(use.unused for use in need.uses)  # an import to remove rather than to declare
            certain = need.sure and not (may_be_unused or is_unused or _is_one_type(need))
            yield _finding(package, workspace, need, Confidence.HIGH if certain else Confidence.MEDIUM)
    for wish in dependencies.optional_needs(package, workspace):
        if wish.is_transitive and not _is_command(wish):
            yield _finding(package, workspace, wish, Confidence.LOW)._replace(fix=None)


def _is_in_cmake(use: Use) -> bool:
    return use.span.path.endswith(("CMakeLists.txt", ".cmake"))


def _is_command(need: dependencies.Need) -> bool:
    """Return whether only CMake commands of another package use the needed package, e.g. find, link and export it."""
    calls = {use.span for use in need.uses if use.via == "macro"}
    return all(use.span in calls for use in need.uses)


_MOST_BETWEEN = 2
"""Maximum number of packages between the declared and the used one that the message names. ``ros-lint why`` lists all."""


def _comes_by_design(package: Package, workspace: Workspace, need: dependencies.Need, path: Sequence[str]) -> bool:
    """Return whether packages rarely declare a needed package (``need``), because a declared package exists to provide it.

    ``path`` leads from the declared package to the needed one. The result is True for

    - parts of build tools, tools that run tests, and linters,
    - packages that launch files use through a metapackage,
    - launch itself in launch files.
    """
    carrier, is_direct = path[0], len(path) == 2
    if need.name == _CORE or (need.name == _BUILD_TOOL and carrier.startswith(f"{_BUILD_TOOL}_")):
        return True
    in_tests = need.role is Role.TEST
    if need.name in (dependencies.TEST_MODULES if in_tests else dependencies.TEST_TOOLS) and package.declares(carrier) & (
        Role.TEST | Role.TOOL
    ):
        return True
    if (
        in_tests
        and carrier == _LINTERS
        and (is_direct or path[1:] == (f"ament_cmake_{need.name.removeprefix('ament_')}", need.name))
    ):
        return True
    if all(use.via in ("launch", "package") for use in need.uses):
        return len(path) > 1 and all(dependencies.is_metapackage(package, workspace, between) for between in path[:-1])
    outside_tests = [use for use in need.uses if use.role is not Role.TEST]
    return dependencies.is_part_of_launch(package, workspace, outside_tests or need.uses)


def _is_part_of_build_tool(path: Sequence[str]) -> bool:
    """Return whether ``ament_cmake`` itself depends on the last package of ``path``, as it does on ``ament_cmake_python``."""
    return len(path) == 2 and path[0] == _BUILD_TOOL and path[1].startswith(f"{_BUILD_TOOL}_")


def _is_one_type(need: dependencies.Need) -> bool:
    """Return whether the only use of the needed package is the name of a type in a single place, not in a public header."""
    return len(need.uses) == 1 and need.uses[0].via == "symbol" and not need.role & Role.EXPORT


def _finding(package: Package, workspace: Workspace, need: dependencies.Need, confidence: Confidence) -> Finding:
    """Return the finding for an undeclared package (``need``).

    The confidence is at most medium if colcon rejects the manifest, or if the declaration would close a cycle.
    """
    best, *others = need.uses
    path = _path(package, workspace, need)
    name = path[-1]
    if _comes_by_design(package, workspace, need, path):
        confidence = Confidence.LOW
    first, *between = [f"'{package_between}'" for package_between in path[:-1]]
    through = " and ".join(between) if len(between) <= _MOST_BETWEEN else f"{len(between)} other packages"
    origin = f"{first} through {through}" if between else first
    proposal = dependencies.remedy(package, workspace, name, need.role)
    return Finding(
        f"'{name}' is used here, but package.xml does not declare it; it comes with {origin}{proposal.ending}",
        best.span,
        name,
        first_related(dependencies.use_note(name, use) for use in others),
        proposal.fix,
        confidence if proposal.certain else min(confidence, Confidence.MEDIUM),
        None if dependencies.is_found_by_cmake(need) and not _is_part_of_build_tool(path) else Severity.INFO,
    )


def _path(package: Package, workspace: Workspace, need: dependencies.Need) -> tuple[str, ...]:
    """Return the names on a path of dependencies, from a declared name to the needed package.

    If possible, the declared name serves the purpose for which the package is needed: to build, to run or to test. Otherwise, a
    dependency that is used for this purpose comes first, because ``wrong-dependency-kind`` asks to correct its tag.
    """
    best = need.uses[0]
    names, purpose = _declared_names(package, workspace), _purpose(best.role)
    used = {} if purpose & Role.TEST else _used_names(package, workspace)[purpose]
    for starts in (names[purpose], used, names[_ANY]):
        for name in sorted(best.providers, key=workspace.world.is_runtime_library):
            if path := workspace.world.path(starts, name):
                return path
    return (need.name,)


@cached_by_package
def _used_names(package: Package, workspace: Workspace) -> Mapping[Role, Mapping[str, None]]:
    """Return the declared names of the packages that a package uses, by the purpose of the uses."""
    needs = [(need.role, need.declared) for need in dependencies.needs(package, workspace)]
    return {
        purpose: dict.fromkeys(name for role, declared in needs if role & purpose for name in declared) for purpose in _PURPOSES
    }


_ANY = ~Role(0)
_PURPOSES = (Role.BUILD | Role.TOOL, Role.EXEC | Role.EXPORT, Role.TEST | Role.TOOL, _ANY)


@cache
def _purpose(role: Role) -> Role:
    """Return all roles (flags such as ``Role.EXEC``) with the same purpose as ``role``: to build, to run or to test."""
    return next(roles for roles in _PURPOSES if role & roles)


@cached_by_package
def _declared_names(package: Package, workspace: Workspace) -> Mapping[Role, Mapping[str, None]]:
    """Return the declared names for each purpose (to build, to run, to test), in the order of the manifest."""
    return {
        purpose: dict.fromkeys(declared.name for declared in package.declared if declared.role & purpose) for purpose in _PURPOSES
    }


RULE = Rule(
    name="transitive-dependency",
    code="ROS202",
    summary="packages declare all dependencies that they use directly",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
