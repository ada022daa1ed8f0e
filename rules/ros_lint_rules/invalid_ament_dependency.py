"""
## What it finds

Arguments of `ament_target_dependencies()` and `ament_export_dependencies()` that are not packages:

- a target of this package or of another one;
- a typo of a found package, or two package names without a blank between them;
- an exported name that is otherwise unknown, with medium confidence.

Also reported: this package itself as an argument of `ament_target_dependencies()` or of `find_package()`, because CMake cannot
find a package before it is installed.

## Why it matters

CMake stops because the package was not found. A wrong export makes `find_package()` of this package fail in other packages.

## How to fix it

Correct the name: the fix corrects typos of found packages. Link targets with `target_link_libraries()`, and export them with
`ament_export_targets()`.

## Limitations

Not reported:

- Scripts that cannot be fully analysed.
- Names that are neither a known ROS package nor a target and resemble no found package.
- Names that differ from a found package only in upper and lower case.
- Exported names that are declared or that a module of the package finds.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from ros_lint.api import (
    Call,
    Confidence,
    Facet,
    Finding,
    Fix,
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


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    script = package.script
    if script is None or package.builds_with != "ament_cmake":
        return
    wrong = (problem for problem in script.cmake.errors if problem.kind == "no-package")
    yield from (Finding(problem.message, problem.span, problem.subject) for problem in wrong)
    if not (build.stops_early(script) or script.hides(Facet.USES)):
        yield from _no_packages(package, dependencies.names_searched(package, script), workspace)


def _no_packages(package: Package, found: frozenset[str], workspace: Workspace) -> Iterator[Finding]:
    """Yield findings for arguments that are not packages: targets, misspelt names of found packages, unknown exported names.

    ``found``: the packages that CMake finds. An exported package needs no find_package() if the manifest declares it or a find
    module exists. Names that are misspelt in the manifest are left out, because another rule reports the manifest.
    """
    script = package.script
    assert script is not None
    world = workspace.world
    targets = {target.name for target in script.products.targets}
    spelt = {name.lower() for name in found}.union(
        name.lower() for name in dependencies.misspelled_names(package, workspace).values()
    )
    for call in package.calls(*_TARGET_COMMANDS, anywhere=True):
        if _REPEATED.intersection(call.blocks):
            continue
        arguments = {name: index for index, name in enumerate(call.texts) if index or call.name == _EXPORTS}
        unknown = {name: at for name, at in arguments.items() if name.lower() not in spelt and not world.is_package(name)}
        if call.name == _EXPORTS:
            unknown = {name: at for name, at in unknown.items() if not _is_findable(package, name, workspace)}
        yield from _targets(call, {name: index for name, index in unknown.items() if name in targets})
        for name, index in unknown.items():
            if name not in targets and (all_names := _suggested(name, found)):
                hint = (
                    f"; did you mean '{all_names[0]}' and '{all_names[1]}'?"
                    if len(all_names) > 1
                    else names.ask_if_meant(all_names)
                )
                yield Finding(
                    f"{call.name}() expects packages, but there is no find_package({name}){hint}",
                    call.span(index),
                    name,
                    fix=Fix.of(f"write '{' '.join(all_names)}'", edits.cmake.write(call, index, " ".join(all_names)), safe=False),
                )
            elif name not in targets and call.name == _EXPORTS and _is_plain(name):
                yield Finding(
                    f"'{name}' is exported, but it is neither found here nor a known package, so find_package({package.name}) "
                    "fails in other packages; correct or remove the name",
                    call.span(index),
                    name,
                    confidence=Confidence.MEDIUM,
                )


def _is_findable(package: Package, name: str, workspace: Workspace) -> bool:
    """Return whether ``find_package(name)`` may succeed, because a declared or known package or a file may provide ``name``.

    The result is True as well for a name with ``::``, because another rule reports it.
    """
    if "::" in name:
        return True  # reported when the command is evaluated
    world = workspace.world
    modules = (f"Find{name}.cmake", *build.config_names(name))
    if package.declares(name) or any(file.endswith(modules) for file in package.files):
        return True
    return world.resolution(name) != "unknown" or world.by_cmake(name).known


def _is_plain(name: str) -> bool:
    """Return whether an argument is an identifier in which dashes are allowed; false for ${variables} and a::b."""
    return bool(name) and name.replace("-", "_").isidentifier()


def _suggested(name: str, found: frozenset[str]) -> tuple[str, ...]:
    """Return the packages that an unknown argument may mean, among the packages that CMake finds (``found``).

    Either two names without a blank between them (``rclcppstd_msgs``), or one similar name.
    """
    for end in range(1, len(name)):
        if name[:end] in found and name[end:] in found:
            return name[:end], name[end:]
    return tuple(names.similar_names(name, sorted(found), 1, 0.9))


def _targets(call: Call, all_names: Mapping[str, int]) -> Iterator[Finding]:
    """Yield one finding for all arguments of a call that are targets of this package."""
    if all_names:
        (name, at), *others = all_names.items()
        are, it = ("are targets", "them") if others else ("is a target", "it")
        verb = "export" if call.name == _EXPORTS else "link"
        yield Finding(
            f"{call.name}() expects packages, but {names.shorten_list(all_names)} {are} of this package; {verb} {it} with "
            f"{_TARGET_COMMANDS[call.name]}()",
            call.span(at),
            name,
            first_related(Related(f"'{other}' is a target, too", call.span(index)) for other, index in others),
        )


_EXPORTS = "ament_export_dependencies"
_TARGET_COMMANDS = {"ament_target_dependencies": "target_link_libraries", _EXPORTS: "ament_export_targets"}
"""Commands that link or export packages, each with the command that links or exports targets."""
_REPEATED = frozenset({"foreach", "while", "function", "macro"})
"""Kinds of CMake blocks that may run several times, so that an argument in them may have several values."""


RULE = Rule(
    name="invalid-ament-dependency",
    code="ROS211",
    summary="the arguments of ament_target_dependencies() and ament_export_dependencies() are packages",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
