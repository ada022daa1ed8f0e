"""
## What it finds

A library that is built and not installed, although an installed program or library links it, it is exported with
`ament_export_libraries()`, or it is `SHARED` or a `MODULE` and nothing but programs at run time, plugin loaders or other
packages can use it. Other libraries that are not installed are told with low confidence.

Also a library that is exported with `ament_export_libraries()` and installed to `lib/<package>` instead of `lib`.

## Why it matters

After the build in its own folder everything runs; from the install space nothing starts: "error while loading shared
libraries: libx.so: cannot open shared object file". Packages that find one which exports a library that is not in its `lib`
stop: "exports the library 'x' which couldn't be found".

## How to fix it

`install(TARGETS x ARCHIVE DESTINATION lib LIBRARY DESTINATION lib RUNTIME DESTINATION bin)`. The fix adds this rule. Of a
library with plugins, which nobody links, the export can be taken away instead.

## Limitations

For libraries of tests, for static libraries that are not exported (they become part of what links them), and where something
that cannot be followed may install the library. Of a library that is made of nothing but headers, what links it takes nothing:
on Ubuntu the linker leaves it out (`--as-needed`), so that it is told with medium confidence unless it is exported.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import (
    EXPORTING_PLUGINS,
    HEADERS,
    REGISTERING,
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
    astray,
    called,
    cmake_edits,
    evaluated_name,
    found_names,
    has_header,
    hidden,
    installs_built,
    is_on_request,
    is_shared_by_words,
    library_calls,
    listed_to_install,
    relative,
    several,
)


def check(package: Package, _: Workspace) -> Iterator[Finding]:
    script = package.script
    if script is None or package.builds_with != "ament_cmake" or hidden(package, Facet.LIBRARIES):
        return
    installed = {provided.target for provided in script.provides}
    listed = listed_to_install(package)
    components = {name for call in called(package, *REGISTERING, anywhere=True) for name in _names(package, call.texts[:1])}
    yield from _astray(package)
    for target in script.targets:
        if target.kind != "library" or target.test or not target.sources or target.name in installed | listed | components:
            continue
        if any("OBJECT" in call.texts[1:2] for call in library_calls(package, target.name)):
            continue
        shared = _is_shared(package, target.name)
        loaded = any(relative(package, made.span.path) in target.sources for made in package.registrations)
        hollow = all(source.endswith(HEADERS) for source in target.sources)
        lone = not hollow and _is_lone(package, target, loaded=loaded)
        users = [(name, span) for name, span in _linked_by(script, target.name) if name in installed]
        users = users if shared and not hollow else []
        exported = _exported(package, target.name)
        related = several(Related(f"{name} links it here", span) for name, span in users)
        if exported is not None:
            related += (Related("it is exported here", exported),)
        reason = f", and {users[0][0]} needs it at run time" if users else ", and is exported" if exported else ""
        yield Finding(
            f"the library {target.name} is built, but not installed{reason}; install it to lib",
            target.span,
            target.name,
            related,
            Fix.of(f"install {target.name}", cmake_edits.install_library(script, target.name)),
            Confidence.HIGH if reason or lone else Confidence.MEDIUM if shared else Confidence.LOW,
            None if reason else Severity.WARNING,
        )


def _astray(package: Package) -> Iterator[Finding]:
    """Speak of exported libraries that are installed where ament_cmake_export_libraries does not look for them."""
    loaded = EXPORTING_PLUGINS in package.built.calls
    for name, place in astray(package, (".so", ".a")).items():
        if exported := _exported(package, name):
            yield Finding(
                f"the library {name} is exported, but installed to lib/{package.name}, where find_package() does not look; "
                f"install it to lib{', or take the export away, as plugins are loaded and not linked' if loaded else ''}",
                place.span,
                name,
                (Related("it is exported here", exported),),
                severity=Severity.WARNING,
            )


def _names(package: Package, texts: tuple[str, ...]) -> Iterator[str]:
    yield from (name for text in texts if (name := evaluated_name(package, text)))


def _is_shared(package: Package, name: str) -> bool:
    """Whether the library is a shared one for sure."""
    found = found_names(package, package.built)
    for call in library_calls(package, name):
        kinds = {"STATIC", "OBJECT", "INTERFACE"}.intersection(call.texts)
        return "SHARED" in call.texts or (not kinds and "ament_cmake_ros" in found)
    return False


def _is_lone(package: Package, library: BuildTarget, *, loaded: bool) -> bool:
    """Whether a library of every build is shared by its own words, and nothing links it that stays in the build folder as well.

    With plugins or components in it, it is ``loaded`` at run time, whoever links it. If a header of its own is installed, it
    is for others, and a test that links it tests it. If nothing of what is built is installed, that says nothing of programs.
    """
    script = package.script
    assert script is not None
    if is_on_request(package, library) or not is_shared_by_words(package, library.name):
        return False
    installed = {provided.target for provided in script.provides if provided.target}
    left = {target.name for target in script.targets if target.kind == "executable" and target.name not in installed}
    if not installs_built(script):
        left.clear()
    tests = {target.name for target in script.targets if target.test}
    left = left - tests if has_header(library, [each.path for each in script.provides]) else left | tests
    return loaded or not any(
        linked == library.name for target in script.targets if target.name in left for linked, _ in target.links
    )


def _linked_by(script: BuildScript, library: str) -> Iterator[tuple[str, Span]]:
    for target in script.targets:
        yield from ((target.name, span) for name, span in target.links if name == library and not target.test)


def _exported(package: Package, library: str) -> Span | None:
    for call in called(package, "ament_export_libraries", anywhere=True):
        if library in _names(package, call.texts) and not call.blocks:
            return call.place
    return None


RULE = Rule(
    name="uninstalled-library",
    code="ROS415",
    summary="a library that is needed after the installation must be installed",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
