"""
## What it finds

Plugins of pluginlib that cannot be loaded:

- A class that is registered with `PLUGINLIB_EXPORT_CLASS` in a package without an exported plugin description.
- A plugin description that is not exported, and therefore not installed.
- A plugin description that is exported for a name that is not a package, while a loader of the workspace searches for plugins
  of its base classes under another name.
- A plugin description that is exported for its own package, although nothing in the workspace loads plugins of that package and
  the base classes belong to another package.
- A registered class in a library of which no exported description lists a class.
- A described class that no source registers under exactly this name, or that is registered with another base class.
- A described library that the package does not build or install, or a `<library>` without `path`.

## Why it matters

The loader searches for plugins by name and fails: "According to the loaded plugin descriptions the class x with base class type
y does not exist", or "Could not find library". A `<library>` without `path` makes pluginlib loop forever.

## How to fix it

Write `pluginlib_export_plugin_description_file(<package of the base class> plugins.xml)`. Write type and path in the
description as they are in the sources and in `add_library()`. The fix exports a description if all its base classes belong to
one package. If the package of the base class is in the workspace and nothing loads such plugins, the macro may be unnecessary
and can be removed. The severity of this finding is info.

## Limitations

Not reported:

- Packages whose libraries or installed files cannot be fully analysed.
- Plugins of tests, and nodelets, which ROS 2 does not have.
- Descriptions that are exported only under a condition.
- Components registered as in Crystal, with the base class `rclcpp::Node`: they are not plugins.
- Described classes in packages that register classes with their own macros.

Reported with medium confidence:

- A class that no source registers but whose name appears in a source, or that another package registers.
- A registered class that is in no library of the package, if the package builds libraries.
- A described library without classes, or one that is built but not certainly shared.
- A library or class in an installed description that is not exported for any package.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator

from ros_lint.api import (
    Call,
    Confidence,
    Facet,
    Finding,
    Fix,
    Package,
    PluginClass,
    PluginFile,
    PluginLibrary,
    PluginLoader,
    Registration,
    Related,
    Rule,
    Severity,
    Workspace,
    build,
    cached_by_workspace,
    edits,
    files,
    first_related,
    names,
)

_SEEN = Facet.LIBRARIES | Facet.SHARE | Facet.COMPONENTS


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    script = package.script
    if script is None or package.builds_with != "ament_cmake" or build.opaque_except_undefined_targets(package, _SEEN):
        return
    all_macros = [macro for macro in package.registrations if macro.kind == "plugin"]
    registered = [
        macro for macro in all_macros if not (files.is_auxiliary(package.relative(macro.span.path)) or _is_no_plugin(macro))
    ]
    all_names = {macro.name for macro in registered}
    installed = script.products.installed
    exported = list(package.calls(build.EXPORTING_PLUGINS, anywhere=True))
    if build.EXPORTING_PLUGINS not in script.commands.names and not exported:
        yield from _unexported(package, workspace, registered)
        # A description that is not exported has no effect, and many remain from ROS 1.
        for plugin in script.files.plugin_files:
            if plugin.path in installed and not files.is_auxiliary(plugin.path):
                for finding in _libraries(package, workspace, plugin, all_macros):
                    yield finding._replace(confidence=Confidence.MEDIUM)
        return
    yield from _wrongly_exported(package, workspace)
    yield from _undescribed(package, registered)
    described = {
        entry.type
        for plugin in script.files.plugin_files
        if plugin.path in installed
        for library in plugin.libraries
        for entry in library.classes
    }
    for plugin in script.files.plugin_files:
        if files.is_auxiliary(plugin.path):
            continue
        if plugin.path in installed:
            yield from _libraries(package, workspace, plugin, all_macros)
        elif any(plugin.path in call.texts for call in exported):
            continue  # only under a condition
        elif exported and any(entry.type in all_names - described for library in plugin.libraries for entry in library.classes):
            yield Finding(
                f"'{plugin.path}' is not exported, so its plugins are not found; "
                f"add {build.EXPORTING_PLUGINS}(... {plugin.path})",
                plugin.span,
                plugin.path,
                fix=_export(package, plugin),
            )


def _undescribed(package: Package, registered: list[Registration]) -> Iterator[Finding]:
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
                f"'{macro.name}' is registered, but no exported plugin description lists it, so loaders do not find it",
                macro.span,
                macro.name,
                first_related(Related("this description is exported", call.span(1)) for call in calls),
            )


def _is_no_plugin(macro: Registration) -> bool:
    """Return whether a registered class needs no description: nodelets of ROS 1, and components registered as in Crystal.

    A package may contain sources for ROS 1 and ROS 2; those for ROS 1 are not built here.
    """
    return macro.base.startswith("nodelet::") or macro.base in ("rclcpp::Node", "rclcpp_lifecycle::LifecycleNode")


@cached_by_workspace
def _registered_classes(workspace: Workspace) -> frozenset[str]:
    """Return the classes that the packages register."""
    return frozenset([macro.name for package in workspace.packages for macro in package.registrations])


@cached_by_workspace
def _loading(workspace: Workspace) -> dict[str, list[PluginLoader]]:
    """Return the loaders of all packages by the base class of the plugins that they load."""
    loaders: dict[str, list[PluginLoader]] = {}
    for package in workspace.packages:
        for loader in package.loaders:
            loaders.setdefault(loader.base, []).append(loader)
    return loaders


def _wrongly_exported(package: Package, workspace: Workspace) -> Iterator[Finding]:
    """Compare the packages for which descriptions are exported with those that the loaders of the workspace search."""
    script = package.script
    assert script is not None
    described = {plugin.path: plugin for plugin in script.files.plugin_files}
    for call in package.calls(build.EXPORTING_PLUGINS, anywhere=True):
        if len(call.texts) < 2 or "$" in call.texts[0] or call.texts[1] not in described:
            continue
        exported_for, path = call.texts[:2]
        bases = {entry.base for library in described[path].libraries for entry in library.classes}
        loaders = [loader for base in sorted(bases) for loader in _loading(workspace).get(base, ())]
        asked = sorted({loader.package for loader in loaders})
        if exported_for == package.name and exported_for not in asked:
            yield from _for_itself(package, call, bases, workspace)
        if loaders and exported_for not in asked and not workspace.world.is_package(exported_for):
            fix = Fix(f"export it for '{asked[0]}'", (edits.cmake.write(call, 0, asked[0]),), safe=False)
            yield Finding(
                f"'{path}' is exported for '{exported_for}', which is not a package; "
                f"the loader searches for {names.shorten_list(asked)}",
                call.span(0),
                path,
                first_related(Related("loaded here", loader.span) for loader in loaders),
                fix if len(asked) == 1 else None,
            )


def _for_itself(package: Package, call: Call, bases: Collection[str], workspace: Workspace) -> Iterator[Finding]:
    """Yield the finding for a description that is exported for its own package, for which nothing loads plugins.

    All its base classes belong to one other package.
    """
    owners = {base.partition("::")[0] for base in bases}
    asked = {loader.package for loaders in _loading(workspace).values() for loader in loaders}
    if len(owners) != 1 or package.name in owners or package.name in asked:
        return
    owner = owners.pop()
    if package.declares(owner) and workspace.world.is_package(owner):
        yield Finding(
            f"'{call.texts[1]}' is exported for '{package.name}', but nothing loads its plugins; export it for "
            f"'{owner}', which has the base class",
            call.span(0),
            call.texts[1],
            fix=Fix(f"export it for '{owner}'", (edits.cmake.write(call, 0, owner),), safe=False),
        )


def _builds_libraries(package: Package) -> bool:
    return any(target.kind == "library" and target.sources for target in package.built.products.targets)


_READ_BY_RQT = frozenset({"rqt_gui", "qt_gui"})
"""Tags in <export> of the manifest by which plugins are found. ROS 2 ignores other tags with a plugin attribute."""


def _reads_manifest(package: Package) -> bool:
    """Return whether the manifest exports a description for rqt, which reads it there."""
    exports = package.manifest.exports if package.manifest else ()
    return any(element.tag in _READ_BY_RQT and element.get("plugin") for element in exports)


def _unexported(package: Package, workspace: Workspace, registered: list[Registration]) -> Iterator[Finding]:
    script = package.script
    assert script is not None
    if not registered:
        return
    first, *others = registered
    all_names = {macro.name for macro in registered}
    plugin = next(
        (p for p in script.files.plugin_files if any(c.type in all_names for lib in p.libraries for c in lib.classes)), None
    )
    if _reads_manifest(package):
        return
    if plugin is None and (base := _unloaded_base(registered, workspace)):
        yield Finding(
            f"'{first.name}' is registered, but nothing loads plugins of '{base}'; remove the macro or export a description",
            first.span,
            "pluginlib",
            first_related(Related("also registered here", macro.span) for macro in others),
            severity=Severity.INFO,
        )
        return
    remedy = (
        f"{build.EXPORTING_PLUGINS}(... {plugin.path})" if plugin else f"a plugin description and {build.EXPORTING_PLUGINS}()"
    )
    yield Finding(
        f"'{first.name}' is registered, but no plugin description is exported, so loaders do not find it; add {remedy}",
        first.span,
        plugin.path if plugin else "pluginlib",
        first_related(Related("also registered here", macro.span) for macro in others)
        + ((Related("described here", plugin.span),) if plugin else ()),
        _export(package, plugin) if plugin else None,
        # A source that is not compiled may be unused; in a package without libraries, the library is yet to be added.
        confidence=Confidence.HIGH
        if build.library_registering(package, first) or not _builds_libraries(package)
        else Confidence.MEDIUM,
    )


def _unloaded_base(registered: list[Registration], workspace: Workspace) -> str:
    """Return the base of the registered classes if it is in the workspace and nothing loads its plugins, else ""."""
    bases = {macro.base for macro in registered}
    base = bases.pop()
    owner = base.partition("::")[0]
    return base if not bases and owner in workspace.by_name and base not in _loading(workspace) else ""


def _export(package: Package, plugin: PluginFile) -> Fix | None:
    script = package.script
    bases = {entry.base.partition("::")[0] for library in plugin.libraries for entry in library.classes}
    if script is None or len(bases) != 1 or "" in bases:
        return None
    base = bases.pop()
    if not package.declares(base) and base != package.name:
        return None
    return Fix.of(
        f"export '{plugin.path}'", edits.cmake.at_end(script, f"{build.EXPORTING_PLUGINS}({base} {plugin.path})"), safe=False
    )


def _libraries(package: Package, workspace: Workspace, plugin: PluginFile, registered: list[Registration]) -> Iterator[Finding]:
    for library in plugin.libraries:
        if not library.path:
            yield Finding("<library> without path makes pluginlib loop forever; add the path", library.span, plugin.path)
        else:
            yield from _library(package, plugin, library)
        for entry in library.classes:
            for finding in _class(package, plugin, entry, registered):
                if entry.type in _registered_classes(workspace) and not any(macro.name == entry.type for macro in registered):
                    # The library may link that of the other package: then the class is loaded.
                    message = f"'{entry.type}' is registered in another package; describe it there"
                    yield finding._replace(message=message, confidence=Confidence.MEDIUM)
                else:
                    yield finding


def _library(package: Package, plugin: PluginFile, library: PluginLibrary) -> Iterator[Finding]:
    script = package.script
    assert script is not None
    installed = {_plain(p.path) for p in script.products.installs if not p.source and p.path.endswith((".so", ".a"))}
    built = {target.name for target in script.products.targets if target.kind == "library"}
    name = _plain(library.path)
    if name in installed or "$" in library.path or not built:
        return
    if name in built:
        message = f"the library '{name}' is built, but not installed to lib/"
        # The library may be static, or its file may have another name.
        sure = Confidence.HIGH if build.is_declared_shared(package, name) and library.classes else Confidence.MEDIUM
    else:
        near = names.similar_names(name, sorted(installed | built), 1, 0.8)
        message = f"the package does not build a library '{name}'{names.ask_if_meant(near)}"
        sure = Confidence.HIGH if library.classes else Confidence.MEDIUM  # without classes nothing is loaded
    yield Finding(message, library.span, f"{plugin.path}#{library.path.rpartition('/')[2]}", confidence=sure)


def _plain(path: str) -> str:
    """Return the name of a library from its path: lib/libfoo.so and libfoo are foo."""
    name = path.rpartition("/")[2]
    return name.removesuffix(".so").removesuffix(".a").removesuffix(".dll").removeprefix("lib")


def _class(package: Package, plugin: PluginFile, entry: PluginClass, registered: list[Registration]) -> Iterator[Finding]:
    if not entry.type or not registered:
        return
    same = [macro for macro in registered if macro.name == entry.type]
    if same:
        yield from _base(plugin, entry, same)
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
        hint = f"; the sources register '{alike[0].name}'"
    elif entry.type in package.unwritten_classes:
        verb, hint = "registers or defines", "; remove the entry"
    else:
        hint = f"; add PLUGINLIB_EXPORT_CLASS({entry.type}, {entry.base}) to a source"
    related = first_related(Related("registered here", macro.span) for macro in alike)
    yield Finding(
        f"no source {verb} '{entry.type}'{hint}",
        entry.span,
        f"{plugin.path}#{entry.type}",
        related,
        confidence=Confidence.HIGH if alike or entry.type in package.unwritten_classes else Confidence.MEDIUM,
    )


def _base(plugin: PluginFile, entry: PluginClass, macros: list[Registration]) -> Iterator[Finding]:
    """Compare the described base class of a plugin with those of its registrations."""
    if all(_differ(entry.base, macro.base) for macro in macros):
        yield Finding(
            f"'{entry.type}' is described as '{entry.base}', but registered as '{macros[0].base}'; "
            "write the same base class in both places",
            entry.span,
            f"{plugin.path}#{entry.type}",
            first_related(Related("registered here", macro.span) for macro in macros),
        )


def _differ(described: str, registered: str) -> bool:
    """Return whether two names denote different classes. A name without a namespace, also in ``< >``, matches any namespace."""
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
    summary="plugins are described, exported and built under one name",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
