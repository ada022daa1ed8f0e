"""
## What it finds

A library that is built but not installed, although

- an installed program or library links it,
- it is exported with `ament_export_libraries()`, or
- it is `SHARED` or a `MODULE` that only installed programs, plugin loaders or other packages can use.

Also reported: a library that is exported with `ament_export_libraries()` and installed to `lib/<package>` instead of `lib`.

One rule reports both, because other packages and programs find the library in neither case.

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

from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

from ros_lint.api import (
    BuildScript,
    BuildTarget,
    Call,
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


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    script = package.script
    if script is None or package.builds_with != "ament_cmake" or build.opaque_except_undefined_targets(package, Facet.LIBRARIES):
        return
    installation = _installation(script)
    installed = installation.targets
    listed = build.install_arguments(package)
    calls = build.library_calls(package, workspace)
    components = {name for call in package.calls(*build.REGISTERING, anywhere=True) for name in _names(package, call.texts[:1])}
    exports = _exports(package)
    links = _links(script)
    shared_by_default = "ament_cmake_ros" in dependencies.names_searched(package, script)
    registering = {package.relative(made.span.path) for made in package.registrations}
    yield from _in_other_folder(package, exports)
    named = installed | listed | components
    for target in script.products.targets:
        if target.kind != "library" or target.test or not target.sources or target.name in named:
            continue
        if any("OBJECT" in call.texts[1:2] for call in calls.get(target.name, ())):
            continue
        shared = _is_shared(calls.get(target.name, ()), by_default=shared_by_default)
        loaded = not registering.isdisjoint(target.sources)
        headers_only = all(source.endswith(files.HEADERS) for source in target.sources)
        for_others = not headers_only and _is_for_others(
            package, workspace, target, installation, links.get(target.name, ()), loaded=loaded
        )
        users = [(name, span) for name, span, test in links.get(target.name, ()) if name in installed and not test]
        users = users if shared and not headers_only else []
        exported = exports.get(target.name)
        related = first_related(Related(f"'{target.name}' is linked by '{name}' here", span) for name, span in users)
        if exported is not None:
            related += (Related(f"'{target.name}' is exported here", exported),)
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


def _in_other_folder(package: Package, exports: Mapping[str, Span]) -> Iterator[Finding]:
    """Yield findings for exported libraries that are installed to lib/<package> or outside of lib.

    ament_export_libraries() looks for libraries in lib (ament_cmake_export_libraries-extras.cmake.in).
    """
    loaded = build.EXPORTING_PLUGINS in package.built.commands.names
    for name, place in build.libraries_elsewhere(package, (".so", ".a")).items():
        if exported := exports.get(name):
            folder = place.path.rpartition("/")[0]
            yield Finding(
                f"the library '{name}' is exported, but installed to {folder}, where find_package() does not look; "
                f"install it to lib{', or remove the export, because plugins are loaded, not linked' if loaded else ''}",
                place.span,
                name,
                (Related(f"'{name}' is exported here", exported),),
                severity=Severity.WARNING,
            )


def _names(package: Package, texts: tuple[str, ...]) -> Iterator[str]:
    yield from (name for text in texts if (name := build.evaluated_name(package, text)))


def _is_shared(calls: Sequence[Call], *, by_default: bool) -> bool:
    """Return whether the first of ``calls``, the commands that create a library, certainly creates a shared library."""
    if not calls:
        return False
    kinds = {"STATIC", "OBJECT", "INTERFACE"}.intersection(calls[0].texts)
    return "SHARED" in calls[0].texts or (not kinds and by_default)


class _Installation(NamedTuple):
    """What a build script installs, and which targets it leaves in the build folder."""

    targets: frozenset[str]
    """Names of the installed targets."""
    headers: frozenset[str]
    """File stems of the installed headers."""
    tests: frozenset[str]
    """Names of the targets for tests."""
    in_build_folder: frozenset[str]
    """Names of the programs that are not installed; empty if the package installs nothing that it builds."""


def _installation(script: BuildScript) -> _Installation:
    installs = script.products.installs
    installed = frozenset([provided.target for provided in installs])
    programs = [target.name for target in script.products.targets if target.kind == "executable"]
    return _Installation(
        installed,
        frozenset([build.stem(provided.path) for provided in installs if provided.path.endswith(files.HEADERS)]),
        frozenset([target.name for target in script.products.targets if target.test]),
        frozenset(programs).difference(installed - {""}) if build.installs_built(script) else frozenset(),
    )


def _is_for_others(
    package: Package,
    workspace: Workspace,
    library: BuildTarget,
    installation: _Installation,
    users: Sequence[_User],
    *,
    loaded: bool,
) -> bool:
    """Return whether a shared library is only useful if it is installed.

    Such a library is declared SHARED, is part of every build, and is linked by no uninstalled program or test. Exceptions:

    - A library that is ``loaded`` at run time, because it has plugins or components, may be linked by any target.
    - A library with an installed header may be linked by tests.
    - If the package installs nothing that it builds, programs may link the library.
    """
    if build.is_optional_target(package, library) or not build.is_declared_shared(package, workspace, library.name):
        return False
    public = not installation.headers.isdisjoint(map(build.stem, library.sources))
    uninstalled, tests = installation.in_build_folder, installation.tests
    uninstalled = uninstalled - tests if public else uninstalled | tests
    return loaded or uninstalled.isdisjoint([user.target for user in users])


class _User(NamedTuple):
    """A target that links a library."""

    target: str
    span: Span
    test: bool


def _links(script: BuildScript) -> Mapping[str, Sequence[_User]]:
    """Return the targets that link a library, by the name of the library."""
    links: dict[str, list[_User]] = {}
    for target in script.products.targets:
        for name, span in target.links:
            links.setdefault(name, []).append(_User(target.name, span, target.test))
    return links


def _exports(package: Package) -> Mapping[str, Span]:
    """Return the place of the first unconditional ament_export_libraries() for each library, by the name of the library."""
    exports: dict[str, Span] = {}
    for call in package.calls("ament_export_libraries", anywhere=True):
        if not call.blocks:
            for name in _names(package, call.texts):
                exports.setdefault(name, call.name_span)
    return exports


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
