"""
## What it finds

A class that is registered with `PLUGINLIB_EXPORT_CLASS`, but is in no exported plugin description:

- The package exports no description.
- The description is exported only in package.xml, as in ROS 1: `<base plugin="${prefix}/plugins.xml"/>`.
- The description is not exported, and therefore not installed.
- No exported description lists a class of the library.

## Why it matters

The loader searches for plugins in exported descriptions and fails: "According to the loaded plugin descriptions the class x with
base class type y does not exist".

## How to fix it

Write `pluginlib_export_plugin_description_file(<package of the base class> plugins.xml)`. The fix exports a description if all
its base classes belong to one declared package, or if package.xml exports the description for a declared package. If the package
of the base class is in the workspace and nothing loads such plugins, the macro may be unnecessary and can be removed. Such a
finding has the severity info.

## Limitations

Not reported:

- Packages whose libraries or installed files cannot be fully analysed.
- Plugins of tests, and nodelets, which ROS 2 does not have.
- Descriptions that are exported only under a condition.
- Components registered as in Crystal, with the base class `rclcpp::Node`: they are not plugins.

A registered class that is in no library of the package is reported with medium confidence, if the package builds libraries.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from ros_lint.api import (
    Confidence,
    Finding,
    Fix,
    Package,
    PluginFile,
    Registration,
    Related,
    Rule,
    Severity,
    Workspace,
    build,
    edits,
    first_related,
)


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    plugins = build.plugins(package)
    if plugins is None:
        return
    if plugins.exports:
        yield from _undescribed(package, plugins.registered)
        yield from _uninstalled(package, plugins)
    elif plugins.registered and not _reads_manifest(package):
        yield _unexported(package, workspace, plugins)


def _uninstalled(package: Package, plugins: build.Plugins) -> Iterator[Finding]:
    """Yield a finding for each unexported plugin description with a registered class that no installed description lists."""
    exported = {text for call in package.calls(build.EXPORTING_PLUGINS, anywhere=True) for text in call.texts}
    script = package.built
    installed = [plugin for plugin in script.files.plugin_files if plugin.path in script.products.installed]
    described = {entry.type for plugin in installed for library in plugin.libraries for entry in library.classes}
    lacking = {macro.name for macro in plugins.registered} - described
    for plugin in plugins.uninstalled if exported else ():
        if plugin.path in exported:
            continue  # only under a condition
        if any(entry.type in lacking for library in plugin.libraries for entry in library.classes):
            yield Finding(
                f"'{plugin.path}' is not exported, so its plugins are not found; "
                f"add {build.EXPORTING_PLUGINS}({_base_package(package, plugins, plugin) or _UNKNOWN_BASE} {plugin.path})",
                plugin.span,
                plugin.path,
                fix=_export(package, plugins, plugin),
            )


def _undescribed(package: Package, registered: Sequence[Registration]) -> Iterator[Finding]:
    """Yield findings for registered classes that no description lists, if all descriptions can be read."""
    descriptions = {plugin.path: plugin for plugin in package.built.files.plugin_files}
    calls = list(package.calls(build.EXPORTING_PLUGINS, anywhere=True))
    if _reads_manifest(package) or not all(len(call.texts) > 1 and call.texts[1] in descriptions for call in calls):
        return
    classes = [entry for plugin in descriptions.values() for library in plugin.libraries for entry in library.classes]
    known = {name.rpartition("::")[2] for entry in classes for name in (entry.type, entry.name.replace("/", "::"))}
    # A class next to a described one, or in a library that others link, may be a base class or a copy.
    needed = {build.library_registering(package, macro) for macro in registered if macro.name.rpartition("::")[2] in known}
    needed.update(name for target in package.built.products.targets for name, _ in target.links)
    for macro in registered:
        library = build.library_registering(package, macro)
        if library and library not in needed:
            yield Finding(
                f"the plugin '{macro.name}' is registered, but no exported plugin description lists it, so loaders do not find "
                "it; add it to a description",
                macro.span,
                macro.name,
                first_related(
                    Related(f"the plugin description '{call.texts[1]}' is exported here", call.span(1)) for call in calls
                ),
            )


_READ_BY_RQT = frozenset({"rqt_gui", "qt_gui"})
"""Tags in <export> of the manifest by which rqt finds plugins. ROS 2 ignores other tags with an attribute ``plugin``."""


def _reads_manifest(package: Package) -> bool:
    """Return whether the manifest exports a plugin description for rqt, because rqt reads the ``<export>`` of the manifest."""
    exports = package.manifest.exports if package.manifest else ()
    return any(element.tag in _READ_BY_RQT and element.get("plugin") for element in exports)


def _unexported(package: Package, workspace: Workspace, plugins: build.Plugins) -> Finding:
    """Return the finding for a package that registers classes and exports no plugin description."""
    registered = plugins.registered
    first, *others = registered
    related = first_related(Related(f"'{macro.name}' is also registered here", macro.span) for macro in others)
    types = {macro.name for macro in registered}
    files = package.built.files.plugin_files
    plugin = next((p for p in files if any(c.type in types for library in p.libraries for c in library.classes)), None)
    if plugin is None and (base := _unloaded_base(registered, workspace)):
        message = (
            f"the plugin '{first.name}' is registered, but nothing loads plugins of '{base}'; remove PLUGINLIB_EXPORT_CLASS, "
            "or export a plugin description"
        )
        return Finding(message, first.span, "pluginlib", related, severity=Severity.INFO)
    exported = plugins.of_ros_1.get(plugin.path) if plugin else None
    if plugin is None:
        problem = "no plugin description is exported"
        remedy = f"a plugin description and {build.EXPORTING_PLUGINS}()"
    else:
        problem = (
            f"ROS 2 does not read the export of '{plugin.path}' in package.xml"
            if exported
            else "no plugin description is exported"
        )
        remedy = f"{build.EXPORTING_PLUGINS}({_base_package(package, plugins, plugin) or _UNKNOWN_BASE} {plugin.path})"
    return Finding(
        f"the plugin '{first.name}' is registered, but {problem}, so loaders do not find it; add {remedy}",
        first.span,
        plugin.path if plugin else "pluginlib",
        related
        + ((Related(f"the plugin description '{plugin.path}'", plugin.span),) if plugin else ())
        + ((Related(f"'{plugin.path}' is exported here, as in ROS 1", exported.span),) if plugin and exported else ()),
        _export(package, plugins, plugin) if plugin else None,
        # A source that is not compiled may be unused; in a package without libraries, the library is yet to be added.
        confidence=Confidence.HIGH
        if build.library_registering(package, first) or not _builds_libraries(package)
        else Confidence.MEDIUM,
    )


def _unloaded_base(registered: Sequence[Registration], workspace: Workspace) -> str:
    """Return the common base class of registered classes if it is in a workspace package and nothing loads its plugins.

    The result is "" otherwise.
    """
    bases = {macro.base for macro in registered}
    base = bases.pop()
    owner = base.partition("::")[0]
    return base if not bases and owner in workspace.by_name and base not in build.plugin_loaders(workspace) else ""


def _builds_libraries(package: Package) -> bool:
    return any(target.kind == "library" and target.sources for target in package.built.products.targets)


def _export(package: Package, plugins: build.Plugins, plugin: PluginFile) -> Fix | None:
    script = package.script
    base = _base_package(package, plugins, plugin)
    if script is None or not base:
        return None
    return Fix.of(
        f"export '{plugin.path}'", edits.cmake.at_end(script, f"{build.EXPORTING_PLUGINS}({base} {plugin.path})"), safe=False
    )


_UNKNOWN_BASE = "<package of the base class>"


def _base_package(package: Package, plugins: build.Plugins, plugin: PluginFile) -> str:
    """Return the package of the base classes in a plugin description, "" if it is unknown or not declared.

    It has the name of the namespace of all base classes, or the name of the tag by which package.xml exports the description.
    """
    namespaces = {entry.base.partition("::")[0] for library in plugin.libraries for entry in library.classes}
    exported = plugins.of_ros_1.get(plugin.path)
    candidates = (*(namespaces if len(namespaces) == 1 else ()), *((exported.tag,) if exported else ()))
    return next((name for name in candidates if name == package.name or package.declares(name)), "")


RULE = Rule(
    name="unexported-plugin",
    code="ROS425",
    summary="registered plugins are in an exported description",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
