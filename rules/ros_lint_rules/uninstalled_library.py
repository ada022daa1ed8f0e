"""
## What it finds

A library that is built but not installed, although

- an installed program or library links it,
- it is exported with `ament_export_libraries()`, or
- it is `SHARED` or a `MODULE` that only installed programs, plugin loaders or other packages can use.

Also a library that is exported with `ament_export_libraries()` and installed to `lib/<package>` instead of `lib`.

This rule reports both because other packages and programs find the library in neither case.

## Why it matters

Programs run in the build folder, but not from the install space: "error while loading shared libraries: libx.so: cannot open
shared object file". Packages that find a package whose exported library is not in `lib` stop: "exports the library 'x' which
couldn't be found".

## How to fix it

`install(TARGETS x ARCHIVE DESTINATION lib LIBRARY DESTINATION lib RUNTIME DESTINATION bin)`. The fix adds this rule. For a
library of plugins, which is not linked, the export can be removed instead.

## Limitations

Not reported:

- Libraries of tests.
- A part of the build script that cannot be evaluated may install the library.

Reported with medium confidence:

- Shared libraries with headers as their only sources, unless exported: on Ubuntu the linker drops them (`--as-needed`).
- Shared libraries that programs or tests in the build folder use.

Reported with low confidence: other libraries that are not installed, such as static libraries that are not exported, because
they become part of the targets that link them.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import (
    BuildScript,
    BuildTarget,
    Confidence,
    Facet,
    Finding,
    Fix,
    Package,
    Related,
    Rule,
    Severity,
    Span,
    Workspace,
    build,
    dependencies,
    edits,
    files,
    first_related,
)


def check(package: Package, _: Workspace) -> Iterator[Finding]:
    script = package.script
    if script is None or package.builds_with != "ament_cmake" or build.opaque_except_undefined_targets(package, Facet.LIBRARIES):
        return
    installed = {provided.target for provided in script.products.installs}
    listed = build.install_arguments(package)
    components = {name for call in package.calls(*build.REGISTERING, anywhere=True) for name in _names(package, call.texts[:1])}
    yield from _in_other_folder(package)
    for target in script.products.targets:
        if target.kind != "library" or target.test or not target.sources or target.name in installed | listed | components:
            continue
        if any("OBJECT" in call.texts[1:2] for call in build.library_calls(package, target.name)):
            continue
        shared = _is_shared(package, target.name)
        loaded = any(package.relative(made.span.path) in target.sources for made in package.registrations)
        headers_only = all(source.endswith(files.HEADERS) for source in target.sources)
        for_others = not headers_only and _is_for_others(package, target, loaded=loaded)
        users = [(name, span) for name, span in _linked_by(script, target.name) if name in installed]
        users = users if shared and not headers_only else []
        exported = _exported(package, target.name)
        related = first_related(Related(f"linked by '{name}' here", span) for name, span in users)
        if exported is not None:
            related += (Related("exported here", exported),)
        reason = f", although '{users[0][0]}' needs it at run time" if users else ", although it is exported" if exported else ""
        yield Finding(
            f"the library '{target.name}' is built, but not installed{reason}; install it to lib",
            target.span,
            target.name,
            related,
            Fix.of(f"install '{target.name}'", edits.cmake.install_library(script, target.name)),
            Confidence.HIGH if reason or for_others else Confidence.MEDIUM if shared else Confidence.LOW,
            None if reason else Severity.WARNING,
        )


def _in_other_folder(package: Package) -> Iterator[Finding]:
    """Yield findings for exported libraries that are installed to lib/<package> or outside of lib.

    ament_export_libraries() looks for libraries in lib (ament_cmake_export_libraries-extras.cmake.in).
    """
    loaded = build.EXPORTING_PLUGINS in package.built.commands.names
    for name, place in build.libraries_elsewhere(package, (".so", ".a")).items():
        if exported := _exported(package, name):
            folder = place.path.rpartition("/")[0]
            yield Finding(
                f"the library '{name}' is exported, but installed to {folder}, where find_package() does not look; "
                f"install it to lib{', or remove the export, because plugins are loaded, not linked' if loaded else ''}",
                place.span,
                name,
                (Related("exported here", exported),),
                severity=Severity.WARNING,
            )


def _names(package: Package, texts: tuple[str, ...]) -> Iterator[str]:
    yield from (name for text in texts if (name := build.evaluated_name(package, text)))


def _is_shared(package: Package, name: str) -> bool:
    """Return whether the library is certainly shared."""
    packages = dependencies.names_searched(package, package.built)
    for call in build.library_calls(package, name):
        kinds = {"STATIC", "OBJECT", "INTERFACE"}.intersection(call.texts)
        return "SHARED" in call.texts or (not kinds and "ament_cmake_ros" in packages)
    return False


def _is_for_others(package: Package, library: BuildTarget, *, loaded: bool) -> bool:
    """Return whether a shared library is only useful if it is installed.

    It is declared SHARED, every build has it, and no uninstalled program or test links it, with these exceptions:

    - If the library is ``loaded`` at run time, because it has plugins or components, links do not matter.
    - If its header is installed, tests may link it.
    - If the package installs nothing that it builds, its programs may link it.
    """
    script = package.script
    assert script is not None
    if build.is_optional_target(package, library) or not build.is_declared_shared(package, library.name):
        return False
    installed = {provided.target for provided in script.products.installs if provided.target}
    uninstalled = {
        target.name for target in script.products.targets if target.kind == "executable" and target.name not in installed
    }
    if not build.installs_built(script):
        uninstalled.clear()
    tests = {target.name for target in script.products.targets if target.test}
    public = build.has_header(library, [provided.path for provided in script.products.installs])
    uninstalled = uninstalled - tests if public else uninstalled | tests
    return loaded or not any(
        linked == library.name for target in script.products.targets if target.name in uninstalled for linked, _ in target.links
    )


def _linked_by(script: BuildScript, library: str) -> Iterator[tuple[str, Span]]:
    for target in script.products.targets:
        yield from ((target.name, span) for name, span in target.links if name == library and not target.test)


def _exported(package: Package, library: str) -> Span | None:
    for call in package.calls("ament_export_libraries", anywhere=True):
        if library in _names(package, call.texts) and not call.blocks:
            return call.name_span
    return None


RULE = Rule(
    name="uninstalled-library",
    code="ROS415",
    summary="libraries that are needed after installation are installed",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
