"""
## What it finds

A package that generates messages, services or actions and does not say all that this needs: it is no member of the
group `rosidl_interface_packages`, it does not declare `rosidl_default_runtime`, or an interface has a field of another
package that `rosidl_generate_interfaces()` does not list under `DEPENDENCIES`.

## Why it matters

Without the group, CMake stops. Without the run-time package the generated code cannot be loaded where nothing else
brings it. Without the dependency the generated code does not compile.

## How to fix it

Add what the message names. The fix does this for package.xml.

## Limitations

- The interfaces are not installed, so that nobody but the package itself uses them.
- The script cannot be followed everywhere.
- The other package comes along with one that is listed.
- The run-time package comes along with another declared dependency, or may do so, or all that it brings does: then nothing
  fails, the severity is info and the confidence medium.
- The script names the run-time package, too, as in `ament_export_dependencies(rosidl_default_runtime)`: then
  `undeclared-dependency` tells of it, once.

Where a folder of the package has a manifest of its own beside its CMakeLists.txt, CMake reads that one.
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
    add_dependency,
    called,
    come_along,
    folders_of,
    given_for,
    interface_names,
    manifest_edits,
    naming,
    relative,
    undeclared,
)

_RUNTIME = "rosidl_default_runtime"
_CORE = "rosidl_core_runtime"
"""What the messages have that the default runtime itself depends on."""
_GENERATE = "rosidl_generate_interfaces"


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    script, manifest = package.script, package.manifest
    if script is None or manifest is None or manifest.problems or _GENERATE not in script.calls:
        return
    place = next((m for m in script.mentions if m.via == "macro" and m.purpose == "interfaces"), None)
    if place is None or not script.interfaces or not _is_installed(package):
        return
    sure = Confidence.MEDIUM if place.optional or place.test else Confidence.HIGH
    inside = folders_of(relative(package, place.span.path))
    if not any(f"{folder}/package.xml" in package.files for folder in inside):  # else CMake reads that one
        if interface_names.GROUP not in package.groups and not _skips_check(package, place.span):
            yield Finding(
                f"{_GENERATE}() stops here unless package.xml says <member_of_group>{interface_names.GROUP}</member_of_group>",
                place.span,
                interface_names.GROUP,
                (),
                Fix(f"join the group {interface_names.GROUP}", _join(manifest)),
                sure,
            )
        yield from _runtime(package, workspace, place.span, sure)
    if not package.hidden(Facet.USES):
        yield from _fields(package, workspace, place.span, sure)


def _skips_check(package: Package, place: Span) -> bool:
    calls = called(package, _GENERATE, anywhere=True)
    return any(call.place == place and "SKIP_GROUP_MEMBERSHIP_CHECK" in call.texts for call in calls)


def _is_installed(package: Package) -> bool:
    assert package.script is not None
    kinds = tuple(f"share/{package.name}/{kind}/" for kind in ("msg", "srv", "action"))
    return any(provided.path.startswith(kinds) for provided in package.script.provides)


def _join(manifest: Manifest) -> tuple[Edit, ...]:
    edits = (manifest_edits.add(manifest, "member_of_group", interface_names.GROUP),)
    return edits if manifest.format >= 3 else (manifest_edits.raise_format(manifest, 3), *edits)


def _runtime(package: Package, workspace: Workspace, place: Span, sure: Confidence) -> Iterator[Finding]:
    starts = [each.name for each in package.declared if each.role & (Role.EXEC | Role.EXPORT)]
    told = {need.name for need, certain in undeclared(package, workspace) if certain}
    if not {_RUNTIME, _CORE}.isdisjoint(starts) or _RUNTIME in told:
        return
    closure = workspace.world.closure(starts)
    needed = workspace.world.closure([_RUNTIME])
    all_else = len(needed) > 1 and set(needed.less(closure)) == {_RUNTIME}
    along = _RUNTIME in closure or bool(closure.unknown) or all_else
    tag = "run_depend" if package.manifest and package.manifest.format == 1 else "exec_depend"
    yield Finding(
        f"what is generated here needs {_RUNTIME} at run time: add <{tag}>{_RUNTIME}</{tag}>",
        place,
        _RUNTIME,
        (),
        naming(workspace, _RUNTIME, f"declare {_RUNTIME} as <{tag}>", *add_dependency(package, tag, _RUNTIME)),
        Confidence.MEDIUM if along else sure,
        Severity.INFO if along else None,
    )


def _fields(package: Package, workspace: Workspace, place: Span, sure: Confidence) -> Iterator[Finding]:
    script = package.script
    assert script is not None
    listed = frozenset(mention.name for mention in given_for(script, "interfaces"))
    along = come_along(workspace, listed)
    if along is None:
        return
    said = set()
    for use in package.uses:
        if use.via != "interface" or use.package in along | interface_names.UNDERLYING or use.package in said or not use.sure:
            continue
        if not use.span.path.endswith((".msg", ".srv", ".action")):
            continue
        said.add(use.package)
        yield Finding(
            f"{use.package} is used here, but {_GENERATE}() is not told: add it to DEPENDENCIES",
            use.span,
            use.package,
            (),
            None,
            sure,
        )


RULE = Rule(
    name="missing-interface-runtime",
    code="ROS208",
    summary="a package that generates interfaces must say all that they need",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
