"""
## What it finds

- CMake targets that a `CMakeLists.txt` installs, links or gives properties to, but that are not defined.
- Sets of targets in `ament_export_targets()` to which no `install(TARGETS ... EXPORT ...)` adds a target.
- Targets `other::name` of another package of the workspace that does not export them.
- Libraries in `ament_export_libraries()` that are not built, if they have the name of the project or nearly the name of a built
  library.

One rule reports all of them, because each is a name that no command of the workspace defines, usually a typo.

## Why it matters

CMake stops with one of these messages:

- "install TARGETS given target "x" which does not exist"
- "Cannot specify link libraries for target "x" which is not built by this project"
- "Target "x" links to: other::name but the target was not found"
- "install(EXPORT) given unknown export "x""

A missing exported library affects the packages that depend on this one: they print "exports the library 'x' which couldn't be
found" and then do not link.

## How to fix it

Correct the name, or define the target before its use. If a defined target has nearly the same name, the fix writes that name.
To export a target of another package, write `install(TARGETS ... EXPORT export_other)` and `ament_export_targets(export_other)`
there.

## Limitations

Not reported:

- Scripts with commands, names or included files that cannot be evaluated. Exception: calls of `install()` before these places,
  because CMake looks for the target when `install()` is called.
- Uses under a condition.
- Uses in functions and loops, except names in `target_link_libraries()` and `ament_target_dependencies()` that can be
  evaluated.
- Exported libraries that may be libraries of the system.
- Scripts that find an unknown package, because it may define targets; `install()` and misspelled names are still reported.
- Targets of another package that generates interfaces, has `CONFIG_EXTRAS`, or may export the target in a way that cannot be
  followed.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence

from ros_lint.api import (
    ALL_FACETS,
    BuildScript,
    Call,
    Finding,
    Fix,
    Mention,
    Package,
    Related,
    Rule,
    Severity,
    Workspace,
    build,
    dependencies,
    edits,
    first_related,
    names,
)

_USERS = (
    "ament_target_dependencies",
    "target_compile_definitions",
    "target_compile_features",
    "target_compile_options",
    "target_include_directories",
    "target_link_libraries",
    "target_sources",
)
_UNDEFINED = "; correct the name, or define the target before this call"
"""The remedy for an undefined target if no target has a similar name."""
_DEFINING = ("add_custom_target", "rosidl_generate_interfaces", "ament_vendor", "add_executable", "add_library")


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    script = package.script
    if script is None or package.builds_with not in ("ament_cmake", "cmake"):
        return
    all_names = sorted({target.name for target in script.products.targets})
    rejected = {problem.subject for problem in script.problems if problem.kind == "undefined-target"}
    hidden = bool(build.opaque_except_undefined_targets(package, ALL_FACETS))
    if hidden and not rejected:
        return
    defined = set(all_names)
    for call in package.calls(*_DEFINING, anywhere=True):
        defined.update(call.texts[:1])
        defined.add((build.evaluated_name(package, call.texts[0]) if call.args else None) or "")
    wrong: dict[str, list[tuple[Call, int]]] = {}
    finds_unknown = _finds_unknown(package, workspace)
    for call in package.calls(*_USERS, "install"):
        for index in build.installed_targets(call) if call.name == "install" else range(len(call.args[:1])):
            name = build.evaluated_name(package, call.texts[index])
            if name is None or call.blocks or name in defined or "::" in name:
                continue
            if hidden:
                is_wrong = call.name == "install" and name in rejected
            else:
                is_wrong = call.name == "install" or not finds_unknown or bool(names.similar_names(name, all_names, 1, 0.8))
            if is_wrong:
                wrong.setdefault(name, []).append((call, index))
    for name, places in wrong.items():
        yield _finding(f"{places[0][0].name}() fails because '{name}' is not a target", name, all_names, places, _UNDEFINED)
    if hidden:
        return
    for problem in script.cmake.errors:  # these include computed names
        name = problem.subject
        if problem.kind == "undefined-target" and name not in defined and name not in wrong:
            near = names.similar_names(name, all_names, 1, 0.8)
            if near or not finds_unknown or workspace.world.is_package(name):  # targets do not have the plain name of a package
                yield Finding(problem.message + (names.ask_if_meant(near) or _UNDEFINED), problem.span, name)
    yield from _unfilled(package)
    yield from _of_others(package, script, workspace)
    yield from _no_libraries(package, defined)


def _finds_unknown(package: Package, workspace: Workspace) -> bool:
    """Return whether the script finds an unknown package, which may define targets."""
    written = {call.texts[0] for call in package.calls("find_package", anywhere=True) if call.args}
    all_names = {name for name in written if "$" not in name}
    all_names.update(mention.name for mention in package.built.mentions if mention.via == "cmake")
    return not all(workspace.world.by_cmake(name.partition("/")[0]).known for name in all_names)


def _unfilled(package: Package) -> Iterator[Finding]:
    """Yield findings for arguments of ament_export_targets() to which no ``install(TARGETS ... EXPORT ...)`` adds a target."""
    filled = list(dict.fromkeys([exported.export_set for exported in package.built.exports.targets]))
    for call in package.calls("ament_export_targets", "ament_export_interfaces"):
        for index, text in enumerate(call.texts):
            name = build.evaluated_name(package, text)
            if text == "NAMESPACE":
                break
            if text == "HAS_LIBRARY_TARGET" or name is None or call.blocks or "__rosidl" in name or name in filled:
                continue
            message = f"{call.name}() exports '{name}', but no install(TARGETS ... EXPORT {name}) adds a target to it"
            yield _finding(message, name, filled, [(call, index)], "; add it there, or correct the name")


def _of_others(package: Package, script: BuildScript, workspace: Workspace) -> Iterator[Finding]:
    """Yield findings for targets of other packages of the workspace that these packages do not export."""
    found = dependencies.names_searched(package, script)
    wrong: dict[str, list[Mention]] = {}
    for mention in script.mentions:
        owner, colons, target = mention.name.partition("::")
        if mention.via == "target" and colons and not mention.optional and owner in found and owner != package.name:
            others = workspace.by_name.get(owner, ())
            if others and not any(_may_export(other, target) for other in others):
                wrong.setdefault(owner, []).append(mention)
    for owner, mentions in wrong.items():
        all_names = list(dict.fromkeys(mention.name.partition("::")[2] for mention in mentions))
        exported = sorted({target.target for other in workspace.by_name[owner] for target in other.built.exports.targets})
        near = names.similar_names(all_names[0], exported, 3, 0.6) if len(all_names) == 1 else []
        hint = (
            names.did_you_mean(near)
            if near
            else f"; it exports {names.shorten_list(exported)}"
            if exported
            else "; it exports no targets: use install(TARGETS ... EXPORT) and ament_export_targets() there"
        )
        first, *more = mentions
        related = [
            *first_related(Related(f"'{mention.name}' is also linked here", mention.span) for mention in more),
            *_definitions(workspace.by_name[owner], all_names),
        ]
        targets = "a target" if len(all_names) == 1 else "targets"
        message = f"'{owner}' does not export {targets} {names.shorten_list(all_names)}{hint}"
        yield Finding(message, first.span, f"{owner}::{all_names[0]}", tuple(related))


def _may_export(package: Package, target: str) -> bool:
    script = package.script
    if (
        script is None
        or package.builds_with != "ament_cmake"
        or script.products.interfaces
        or build.opaque_except_undefined_targets(package, ALL_FACETS)
    ):
        return True
    if build.has_extras(package):
        return True
    return any(exported.target == target for exported in package.built.exports.targets) or _may_rename_targets(package)


def _may_rename_targets(package: Package) -> bool:
    """Return whether targets may be exported under names that they do not have in the package.

    The result is also True if the package installs its own CMake configuration file.
    """
    calls = package.calls("ament_export_targets", "install", "export", "set_target_properties", "set_property", anywhere=True)
    if any("NAMESPACE" in call.texts or "EXPORT_NAME" in call.texts for call in calls):
        return True
    all_names = build.config_names(package.name)
    return any(file.source and file.path.rpartition("/")[2] in all_names for file in package.built.products.installs)


def _definitions(owners: Sequence[Package], all_names: Collection[str]) -> Iterator[Related]:
    """Yield the places where the packages ``owners`` define targets with the names ``all_names`` without exporting them."""
    for owner in owners:
        for target in owner.built.products.targets:
            if target.name in all_names:
                yield Related(f"'{target.name}' is defined here, but not exported", target.span)


def _no_libraries(package: Package, defined: Collection[str]) -> Iterator[Finding]:
    """Yield findings for exported libraries that are not built, if the name is that of the project or resembles a built library.

    Libraries with other names may be libraries of the system. ``defined``: names of all targets of the package.
    """
    libraries = sorted(target.name for target in package.built.products.targets if target.kind == "library")
    for call in package.calls("ament_export_libraries"):
        for index, text in enumerate(call.texts):
            name = build.evaluated_name(package, text)
            if name is None or call.blocks or name in defined:
                continue
            if name == build.evaluated_name(package, "${PROJECT_NAME}") or names.similar_names(name, libraries, 1, 0.9):
                message = f"ament_export_libraries() exports '{name}', which is not a library of this package"
                remedy = "; write the name of a library that the package builds, or remove this name"
                yield _finding(message, name, libraries, [(call, index)], remedy)._replace(severity=Severity.WARNING)


def _finding(message: str, name: str, all_names: Sequence[str], places: list[tuple[Call, int]], otherwise: str = "") -> Finding:
    """Return the finding for an undefined name. It suggests a similar name of ``all_names``, or else ends with ``otherwise``.

    ``places``: the calls with the undefined name, each with the index of the argument.
    """
    near = names.similar_names(name, all_names, 1, 0.8)
    message += names.ask_if_meant(near) if near else otherwise
    fix = None
    if near and all(call.texts[index] == name for call, index in places):
        fix = Fix(f"write '{near[0]}'", tuple(edits.cmake.write(call, index, near[0]) for call, index in places), safe=False)
    first, *others = [call.span(index) for call, index in places]
    return Finding(message, first, name, first_related(Related(f"'{name}' is also used here", span) for span in others), fix)


RULE = Rule(
    name="undefined-target",
    code="ROS305",
    summary="used CMake targets are defined",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
