"""
## What it finds

Messages, services and actions in `msg/`, `srv/` and `action/` of a package that `rosidl_generate_interfaces()` is not given,
while it is given others.

## Why it matters

No code is generated from such a file: "fatal error: robot/msg/state.hpp: No such file or directory", "cannot import name
'State' from 'robot.msg'", and `ros2 interface show` does not know it.

## How to fix it

Add the file to the call, or remove it. The fix adds it below another of the same folder, where these are written out.

## When it keeps silent

For packages that generate nothing, for files in other folders, and where the list of files cannot be followed. Nothing could
be generated from a file whose name rosidl refuses, such as `State copy.msg`: it is a copy that was left lying. A call that
stands under a condition is told of with medium confidence.
"""

from __future__ import annotations

import re
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
    Span,
    Workspace,
    called,
)

_GENERATE = "rosidl_generate_interfaces"
_KINDS = {"msg": ("msg", "idl"), "srv": ("srv", "idl"), "action": ("action", "idl")}
"""Suffixes of interfaces, by folder."""
_NAME = re.compile(r"[A-Z][A-Za-z0-9]*")
"""What rosidl takes for the name of a message; it asks nothing of those of files in IDL."""


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    script = package.script
    if script is None or package.builds_with != "ament_cmake" or package.hidden(Facet.INTERFACES):
        return
    calls = list(called(package, _GENERATE, anywhere=True))
    if not calls or not script.interfaces:
        return
    for file in package.files:
        folder, _, name = file.partition("/")
        stem, _, suffix = name.rpartition(".")
        if suffix not in _KINDS.get(folder, ()) or "/" in name or f"{folder}/{stem}" in script.interfaces:
            continue
        if suffix == "idl" or _NAME.fullmatch(stem):
            yield _finding(package, calls, file)


def _finding(package: Package, calls: list[Call], file: str) -> Finding:
    base = f"{package.path}/" if package.path else ""
    return Finding(
        f"{file} is not given to {_GENERATE}(), so nothing is generated from it",
        calls[0].place,
        file,
        (Related("this file", Span(f"{base}{file}", 1, 1, 1, 1)),),
        _fix(calls, file),
        Confidence.MEDIUM if calls[0].blocks else Confidence.HIGH,
    )


def _fix(calls: list[Call], file: str) -> Fix | None:
    """Return how to add a file below the last one of its folder, None where none is written out."""
    folder = f"{file.partition('/')[0]}/"
    for call in calls:
        at = max((index for index, text in enumerate(call.texts) if text.startswith(folder)), default=None)
        if at is not None:
            span = call.span(at)
            quote = '"' if span.end_column - span.column == len(call.texts[at]) + 2 else ""
            gap = " " if at and span.line == call.span(at - 1).line else "\n" + " " * (span.column - 1)
            return Fix(f"generate {file}", (Edit(span.end(), f"{gap}{quote}{file}{quote}"),), safe=False)
    return None


RULE = Rule(
    name="ungenerated-interface",
    code="ROS313",
    summary="an interface file must be given to the generators",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
