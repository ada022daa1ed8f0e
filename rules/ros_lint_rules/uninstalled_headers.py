"""
## What it finds

- A package that does not install the headers in `include/`, although it exports its include folder
  (`ament_export_include_directories()`, or targets with `ament_export_targets()`) or a library (`ament_export_libraries()`), or
  although another package of the workspace includes one of the headers.
- A package that installs headers but does not export their folder, while another package of the workspace finds it with
  `find_package()` and includes them. Exporting libraries and dependencies is not enough, and neither is a set of targets that
  is not exported.
- Headers that are installed without the folder by which another package of the workspace includes them, as by
  `install(DIRECTORY include/robot/ DESTINATION include)`.
- Headers that are installed with an additional folder: without a slash at the end, `install(DIRECTORY include DESTINATION
  include)` puts `robot/robot.hpp` into `include/include`.

## Why it matters

Packages that depend on this one find the library but not its headers: "fatal error: robot/robot.hpp: No such file or
directory".

## How to fix it

`install(DIRECTORY include/ DESTINATION include/${PROJECT_NAME})`, with the same folder in `target_include_directories(...
$<INSTALL_INTERFACE:include/${PROJECT_NAME}>)`. The fix installs to the folder that is exported.

Remove the export instead if the package only has programs, because headers without a library are useless to others. The same
may apply if the library is not installed, or is only loaded, as plugins and components are.

To export installed headers, use `ament_export_targets()` with an `install(TARGETS ... EXPORT ...)`, or
`ament_export_include_directories()` and `ament_export_libraries()`.

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

import re
from collections.abc import Iterator, Mapping, Sequence

from ros_lint.api import (
    BuildScript,
    Call,
    Confidence,
    Facet,
    Finding,
    Fix,
    InstalledFile,
    Package,
    Related,
    Rule,
    Severity,
    Use,
    Workspace,
    build,
    cached_by_workspace,
    dependencies,
    edits,
    files,
    first_related,
)

_LINKED = ("ament_export_interfaces", "ament_export_libraries", "ament_export_targets")
_FOLDERS = ("include_directories", "target_include_directories")
_EXPORTS = (
    "ament_auto_package", "ament_export_include_directories", "ament_export_interfaces", "ament_export_targets",
    "configure_package_config_file", "export", "install_basic_package_files", "rosidl_", "write_basic_package_version_file",
)  # fmt: skip
"""Prefixes of commands that may export the folder of the headers."""


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    script = package.script
    if script is None or package.builds_with != "ament_cmake" or build.opaque_except_undefined_targets(package, Facet.LIBRARIES):
        return
    headers = [file for file in package.files if file.startswith("include/") and file.endswith(files.HEADERS)]
    places = [provided.path for provided in script.products.installs]
    if not headers or script.commands.insertion is None:
        return
    names = {_name(file) for file in headers}
    installed = any(
        provided.path.endswith(files.HEADERS) and (provided.source or _name(provided.path) in names)
        for provided in script.products.installs
    )
    includes = _includes(workspace).get(package.name, ())
    wanted = [(other, use) for other, use in includes if any(file.endswith(f"/{use.name}") for file in headers)]
    if installed:
        yield from _misplaced(package, wanted)
        yield from _doubled(package, script, wanted)
    if installed and _may_export(package):
        return
    if installed:
        yield from _unexported(package, wanted)
        return
    exports = _exports(package)
    library = any(path.startswith("lib/lib") for path in places)
    loaded = _is_loaded(package, script)
    linked = library and not loaded and any(not call.blocks for call in package.calls(*_LINKED))
    if (
        exports
        and not wanted
        and script.products.targets
        and all(target.kind == "executable" for target in script.products.targets)
    ):
        yield from _export_without_library(headers, exports)
        return
    sure = Confidence.HIGH if exports or linked or wanted else Confidence.MEDIUM if library else Confidence.LOW
    may_be_needless = bool(exports) and (loaded or not library) and not wanted
    why = ", although they are exported" if exports else f", although '{wanted[0][0].name}' includes them" if wanted else ""
    yield Finding(
        f"the headers in include/ ({_name(headers[0])} ...) are not installed{why}; "
        f"install them to {_place(exports)}{', or remove the export' if may_be_needless else ''}",
        script.commands.insertion,
        "include/",
        (*(Related("exported here", call.name_span) for call in exports), *_included_here(wanted)),
        _fix(package, exports),
        sure,
        None if (exports and library and not may_be_needless) or wanted else Severity.WARNING,
    )


_GAZEBO = re.compile(r"(?:gazebo|gz|ignition)(?!.*_msgs$)", re.IGNORECASE)
"""Names of packages that a package finds to build plugins of Gazebo."""


def _is_loaded(package: Package, script: BuildScript) -> bool:
    """Return whether a library of the package may be loaded at run time instead of linked."""
    if any(True for _ in package.calls(build.EXPORTING_PLUGINS, *build.REGISTERING, anywhere=True)):
        return True
    return any(_GAZEBO.match(name) for name in dependencies.names_searched(package, script))


def _name(path: str) -> str:
    return path.rpartition("/")[2]


def _misplaced(package: Package, wanted: list[tuple[Package, Use]]) -> Iterator[Finding]:
    """Yield the headers that other packages include by a folder which is missing where they are installed."""
    installed = [file for file in package.built.products.installs if file.source.endswith(files.HEADERS) and not file.conditional]
    provided = {file.source: file for file in installed}
    paths = [file.path for file in package.built.products.installs]
    lost = [
        (file, other, use)
        for other, use in wanted
        for file in [f"include/{use.name}"]
        if file in provided and "/" in use.name and not any(path.endswith(f"/{use.name}") for path in paths)
    ]
    if lost:
        (file, other, use), *_ = lost
        folder = provided[file].path.rpartition("/")[0]
        yield Finding(
            f"'{file}' is installed to {folder}, so '{other.name}' cannot include it as '{use.name}'; "
            f"install it to {folder}/{use.name.rpartition('/')[0]}",
            provided[file].span,
            file,
            _included_here([(other, use) for _, other, use in lost]),
        )


def _doubled(package: Package, script: BuildScript, wanted: list[tuple[Package, Use]]) -> Iterator[Finding]:
    """Yield the headers that are installed with their folder include/, below the folder that compilers search."""
    own = [
        file for file in script.products.installs if file.source.startswith("include/") and file.source.endswith(files.HEADERS)
    ]
    first = next((file for file in own if file.path.startswith("include/")), None)
    if first is None or build.has_extras(package) or not all(_is_doubled(file) for file in own):
        return
    folder = first.path.removesuffix(first.source.removeprefix("include")).removeprefix("/")
    words = (re.sub(r"\$\{\w*PROJECT_NAME\}", script.project.name, text) for call in script.commands.calls for text in call.texts)
    if any(folder in word for word in words):
        return  # the script names it, probably as an include directory
    library = any(file.path.startswith("lib/lib") for file in script.products.installs)
    exported = library and bool(_exports(package) or any(True for _ in package.calls(*_LINKED)))
    needed = bool(wanted) or (exported and not _is_loaded(package, script))
    places = ((call, at) for call in package.calls("install", anywhere=True) for at in range(len(call.args)))
    call, at = next(((call, at) for call, at in places if call.span(at) == first.span), (None, 0))
    fix = Fix.of("install the contents of the folder", edits.cmake.write(call, at, f"{call.texts[at]}/")) if call else None
    yield Finding(
        f"the headers in include/ ({_name(first.source)} ...) are installed to {folder}, where compilers do not find them; "
        "write include/ with a slash at the end",
        first.span,
        "include/",
        _included_here(wanted),
        fix,
        Confidence.HIGH if needed else Confidence.MEDIUM if exported else Confidence.LOW,
        None if needed else Severity.WARNING,
    )


def _is_doubled(provided: InstalledFile) -> bool:
    """Return whether a file of include/ is installed with its whole path below another folder, in every build."""
    return provided.path.startswith("include/") and provided.path.endswith(f"/{provided.source}") and not provided.conditional


def _export_without_library(headers: Sequence[str], exports: Sequence[Call]) -> Iterator[Finding]:
    """Yield the export of a missing folder by a package that has programs only."""
    first, *others = exports
    yield Finding(
        f"the headers in include/ ({_name(headers[0])} ...) are exported but not installed, and there is no library "
        "to use them with; remove the export",
        first.name_span,
        "include/",
        first_related(Related("also exported here", call.name_span) for call in others),
        severity=Severity.WARNING,
    )


def _unexported(package: Package, wanted: list[tuple[Package, Use]]) -> Iterator[Finding]:
    """Yield the missing export of headers that a package includes which finds this one."""
    includes = [
        (other, use) for other, use in wanted if other.script and package.name in dependencies.names_searched(other, other.script)
    ]
    if includes and package.script and package.script.commands.insertion:
        libraries = "" if any(True for _ in package.calls("ament_export_libraries")) else " and ament_export_libraries()"
        what = (
            "no include directories"
            if any(name.startswith("ament_export_") for name in package.script.commands.names)
            else "nothing"
        )
        yield Finding(
            f"'{package.name}' exports {what}, although '{includes[0][0].name}' includes its headers; add "
            f"ament_export_include_directories(){libraries}, or ament_export_targets()",
            package.script.commands.insertion,
            package.name,
            _included_here(includes),
        )


def _may_export(package: Package) -> bool:
    """Return whether the package may export the folder of its headers."""
    script = package.script
    if (
        script is None
        or build.has_extras(package)
        or package.opaque
        or any(name.startswith(_EXPORTS) for name in script.commands.names)
    ):
        return True
    return any(call.texts[:1] == ("EXPORT",) and _is_read(package, call) for call in package.calls("install", anywhere=True))


def _is_read(package: Package, call: Call) -> bool:
    """Return whether a command can be part of the build: not in a CMakeLists.txt that no add_subdirectory() reads."""
    folder, _, name = package.relative(call.path).rpartition("/")
    return not folder or name != "CMakeLists.txt" or folder in package.built.cmake.subdirectories


def _included_here(wanted: list[tuple[Package, Use]]) -> tuple[Related, ...]:
    return first_related(Related(f"included in '{other.name}'", use.span) for other, use in wanted)


@cached_by_workspace
def _includes(workspace: Workspace) -> Mapping[str, list[tuple[Package, Use]]]:
    """Return the includes of headers of other packages, by the name of the package that is included."""
    includes: dict[str, list[tuple[Package, Use]]] = {}
    for package in workspace.packages:
        if package.script is None or _searches_outside(package):
            continue
        for use in package.uses:
            others = workspace.by_name.get(use.package, ()) if use.via == "include" and use.certain and not use.optional else ()
            if others and use.package != package.name and not files.is_auxiliary(package.relative(use.span.path)):
                includes.setdefault(use.package, []).append((package, use))
    return includes


def _searches_outside(package: Package) -> bool:
    """Return whether an include directory of the package is a path that leads outside of it."""
    calls = package.calls(*_FOLDERS, anywhere=True)
    return any("../" in text or text.startswith("/") or "ENV{" in text for call in calls for text in call.texts)


def _exports(package: Package) -> list[Call]:
    return [
        call
        for call in package.calls("ament_export_include_directories", anywhere=True)
        if not call.blocks and any((build.evaluated_name(package, text) or "").startswith("include") for text in call.texts)
    ]


def _place(exports: list[Call]) -> str:
    """Return the folder to install headers to: the exported folder, if there is one."""
    return exports[0].texts[0].strip("/") if exports else "include"


def _fix(package: Package, exports: list[Call]) -> Fix | None:
    script = package.script
    assert script is not None
    line = f"install(DIRECTORY include/ DESTINATION {_place(exports)})"
    return Fix.of("install the headers", edits.cmake.at_end(script, line), safe=bool(exports))


RULE = Rule(
    name="uninstalled-headers",
    code="ROS416",
    summary="headers for other packages are installed and exported",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
