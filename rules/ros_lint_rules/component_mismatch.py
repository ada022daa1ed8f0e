"""
## What it finds

Components that cannot be loaded: CMake registers a class that no source makes loadable under this name with
`RCLCPP_COMPONENTS_REGISTER_NODE`; a source does so and CMake does not register the class, or does so in a function or in the
`CMakeLists.txt` of a subfolder; the library of a component is not installed, or not to `lib`. Also
`rclcpp_components_register_nodes(library PLUGIN "robot::Talker" EXECUTABLE talker)`: this command takes names of classes
and nothing else, so `PLUGIN`, `EXECUTABLE` and `talker` become components, and no executable is built.

## Why it matters

`ros2 component load` and `ComposableNode` look up the name in the index, then in the library, letter by letter: "Could not
find requested resource in ament index", or "Failed to find class with the requested plugin name". The executable that
`rclcpp_components_register_node(... EXECUTABLE x)` builds has the same trouble. The registration is a variable of CMake that
`ament_package()` writes into the index: what a function or a subfolder sets is gone when it ends.

## How to fix it

Write the same name, with its namespaces, into both. Take the words out that belong to `rclcpp_components_register_node()`, or
call that, with an `EXECUTABLE` that is called otherwise than the library. Install the library to `lib`. Register components
in the `CMakeLists.txt` of the package, or in a macro instead of a function.

## Limitations

Where the components or the libraries of the package cannot be seen whole; for tests; where no source of the package has the
macro, nor includes the header for it. A package that registers no component at all may compose its nodes by itself: the
confidence is medium unless a launch file of the workspace loads the component.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from ros_lint.api import (
    REGISTERING,
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
    astray,
    called,
    cmake_edits,
    evaluated_name,
    found_names,
    is_apart,
    library_of,
    listed_to_install,
    relative,
    several,
    similar,
)


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    script = package.script
    if script is None or package.builds_with != "ament_cmake" or package.hidden(Facet.COMPONENTS):
        return
    calls = called(package, "rclcpp_components_register_nodes")
    yield from (_confused(call, strays) for call in calls if (strays := _strays(call)))
    made = [one for one in package.registrations if one.kind == "component" and not is_apart(relative(package, one.span.path))]
    names = {one.name for one in made}
    registered = {component.name.removeprefix("::") for component in script.components}
    left = [one for one in made if one.name not in registered]
    unmade = [component for component in script.components if component.name.removeprefix("::") not in names]
    if not made and not _forgets_macro(package):
        unmade = []  # the macro of somebody else may make them
    # The only class that nobody makes is the only one that is compiled and that nobody registers, whatever the names.
    only = left if len(unmade) == len(left) == 1 and library_of(package, left[0]) else []
    for component in unmade:
        alike = only or _alike(component, left)
        left = [one for one in left if one not in alike]
        yield _unmade(component, alike)
    yield from _lost(script)
    for one in left:
        yield _unregistered(package, one, started=one.name in workspace.loaded.get(package.name, ()))
    if not package.hidden(Facet.LIBRARIES):
        yield from _libraries(package)


def _forgets_macro(package: Package) -> bool:
    """Whether a source includes what is only there to make components loadable, and none does, those of tests included."""
    included = any(use.via == "include" and "register_node_macro" in use.what for use in package.uses)
    return included and all(one.kind != "component" for one in package.registrations)


_WORDS = {"PLUGIN": 0, "NO_UNDEFINED_SYMBOLS": 0, "EXECUTABLE": 1, "EXECUTOR": 1}
"""What rclcpp_components_register_node() takes, with how many names that are no class stand after each word."""


def _strays(call: Call) -> list[tuple[int, int]]:
    """Return the first and last argument of what is taken for names of classes in a call, and belongs to the other command."""
    words = ((at, _WORDS[text]) for at, text in enumerate(call.texts) if at and text in _WORDS)
    return [(at, min(at + more, len(call.args) - 1)) for at, more in words]


def _confused(call: Call, strays: Sequence[tuple[int, int]]) -> Finding:
    words = " and ".join([call.texts[first] for first, _ in strays])
    return Finding(
        f"rclcpp_components_register_nodes() takes names of classes only, and makes components of {words}, too; leave them "
        "out, or call rclcpp_components_register_node()",
        call.span(strays[0][0]),
        call.texts[0],
        fix=Fix("leave them out", tuple([cmake_edits.drop(call, *stray) for stray in strays])),
        severity=Severity.WARNING,
    )


def _lost(script: BuildScript) -> Iterator[Finding]:
    """Speak of components that are registered where ament_package() does not see it, all at once."""
    seen = {component.name for component in script.components if not component.lost}
    lost = {component.name: component for component in script.components if component.name not in seen}
    if not lost:
        return
    first, *others = lost.values()
    more = f" and {len(others)} more" if others else ""
    yield Finding(
        f"{first.name}{more}: registered in a function or a subfolder, which ament_package() does not see, so nobody finds "
        "the component; register it in CMakeLists.txt of the package itself",
        first.span,
        first.name,
        several(Related("also this one", other.span) for other in others),
        confidence=Confidence.MEDIUM if first.conditional else Confidence.HIGH,
    )


def _alike(component: Component, left: list[Registration]) -> list[Registration]:
    """Return the registrations that are meant: of the same class in another namespace, or else of a similar class."""
    last = component.name.rpartition("::")[2]
    alike = [one for one in left if one.name.rpartition("::")[2] == last]
    if alike:
        return alike
    plain = {_plain(one.name.rpartition("::")[2]): one for one in left}
    near = similar(_plain(last), plain, 1, 0.8)
    return [plain[near[0]]] if near else []


def _plain(name: str) -> str:
    return name.lower().replace("_", "")


def _unmade(component: Component, alike: list[Registration]) -> Finding:
    hint = f"; the sources say {alike[0].name}" if alike else f"; add RCLCPP_COMPONENTS_REGISTER_NODE({component.name}) to one"
    place = component.span.inner(component.name) if len(alike) == 1 else None
    fix = Fix(f"write {alike[0].name}", (Edit(place, alike[0].name),)) if place else None
    related = several(Related("made loadable here", one.span) for one in alike)
    subject = alike[0].name if alike else component.name
    return Finding(f"no source makes the component {component.name} loadable{hint}", component.span, subject, related, fix)


def _unregistered(package: Package, one: Registration, *, started: bool) -> Finding:
    script = package.script
    assert script is not None
    library = library_of(package, one)
    way = f'rclcpp_components_register_nodes({library or "..."} "{one.name}")'
    usable = library and "rclcpp_components" in found_names(package, script)
    fix = Fix.of(f"register {one.name}", cmake_edits.at_end(script, way), safe=False) if usable else None
    return Finding(
        f"CMake does not register the component {one.name}; add {way}",
        one.span,
        one.name,
        fix=fix,
        confidence=Confidence.HIGH if library and (script.components or started) else Confidence.MEDIUM,
        severity=Severity.WARNING,
    )


def _libraries(package: Package) -> Iterator[Finding]:
    """Speak of libraries with components that are not installed."""
    script = package.script
    assert script is not None
    files = {provided.path.rpartition("/")[2] for provided in script.provides}
    listed = listed_to_install(package).union(provided.target for provided in script.provides)
    elsewhere = astray(package, (".so",))
    targets = {target.name: target for target in reversed(script.targets)}
    told: set[str] = set()
    for call in called(package, *REGISTERING):
        name = evaluated_name(package, call.texts[0]) if call.args else None
        if name not in targets or name in told or call.blocks:
            continue
        if place := elsewhere.get(name):
            told.add(name)
            yield Finding(
                f"the library {name} has components, and is installed to {place.path.rpartition('/')[0]}; "
                "the index says that it is in lib, so install it there",
                place.span,
                name,
                (Related("its components are registered here", call.span(0)),),
            )
        elif name not in listed and not any(file.startswith(f"lib{name}.") for file in files):
            told.add(name)
            fix = Fix.of(f"install {name}", cmake_edits.install_library(script, name))
            message = f"the library {name} has components, and is not installed; install it to lib"
            yield Finding(message, call.span(0), name, (Related("it is built here", targets[name].span),), fix)


RULE = Rule(
    name="component-mismatch",
    code="ROS413",
    summary="a component must have one name in CMake and in the sources, and its library must be installed",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
