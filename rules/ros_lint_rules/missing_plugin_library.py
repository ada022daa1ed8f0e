"""
## What it finds

A library in a plugin description that the package does not build or install, or a `<library>` without `path`.

## Why it matters

The loader fails: "Could not find library". A `<library>` without `path` makes pluginlib loop forever.

## How to fix it

Write the name of the library as in `add_library()`, and install the library to `lib`.

## Limitations

Not reported:

- Packages whose libraries or installed files cannot be fully analysed.
- Descriptions of tests, and those that are exported only under a condition.

Reported with medium confidence:

- A described library without classes, or one that is built but not certainly shared.
- A library in an installed description that is not exported for any package.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import Confidence, Finding, Package, PluginFile, PluginLibrary, Rule, Severity, Workspace, build, names


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    plugins = build.plugins(package)
    if plugins is None:
        return
    for plugin in plugins.installed:
        for library in plugin.libraries:
            for finding in _library(package, workspace, plugin, library):
                # A description that is not exported has no effect, and many remain from ROS 1.
                yield finding if plugins.exports else finding._replace(confidence=Confidence.MEDIUM)


def _library(package: Package, workspace: Workspace, plugin: PluginFile, library: PluginLibrary) -> Iterator[Finding]:
    if not library.path:
        yield Finding(
            "<library> without the attribute 'path' makes pluginlib loop forever; add the attribute", library.span, plugin.path
        )
        return
    script = package.built
    installed = {_plain(p.path) for p in script.products.installs if not p.source and p.path.endswith((".so", ".a"))}
    built = {target.name for target in script.products.targets if target.kind == "library"}
    name = _plain(library.path)
    if name in installed or "$" in library.path or not built:
        return
    if name in built:
        message = f"the library '{name}' is built, but not installed to lib; install it there"
        # The library may be static, or its file may have another name.
        sure = Confidence.HIGH if build.is_declared_shared(package, workspace, name) and library.classes else Confidence.MEDIUM
    else:
        near = names.similar_names(name, sorted(installed | built), 1, 0.8)
        hint = names.ask_if_meant(near) or "; correct the path, or remove this <library>"
        message = f"the package does not build a library '{name}'{hint}"
        sure = Confidence.HIGH if library.classes else Confidence.MEDIUM  # without classes nothing is loaded
    yield Finding(message, library.span, f"{plugin.path}#{library.path.rpartition('/')[2]}", confidence=sure)


def _plain(path: str) -> str:
    """Return the name of a library from its path: ``foo`` for ``lib/libfoo.so`` and for ``libfoo``."""
    name = path.rpartition("/")[2]
    return name.removesuffix(".so").removesuffix(".a").removesuffix(".dll").removeprefix("lib")


RULE = Rule(
    name="missing-plugin-library",
    code="ROS427",
    summary="libraries of plugins are built and installed",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    package=check,
)
