"""
## What it finds

Components whose name differs between CMake and the sources:

- CMake registers a class, but no source has `RCLCPP_COMPONENTS_REGISTER_NODE` for this name.
- A source has the macro, but CMake does not register the class.

One rule reports both cases, because a misspelt name causes both.

## Why it matters

`ros2 component load` and `ComposableNode` look up the exact name, first in the ament index, then in the library. They fail with
"Could not find requested resource in ament index" or "Failed to find class with the requested plugin name". The executable that
`rclcpp_components_register_node(... EXECUTABLE x)` builds fails in the same way.

## How to fix it

Write the same name, with its namespaces, in both places.

## Limitations

Not reported:

- Packages whose components cannot be fully analysed.
- Components of tests.
- Registered classes without the macro, if no source of the package has the macro or includes its header.

If a package registers no component at all, it may compose its nodes itself: the confidence is medium unless a launch file of
the workspace loads the component.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import (
    Component,
    Confidence,
    Edit,
    Facet,
    Finding,
    Fix,
    Package,
    Registration,
    Related,
    Rule,
    Severity,
    Workspace,
    build,
    dependencies,
    edits,
    files,
    first_related,
    names,
)


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    script = package.script
    if script is None or package.builds_with != "ament_cmake" or package.hidden(Facet.COMPONENTS):
        return
    macros = [macro for macro in package.registrations if macro.kind == "component"]
    macros = [macro for macro in macros if not files.is_auxiliary(package.relative(macro.span.path))]
    all_names = {macro.name for macro in macros}
    registered = {component.name.removeprefix("::") for component in script.products.components}
    unregistered = [macro for macro in macros if macro.name not in registered]
    lacking = [component for component in script.products.components if component.name.removeprefix("::") not in all_names]
    if not macros and not _forgets_macro(package):
        lacking = []  # a macro of another package may expand to RCLCPP_COMPONENTS_REGISTER_NODE
    # One component without a macro and one compiled macro without a component belong together, whatever their names.
    only = unregistered if len(lacking) == len(unregistered) == 1 and build.library_registering(package, unregistered[0]) else []
    for component in lacking:
        alike = only or _alike(component, unregistered)
        unregistered = [macro for macro in unregistered if macro not in alike]
        yield _without_macro(component, alike)
    for macro in unregistered:
        yield _unregistered(package, macro, loaded=macro.name in workspace.loaded.get(package.name, ()))


def _forgets_macro(package: Package) -> bool:
    """Return whether a source includes register_node_macro.hpp, but no source calls RCLCPP_COMPONENTS_REGISTER_NODE().

    Sources of tests count, too.
    """
    included = any(use.via == "include" and "register_node_macro" in use.what for use in package.uses)
    return included and all(macro.kind != "component" for macro in package.registrations)


def _alike(component: Component, macros: list[Registration]) -> list[Registration]:
    """Return the calls of RCLCPP_COMPONENTS_REGISTER_NODE() that may register a component under another name.

    These are all calls with the class name of the component in another namespace, else the call with the most similar class
    name, else [].
    """
    last = component.name.rpartition("::")[2]
    alike = [macro for macro in macros if macro.name.rpartition("::")[2] == last]
    if alike:
        return alike
    plain = {_plain(macro.name.rpartition("::")[2]): macro for macro in macros}
    near = names.similar_names(_plain(last), plain, 1, 0.8)
    return [plain[near[0]]] if near else []


def _plain(name: str) -> str:
    return name.lower().replace("_", "")


def _without_macro(component: Component, alike: list[Registration]) -> Finding:
    hint = (
        names.did_you_mean([alike[0].name]) if alike else f"; add RCLCPP_COMPONENTS_REGISTER_NODE({component.name}) to a source"
    )
    place = component.span.inner(component.name) if len(alike) == 1 else None
    fix = Fix(f"write '{alike[0].name}'", (Edit(place, alike[0].name),)) if place else None
    related = first_related(Related(f"a source registers '{macro.name}' here", macro.span) for macro in alike)
    subject = alike[0].name if alike else component.name
    return Finding(f"no source registers the component '{component.name}'{hint}", component.span, subject, related, fix)


def _unregistered(package: Package, macro: Registration, *, loaded: bool) -> Finding:
    script = package.script
    assert script is not None
    library = build.library_registering(package, macro)
    command = f'rclcpp_components_register_nodes({library or "<library>"} "{macro.name}")'
    usable = library and "rclcpp_components" in dependencies.names_searched(package, script)
    fix = Fix.of(f"register '{macro.name}'", edits.cmake.at_end(script, command), safe=False) if usable else None
    return Finding(
        f"CMakeLists.txt does not register the component '{macro.name}', so it cannot be loaded; add {command}",
        macro.span,
        macro.name,
        fix=fix,
        confidence=Confidence.HIGH if library and (script.products.components or loaded) else Confidence.MEDIUM,
        severity=Severity.WARNING,
    )


RULE = Rule(
    name="component-mismatch",
    code="ROS413",
    summary="components have the same name in CMake and in the sources",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
