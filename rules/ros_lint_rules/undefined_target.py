"""
## What it finds

CMake targets that a CMakeLists.txt installs, links, or gives properties to, and that nothing defines.

## Why it matters

CMake stops: "install TARGETS given target "x" which does not exist", or "Cannot specify link libraries for target "x" which
is not built by this project".

## How to fix it

Correct the name, or define the target before. Where one defined target has nearly the same name, the fix takes that.

## When it keeps silent

Where a command, a name or an included file cannot be followed; under conditions; in functions and loops.
"""

from __future__ import annotations

import difflib
from collections.abc import Iterator

from ros_lint.api import (
    ANYTHING,
    Call,
    Edit,
    Finding,
    Fix,
    Package,
    Rule,
    Severity,
    Span,
    Workspace,
    called,
    evaluated_name,
    hidden,
)

_USERS = (
    "ament_target_dependencies",
    "target_compile_definitions",
    "target_compile_features",
    "target_compile_options",
    "target_include_directories",
    "target_link_libraries",
    "target_sources",
)
_INSTALL_WORDS = frozenset(
    {"EXPORT", "DESTINATION", "ARCHIVE", "LIBRARY", "RUNTIME", "INCLUDES", "OBJECTS", "COMPONENT", "PERMISSIONS", "OPTIONAL",
     "PUBLIC_HEADER", "PRIVATE_HEADER", "RESOURCE", "CONFIGURATIONS", "FRAMEWORK", "BUNDLE", "NAMELINK_SKIP", "FILE_SET",
     "EXCLUDE_FROM_ALL"}
)  # fmt: skip
_MAKERS = ("add_custom_target", "rosidl_generate_interfaces", "ament_vendor", "add_executable", "add_library")


def check(package: Package, _: Workspace) -> Iterator[Finding]:
    script = package.script
    if script is None or package.builds_with not in ("ament_cmake", "cmake"):
        return
    names = sorted({target.name for target in script.targets})
    if hidden(package, ANYTHING):
        return
    defined = set(names)
    for call in called(package, *_MAKERS, anywhere=True):
        defined.update(call.texts[:1])
        defined.add((evaluated_name(package, call.texts[0]) if call.args else None) or "")
    reported: set[str] = set()
    for call in called(package, *_USERS, "install"):
        for index in _targets(call):
            name = evaluated_name(package, call.texts[index])
            if name is None or call.blocks or name in defined or "::" in name or name in reported:
                continue
            reported.add(name)
            yield _finding(f"{call.name}() of {name}, which is no target", name, names, call.span(index))


def _targets(call: Call) -> Iterator[int]:
    """Yield the indexes of the arguments that are names of targets."""
    if call.name != "install":
        yield from range(len(call.args[:1]))
    elif call.texts[:1] == ("TARGETS",):
        for index, text in enumerate(call.texts[1:], 1):
            if text in _INSTALL_WORDS:
                return
            yield index


def _finding(message: str, name: str, names: list[str], span: Span) -> Finding:
    near = difflib.get_close_matches(name, names, 1, 0.8)
    fix = None
    if near:
        message += f"; is {near[0]} meant?"
        if span.line == span.end_line and span.end_column - span.column == len(name):
            fix = Fix(f"write {near[0]}", (Edit(span, near[0]),), safe=False)
    return Finding(message, span, name, fix=fix)


RULE = Rule(
    name="undefined-target",
    code="ROS305",
    summary="a target that is used must be defined",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
