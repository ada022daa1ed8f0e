"""
## What it finds

A launch file that loads a component class which its package does not register.

## Why it matters

The container reports `Failed to find class with the requested plugin name`. The component is missing, while everything else
runs.

## How to fix it

Correct the name of the class, or register it: `rclcpp_components_register_node(library PLUGIN "ns::Class" EXECUTABLE x)` or
`rclcpp_components_register_nodes(library "ns::Class")`. The fix corrects the name if only one class is possible.

## Limitations

Not reported:

- A part of the package's build script that cannot be evaluated may register the class.
- The package is released, and the sources of its release are not fully known. The sources for an earlier and a later
  distribution are used instead, if both are known and neither contains the class.
- Launch files of tests and examples.

Reported with medium confidence:

- The distribution was not chosen, and the package may have the class in another distribution.
- The class is the default of an argument.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import lru_cache

from ros_lint.api import (
    Confidence,
    Facet,
    Finding,
    Package,
    Related,
    Rule,
    Severity,
    Workspace,
    cached_by_name,
    cached_by_package,
    first_related,
    launch,
    names,
)


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    for (owner, name), references in launch.references_by_name(package, ("component",)).items():
        all_names = _names_without(owner, name, workspace)
        if all_names is None:
            continue
        best, *others = sorted(references, key=lambda reference: (reference.from_default, reference.span))
        meant = _by_lower(all_names).get(name.lower(), [])
        near = (
            meant
            or [
                other
                for other in names.similar_names(name, all_names, 4, 0.75)
                if names.similar_names(_class(name), [_class(other)], 1, 0.75)
            ][:2]
        )
        hint = names.did_you_mean(near) or (
            f"; it registers {names.shorten_list(all_names)}"
            if all_names
            else "; it registers no components: correct the package, or register the class"
        )
        only = meant[0] if len(meant) == 1 else ""
        sure = workspace.surely_lacks(owner, "components", name)
        yield Finding(
            f"'{owner}' does not register a component '{name}'{hint}",
            best.span,
            f"{owner}/{name}",
            first_related(Related(f"'{name}' is also loaded here", other.span) for other in others),
            launch.rename_fix(f"load '{only}'", only, [(reference.span, reference.exact) for reference in references]),
            Confidence.HIGH if sure and not best.from_default else Confidence.MEDIUM,
        )


@lru_cache(maxsize=8)
def _by_lower(all_names: tuple[str, ...]) -> Mapping[str, list[str]]:
    """Return the names of components by their names in lower case."""
    result: dict[str, list[str]] = {}
    for name in all_names:
        result.setdefault(name.lower(), []).append(name)
    return result


def _class(name: str) -> str:
    """Return the class name of a component without its namespace: ``Talker`` for ``demo::Talker``."""
    return name.rpartition("::")[2]


def _names_without(owner: str, name: str, workspace: Workspace) -> tuple[str, ...] | None:
    """Return the components that the package ``owner`` registers if ``name`` is certainly not among them, else None."""
    owners = workspace.by_name.get(owner, ())
    if not owners:
        known = workspace.world.components(owner)
        return known.possible if known.ask(name) == "missing" else None
    registered = [_registered(package, workspace) for package in owners]
    if any(all_names is None or name in all_names for all_names in registered):
        return None
    return _all_registered(workspace, owner)


@cached_by_name
def _all_registered(workspace: Workspace, owner: str) -> tuple[str, ...]:
    """Return the known components of the packages with the name ``owner``, sorted."""
    registered = [_registered(package, workspace) for package in workspace.by_name.get(owner, ())]
    return tuple(sorted({name for all_names in registered for name in all_names or ()}))


@cached_by_package
def _registered(package: Package, _: Workspace) -> frozenset[str] | None:
    """Return the components that a package registers, None if they are not known."""
    if package.script is None or package.hidden(Facet.COMPONENTS):
        return None
    # component-mismatch reports classes that the sources export but CMake does not register.
    exported = [registration.name for registration in package.registrations if registration.kind == "component"]
    return frozenset([*(component.name for component in package.script.products.components), *exported])


RULE = Rule(
    name="launch-unknown-component",
    code="ROS504",
    summary="components that launch files load are registered by their packages",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
