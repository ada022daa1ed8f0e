"""
## What it finds

An interface with a field of another package that `rosidl_generate_interfaces()` does not list under `DEPENDENCIES`.

## Why it matters

The generated code does not compile.

## How to fix it

Add the package to `DEPENDENCIES`.

## Limitations

Not reported:

- Interfaces that are not installed, because only the package itself uses them.
- Scripts that cannot be fully analysed.
- Packages that a listed package provides transitively.

The confidence is medium for interfaces that are generated under a condition.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import Confidence, Facet, Finding, Package, Rule, Severity, Workspace, build, dependencies, names


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    generation = build.interface_generation(package)
    if generation is None or package.hidden(Facet.USES):
        return
    listed = frozenset(mention.name for mention in dependencies.macro_packages(package.built, "interfaces"))
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
            f"'{use.package}' is used here, but {build.GENERATING}() does not list it; add it to DEPENDENCIES",
            use.span,
            use.package,
            (),
            None,
            Confidence.HIGH if generation.certain else Confidence.MEDIUM,
        )


RULE = Rule(
    name="missing-interface-dependency",
    code="ROS213",
    summary="packages of interface fields are listed under DEPENDENCIES",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    package=check,
)
