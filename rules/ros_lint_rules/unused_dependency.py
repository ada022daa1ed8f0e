"""
## What it finds

A `<depend>` or `<build_depend>` on a ROS package that nothing in the package uses: no include, no import, no
`find_package`, no interface, no launch file, and its name stands in no other file. And a `<test_depend>` in a package
without any test that could use it, if nothing else does, such as `find_package` or a launch file. And a
`<member_of_group>rosidl_interface_packages</member_of_group>` in a package that has and generates no interfaces.

## Why it matters

Every dependency is installed and built before this package, and rebuilds it when it changes. A leftover costs time on
every machine, and tells readers something wrong. What depends on the group of all packages with interfaces, such as
`ros1_bridge`, waits for each member.

## How to fix it

Remove the tag, and with a `<build_depend>` those for exporting it and for running what has no programs. The fix does this,
and needs `--unsafe-fixes` where the confidence is less than high.

## Limitations

Where a type of it stands in C++ code by its bare name, which a header of a third package makes possible, and where a page
of the package says to start something of it (`ros2 run`, `ros2 launch`). And
whenever the dependency might be needed in a way that leaves no trace: linters, run-time and tool dependencies, tags
under a condition that not every environment of ROS 2 meets, packages whose build scripts cannot be followed everywhere,
metapackages, vendor packages and packages without code, and dependencies that give CMake macros or plugins. For rosdep keys of
libraries, which others' headers may need, unless they come along with a package that is used, for packages that nobody knows,
for Python packages that are mostly declared to be run, and such as have messages and programs, where a file of the workspace
cannot be read, and where no module is there that an entry point names, or none that imports anything, the confidence is medium.

So it is where nothing uses the dependency, but something else that is used and not declared comes along with it alone, in
this package or in another one of the workspace. That is to be declared instead, and nothing is removed.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import (
    FINDS_TESTS,
    INTERFACES,
    LINTERS,
    PYTHON_LIKE,
    BuildScript,
    Carried,
    Confidence,
    Declared,
    Depend,
    Facet,
    Finding,
    Fix,
    Package,
    Role,
    Rule,
    Severity,
    Workspace,
    called,
    carriers,
    conditions,
    interface_names,
    is_built_in_sight,
    is_library,
    is_mostly_run,
    is_seen_whole,
    is_unseen_by_name,
    leaves_trace,
    misspelt,
    remove_dependency,
    runs,
    satisfying,
    sounds_unseen,
    used_names,
    works_unseen,
)

_TAGS = ("depend", "build_depend")
_HANDED_ON = Role.EXEC | Role.EXPORT
_NO_TEST = FINDS_TESTS | {"enable_testing"}


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    yield from _no_member(package)
    found = list(_unused(package, workspace))
    carried = carriers(package, workspace, [declared for declared, _, _ in found]) if found else {}
    for declared, says, confidence in found:
        depend = declared.depend
        name, sure = depend.name, confidence is Confidence.HIGH
        if name in carried:
            told = _told(package, name, carried[name])
            yield Finding(told, depend.span, name, confidence=min(confidence, Confidence.MEDIUM))
            continue
        idle = [depend, *(_left(package, workspace, depend) if sure else ())]
        its = " and ".join(f"<{each.tag}>" for each in idle[1:])
        written = f"<{depend.tag}>{name}</{depend.tag}>" + (f" and its {its}" if its else "")
        yield Finding(
            f"{name} is declared, but {says}: remove {written}",
            depend.span,
            name,
            fix=Fix(f"remove {written}", tuple(edit for each in idle for edit in remove_dependency(package, each)), safe=sure),
            confidence=confidence,
        )


def _no_member(package: Package) -> Iterator[Finding]:
    """Speak of the group of packages with interfaces, in one that has none."""
    manifest, script = package.manifest, package.script
    if manifest is None or script is None or script.problems or interface_names.GROUP not in package.groups:
        return
    if package.builds_with not in ("ament_cmake", "ament_python") or script.hides(Facet.INTERFACES | Facet.USES):
        return
    generated = script.interfaces or any(True for _ in called(package, "rosidl_generate_interfaces", anywhere=True))
    if generated or any(file.endswith(INTERFACES) for file in package.files):
        return
    for depend in manifest.depends:
        if depend.tag == "member_of_group" and depend.name == interface_names.GROUP and conditions.always(depend.condition):
            written = f"<{depend.tag}>{interface_names.GROUP}</{depend.tag}>"
            fix = Fix(f"remove {written}", tuple(remove_dependency(package, depend)))
            yield Finding(
                f"{package.name} generates no interfaces: remove {written}", depend.span, interface_names.GROUP, fix=fix
            )


def _told(package: Package, name: str, carried: Carried) -> str:
    if carried.package == package.name:
        return f"{name} is declared in place of {carried.name}: declare that instead"
    if carried.name == name:
        return f"{name} is declared, but only {carried.package} uses it: declare it there instead"
    return f"{name} is declared, but only brings {carried.name} to {carried.package}: declare that there instead"


def _left(package: Package, workspace: Workspace, depend: Depend) -> Iterator[Depend]:
    """Yield the other tags of what nothing is built with: for those that build against the package, and to run no programs."""
    for other in package.tags(depend.name) if depend.tag == "build_depend" else ():
        tag = other.depend.tag
        to_run = tag == "exec_depend" and not runs(workspace.world, depend.name)
        if (tag == "build_export_depend" or to_run) and other.always:
            yield other.depend


def _unused(package: Package, workspace: Workspace) -> Iterator[tuple[Declared, str, Confidence]]:
    """Yield the tags of dependencies that nothing in the package uses, with what to say and how sure it is."""
    script = package.script
    if script is None or not is_built_in_sight(package):
        return
    whole = is_seen_whole(package)
    unsure = workspace.unread() or _lacks_programs(package, script)
    world = workspace.world
    built = [each.name for each in package.declared if each.depend.tag in _TAGS and each.always]
    used = used_names(built, package.uses)
    libraries = satisfying(package.uses)
    wrong = misspelt(package, workspace)
    for declared in package.declared:
        depend = declared.depend
        name = depend.name
        if not declared.always or name in used or name in wrong or sounds_unseen(world, name):
            continue
        if not (whole or is_library(world, name)):
            continue
        unknown = is_unseen_by_name(world, name)
        mostly_run = depend.tag in _TAGS and not unknown and is_mostly_run(workspace, name)
        if depend.tag in _TAGS:
            if name in package.traces or (name in libraries if unknown else works_unseen(package, workspace, name)):
                continue
            if mostly_run and not leaves_trace(package, workspace, name):
                continue
            says = "nothing in the package uses it"
        elif depend.tag == "test_depend" and not (
            _is_used(package, name)
            or _brings_linters(script, workspace, name)
            or _can_test_with(package, script, workspace, name)
        ):
            says = "there is no test that could use it"
        else:
            continue
        # What headers of others need of a library is there without the tag, if it comes along with what they are from.
        doubted = unknown and not (depend.tag in _TAGS and is_library(world, name) and name in world.closure(sorted(used)))
        yield declared, says, Confidence.MEDIUM if doubted or mostly_run or unsure else Confidence.HIGH


def _lacks_programs(package: Package, script: BuildScript) -> bool:
    """Whether the code that uses what is declared is elsewhere yet: no module is there that an entry point names, or none."""
    if script.entry_points:
        return not script.modules
    return package.builds_with == "ament_python" and not any(use.role & ~Role.TEST for use in package.uses)


def _is_used(package: Package, name: str) -> bool:
    """Whether a package is used, test or no test: CMake stops without it, and to a launch file it is declared wrongly."""
    return any(use.package == name for use in package.uses)


def _brings_linters(script: BuildScript, workspace: Workspace, name: str) -> bool:
    """Whether a package of the workspace is found for the linters that it brings, whatever it is called."""
    brought = (each for package in workspace.by_name.get(name, ()) for each in package.declared if each.role & _HANDED_ON)
    return not FINDS_TESTS.isdisjoint(script.calls) and any(each.name in LINTERS for each in brought)


def _can_test_with(package: Package, script: BuildScript, workspace: Workspace, name: str) -> bool:
    """Whether a package has tests, and such as can use another one: modules are used by Python, and by nothing else."""
    if not any("test" in file.lower() for file in package.files) and not any(
        "test" in call and call not in _NO_TEST for call in script.calls
    ):
        return False
    released = workspace.world.released(name)
    python = bool(released and released.build_type == "ament_python") and name not in workspace.by_name
    return not python or any(file.endswith(PYTHON_LIKE) for file in package.files)


RULE = Rule(
    name="unused-dependency",
    code="ROS204",
    summary="a package that is declared must be used",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
