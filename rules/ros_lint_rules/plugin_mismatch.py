"""
## What it finds

A class in a plugin description that no source registers under exactly this name, or that is registered with another base class.

## Why it matters

The loader fails: "According to the loaded plugin descriptions the class x with base class type y does not exist", or "Failed to
find class x".

## How to fix it

Write the type and the base class in the description as in `PLUGINLIB_EXPORT_CLASS`, or remove the entry.

## Limitations

Not reported:

- Packages whose libraries or installed files cannot be fully analysed.
- Descriptions of tests, and those that are exported only under a condition.
- Described classes in packages that register classes with their own macros.

Reported with medium confidence:

- A class that no source registers but whose name appears in a source, or that another package registers.
- A class in an installed description that the build script does not export.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence

from ros_lint.api import (
    Confidence,
    Finding,
    Package,
    PluginClass,
    PluginFile,
    Registration,
    Related,
    Rule,
    Severity,
    Workspace,
    build,
    cached_by_workspace,
    first_related,
    names,
)


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    plugins = build.plugins(package)
    if plugins is None:
        return
    exported = {path for call in package.calls(build.EXPORTING_PLUGINS, anywhere=True) for path in call.texts[1:]}
    not_exported = plugins.of_ros_1.keys() - exported
    described = [(plugin, entry) for plugin in plugins.installed for library in plugin.libraries for entry in library.classes]
    for plugin, entry in described:
        for finding in _class(package, plugin, entry, plugins.macros):
            registered_here = any(macro.name == entry.type for macro in plugins.macros)
            if entry.type in _registering_packages(workspace) and not registered_here:
                # The library may link that of the other package: then the class is loaded.
                message = _of_other_package(entry.type, workspace)
                yield finding._replace(message=message, confidence=Confidence.MEDIUM)
            elif plugins.exports and plugin.path not in not_exported:
                yield finding
            else:  # A description that is not exported has no effect, and many remain from ROS 1.
                yield finding._replace(confidence=Confidence.MEDIUM)


def _of_other_package(plugin: str, workspace: Workspace) -> str:
    """Return the message for a class in a plugin description if only another package registers the class."""
    owner = _registering_packages(workspace)[plugin]
    described = {entry.type for file in owner.built.files.plugin_files for library in file.libraries for entry in library.classes}
    remedy = (
        "remove this <class>, because that package describes the class"
        if plugin in described
        else f"move this <class> to a plugin description of '{owner.name}'"
    )
    return f"no source of this package registers the plugin '{plugin}', only package '{owner.name}' does; {remedy}"


@cached_by_workspace
def _registering_packages(workspace: Workspace) -> Mapping[str, Package]:
    """Return the packages that register classes as plugins or components in C++, by the name of the class."""
    return {macro.name: package for package in workspace.packages for macro in package.registrations}


def _class(package: Package, plugin: PluginFile, entry: PluginClass, registered: Sequence[Registration]) -> Iterator[Finding]:
    if not entry.type or not registered:
        return
    same = [macro for macro in registered if macro.name == entry.type]
    if same:
        yield from _base(package, plugin, entry, same)
        return
    last = entry.type.rpartition("::")[2]
    described = {
        described_class.type
        for file in package.built.files.plugin_files
        for library in file.libraries
        for described_class in library.classes
    }
    alike = [macro for macro in registered if macro.name.rpartition("::")[2] == last and macro.name not in described]
    verb = "registers"
    if alike:
        hint = names.did_you_mean([alike[0].name])
    elif entry.type in package.unwritten_classes:
        verb, hint = "registers or defines", "; remove this <class>"
    else:
        hint = f"; add PLUGINLIB_EXPORT_CLASS({entry.type}, {entry.base}) to a source"
    related = first_related(Related(f"'{macro.name}' is registered here", macro.span) for macro in alike)
    yield Finding(
        f"no source of this package {verb} the plugin '{entry.type}'{hint}",
        entry.span,
        f"{plugin.path}#{entry.type}",
        related,
        confidence=Confidence.HIGH if alike or entry.type in package.unwritten_classes else Confidence.MEDIUM,
    )


def _base(package: Package, plugin: PluginFile, entry: PluginClass, macros: Sequence[Registration]) -> Iterator[Finding]:
    """Yield a finding if every registration of a plugin has a base class other than the class in the description."""
    if all(_differ(entry.base, macro.base) for macro in macros):
        described = [
            other.base
            for file in package.built.files.plugin_files
            for library in file.libraries
            for other in library.classes
            if other.type == entry.type
        ]
        twice = any(not _differ(base, macro.base) for base in described for macro in macros)
        remedy = (
            "remove this <class>, because another one has that base class"
            if twice
            else "write the same base class in both places"
        )
        yield Finding(
            f"the plugin '{entry.type}' is described with the base class '{entry.base}', but registered with '{macros[0].base}'; "
            f"{remedy}",
            entry.span,
            f"{plugin.path}#{entry.type}",
            first_related(Related(f"'{macro.name}' is registered here", macro.span) for macro in macros),
        )


def _differ(described: str, registered: str) -> bool:
    """Return whether two names certainly denote different classes.

    A name without a namespace matches a name in any namespace, also in template arguments.
    """
    if "::" not in described or "::" not in registered:
        return False
    first, second = (_NAME.findall(name) for name in (described, registered))
    return len(first) != len(second) or not all(map(_may_be_same, first, second))


_NAME = re.compile(r"[\w:]+")


def _may_be_same(first: str, second: str) -> bool:
    """Return whether two names may denote the same class, if one of them omits namespaces."""
    return f"::{first}".endswith(f"::{second}") or f"::{second}".endswith(f"::{first}")


RULE = Rule(
    name="plugin-mismatch",
    code="ROS412",
    summary="described plugins are registered under the same name",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    package=check,
)
