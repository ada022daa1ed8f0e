"""
## What it finds

Messages, services and actions in `msg/`, `srv/` and `action/` of a package that `rosidl_generate_interfaces()` is not given,
while it is given others. And those of an `ament_python` package that says in `package.xml` that it generates interfaces:
nothing is generated from them at all.

## Why it matters

No code is generated from such a file: "fatal error: robot/msg/state.hpp: No such file or directory", "cannot import name
'State' from 'robot.msg'", and `ros2 interface show` does not know it.

## How to fix it

Add the file to the call, or remove it. The fix adds it below another of the same folder, where these are written out. rosidl
refuses names like `motor_state.msg`: such a file has to be called `MotorState.msg` first. What an `ament_python` package
defines has to move to one of `ament_cmake`.

## When it keeps silent

For packages that generate nothing, for files in other folders, and where the list of files cannot be followed. So it does of
copies that were left lying, such as `State copy.msg` or `State.old.msg`, and of what a comment in a CMake file has where a list
had it: it was set aside. A call that stands under a condition is told of with medium confidence.
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
    Workspace,
    called,
    place_of,
    several,
)

_GENERATE = "rosidl_generate_interfaces"
_KINDS = {"msg": ("msg", "idl"), "srv": ("srv", "idl"), "action": ("action", "idl")}
"""Suffixes of interfaces, by folder."""
_SAYS_SO = ("rosidl_interface_packages", "rosidl_default_generators")
_NAME = re.compile(r"[A-Z][A-Za-z0-9]*")
"""What rosidl takes for the name of a message; it asks nothing of those of files in IDL."""


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    script = package.script
    if package.builds_with == "ament_python":
        yield from _of_python(package)
    if script is None or package.builds_with != "ament_cmake" or package.hidden(Facet.INTERFACES):
        return
    calls = list(called(package, _GENERATE, anywhere=True))
    if not calls or not script.interfaces:
        return
    listed = {*script.interfaces, *script.set_aside}
    for file in package.files:
        folder, _, name = file.partition("/")
        stem, _, suffix = name.rpartition(".")
        if suffix not in _KINDS.get(folder, ()) or "/" in name or f"{folder}/{stem}" in listed:
            continue
        if stem.isidentifier():
            yield _finding(package, calls, file, "" if suffix == "idl" or _NAME.fullmatch(stem) else _camel(stem))


def _of_python(package: Package) -> Iterator[Finding]:
    """Speak of all interfaces of a package at the tag that says that it generates them."""
    depends = package.manifest.depends if package.manifest else ()
    tag = next((depend for depend in depends if depend.name in _SAYS_SO), None)
    parts = [(file, *file.rpartition("/")) for file in package.files]
    found = [file for file, folder, _, name in parts if name.rpartition(".")[2] == folder.rpartition("/")[2] in _KINDS]
    if tag is None or not found:
        return
    others = f" and {len(found) - 1} more" if len(found) > 1 else ""
    yield Finding(
        f"nothing is generated from {found[0]}{others}: ament_python does not do that, so put {'them' if others else 'it'} "
        "into a package of ament_cmake",
        tag.span,
        found[0],
        several(_here(package, file) for file in found),
    )


def _here(package: Package, file: str) -> Related:
    return Related("this file", place_of(package, file))


def _camel(stem: str) -> str:
    """Return a name as rosidl wants it."""
    return "".join(word[:1].upper() + word[1:] for word in stem.split("_"))


def _finding(package: Package, calls: list[Call], file: str, wanted: str) -> Finding:
    """``wanted``: what the file has to be called before anything can be generated from it, "" if it is."""
    way_out = f"rosidl wants it to be called {wanted}" if wanted else "add it, or remove it"
    return Finding(
        f"{file} is not given to {_GENERATE}(), so nothing is generated from it; {way_out}",
        calls[0].place,
        file,
        (_here(package, file),),
        None if wanted else _fix(calls, file),
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
