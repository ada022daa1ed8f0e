"""
## What it finds

A package that does not install the headers in `include/`, although

- it exports its include folder (`ament_export_include_directories()`, or targets with `ament_export_targets()`),
- it exports a library (`ament_export_libraries()`), or
- another package of the workspace includes one of the headers.

## Why it matters

Packages that depend on this one find the library but not its headers: "fatal error: robot/robot.hpp: No such file or
directory".

## How to fix it

`install(DIRECTORY include/ DESTINATION include/${PROJECT_NAME})`, with the same folder in `target_include_directories(...
$<INSTALL_INTERFACE:include/${PROJECT_NAME}>)`. The fix installs to the folder that is exported.

Remove the export instead if the package only has programs, because headers without a library are useless to others. Removing it
may also be right if the library is not installed, or is only loaded, as plugins and components are.

## Limitations

Not reported:

- Packages without `include/`.
- A part of the build script that cannot be evaluated may install the headers.
- Includes in a package that adds a folder outside of itself to its include directories by hand, and includes in tests.

Reported with medium confidence: packages that install a library without headers but export nothing, that export plugins or
components, or that build plugins of Gazebo, because other packages do not link these.

Reported with low confidence: packages that only install programs, unless they export a folder that does not exist after
installation.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from ros_lint.api import (
    Call,
    Confidence,
    Finding,
    Fix,
    Package,
    Related,
    Rule,
    Severity,
    Workspace,
    build,
    edits,
    first_related,
)


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    headers = build.own_headers(package, workspace)
    if headers is None or headers.installed:
        return
    exports, targets = headers.exports, package.built.products.targets
    if exports and not headers.included and targets and all(target.kind == "executable" for target in targets):
        yield from _export_without_library(headers.files, exports)
    else:
        yield _uninstalled(package, headers)


def _uninstalled(package: Package, headers: build.OwnHeaders) -> Finding:
    exports, includes, library = headers.exports, headers.included, headers.library
    exports_library = any(not call.blocks for call in package.calls(*build.EXPORTING_LIBRARIES))
    linked = library and not headers.loaded and exports_library
    sure = Confidence.HIGH if exports or linked or includes else Confidence.MEDIUM if library else Confidence.LOW
    may_be_needless = bool(exports) and (headers.loaded or not library) and not includes
    why = ", although they are exported" if exports else f", although '{includes[0][0].name}' includes them" if includes else ""
    return Finding(
        f"the headers in 'include/' ('{_name(headers.files[0])}' ...) are not installed{why}; "
        f"install them to {_place(exports)}{', or remove the export' if may_be_needless else ''}",
        headers.insertion,
        "include/",
        (*(Related("the headers are exported here", call.name_span) for call in exports), *build.related_includes(includes)),
        _fix(package, exports),
        sure,
        None if (exports and library and not may_be_needless) or includes else Severity.WARNING,
    )


def _name(path: str) -> str:
    return path.rpartition("/")[2]


def _export_without_library(headers: Sequence[str], exports: Sequence[Call]) -> Iterator[Finding]:
    """Yield the finding for exported headers that are not installed, in a package with programs but without libraries."""
    first, *others = exports
    yield Finding(
        f"the headers in 'include/' ('{_name(headers[0])}' ...) are exported but not installed, and there is no library "
        "to use them with; remove the export",
        first.name_span,
        "include/",
        first_related(Related("the headers are also exported here", call.name_span) for call in others),
        severity=Severity.WARNING,
    )


def _place(exports: Sequence[Call]) -> str:
    """Return the folder to which headers should be installed: the exported folder, "include" if none is exported."""
    return exports[0].texts[0].strip("/") if exports else "include"


def _fix(package: Package, exports: Sequence[Call]) -> Fix | None:
    script = package.script
    assert script is not None
    line = f"install(DIRECTORY include/ DESTINATION {_place(exports)})"
    return Fix.of("install the headers in 'include/'", edits.cmake.at_end(script, line), safe=bool(exports))


RULE = Rule(
    name="uninstalled-headers",
    code="ROS416",
    summary="headers for other packages are installed",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
