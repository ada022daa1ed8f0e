"""
## What it finds

- A `<depend>` or `<build_depend>` on a ROS package that the package does not use: no include, import, `find_package`, interface
  or launch file refers to it, and no other file contains its name.
- A `<test_depend>` in a package without a test that could use it, unless something else uses it, such as `find_package` or a
  launch file. A `<test_depend>` on messages that no file names is reported although the package has tests.
- A `<buildtool_depend>` on a package for which CMake does not look.

## Why it matters

Every dependency is installed and built before this package, and a change of it causes a rebuild. An unused dependency costs
time on every machine and misleads readers.

## How to fix it

Remove the tag. Together with a `<build_depend>`, also remove the `<build_export_depend>`, and the `<exec_depend>` if the
dependency provides nothing to run. The fix does this. It needs `--unsafe-fixes` unless the confidence is high.

A `<test_depend>` beside a `<depend>` of the same name is an info, because nothing more is installed for it.

## Limitations

Not reported:

- Dependencies with a type that C++ code uses by its bare name, because a header of a third package may declare it.
- Dependencies with whose names a type, function or macro in C or C++ code begins: `rmw_request_id_t`, `RCLCPP_ERROR(`.
- Dependencies with programs or launch files that the documentation of the package starts (`ros2 run`, `ros2 launch`).
- Dependencies that may be needed although no file names them: linters, run-time and tool dependencies, metapackages, vendor
  packages, packages without code, and packages that provide CMake macros or plugins.
- Packages through which `ament_auto_find_build_dependencies()` finds a used library that is declared by its rosdep key.
- Packages that contain no code themselves, and packages whose build scripts cannot be fully evaluated.
- Packages that compile sources outside of their folder, or that have include directories there.
- Tags with a condition that is false in some ROS 2 environment.

Reported with medium confidence:

- rosdep keys of libraries, because headers of other packages may need them. The confidence is high if a package that is used
  depends on the library.
- Packages that are not known.
- Build tools.
- Packages that others mostly declare for run time only: Python packages, and packages with both messages and programs.
- Any dependency, if a file of the workspace cannot be read.
- Any dependency, if the modules that entry points name do not exist yet, or if no Python code imports anything.
- Unused dependencies through which this package, or another one of the workspace, gets a package that it uses but does not
  declare. Declare that package instead. There is no fix in this case.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import (
    BuildScript,
    Confidence,
    Declared,
    Depend,
    Finding,
    Fix,
    Package,
    Role,
    Rule,
    Severity,
    Workspace,
    build,
    dependencies,
)

_TAGS = ("depend", "build_depend")
_HANDED_ON = Role.EXEC | Role.EXPORT
_BUILD_TYPE = frozenset({"ament_cmake", "ament_cmake_core"})
_NO_TEST = build.FINDS_TESTS | {"enable_testing"}


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    unused = list(_unused(package, workspace))
    kept = dependencies.found_only_through(package, workspace, [declared.name for declared, _, _ in unused])
    unused = [tag for tag in unused if tag[0].name not in kept]
    carried = dependencies.needed_transitively(package, workspace, [declared for declared, _, _ in unused]) if unused else {}
    for declared, reason, confidence in unused:
        depend = declared.depend
        name, sure = depend.name, confidence is Confidence.HIGH
        if name in carried:
            message = _message_if_carrying(package, name, carried[name])
            yield Finding(message, depend.span, name, confidence=min(confidence, Confidence.MEDIUM))
            continue
        tags = [depend, *(_needless_tags(package, workspace, depend) if sure else ())]
        more_tags = " and ".join(f"<{tag.tag}>" for tag in tags[1:])
        written = f"<{depend.tag}>{name}</{depend.tag}>" + (f" and its {more_tags}" if more_tags else "")
        other = next(
            (tag.depend.tag for tag in package.tags(name) if depend.tag == "test_depend" and tag.depend.tag == "depend"), ""
        )
        how = f"as <{other}>, too, and" if other else "but"
        yield Finding(
            f"'{name}' is declared{'' if other else ','} {how} {reason}; remove {written}",
            depend.span,
            name,
            fix=Fix(
                f"remove {written}",
                tuple(edit for tag in tags for edit in dependencies.remove_dependency(package, tag)),
                safe=sure,
            ),
            confidence=confidence,
            severity=Severity.INFO if other else None,
        )


def _message_if_carrying(package: Package, name: str, carried: dependencies.LostProvision) -> str:
    """Return the message for the unused dependency ``name``, which must not simply be removed.

    ``carried`` is a package that is used but not declared. It is available only because ``name`` depends on it.
    """
    if carried.package == package.name:
        return f"'{name}' is not used, only its dependency '{carried.name}'; declare '{carried.name}' instead"
    if carried.name == name:
        return f"'{name}' is declared here, but only '{carried.package}' uses it; declare it in '{carried.package}' instead"
    return (
        f"'{name}' is not used; only '{carried.package}' uses its dependency '{carried.name}'; "
        f"declare '{carried.name}' in '{carried.package}' instead"
    )


def _needless_tags(package: Package, workspace: Workspace, depend: Depend) -> Iterator[Depend]:
    """Yield the <build_export_depend> and <exec_depend> tags that have no purpose without the unused <build_depend>."""
    for other in package.tags(depend.name) if depend.tag == "build_depend" else ():
        tag = other.depend.tag
        to_run = tag == "exec_depend" and not dependencies.has_programs(workspace.world, depend.name)
        if (tag == "build_export_depend" or to_run) and other.always:
            yield other.depend


def _unused(package: Package, workspace: Workspace) -> Iterator[tuple[Declared, str, Confidence]]:
    """Yield the tags of dependencies that nothing in the package uses, with the reason and the confidence."""
    script = package.script
    if script is None or not dependencies.is_build_visible(package):
        return
    whole = dependencies.is_fully_visible(package)
    unsure = workspace.unread() or _lacks_programs(package, script)
    world = workspace.world
    built = [declared.name for declared in package.declared if declared.depend.tag in _TAGS and declared.always]
    used = dependencies.used_names(built, package.uses)
    libraries = dependencies.satisfying(package.uses)
    wrong = dependencies.misspelled_names(package, workspace)
    for declared in package.declared:
        depend = declared.depend
        name = depend.name
        if not declared.always or name in used or name in wrong:
            continue
        if depend.tag == "buildtool_depend":
            if whole and _is_never_found(package, script, workspace, name):
                yield declared, "the build script does not look for it", Confidence.MEDIUM
            continue
        if dependencies.name_suggests_no_trace(world, name):
            continue
        if not (whole or dependencies.is_library(world, name)):
            continue
        unknown = dependencies.is_traceless_by_name(world, name)
        mostly_run = depend.tag in _TAGS and not unknown and dependencies.is_mostly_runtime(workspace, name)
        if depend.tag in _TAGS:
            if name in package.textual_mentions or (
                name in libraries if unknown else dependencies.may_be_used_without_trace(package, workspace, name)
            ):
                continue
            if mostly_run and not dependencies.usage_is_visible(package, workspace, name):
                continue
            reason = "nothing in the package uses it"
        elif depend.tag == "test_depend" and not (_is_used(package, name) or _brings_linters(script, workspace, name)):
            if not _can_test_with(package, script, workspace, name):
                reason = f"the package has no {_kind_of_test(name)} that could use it"
            elif _is_of_interfaces(workspace, name) and name not in package.textual_mentions:
                reason = "no test uses it"
            else:
                continue
        else:
            continue
        # Headers of other packages may need a library, but it is available without the tag if a used package depends on it.
        doubted = unknown and not (
            depend.tag in _TAGS and dependencies.is_library(world, name) and name in world.closure(sorted(used))
        )
        yield declared, reason, Confidence.MEDIUM if doubted or mostly_run or unsure else Confidence.HIGH


def _lacks_programs(package: Package, script: BuildScript) -> bool:
    """Return whether the package is still a skeleton: no module of its entry points exists, or no code imports anything."""
    if script.products.entry_points:
        return not script.python.entry_point_modules
    return package.builds_with == "ament_python" and not any(use.role & ~Role.TEST for use in package.uses)


def _is_never_found(package: Package, script: BuildScript, workspace: Workspace, name: str) -> bool:
    """Return whether the released build tool ``name`` is of no use, because the build script has no find_package() for it.

    This concerns build tools of build type ament_cmake: only find_package() makes them available.
    """
    released = workspace.world.released(name)
    return (
        package.builds_with == "ament_cmake"
        and released is not None
        and released.build_type == "ament_cmake"
        and name not in _BUILD_TYPE
        and not (_is_used(package, name) or name in dependencies.names_searched(package, script))
    )


def _is_of_interfaces(workspace: Workspace, name: str) -> bool:
    """Return whether a released package has interfaces and nothing to run, so that code has to name their types."""
    released = workspace.world.released(name)
    return bool(released and released.interfaces) and not dependencies.has_programs(workspace.world, name)


def _is_used(package: Package, name: str) -> bool:
    """Return whether the package uses the dependency ``name`` at all, in tests or elsewhere."""
    return any(use.package == name for use in package.uses)


def _brings_linters(script: BuildScript, workspace: Workspace, name: str) -> bool:
    """Return whether the test dependency ``name`` provides linters that the build script runs.

    It then is a package of the workspace with linters among its exported or run-time dependencies.
    """
    handed_on = (depend for package in workspace.by_name.get(name, ()) for depend in package.declared if depend.role & _HANDED_ON)
    return not build.FINDS_TESTS.isdisjoint(script.commands.names) and any(depend.name in build.LINTERS for depend in handed_on)


def _kind_of_test(name: str) -> str:
    """Return the kind of tests that the test dependency ``name`` serves, as text for a message: "launch test" or "test"."""
    return "launch test" if name.startswith(("launch_pytest", "launch_testing")) else "test"


def _can_test_with(package: Package, script: BuildScript, workspace: Workspace, name: str) -> bool:
    """Return whether the package has tests that can use the package ``name``. An ament_python package needs Python tests."""
    if not any("test" in file.lower() for file in package.files) and not any(
        "test" in call and call not in _NO_TEST for call in script.commands.names
    ):
        return False
    released = workspace.world.released(name)
    python = bool(released and released.build_type == "ament_python") and name not in workspace.by_name
    return not python or any(file.endswith(dependencies.PYTHON_LIKE) for file in package.files)


RULE = Rule(
    name="unused-dependency",
    code="ROS204",
    summary="declared dependencies are used",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
