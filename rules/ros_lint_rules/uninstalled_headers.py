"""
## What it finds

A package that exports its include folder (`ament_export_include_directories()`, or targets with
`ament_export_targets()`) or a library (`ament_export_libraries()`), and does not install the headers in `include/`. Packages
that install a library and no headers are told with medium confidence, so are those that export plugins or components, which
nobody links; those with programs only with low confidence.

## Why it matters

Packages that depend on it find the library and not its headers: "fatal error: robot/robot.hpp: No such file or directory".

## How to fix it

`install(DIRECTORY include/ DESTINATION include/${PROJECT_NAME})`, with the same folder in
`target_include_directories(... $<INSTALL_INTERFACE:include/${PROJECT_NAME}>)`. The fix installs to the folder that is
exported.

## When it keeps silent

For packages without `include/`, and where something that cannot be followed may install the headers.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import (
    Call,
    Confidence,
    Edit,
    Facet,
    Finding,
    Fix,
    Package,
    Related,
    Rule,
    Severity,
    Workspace,
    called,
    evaluated_name,
    hidden,
)

_LOADED = (
    "pluginlib_export_plugin_description_file", "rclcpp_components_register_node", "rclcpp_components_register_nodes",
)  # fmt: skip
_LINKED = ("ament_export_interfaces", "ament_export_libraries", "ament_export_targets")
_HEADERS = (".h", ".hh", ".hpp", ".hxx", ".inl", ".ipp", ".tpp")


def check(package: Package, _: Workspace) -> Iterator[Finding]:
    script = package.script
    if script is None or package.builds_with != "ament_cmake" or hidden(package, Facet.LIBRARIES):
        return
    headers = [file for file in package.files if file.startswith("include/") and file.endswith(_HEADERS)]
    places = [provided.path for provided in script.provides]
    if not headers or script.end is None or any(path.endswith(_HEADERS) for path in places):
        return
    exports = _exports(package)
    library = any(path.startswith("lib/lib") for path in places)
    loaded = any(True for _ in called(package, *_LOADED, anywhere=True))
    linked = library and not loaded and any(not call.blocks for call in called(package, *_LINKED))
    sure = Confidence.HIGH if exports or linked else Confidence.MEDIUM if library else Confidence.LOW
    yield Finding(
        f"the headers in include/ ({headers[0].rpartition('/')[2]} ...) are not installed{', but exported' if exports else ''}",
        script.end,
        "include/",
        tuple(Related("exported here", call.place) for call in exports),
        _fix(package, exports),
        sure,
        None if exports and library else Severity.WARNING,
    )


def _exports(package: Package) -> list[Call]:
    return [
        call
        for call in called(package, "ament_export_include_directories", anywhere=True)
        if not call.blocks and any((evaluated_name(package, text) or "").startswith("include") for text in call.texts)
    ]


def _fix(package: Package, exports: list[Call]) -> Fix | None:
    script = package.script
    assert script is not None
    if script.end is None:
        return None
    folder = exports[0].texts[0].strip("/") if exports else "include"
    line = f"install(DIRECTORY include/ DESTINATION {folder})\n"
    return Fix("install the headers", (Edit(script.end, line),), safe=bool(exports))


RULE = Rule(
    name="uninstalled-headers",
    code="ROS416",
    summary="headers that are exported must be installed",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
