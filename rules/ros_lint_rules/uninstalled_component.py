"""
## What it finds

A library with components that is not installed, or not installed to `lib`.

## Why it matters

`ros2 component load` and `ComposableNode` look up the library in the ament index, which expects it in `lib`. They fail, and so
does the executable that `rclcpp_components_register_node(... EXECUTABLE x)` builds.

## How to fix it

Install the library to `lib`. The fix does this for a library that is not installed.

## Limitations

Packages whose components or libraries cannot be fully analysed are not reported.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import Facet, Finding, Fix, Package, Related, Rule, Severity, Workspace, build, edits


def check(package: Package, _: Workspace) -> Iterator[Finding]:
    script = package.script
    if script is None or package.builds_with != "ament_cmake" or package.hidden(Facet.COMPONENTS | Facet.LIBRARIES):
        return
    paths = {provided.path.rpartition("/")[2] for provided in script.products.installs}
    listed = build.install_arguments(package).union(provided.target for provided in script.products.installs)
    elsewhere = build.libraries_elsewhere(package, (".so",))
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
                (Related(f"the components of '{name}' are registered here", call.span(0)),),
            )
        elif name not in listed and not any(file.startswith(f"lib{name}.") for file in paths):
            reported.add(name)
            fix = Fix.of(f"install '{name}'", edits.cmake.install_library(script, name))
            message = f"the library '{name}' has components but is not installed; install it to lib"
            yield Finding(message, call.span(0), name, (Related(f"the library '{name}' is built here", targets[name].span),), fix)


RULE = Rule(
    name="uninstalled-component",
    code="ROS424",
    summary="libraries with components are installed to lib",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
