"""
## What it finds

Messages, services and actions in `msg/`, `srv/` and `action/` of a package that `rosidl_generate_interfaces()` is not given,
while it is given others. And those of an `ament_python` package that says in `package.xml` that it generates interfaces:
nothing is generated from them at all. And, in other packages of the workspace, what includes, imports by name or has in an
interface of its own one that the package it should be from does not generate, and has no file of.

## Why it matters

No code is generated from such a file: "fatal error: robot/msg/state.hpp: No such file or directory", "cannot import name
'State' from 'robot.msg'", and `ros2 interface show` does not know it.

## How to fix it

Add the file to the call, or remove it. The fix adds it below another of the same folder, where these are written out. rosidl
refuses names like `motor_state.msg`: such a file has to be called `MotorState.msg` first. What an `ament_python` package
defines has to move to one of `ament_cmake`. Of what is used and not there, correct the name, or add the file.

## When it keeps silent

For packages that generate nothing, for files in other folders, and where the list of files cannot be followed. So it does of
copies that were left lying, such as `State copy.msg` or `State.old.msg`. What a comment in a CMake file has where a list had it
was set aside, and is told of with medium confidence, as is a call that stands under a condition. Of uses it does not speak in
files that may be dead, where the import or include is optional, where any folder of the package offers what is named in another
way, or two packages of the workspace have the name, and in packages with a file that cannot be read.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from typing import NamedTuple

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
    did_you_mean,
    interface_names,
    per_package,
    place_of,
    several,
    similar,
)

_GENERATE = "rosidl_generate_interfaces"
_KINDS = {"msg": ("msg", "idl"), "srv": ("srv", "idl"), "action": ("action", "idl")}
"""Suffixes of interfaces, by folder."""
_SAYS_SO = ("rosidl_interface_packages", "rosidl_default_generators")
_HEADER = re.compile(r"(?P<maker>\w+)/(?P<kind>msg|srv|action)/(?P<name>(?!rosidl_)(?!\w*__)\w+)(?P<end>\.h(?:pp)?)")
"""The header of an interface, and none that it is made of."""


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    script = package.script
    if package.builds_with == "ament_python":
        yield from _of_python(package)
    yield from _of_users(package, workspace)
    if script is None or package.builds_with != "ament_cmake" or package.hidden(Facet.INTERFACES):
        return
    calls = list(called(package, _GENERATE, anywhere=True))
    if not calls or not script.interfaces:
        return
    for file in package.files:
        interface = _interface(file) if file.count("/") == 1 else ""
        name = interface.partition("/")[2]
        if interface not in script.interfaces and name.isidentifier():
            wanted = "" if file.endswith(".idl") or interface_names.is_message(name) else interface_names.camel(name)
            yield _finding(package, calls, file, wanted, aside=interface in script.set_aside)


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


class _Used(NamedTuple):
    """An interface of another package in a place that needs it."""

    maker: str
    kind: str
    """msg, srv or action; "" where that does not show."""
    name: str
    """As written, without the end of a header."""
    header: str
    """How the name of a header ends, "" for others."""
    place: Span


def _of_users(package: Package, workspace: Workspace) -> Iterator[Finding]:
    """Speak of what a package uses of others that generate interfaces, and not these ones."""
    if not package.builds_with.startswith("ament_") or workspace.unread(package):
        return
    told: dict[tuple[str, str, str, str], list[Span]] = {}
    for used in _used(package):
        told.setdefault(used[:-1], []).append(used.place)
    for what, places in told.items():
        used = _Used(*what, places[0])
        makers = workspace.by_name.get(used.maker, ())
        if len(makers) != 1 or (wrong := _wrong(used, makers[0], workspace)) is None:
            continue
        made = next(called(makers[0], _GENERATE, anywhere=True), None)
        yield Finding(
            wrong,
            places[0],
            f"{used.maker}/{used.kind or 'msg'}/{used.name}",
            several(
                [
                    *([Related("what is generated", made.place)] if made else ()),
                    *(Related("here, too", place) for place in places[1:]),
                ]
            ),
            severity=Severity.ERROR,
        )


def _used(package: Package) -> Iterator[_Used]:
    """Yield what a package surely uses that others should generate."""
    needed = [use for use in package.uses if use.sure and not use.optional]
    for use in needed:
        if use.via == "interface":
            yield _Used(use.package, "", use.name.rpartition("/")[2], "", use.span)
        elif use.via == "include" and (match := _HEADER.fullmatch(use.name)) and match["maker"] == use.package:
            yield _Used(use.package, match["kind"], match["name"], match["end"], use.span)
    modules = {use.span: use.package for use in needed if use.via == "import"}
    for imported in package.imported_types:
        maker, kind, name = imported.name.split("/")
        if modules.get(imported.module) == maker and name[0].isupper():
            yield _Used(maker, kind, name, "", imported.span)


def _wrong(used: _Used, maker: Package, workspace: Workspace) -> str | None:
    """Return what is wrong about a use, None if nothing is, or nobody can tell."""
    generated = maker.built.interfaces
    if not generated or maker.builds_with != "ament_cmake" or maker.hidden(Facet.INTERFACES):
        return None
    form = interface_names.snake if used.header else str
    there = _there(maker, workspace)[used.kind, bool(used.header)]
    if used.name in there or (not used.header and any(used.name.startswith(f"{name}_") for name in there)):
        return None
    by_hand = f"{used.maker}/{used.kind}/{used.name}{used.header}" if used.header else f"{used.kind}/__init__.py"
    if any(f"/{file}".endswith(f"/{by_hand}") for file in maker.files):
        return None
    named = f"{used.kind or 'msg'}/{used.name}{used.header}"
    elsewhere = next((each for each in generated if _form(each, form).endswith(f"/{used.name}")), "")
    if elsewhere:
        return f"{used.maker} generates no {named}; there is {_form(elsewhere, form)}{used.header}"
    near = similar(used.name, sorted(there))
    way_out = did_you_mean([f"{each}{used.header}" for each in near]) or "; correct the name, or add the file"
    return f"{used.maker} generates no {named}{way_out}"


@per_package
def _there(maker: Package, workspace: Workspace) -> Mapping[tuple[str, bool], frozenset[str]]:
    """Return the interfaces of a package by their kind, "" for any, and by whether they are written as in headers.

    Those of files from which nothing is generated count, too: another finding speaks of them.
    """
    left_over = [each for file in maker.files if (each := _interface(file)) and each not in maker.built.set_aside]
    everything = dict.fromkeys([*maker.built.interfaces, *left_over])
    names = {kind: [each.partition("/")[2] for each in everything if each.startswith(kind)] for kind in ("", *_KINDS)}
    return {
        (kind, header): frozenset(map(interface_names.snake, plain) if header else plain)
        for kind, plain in names.items()
        for header in (False, True)
    }


def _form(interface: str, form: Callable[[str], str]) -> str:
    kind, _, name = interface.partition("/")
    return f"{kind}/{form(name)}"


def _interface(file: str) -> str:
    """Return the interface that a file has in it, as ``msg/Name``, "" if it has none."""
    folder, _, name = file.rpartition("/")
    stem, _, suffix = name.rpartition(".")
    kind = folder.rpartition("/")[2]
    return f"{kind}/{stem}" if suffix in _KINDS.get(kind, ()) else ""


def _here(package: Package, file: str) -> Related:
    return Related("this file", place_of(package, file))


def _finding(package: Package, calls: list[Call], file: str, wanted: str, *, aside: bool) -> Finding:
    """``wanted``: what the file has to be called before anything can be generated from it, "" if it is.

    ``aside``: a comment has it where a list had it, which is mostly meant so.
    """
    way_out = f"rosidl wants it to be called {wanted}" if wanted else "add it, or remove it"
    return Finding(
        f"{file} is not given to {_GENERATE}(), so nothing is generated from it; {way_out}",
        calls[0].place,
        file,
        (_here(package, file),),
        None if wanted or aside else _fix(calls, file),
        Confidence.MEDIUM if aside or calls[0].blocks else Confidence.HIGH,
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
