"""
## What it finds

A package that exports its include folder (`ament_export_include_directories()`, or targets with
`ament_export_targets()`) or a library (`ament_export_libraries()`), and does not install the headers in `include/`; also one
of which another package of the workspace includes a header. Packages that install a library and no headers are told with
medium confidence, so are those that export plugins or components, or build plugins of Gazebo, which nobody links; those with
programs only with low confidence, unless they export a folder that is not there once they are installed.

Also a package that installs its headers and tells nobody where they are, while another package of the workspace finds it with
`find_package()` and includes them: libraries and dependencies that it exports, and a set of targets that it does not, do not
say so.

And headers that another package of the workspace includes by a folder which they lose when they are installed, as by
`install(DIRECTORY include/robot/ DESTINATION include)`, and those that get one too many: without a slash at its end the folder
itself is installed, so that `install(DIRECTORY include DESTINATION include)` puts `robot/robot.hpp` into `include/include`.

## Why it matters

Packages that depend on it find the library and not its headers: "fatal error: robot/robot.hpp: No such file or directory".

## How to fix it

`install(DIRECTORY include/ DESTINATION include/${PROJECT_NAME})`, with the same folder in
`target_include_directories(... $<INSTALL_INTERFACE:include/${PROJECT_NAME}>)`. The fix installs to the folder that is
exported. Where there are only programs, take the export away: headers without a library serve nobody; so it may be where the
library is not installed, or is loaded, as plugins and components are, and nobody links it. To export them:
`ament_export_targets()` with an `install(TARGETS ... EXPORT ...)`, or `ament_export_include_directories()` and
`ament_export_libraries()`.

## Limitations

For packages without `include/`, and where something that cannot be followed may install the headers. About who includes them,
if that package adds a folder outside of its own to its include directories by hand, and for its tests.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence

from ros_lint.api import (
    EXPORTING_PLUGINS,
    HEADERS,
    REGISTERING,
    BuildScript,
    Call,
    Confidence,
    Facet,
    Finding,
    Fix,
    Package,
    Provided,
    Related,
    Rule,
    Severity,
    Use,
    Workspace,
    called,
    cmake_edits,
    evaluated_name,
    found_names,
    has_extras,
    hidden,
    is_apart,
    per_workspace,
    relative,
    several,
)

_LINKED = ("ament_export_interfaces", "ament_export_libraries", "ament_export_targets")
_FOLDERS = ("include_directories", "target_include_directories")
_EXPORTS = (
    "ament_auto_package", "ament_export_include_directories", "ament_export_interfaces", "ament_export_targets",
    "configure_package_config_file", "export", "install_basic_package_files", "rosidl_", "write_basic_package_version_file",
)  # fmt: skip
"""How the names begin of commands that may tell others of a package where its headers are."""


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    script = package.script
    if script is None or package.builds_with != "ament_cmake" or hidden(package, Facet.LIBRARIES):
        return
    headers = [file for file in package.files if file.startswith("include/") and file.endswith(HEADERS)]
    places = [provided.path for provided in script.provides]
    if not headers or script.end is None:
        return
    names = {_name(file) for file in headers}
    installed = any(
        provided.path.endswith(HEADERS) and (provided.source or _name(provided.path) in names) for provided in script.provides
    )
    takers = _wanted(workspace).get(package.name, ())
    wanted = [(other, use) for other, use in takers if any(file.endswith(f"/{use.name}") for file in headers)]
    if installed:
        yield from _misplaced(package, wanted)
        yield from _doubled(package, script, wanted)
    if installed and _tells(package):
        return
    if installed:
        yield from _unexported(package, wanted)
        return
    exports = _exports(package)
    library = any(path.startswith("lib/lib") for path in places)
    loaded = _is_loaded(package, script)
    linked = library and not loaded and any(not call.blocks for call in called(package, *_LINKED))
    if exports and not wanted and script.targets and all(target.kind == "executable" for target in script.targets):
        yield from _for_nobody(headers, exports)
        return
    sure = Confidence.HIGH if exports or linked or wanted else Confidence.MEDIUM if library else Confidence.LOW
    perhaps_for_nobody = bool(exports) and (loaded or not library) and not wanted
    why = ", but exported" if exports else f", and {wanted[0][0].name} includes them" if wanted else ""
    yield Finding(
        f"the headers in include/ ({_name(headers[0])} ...) are not installed{why}; "
        f"install them to {_place(exports)}{', or take the export away' if perhaps_for_nobody else ''}",
        script.end,
        "include/",
        (*(Related("exported here", call.place) for call in exports), *_included_here(wanted)),
        _fix(package, exports),
        sure,
        None if (exports and library and not perhaps_for_nobody) or wanted else Severity.WARNING,
    )


_GAZEBO = re.compile(r"(?:gazebo|gz|ignition)(?!.*_msgs$)", re.IGNORECASE)
"""What a package finds to build plugins of Gazebo."""


def _is_loaded(package: Package, script: BuildScript) -> bool:
    """Whether a library of a package may be one that is loaded, and that nobody links."""
    if any(True for _ in called(package, EXPORTING_PLUGINS, *REGISTERING, anywhere=True)):
        return True
    return any(_GAZEBO.match(name) for name in found_names(package, script))


def _name(path: str) -> str:
    return path.rpartition("/")[2]


def _misplaced(package: Package, wanted: list[tuple[Package, Use]]) -> Iterator[Finding]:
    """Speak of headers that other packages include by a folder which is not there where they are installed."""
    provided = {each.source: each for each in package.built.provides if each.source.endswith(HEADERS) and not each.conditional}
    paths = [each.path for each in package.built.provides]
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
            f"{file} is installed to {folder}, and {other.name} includes it as {use.name}, which nobody finds there; "
            f"install it to {folder}/{use.name.rpartition('/')[0]}",
            provided[file].span,
            file,
            _included_here([(other, use) for _, other, use in lost]),
        )


def _doubled(package: Package, script: BuildScript, wanted: list[tuple[Package, Use]]) -> Iterator[Finding]:
    """Speak of headers that are installed with the folder include/ around them, below the one that is looked into."""
    own = [each for each in script.provides if each.source.startswith("include/") and each.source.endswith(HEADERS)]
    first = next((each for each in own if each.path.startswith("include/")), None)
    if first is None or has_extras(package) or not all(_is_doubled(each) for each in own):
        return
    folder = first.path.removesuffix(first.source.removeprefix("include")).removeprefix("/")
    words = (re.sub(r"\$\{\w*PROJECT_NAME\}", script.name, text) for call in script.written for text in call.texts)
    if any(folder in word for word in words):
        return  # it is named as the folder to look into
    library = any(each.path.startswith("lib/lib") for each in script.provides)
    exported = library and bool(_exports(package) or any(True for _ in called(package, *_LINKED)))
    needed = bool(wanted) or (exported and not _is_loaded(package, script))
    places = ((call, at) for call in called(package, "install", anywhere=True) for at in range(len(call.args)))
    call, at = next(((call, at) for call, at in places if call.span(at) == first.span), (None, 0))
    fix = Fix.of("install what is in the folder", cmake_edits.write(call, at, f"{call.texts[at]}/")) if call else None
    yield Finding(
        f"the headers in include/ ({_name(first.source)} ...) are installed to {folder}, where nobody looks for them; "
        "write include/ with a slash at the end",
        first.span,
        "include/",
        _included_here(wanted),
        fix,
        Confidence.HIGH if needed else Confidence.MEDIUM if exported else Confidence.LOW,
        None if needed else Severity.WARNING,
    )


def _is_doubled(provided: Provided) -> bool:
    """Whether a file of include/ is installed below another folder with all of its path, in every build."""
    return provided.path.startswith("include/") and provided.path.endswith(f"/{provided.source}") and not provided.conditional


def _for_nobody(headers: Sequence[str], exports: Sequence[Call]) -> Iterator[Finding]:
    """Speak of a package of programs that exports a folder: who finds it is told of a folder that is not there."""
    first, *others = exports
    yield Finding(
        f"the headers in include/ ({_name(headers[0])} ...) are exported and not installed, and there is no library "
        "to use them with; take the export away",
        first.place,
        "include/",
        several(Related("exported here, too", call.place) for call in others),
        severity=Severity.WARNING,
    )


def _unexported(package: Package, wanted: list[tuple[Package, Use]]) -> Iterator[Finding]:
    """Speak of a package that tells nobody of its headers, if another one looks for them in what it exports."""
    takers = [(other, use) for other, use in wanted if other.script and package.name in found_names(other, other.script)]
    if takers and package.script and package.script.end:
        libraries = "" if any(True for _ in called(package, "ament_export_libraries")) else " and ament_export_libraries()"
        what = "no include directories" if any(name.startswith("ament_export_") for name in package.script.calls) else "nothing"
        yield Finding(
            f"{package.name} exports {what}, and {takers[0][0].name} includes its headers; add "
            f"ament_export_include_directories(){libraries}, or ament_export_targets()",
            package.script.end,
            package.name,
            _included_here(takers),
        )


def _tells(package: Package) -> bool:
    """Whether a package may tell others where its headers are."""
    script = package.script
    if script is None or has_extras(package) or package.opaque or any(name.startswith(_EXPORTS) for name in script.calls):
        return True
    return any(call.texts[:1] == ("EXPORT",) and _is_read(package, call) for call in called(package, "install", anywhere=True))


def _is_read(package: Package, call: Call) -> bool:
    """Whether a command can be part of the build: not if it is in the CMakeLists.txt of a folder that nobody enters."""
    folder, _, name = relative(package, call.path).rpartition("/")
    return not folder or name != "CMakeLists.txt" or folder in package.built.entered


def _included_here(wanted: list[tuple[Package, Use]]) -> tuple[Related, ...]:
    return several(Related(f"included in {other.name}", use.span) for other, use in wanted)


@per_workspace
def _wanted(workspace: Workspace) -> Mapping[str, list[tuple[Package, Use]]]:
    """Return who includes headers of other packages, and where, by package."""
    found: dict[str, list[tuple[Package, Use]]] = {}
    for package in workspace.packages:
        if package.script is None or _reaches_out(package):
            continue
        for use in package.uses:
            others = workspace.by_name.get(use.package, ()) if use.via == "include" and use.sure and not use.optional else ()
            if others and use.package != package.name and not is_apart(relative(package, use.span.path)):
                found.setdefault(use.package, []).append((package, use))
    return found


def _reaches_out(package: Package) -> bool:
    """Whether a package looks for headers in folders outside of it: a path that it writes out leads there."""
    calls = called(package, *_FOLDERS, anywhere=True)
    return any("../" in text or text.startswith("/") or "ENV{" in text for call in calls for text in call.texts)


def _exports(package: Package) -> list[Call]:
    return [
        call
        for call in called(package, "ament_export_include_directories", anywhere=True)
        if not call.blocks and any((evaluated_name(package, text) or "").startswith("include") for text in call.texts)
    ]


def _place(exports: list[Call]) -> str:
    """Return where headers are looked for: in the folder that is exported, if one is."""
    return exports[0].texts[0].strip("/") if exports else "include"


def _fix(package: Package, exports: list[Call]) -> Fix | None:
    script = package.script
    assert script is not None
    line = f"install(DIRECTORY include/ DESTINATION {_place(exports)})"
    return Fix.of("install the headers", cmake_edits.at_end(script, line), safe=bool(exports))


RULE = Rule(
    name="uninstalled-headers",
    code="ROS416",
    summary="headers for other packages must be installed and exported",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
