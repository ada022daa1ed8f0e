"""
## What it finds

Installed headers that include another package which `ament_export_dependencies()` does not name.

## Why it matters

Whoever finds this package gets neither the include directories nor the targets of the other one: its headers do not
compile there, unless they happen to find the other package themselves.

## How to fix it

Add `ament_export_dependencies(other)` before `ament_package()`.

## When it keeps silent

- `ament_auto_package()` does the exporting.
- The package exports nothing at all, so that its headers may be there for itself: then the confidence is medium.
- The other package comes along with one that is exported: then, too, the confidence is medium.
- The header is not installed, or perhaps not, or the script cannot be followed everywhere.
- The script does not find the other package: that is another mistake.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import (
    Confidence,
    Facet,
    Finding,
    Package,
    Related,
    Role,
    Rule,
    Severity,
    Use,
    Workspace,
    come_along,
    found_names,
    given_to,
    relative,
)

_MOST_RELATED = 4
_EXPORTS = ("ament_export_dependencies", "ament_export_targets", "ament_export_libraries", "ament_export_interfaces")
_EXPORTS_ALL = frozenset({"ament_auto_package", "autoware_ament_auto_package"})


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    script = package.script
    if script is None or script.problems or package.builds_with != "ament_cmake":
        return
    if package.hidden(Facet.USES | Facet.LIBRARIES) or _EXPORTS_ALL.intersection(script.calls):
        return
    exports = any(call in script.calls for call in _EXPORTS)
    exported = {mention.name for mention in given_to(script, "ament_export_dependencies")}
    along = come_along(workspace, exported) or frozenset(exported)
    finds = found_names(package, script)
    for name, uses in _public(package, workspace).items():
        if name in exported or name not in finds:
            continue
        first, *others = uses
        yield Finding(
            f"{name} is included by this installed header, but not exported: add ament_export_dependencies({name})",
            first.span,
            name,
            tuple(Related(f"also included here: {use.what}", use.span) for use in others[:_MOST_RELATED]),
            None,
            Confidence.MEDIUM if name in along or not exports else Confidence.HIGH,
        )


def _public(package: Package, workspace: Workspace) -> dict[str, list[Use]]:
    """Return the ROS packages that installed headers include, with the places."""
    script = package.script
    assert script is not None
    installed = {provided.source for provided in script.provides if provided.path.startswith("include/")}
    uses: dict[str, list[Use]] = {}
    for use in package.uses:
        if use.via != "include" or use.optional or not (use.sure and use.role & Role.EXPORT):
            continue
        if relative(package, use.span.path) in installed and workspace.world.is_package(use.package):
            uses.setdefault(use.package, []).append(use)
    return uses


RULE = Rule(
    name="unexported-dependency",
    code="ROS207",
    summary="what installed headers include must be exported",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    package=check,
)
