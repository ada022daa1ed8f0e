"""
## What it finds

An include directory below `include/` that the package exports, but to which it installs nothing:

- `install(TARGETS ... EXPORT ... INCLUDES DESTINATION include/robot)` with a set of targets that the package exports;
- `ament_export_include_directories(include/robot)`.

## Why it matters

A package that links such a target stops at "Imported target includes non-existent path". With
`ament_export_include_directories()`, CMake only warns, and the compiler does not find the headers.

## How to fix it

Install the headers to the exported folder, or export the folder to which they are installed. If other packages do not need
headers, remove the export.

## Limitations

Not reported:

- Packages whose build script cannot be fully analysed, and folders whose name contains a variable other than the project name.
- Packages that generate code: the generators install headers.
- A folder that any `install()` names as its destination, because an empty folder exists as well.
- Calls in conditions, loops and functions, and targets that the package does not certainly export.
- Headers in `include/` of which none is installed: see `uninstalled-headers`.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import Call, Facet, Finding, Package, Rule, Severity, Span, Workspace, build


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    script = package.script
    if script is None or package.builds_with != "ament_cmake" or build.stops_early(script) or script.hides(Facet.LIBRARIES):
        return
    if any("generate_" in name for name in script.commands.names) or _are_uninstalled(package, workspace):
        return
    folders = {folder for call in package.calls("install", anywhere=True) for folder in _destinations(package, call)}
    if None in folders:
        return
    paths = [*(f"{folder}/" for folder in folders), *(provided.path for provided in script.products.installs)]
    reported: set[str] = set()
    for folder, span, severity in (*_of_targets(package), *_of_ament(package)):
        if folder in reported or any(path.startswith(f"{folder}/") for path in paths):
            continue
        reported.add(folder)
        effect = (
            "CMake stops in packages that link its targets"
            if severity is Severity.ERROR
            else "packages that use this package do not find headers"
        )
        yield Finding(
            f"'{folder}' is exported as an include directory, but nothing is installed there, so {effect}; "
            "install the headers there, or export the folder that contains them",
            span,
            folder,
            severity=severity,
        )


def _are_uninstalled(package: Package, workspace: Workspace) -> bool:
    headers = build.own_headers(package, workspace)
    return headers is not None and not headers.installed


def _destinations(package: Package, call: Call) -> Iterator[str | None]:
    """Yield the folders to which a command installs files, None for an unknown folder.

    INCLUDES DESTINATION is left out, because it exports a folder and installs nothing.
    """
    texts = call.texts
    for index, word in enumerate(texts[:-1]):
        if word == "DESTINATION" and texts[index - 1] != "INCLUDES":
            yield _folder(package, texts[index + 1])


def _folder(package: Package, text: str) -> str | None:
    """Return a folder relative to the install prefix, None if it is unknown or absolute."""
    name = build.evaluated_name(package, text.replace("${CMAKE_INSTALL_INCLUDEDIR}", "include"))
    return None if name is None or name.startswith("/") else name.rstrip("/")


def _of_targets(package: Package) -> Iterator[tuple[str, Span, Severity]]:
    """Yield the folders that exported targets have as INCLUDES DESTINATION, each with its span and the severity of a finding."""
    exported = {export.export_set for export in package.built.exports.targets if export.reaches_dependents}
    for call in package.calls("install", anywhere=True):
        texts = call.texts
        if call.blocks or texts[:1] != ("TARGETS",) or "EXPORT" not in texts[:-1] or "INCLUDES" not in texts[:-2]:
            continue
        at = texts.index("INCLUDES") + 2
        if build.evaluated_name(package, texts[texts.index("EXPORT") + 1]) in exported and texts[at - 1] == "DESTINATION":
            yield from _below_include(package, call, at, Severity.ERROR)


def _of_ament(package: Package) -> Iterator[tuple[str, Span, Severity]]:
    for call in package.calls("ament_export_include_directories"):
        if call.args and not call.blocks:
            yield from _below_include(package, call, 0, Severity.WARNING)


def _below_include(package: Package, call: Call, at: int, severity: Severity) -> Iterator[tuple[str, Span, Severity]]:
    """Yield the folder that the argument at index ``at`` names, with its span and ``severity``, if it is below include/."""
    folder = _folder(package, call.texts[at]) if at < len(call.args) else None
    if folder is not None and folder.startswith("include/"):
        yield folder, call.span(at), severity


RULE = Rule(
    name="missing-include-directory",
    code="ROS430",
    summary="exported include directories are installed",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    package=check,
)
