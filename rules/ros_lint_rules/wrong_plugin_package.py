"""
## What it finds

- A plugin description that is exported for a name that is not a package, while a loader of the workspace searches for plugins of
  its base classes under another name.
- A plugin description that is exported for its own package, although nothing in the workspace loads plugins of that package and
  the base classes belong to another package.

## Why it matters

The loader searches for the descriptions that are exported for one package, and finds none: "According to the loaded plugin
descriptions the class x with base class type y does not exist".

## How to fix it

Write `pluginlib_export_plugin_description_file(<package of the base class> plugins.xml)`, as the fix does.

## Limitations

Packages whose libraries or installed files cannot be fully analysed are not reported.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator

from ros_lint.api import Call, Finding, Fix, Package, Related, Rule, Severity, Workspace, build, edits, first_related, names


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    if build.plugins(package) is None:
        return
    described = {plugin.path: plugin for plugin in package.built.files.plugin_files}
    for call in package.calls(build.EXPORTING_PLUGINS, anywhere=True):
        if len(call.texts) < 2 or "$" in call.texts[0] or call.texts[1] not in described:
            continue
        exported_for, path = call.texts[:2]
        bases = {entry.base for library in described[path].libraries for entry in library.classes}
        loaders = [loader for base in sorted(bases) for loader in build.plugin_loaders(workspace).get(base, ())]
        asked = sorted({loader.package for loader in loaders})
        if exported_for == package.name and exported_for not in asked:
            yield from _for_itself(package, call, bases, workspace)
        if loaders and exported_for not in asked and not workspace.world.is_package(exported_for):
            fix = Fix(f"export '{path}' for '{asked[0]}'", (edits.cmake.write(call, 0, asked[0]),), safe=False)
            yield Finding(
                f"'{path}' is exported for '{exported_for}', which is not a package; "
                f"export it for {names.shorten_list(asked)}, where the class loader looks for it",
                call.span(0),
                path,
                first_related(Related(f"plugins for '{loader.package}' are loaded here", loader.span) for loader in loaders),
                fix if len(asked) == 1 else None,
            )


def _for_itself(package: Package, call: Call, bases: Collection[str], workspace: Workspace) -> Iterator[Finding]:
    """Yield the finding for a plugin description that a package exports for itself, although nothing loads its plugins.

    All base classes in the description (``bases``) belong to one other package.
    """
    owners = {base.partition("::")[0] for base in bases}
    asked = {loader.package for loaders in build.plugin_loaders(workspace).values() for loader in loaders}
    if len(owners) != 1 or package.name in owners or package.name in asked:
        return
    owner = owners.pop()
    if package.declares(owner) and workspace.world.is_package(owner):
        yield Finding(
            f"'{call.texts[1]}' is exported for '{package.name}', but nothing loads its plugins; export it for "
            f"'{owner}', which has the base class",
            call.span(0),
            call.texts[1],
            fix=Fix(f"export '{call.texts[1]}' for '{owner}'", (edits.cmake.write(call, 0, owner),), safe=False),
        )


RULE = Rule(
    name="wrong-plugin-package",
    code="ROS426",
    summary="plugin descriptions are exported for the package whose loaders search for them",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
