"""
## What it finds

A package that generates messages, services or actions but lacks one of these:

- the group `rosidl_interface_packages` in `package.xml`;
- the dependency `rosidl_default_runtime` in `package.xml`;
- a package under `DEPENDENCIES` of `rosidl_generate_interfaces()`, if an interface has a field of that package.

## Why it matters

Without the group, CMake stops. Without the run-time package, the generated code cannot be loaded unless another package provides
it. Without the dependency, the generated code does not compile.

## How to fix it

Add what the message names. The fix changes `package.xml`.

## Limitations

Not reported:

- Interfaces that are not installed, because only the package itself uses them.
- Missing `DEPENDENCIES` in scripts that cannot be fully analysed.
- Field packages that a listed package provides transitively.
- The run-time package, if the script names it, as in `ament_export_dependencies(rosidl_default_runtime)`: `undeclared-dependency`
  reports it.
- The group and the run-time package, if the CMakeLists.txt is in a subfolder with its own `package.xml`: CMake reads that one.

If another declared dependency provides the run-time package, may do so, or provides all its dependencies, nothing fails: the
severity is info and the confidence medium.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import (
    Confidence,
    Edit,
    Facet,
    Finding,
    Fix,
    Manifest,
    Package,
    Role,
    Rule,
    Severity,
    Span,
    Workspace,
    dependencies,
    edits,
    files,
    names,
)

_RUNTIME = "rosidl_default_runtime"
_CORE = "rosidl_core_runtime"
"""Declared by the interface packages that rosidl_default_runtime itself depends on."""
_GENERATE = "rosidl_generate_interfaces"


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    script, manifest = package.script, package.manifest
    if script is None or manifest is None or manifest.problems or _GENERATE not in script.commands.names:
        return
    place = next((m for m in script.mentions if m.via == "macro" and m.purpose == "interfaces"), None)
    if place is None or not script.products.interfaces or not _is_installed(package):
        return
    sure = Confidence.MEDIUM if place.optional or place.test else Confidence.HIGH
    inside = files.folders_of(package.relative(place.span.path))
    if not any(f"{folder}/package.xml" in package.files for folder in inside):  # CMake would read that one
        if names.interfaces.GROUP not in package.groups and not _skips_check(package, place.span):
            yield Finding(
                f"{_GENERATE}() fails without <member_of_group>{names.interfaces.GROUP}</member_of_group> in package.xml",
                place.span,
                names.interfaces.GROUP,
                (),
                Fix(f"join the group '{names.interfaces.GROUP}'", _join(manifest)),
                sure,
            )
        yield from _runtime(package, workspace, place.span, sure)
    if not package.hidden(Facet.USES):
        yield from _fields(package, workspace, place.span, sure)


def _skips_check(package: Package, place: Span) -> bool:
    calls = package.calls(_GENERATE, anywhere=True)
    return any(call.name_span == place and "SKIP_GROUP_MEMBERSHIP_CHECK" in call.texts for call in calls)


def _is_installed(package: Package) -> bool:
    assert package.script is not None
    kinds = tuple(f"share/{package.name}/{kind}/" for kind in ("msg", "srv", "action"))
    return any(provided.path.startswith(kinds) for provided in package.script.products.installs)


def _join(manifest: Manifest) -> tuple[Edit, ...]:
    changes = (edits.manifest.add(manifest, "member_of_group", names.interfaces.GROUP),)
    return changes if manifest.format >= 3 else (edits.manifest.raise_format(manifest, 3), *changes)


def _runtime(package: Package, workspace: Workspace, place: Span, sure: Confidence) -> Iterator[Finding]:
    starts = [declared.name for declared in package.declared if declared.role & (Role.EXEC | Role.EXPORT)]
    reported = {need.name for need, certain in dependencies.undeclared(package, workspace) if certain}
    if not {_RUNTIME, _CORE}.isdisjoint(starts) or _RUNTIME in reported:
        return
    closure = workspace.world.closure(starts)
    needed = workspace.world.closure([_RUNTIME])
    only_itself = len(needed) > 1 and set(needed.difference(closure)) == {_RUNTIME}
    provided = _RUNTIME in closure or bool(closure.unknown) or only_itself
    tag = "run_depend" if package.manifest and package.manifest.format == 1 else "exec_depend"
    yield Finding(
        f"the generated interfaces need '{_RUNTIME}' at run time; add <{tag}>{_RUNTIME}</{tag}>",
        place,
        _RUNTIME,
        (),
        dependencies.naming_fix(
            workspace, _RUNTIME, f"declare '{_RUNTIME}' as <{tag}>", *dependencies.add_dependency(package, tag, _RUNTIME)
        ),
        Confidence.MEDIUM if provided else sure,
        Severity.INFO if provided else None,
    )


def _fields(package: Package, workspace: Workspace, place: Span, sure: Confidence) -> Iterator[Finding]:
    script = package.script
    assert script is not None
    listed = frozenset(mention.name for mention in dependencies.macro_packages(script, "interfaces"))
    along = dependencies.find_package_closure(workspace, listed)
    if along is None:
        return
    reported = set()
    for use in package.uses:
        if (
            use.via != "interface"
            or use.package in along | names.interfaces.UNDERLYING
            or use.package in reported
            or not use.certain
        ):
            continue
        if not use.span.path.endswith((".msg", ".srv", ".action")):
            continue
        reported.add(use.package)
        yield Finding(
            f"'{use.package}' is used here, but {_GENERATE}() does not list it; add it to DEPENDENCIES",
            use.span,
            use.package,
            (),
            None,
            sure,
        )


RULE = Rule(
    name="missing-interface-runtime",
    code="ROS208",
    summary="packages with interfaces declare all dependencies of the interfaces",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
