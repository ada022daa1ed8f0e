"""
## What it finds

A package of the workspace that an underlay contains, too. The package of the workspace hides that of the underlay. The message
names the versions, the packages of the underlay that were built against the hidden package, and the executables, launch files
and interfaces that only the hidden package has.

## Why it matters

The packages of the underlay still use the version against which they were built. Then headers and libraries of two versions are
mixed, which may crash at run time without any other sign. Files that only the hidden package has are no longer found, because
ROS searches for them in the package of the workspace.

## How to fix it

Build the packages of the underlay that depend on the package in the workspace too. Alternatively, remove the package from the
workspace, or rename it if it has the same name by accident.

## Limitations

- Nothing is reported without an underlay. A released package that is not installed in an underlay does not count, because
  building packages from source is normal.
- If no package of the underlay depends on the hidden package and nothing is lost, the severity is info.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import Facet, Finding, Package, Rule, Severity, Workspace

_MOST_NAMES = 5


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    world = workspace.world
    below = world.installed(package.name)
    if below is None or package.manifest is None or package.manifest.problems:
        return
    version = below.released.version if below.released else ""
    hidden = f"version {version}" if version else "the package"
    message = f"'{package.name}' {package.manifest.version} of the workspace hides {hidden} of underlay '{below.prefix.root}'"
    dependents = tuple(f"'{name}'" for name in world.dependents_below(package.name))
    lost = tuple(_lost(package, workspace))
    reasons = []
    if dependents:
        reasons.append(f"{_few(dependents)} {'was' if len(dependents) == 1 else 'were'} built with that version")
    if lost:
        reasons.append(f"only that version has {_few(lost)}")
    if reasons:
        message += f"; {', and '.join(reasons)}"
    if dependents:
        message += f"; build {_few(dependents)} in the workspace, too"
    elif lost:
        message += f"; add {'it' if len(lost) == 1 else 'them'} to the package in the workspace, or remove that package"
    yield Finding(message, package.span, package.name, severity=None if dependents or lost else Severity.INFO)


def _lost(package: Package, workspace: Workspace) -> Iterator[str]:
    """Yield the executables, launch files and interfaces that only the package of the underlay has."""
    below, script = workspace.world.installed(package.name), package.script
    if below is None or script is None:
        return
    if not package.hidden(Facet.EXECUTABLES):
        folder = f"lib/{package.name}/"
        installed = {
            provided.path.removeprefix(folder) for provided in script.products.installs if provided.path.startswith(folder)
        }
        yield from (f"executable '{name}'" for name in below.known("executables").names if name not in installed)
    if not package.hidden(Facet.SHARE):
        folder = f"share/{package.name}/"
        installed = {
            provided.path.removeprefix(folder) for provided in script.products.installs if provided.path.startswith(folder)
        }
        yield from (f"launch file '{name}'" for name in below.known("launch").names if name not in installed)
    if not package.hidden(Facet.INTERFACES):
        yield from (f"interface '{name}'" for name in below.known("interfaces").names if name not in script.products.interfaces)


def _few(names: tuple[str, ...]) -> str:
    shown = ", ".join(names[:_MOST_NAMES])
    return shown if len(names) <= _MOST_NAMES else f"{shown} and {len(names) - _MOST_NAMES} more"


RULE = Rule(
    name="shadowed-package",
    code="ROS117",
    summary="packages do not hide a package of an underlay",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    package=check,
)
