"""
## What it finds

Plugins of pluginlib that cannot be loaded:

- a class made loadable with `PLUGINLIB_EXPORT_CLASS`, in a package that exports no plugin description;
- a plugin description that is not exported, so not installed either, or exported for what is no package, while a loader of
  the workspace asks for plugins of its classes for another name;
- a class made loadable in a library none of whose classes any of the exported descriptions has; a description of plugins
  for another package that is exported for its own one, for which nothing in the workspace loads plugins;
- a class in the description that no source makes loadable under this very name, or as another class than it says;
- a library that the package does not build or install, or a `<library>` without `path`.

## Why it matters

The loader looks up names: "According to the loaded plugin descriptions the class x with base class type y does not exist", or
"Could not find library". A `<library>` without `path` makes pluginlib loop for ever.

## How to fix it

`pluginlib_export_plugin_description_file(<package of the base class> plugins.xml)`; write type and path as they are in the
sources and in `add_library()`. The fix exports a description whose base classes are all of one package. Where the workspace has
the base class and loads no plugins as that, the macro may be a left-over, and can go: this is an info.

## Limitations

Where the libraries cannot be seen whole, for tests, for nodelets, which ROS 2 does not have, for descriptions that are exported
under a condition only, and for classes in packages that register some with macros of their own. Where a source has the name of
a class that none makes loadable, or another package makes it loadable, the confidence is medium; so it is for a library without
classes. For components that are registered in the way of Crystal, with `rclcpp::Node` as their base: they are no plugins.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator

from ros_lint.api import (
    EXPORTING_PLUGINS,
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
    called,
    cmake_edits,
    hidden,
    is_apart,
    is_meant,
    is_shared_by_words,
    library_of,
    per_workspace,
    relative,
    several,
    similar,
)

_SEEN = Facet.LIBRARIES | Facet.SHARE | Facet.COMPONENTS


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    script = package.script
    if script is None or package.builds_with != "ament_cmake" or hidden(package, _SEEN):
        return
    everything = [made for made in package.registrations if made.kind == "plugin"]
    registered = [made for made in everything if not (is_apart(relative(package, made.span.path)) or _is_no_plugin(made))]
    names = {made.name for made in registered}
    installed = script.installed
    exported = list(called(package, EXPORTING_PLUGINS, anywhere=True))
    if EXPORTING_PLUGINS not in script.calls and not exported:
        yield from _unexported(package, workspace, registered)
        # What descriptions say that nobody is told of does no harm, and many are left over from ROS 1.
        for plugin in script.plugins:
            if plugin.path in installed and not is_apart(plugin.path):
                for finding in _libraries(package, workspace, plugin, everything):
                    yield finding._replace(confidence=Confidence.MEDIUM)
        return
    yield from _for_nobody(package, workspace)
    yield from _undescribed(package, registered)
    found = {
        one.type
        for plugin in script.plugins
        if plugin.path in installed
        for library in plugin.libraries
        for one in library.classes
    }
    for plugin in script.plugins:
        if is_apart(plugin.path):
            continue
        if plugin.path in installed:
            yield from _libraries(package, workspace, plugin, everything)
        elif any(plugin.path in call.texts for call in exported):
            continue  # only under a condition
        elif exported and any(one.type in names - found for library in plugin.libraries for one in library.classes):
            yield Finding(
                f"{plugin.path} is not exported, so its plugins are not found; add {EXPORTING_PLUGINS}(... {plugin.path})",
                plugin.span,
                plugin.path,
                fix=_export(package, plugin),
            )


def _undescribed(package: Package, registered: list[Registration]) -> Iterator[Finding]:
    """Yield the classes that no description has, of those that all of them can be read, exported or not."""
    descriptions = {plugin.path: plugin for plugin in package.built.plugins}
    calls = list(called(package, EXPORTING_PLUGINS, anywhere=True))
    if _reads_manifest(package) or not all(len(call.texts) > 1 and call.texts[1] in descriptions for call in calls):
        return
    classes = [one for plugin in descriptions.values() for library in plugin.libraries for one in library.classes]
    known = {name.rpartition("::")[2] for one in classes for name in (one.type, one.name.replace("/", "::"))}
    # What is beside a class that is described, or in a library for others, may be the base of some, or a copy.
    needed = {library_of(package, made) for made in registered if made.name.rpartition("::")[2] in known}
    needed.update(name for target in package.built.targets for name, _ in target.links)
    for made in registered:
        library = library_of(package, made)
        if library and library not in needed:
            yield Finding(
                f"{made.name} is made loadable, but no exported plugin description has it, so nobody finds it",
                made.span,
                made.name,
                several(Related("this one is exported", call.span(1)) for call in calls),
            )


def _is_no_plugin(made: Registration) -> bool:
    """Whether a class is loadable by what needs no description: nodelets, which ROS 2 does not have, components of Crystal.

    Sources for ROS 1 and 2 lie in one package, and those for ROS 1 are not built here.
    """
    return made.base.startswith("nodelet::") or made.base in ("rclcpp::Node", "rclcpp_lifecycle::LifecycleNode")


@per_workspace
def _made(workspace: Workspace) -> frozenset[str]:
    """Return the classes that some package makes loadable."""
    return frozenset([made.name for package in workspace.packages for made in package.registrations])


@per_workspace
def _loading(workspace: Workspace) -> dict[str, list[PluginLoader]]:
    """Return the loaders of all packages by the class that they load plugins as."""
    found: dict[str, list[PluginLoader]] = {}
    for package in workspace.packages:
        for loader in package.loaders:
            found.setdefault(loader.base, []).append(loader)
    return found


def _for_nobody(package: Package, workspace: Workspace) -> Iterator[Finding]:
    """Compare what a description is exported for with what the loaders of the workspace ask for."""
    script = package.script
    assert script is not None
    described = {plugin.path: plugin for plugin in script.plugins}
    for call in called(package, EXPORTING_PLUGINS, anywhere=True):
        if len(call.texts) < 2 or "$" in call.texts[0] or call.texts[1] not in described:
            continue
        meant, path = call.texts[:2]
        bases = {one.base for library in described[path].libraries for one in library.classes}
        loaders = [loader for base in sorted(bases) for loader in _loading(workspace).get(base, ())]
        asked = sorted({loader.package for loader in loaders})
        if meant == package.name and meant not in asked:
            yield from _for_itself(package, call, bases, workspace)
        if loaders and meant not in asked and not workspace.world.is_package(meant):
            fix = Fix(f"export it for {asked[0]}", (cmake_edits.write(call, 0, asked[0]),), safe=False)
            yield Finding(
                f"{path} is exported for {meant}, which is no package; what loads its plugins asks for {', '.join(asked)}",
                call.span(0),
                path,
                several(Related("loaded here", loader.span) for loader in loaders),
                fix if len(asked) == 1 else None,
            )


def _for_itself(package: Package, call: Call, bases: Collection[str], workspace: Workspace) -> Iterator[Finding]:
    """Yield what is to say of a description that is exported for its own package, for which nothing loads plugins.

    All of its base classes are of one other package.
    """
    owners = {base.partition("::")[0] for base in bases}
    asked = {loader.package for loaders in _loading(workspace).values() for loader in loaders}
    if len(owners) != 1 or package.name in owners or package.name in asked:
        return
    owner = owners.pop()
    if package.declares(owner) and workspace.world.is_package(owner):
        yield Finding(
            f"{call.texts[1]} is exported for {package.name}, and nothing loads plugins for it; their base class is of {owner}",
            call.span(0),
            call.texts[1],
            fix=Fix(f"export it for {owner}", (cmake_edits.write(call, 0, owner),), safe=False),
        )


def _builds_libraries(package: Package) -> bool:
    return any(target.kind == "library" and target.sources for target in package.built.targets)


_READ_BY_RQT = frozenset({"rqt_gui", "qt_gui"})
"""Exports of the manifest whose plugins are found by them. Those of other names say nothing to anybody in ROS 2."""


def _reads_manifest(package: Package) -> bool:
    """Whether a description is exported by the manifest, for those who read it there."""
    exports = package.manifest.exports if package.manifest else ()
    return any(element.tag in _READ_BY_RQT and element.get("plugin") for element in exports)


def _unexported(package: Package, workspace: Workspace, registered: list[Registration]) -> Iterator[Finding]:
    script = package.script
    assert script is not None
    if not registered:
        return
    first, *others = registered
    names = {made.name for made in registered}
    plugin = next((p for p in script.plugins if any(c.type in names for lib in p.libraries for c in lib.classes)), None)
    if _reads_manifest(package):
        return
    if plugin is None and (base := _loaded_by_nobody(registered, workspace)):
        yield Finding(
            f"{first.name} is made loadable, and nothing loads plugins as {base}; take the macro out, or export a description",
            first.span,
            "pluginlib",
            several(Related("also this class", made.span) for made in others),
            severity=Severity.INFO,
        )
        return
    way = f"{EXPORTING_PLUGINS}(... {plugin.path})" if plugin else f"a plugin description and {EXPORTING_PLUGINS}()"
    yield Finding(
        f"{first.name} is made loadable, but no plugin description is exported, so nobody finds it; add {way}",
        first.span,
        plugin.path if plugin else "pluginlib",
        several(Related("also this class", made.span) for made in others)
        + ((Related("it is described here", plugin.span),) if plugin else ()),
        _export(package, plugin) if plugin else None,
        # Sources that nothing compiles may be left over; where there is no library at all, it is yet to be added.
        confidence=Confidence.HIGH if library_of(package, first) or not _builds_libraries(package) else Confidence.MEDIUM,
    )


def _loaded_by_nobody(registered: list[Registration], workspace: Workspace) -> str:
    """Return the base of loadable classes, if it is of a package of the workspace where nothing is seen to load it, else ""."""
    bases = {made.base for made in registered}
    base = bases.pop()
    owner = base.partition("::")[0]
    return base if not bases and owner in workspace.by_name and base not in _loading(workspace) else ""


def _export(package: Package, plugin: PluginFile) -> Fix | None:
    script = package.script
    bases = {one.base.partition("::")[0] for library in plugin.libraries for one in library.classes}
    if script is None or len(bases) != 1 or "" in bases:
        return None
    base = bases.pop()
    if not package.declares(base) and base != package.name:
        return None
    return Fix.of(f"export {plugin.path}", cmake_edits.at_end(script, f"{EXPORTING_PLUGINS}({base} {plugin.path})"), safe=False)


def _libraries(package: Package, workspace: Workspace, plugin: PluginFile, registered: list[Registration]) -> Iterator[Finding]:
    for library in plugin.libraries:
        if not library.path:
            yield Finding("<library> without path makes pluginlib loop for ever; write one", library.span, plugin.path)
        else:
            yield from _library(package, plugin, library)
        for one in library.classes:
            for finding in _class(package, plugin, one, registered):
                if one.type in _made(workspace) and not any(made.name == one.type for made in registered):
                    # In a library that this one may be linked to: then it is loaded all the same.
                    message = f"{one.type} is made loadable in another package; describe it there"
                    yield finding._replace(message=message, confidence=Confidence.MEDIUM)
                else:
                    yield finding


def _library(package: Package, plugin: PluginFile, library: PluginLibrary) -> Iterator[Finding]:
    script = package.script
    assert script is not None
    installed = {_plain(p.path) for p in script.provides if not p.source and p.path.endswith((".so", ".a"))}
    built = {target.name for target in script.targets if target.kind == "library"}
    name = _plain(library.path)
    if name in installed or "$" in library.path or not built:
        return
    if name in built:
        message = f"the library {name} is built, but not installed to lib/"
        # It may be static, or its file may have another name.
        sure = Confidence.HIGH if is_shared_by_words(package, name) and library.classes else Confidence.MEDIUM
    else:
        near = similar(name, sorted(installed | built), 1, 0.8)
        message = f"the package builds no library {name}{is_meant(near)}"
        sure = Confidence.HIGH if library.classes else Confidence.MEDIUM  # of one without classes nothing is loaded
    yield Finding(message, library.span, f"{plugin.path}#{library.path.rpartition('/')[2]}", confidence=sure)


def _plain(path: str) -> str:
    """Return the name of a library by its path: lib/libfoo.so and libfoo are foo."""
    name = path.rpartition("/")[2]
    return name.removesuffix(".so").removesuffix(".a").removesuffix(".dll").removeprefix("lib")


def _class(package: Package, plugin: PluginFile, one: PluginClass, registered: list[Registration]) -> Iterator[Finding]:
    if not one.type or not registered:
        return
    same = [made for made in registered if made.name == one.type]
    if same:
        yield from _base(plugin, one, same)
        return
    last = one.type.rpartition("::")[2]
    described = {each.type for file in package.built.plugins for library in file.libraries for each in library.classes}
    alike = [made for made in registered if made.name.rpartition("::")[2] == last and made.name not in described]
    if alike:
        hint = f"; the sources say {alike[0].name}"
    elif one.type in package.unwritten:
        hint = ", and none has a class that is called so; take it out"
    else:
        hint = f"; add PLUGINLIB_EXPORT_CLASS({one.type}, {one.base}) to one"
    related = several(Related("made loadable here", made.span) for made in alike)
    yield Finding(
        f"no source makes {one.type} loadable{hint}",
        one.span,
        f"{plugin.path}#{one.type}",
        related,
        confidence=Confidence.HIGH if alike or one.type in package.unwritten else Confidence.MEDIUM,
    )


def _base(plugin: PluginFile, one: PluginClass, made: list[Registration]) -> Iterator[Finding]:
    """Compare the class that a plugin is described as with those that it is made loadable as."""
    if all(_differ(one.base, each.base) for each in made):
        yield Finding(
            f"{one.type} is described as a {one.base}, and made loadable as a {made[0].base}; write the same in both places",
            one.span,
            f"{plugin.path}#{one.type}",
            several(Related("made loadable here", each.span) for each in made),
        )


def _differ(described: str, made: str) -> bool:
    """Whether two names are those of two classes. One without a namespace may stand for any; so may each in ``< >``."""
    if "::" not in described or "::" not in made:
        return False
    there, here = (_NAME.findall(name) for name in (described, made))
    return len(there) != len(here) or not all(map(_may_be_same, there, here))


_NAME = re.compile(r"[\w:]+")


def _may_be_same(one: str, other: str) -> bool:
    """Whether two names may be of one class, one of them with fewer of its namespaces."""
    return f"::{one}".endswith(f"::{other}") or f"::{other}".endswith(f"::{one}")


RULE = Rule(
    name="plugin-mismatch",
    code="ROS412",
    summary="a plugin must be described, exported and built under one name",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
