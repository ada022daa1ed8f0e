"""
## What it finds

Components that cannot be loaded:

- CMake registers a class, but no source has `RCLCPP_COMPONENTS_REGISTER_NODE` for this name.
- A source has the macro, but CMake does not register the class.
- CMake registers the class in a function or in the `CMakeLists.txt` of a subfolder.
- The library of a component is not installed, or not installed to `lib`.
- `rclcpp_components_register_nodes(library PLUGIN "robot::Talker" EXECUTABLE talker)`: this command takes only class names, so
  `PLUGIN`, `EXECUTABLE` and `talker` become components, and no executable is built.

## Why it matters

`ros2 component load` and `ComposableNode` look up the exact name, first in the ament index, then in the library. They fail with
"Could not find requested resource in ament index" or "Failed to find class with the requested plugin name". So does the
executable that `rclcpp_components_register_node(... EXECUTABLE x)` builds. The registration is a CMake variable, which
`ament_package()` writes to the index: a variable set in a function or subfolder is lost at its end.

## How to fix it

- Write the same name, with its namespaces, in both places.
- Remove the words that belong to `rclcpp_components_register_node()`, or call that command. Its `EXECUTABLE` must not have the
  name of the library.
- Install the library to `lib`.
- Register components in the `CMakeLists.txt` of the package, or in a macro instead of a function.

## Limitations

Not reported:

- Packages whose components or libraries cannot be fully analysed.
- Components of tests.
- Registered classes without the macro, if no source of the package has the macro or includes its header.

If a package registers no component at all, it may compose its nodes itself: the confidence is medium unless a launch file of
the workspace loads the component.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from ros_lint.api import (
    BuildScript,
    Call,
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
    calls = package.calls("rclcpp_components_register_nodes")
    yield from (_confused(call, strays) for call in calls if (strays := _strays(call)))
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
    yield from _lost(script)
    for macro in unregistered:
        yield _unregistered(package, macro, loaded=macro.name in workspace.loaded.get(package.name, ()))
    if not package.hidden(Facet.LIBRARIES):
        yield from _libraries(package)


def _forgets_macro(package: Package) -> bool:
    """Return whether a source includes the header of the macro, but no source has the macro, tests included."""
    included = any(use.via == "include" and "register_node_macro" in use.what for use in package.uses)
    return included and all(macro.kind != "component" for macro in package.registrations)


_WORDS = {"PLUGIN": 0, "NO_UNDEFINED_SYMBOLS": 0, "EXECUTABLE": 1, "EXECUTOR": 1}
"""Keywords of rclcpp_components_register_node() that no class name follows, with the number of their values."""


def _strays(call: Call) -> list[tuple[int, int]]:
    """Return the ranges of arguments that CMake takes for class names but that belong to rclcpp_components_register_node()."""
    words = ((at, _WORDS[text]) for at, text in enumerate(call.texts) if at and text in _WORDS)
    return [(at, min(at + more, len(call.args) - 1)) for at, more in words]


def _confused(call: Call, strays: Sequence[tuple[int, int]]) -> Finding:
    words = " and ".join([call.texts[first] for first, _ in strays])
    return Finding(
        f"rclcpp_components_register_nodes() accepts only class names, not {words}; remove that or call "
        "rclcpp_components_register_node()",
        call.span(strays[0][0]),
        call.texts[0],
        fix=Fix(f"remove {words}", tuple([edits.cmake.drop(call, *stray) for stray in strays])),
        severity=Severity.WARNING,
    )


def _lost(script: BuildScript) -> Iterator[Finding]:
    """Yield one finding for all components that are registered in a scope which ends before ament_package()."""
    seen = {component.name for component in script.products.components if not component.unregistered}
    lost = {component.name: component for component in script.products.components if component.name not in seen}
    if not lost:
        return
    first, *others = lost.values()
    more = f" and {len(others)} more" if others else ""
    yield Finding(
        f"'{first.name}'{more}: registered in the scope of a function or subfolder, so ament_package() does not write it to the "
        "index; register it in the top CMakeLists.txt",
        first.span,
        first.name,
        first_related(Related("also registered in a function or subfolder", other.span) for other in others),
        confidence=Confidence.MEDIUM if first.conditional else Confidence.HIGH,
    )


def _alike(component: Component, macros: list[Registration]) -> list[Registration]:
    """Return the macros with the same class in another namespace, or else the macro with the most similar class."""
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
    hint = names.did_you_mean([alike[0].name]) if alike else f"; add RCLCPP_COMPONENTS_REGISTER_NODE({component.name})"
    place = component.span.inner(component.name) if len(alike) == 1 else None
    fix = Fix(f"write '{alike[0].name}'", (Edit(place, alike[0].name),)) if place else None
    related = first_related(Related("the source registers this class", macro.span) for macro in alike)
    subject = alike[0].name if alike else component.name
    return Finding(f"no source registers the component '{component.name}'{hint}", component.span, subject, related, fix)


def _unregistered(package: Package, macro: Registration, *, loaded: bool) -> Finding:
    script = package.script
    assert script is not None
    library = build.library_registering(package, macro)
    command = f'rclcpp_components_register_nodes({library or "..."} "{macro.name}")'
    usable = library and "rclcpp_components" in dependencies.names_searched(package, script)
    fix = Fix.of(f"register '{macro.name}'", edits.cmake.at_end(script, command), safe=False) if usable else None
    return Finding(
        f"CMake does not register the component '{macro.name}'; add {command}",
        macro.span,
        macro.name,
        fix=fix,
        confidence=Confidence.HIGH if library and (script.products.components or loaded) else Confidence.MEDIUM,
        severity=Severity.WARNING,
    )


def _libraries(package: Package) -> Iterator[Finding]:
    """Yield the libraries with components that are not installed to lib."""
    script = package.script
    assert script is not None
    paths = {provided.path.rpartition("/")[2] for provided in script.products.installs}
    listed = build.install_arguments(package).union(provided.target for provided in script.products.installs)
    elsewhere = build.libraries_in_libexec(package, (".so",))
    targets = {target.name: target for target in reversed(script.products.targets)}
    reported: set[str] = set()
    for call in package.calls(*build.REGISTERING):
        name = build.evaluated_name(package, call.texts[0]) if call.args else None
        if name not in targets or name in reported or call.blocks:
            continue
        if place := elsewhere.get(name):
            reported.add(name)
            yield Finding(
                f"the library '{name}' has components but is installed to {place.path.rpartition('/')[0]}; install it to lib, "
                "where the ament index expects it",
                place.span,
                name,
                (Related("its components are registered here", call.span(0)),),
            )
        elif name not in listed and not any(file.startswith(f"lib{name}.") for file in paths):
            reported.add(name)
            fix = Fix.of(f"install '{name}'", edits.cmake.install_library(script, name))
            message = f"the library '{name}' has components but is not installed; install it to lib"
            yield Finding(message, call.span(0), name, (Related("the library is built here", targets[name].span),), fix)


RULE = Rule(
    name="component-mismatch",
    code="ROS413",
    summary="components have the same name in CMake and in the source, and their libraries are installed",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
