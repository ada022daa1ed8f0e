"""
## What it finds

A package that installs the headers in `include/` but does not export their folder, while another package of the workspace finds
it with `find_package()` and includes them. Exporting libraries and dependencies is not enough, and neither is a set of targets
that is not exported.

## Why it matters

Packages that depend on this one do not find its headers: "fatal error: robot/robot.hpp: No such file or directory".

## How to fix it

Use `ament_export_targets()` with an `install(TARGETS ... EXPORT ...)`, or `ament_export_include_directories()` and
`ament_export_libraries()`.

## Limitations

Not reported:

- Packages without `include/`, and packages that cannot be fully analysed.
- Includes in a package that adds a folder outside of itself to its include directories by hand, and includes in tests.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import Call, Finding, Package, Rule, Severity, Workspace, build, dependencies

_EXPORTS = (
    "ament_auto_package", "ament_export_include_directories", "ament_export_interfaces", "ament_export_targets",
    "configure_package_config_file", "export", "install_basic_package_files", "rosidl_", "write_basic_package_version_file",
)  # fmt: skip
"""Prefixes of commands that may export the folder of the headers."""


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    headers = build.own_headers(package, workspace)
    if headers is not None and headers.installed and not _may_export(package):
        yield from _unexported(package, headers.included)


def _unexported(package: Package, wanted: build.Includes) -> Iterator[Finding]:
    """Yield a finding for unexported headers of this package that other packages include after find_package()."""
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
            build.related_includes(includes),
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


RULE = Rule(
    name="unexported-headers",
    code="ROS429",
    summary="packages export the folder of headers that other packages include",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    package=check,
)
