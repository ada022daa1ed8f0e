"""
## What it finds

A package of the workspace that an underlay has, too. Whoever asks for the package gets the one on top, here the one of the
workspace: the message says which versions there are, which packages of the underlay were built against the other one, and
what only the other one has.

## Why it matters

The packages below go on using what they were built against, headers and libraries of one version with those of another:
it may crash at run time where nothing else shows. And what only the lower package has can no longer be found, since all
its files are looked for in the upper one.

## How to fix it

Build the packages of the underlay that depend on it in the workspace, too; or take the package out of the workspace, or
rename it if it only happens to be called so.

## Limitations

Without an underlay. Packages that are released, but not installed below, are none: building them from source is what a
workspace is for. When no package below depends on it and nothing is lost, it is only a note.
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
    message = f"{package.name} {package.manifest.version} hides {version or 'the one'} of underlay {below.prefix.root}"
    dependents = world.dependents_below(package.name)
    if dependents:
        message += f", against which {_few(dependents)} {'was' if len(dependents) == 1 else 'were'} built"
    lost = tuple(_lost(package, workspace))
    if lost:
        message += f", and {_few(lost)} {'is' if len(lost) == 1 else 'are'} in that one only"
    if dependents:
        message += ": build what depends on it in the workspace, too"
    elif lost:
        message += ": add what is missing, or take the package out of the workspace"
    yield Finding(message, package.place, package.name, severity=None if dependents or lost else Severity.INFO)


def _lost(package: Package, workspace: Workspace) -> Iterator[str]:
    """Yield what the package of the underlay has and the one of the workspace has not."""
    below, script = workspace.world.installed(package.name), package.script
    if below is None or script is None:
        return
    if not package.hidden(Facet.EXECUTABLES):
        folder = f"lib/{package.name}/"
        have = {provided.path.removeprefix(folder) for provided in script.provides if provided.path.startswith(folder)}
        yield from (f"executable {name}" for name in below.known("executables").names if name not in have)
    if not package.hidden(Facet.SHARE):
        folder = f"share/{package.name}/"
        have = {provided.path.removeprefix(folder) for provided in script.provides if provided.path.startswith(folder)}
        yield from (name for name in below.known("launch").names if name not in have)
    if not package.hidden(Facet.INTERFACES):
        yield from (name for name in below.known("interfaces").names if name not in script.interfaces)


def _few(names: tuple[str, ...]) -> str:
    shown = ", ".join(names[:_MOST_NAMES])
    return shown if len(names) <= _MOST_NAMES else f"{shown} and {len(names) - _MOST_NAMES} more"


RULE = Rule(
    name="shadowed-package",
    code="ROS117",
    summary="a package should not hide one of an underlay by chance",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    package=check,
)
