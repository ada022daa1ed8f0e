"""
## What it finds

Components that CMake registers in a function or in the `CMakeLists.txt` of a subfolder.

## Why it matters

The registration is a CMake variable, which `ament_package()` writes to the ament index. A variable set in a function or
subfolder is lost when CMake leaves the function or subfolder. `ros2 component load` and `ComposableNode` fail with "Could not
find requested resource in ament index".

## How to fix it

Register components in the `CMakeLists.txt` of the package, or in a macro instead of a function.

## Limitations

Packages whose components cannot be fully analysed are not reported. The confidence is medium for registrations under a condition.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import Confidence, Facet, Finding, Package, Related, Rule, Severity, Workspace, first_related


def check(package: Package, _: Workspace) -> Iterator[Finding]:
    if package.builds_with != "ament_cmake" or package.hidden(Facet.COMPONENTS):
        return
    seen = {component.name for component in package.built.products.components if not component.unregistered}
    outside = {component.name: component for component in package.built.products.components if component.name not in seen}
    if not outside:
        return
    first, *others = outside.values()
    are, them = (f" and {len(others)} more component{'s' if others[1:] else ''} are", "them") if others else (" is", "it")
    yield Finding(
        f"'{first.name}'{are} registered in a function or subfolder, so ament_package() does not write {them} to the "
        f"ament index; register {them} in the top CMakeLists.txt, outside functions",
        first.span,
        first.name,
        first_related(Related(f"'{other.name}' is also registered in a function or subfolder", other.span) for other in others),
        confidence=Confidence.MEDIUM if first.conditional else Confidence.HIGH,
    )


RULE = Rule(
    name="component-scope",
    code="ROS423",
    summary="components are registered in the scope of ament_package()",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    package=check,
)
