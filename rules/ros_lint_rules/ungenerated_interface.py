"""
## What it finds

Messages, services and actions in `msg/`, `srv/` and `action/` of a package that `rosidl_generate_interfaces()` is not given,
while it is given others. And those of an `ament_python` package that says in `package.xml` that it generates interfaces:
nothing is generated from them at all.

And the reverse: what a package includes, imports by name or has in an interface of its own, and the package that it should
be from does not have: itself, another one of the workspace, or one that is released. Or one that generates nothing at all.
`Header header` in a definition means a `Header` of the same package, and not that of `std_msgs`.

## Why it matters

No code is generated from such a file: "fatal error: robot/msg/state.hpp: No such file or directory", "cannot import name
'State' from 'robot.msg'", and `ros2 interface show` does not know it.

## How to fix it

Add the file to the call, or remove it. The fix adds it below another of the same folder, where these are written out. rosidl
refuses names like `motor_state.msg`: such a file has to be called `MotorState.msg` first. What an `ament_python` package
defines has to move to one of `ament_cmake`. Of what is used and not there, correct the name, or add the file.

## Limitations

For packages that generate nothing, unless others import from them or have it in interfaces, for files in other folders, and
where the list of files cannot be followed. So it does of copies that were left lying, such as `State copy.msg` or
`State.old.msg`. What a comment in a CMake file has where a list had it was set aside, and is told of with medium confidence,
as is a call that stands under a condition. Of uses it does not speak in files that may be dead, where the import or include
is optional, where any folder of the package offers what is named in another way, or two packages of the workspace have the
name, and in packages with a file that cannot be read.

Of a released package only where all of its interfaces are known. Where nobody said which distribution is meant, none that has
it may have the interface, and another one is called nearly so: else a newer version may have it. The confidence is medium
where the workspace lists further repositories, which may bring a package of the same name.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from functools import cache
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
    few,
    generated_from,
    interface_names,
    per_package,
    place_of,
    relative,
    several,
    similar,
)

_GENERATE = "rosidl_generate_interfaces"
_KINDS = {"msg": ("msg", "idl"), "srv": ("srv", "idl"), "action": ("action", "idl")}
"""Suffixes of interfaces, by folder."""
_SAYS_SO = (interface_names.GROUP, "rosidl_default_generators")
_HEADER = re.compile(r"(?P<maker>\w+)/(?P<kind>msg|srv|action)/(?P<name>(?!rosidl_)(?!\w*__)\w+)(?P<end>\.h(?:pp)?)")
"""The header of an interface, and none that it is made of."""
_USUAL = ("std_msgs", "geometry_msgs", "sensor_msgs", "builtin_interfaces", "nav_msgs")
"""Packages with messages that others are made of."""


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
    plain: dict[str, list[str]] = {}
    for file in package.files:
        interface = _interface(file) if file.count("/") == 1 else ""
        kind, _, name = interface.partition("/")
        if interface in script.interfaces or not name.isidentifier():
            continue
        wanted = "" if file.endswith(".idl") or interface_names.is_message(name) else interface_names.camel(name)
        refused = next(iter(_refused(package, file)), "")
        aside = interface in script.set_aside
        if wanted or refused or aside:
            yield _finding(package, calls, file, wanted, refused, aside=aside)
        else:
            plain.setdefault(kind, []).append(file)
    for files in plain.values():
        if len(files) > _MANY:
            yield _of_many(package, calls, files)
        else:
            yield from (_finding(package, calls, file) for file in files)


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
    """An interface in a place that needs it."""

    maker: str
    kind: str
    """msg, srv or action; "" where that does not show."""
    name: str
    """As written, without the end of a header."""
    header: str
    """How the name of a header ends, "" for others."""
    bare: bool
    """Whether it is written without a package, for one of its own."""
    place: Span


def _of_users(package: Package, workspace: Workspace) -> Iterator[Finding]:
    """Speak of what a package uses of those that generate interfaces, and not these ones."""
    if not package.builds_with.startswith("ament_") or workspace.unread(package):
        return
    told: dict[tuple[str, str, str, str, bool], list[Span]] = {}
    for used in _used(package):
        told.setdefault(used[:-1], []).append(used.place)
    without: set[str] = set()
    for what, places in told.items():
        used = _Used(*what, places[0])
        if used.maker in without:
            continue
        makers = workspace.by_name.get(used.maker, ())
        maker = makers[0] if len(makers) == 1 else None
        wrong = _lacking(used, workspace) if not makers else _wrong(used, maker, workspace) if maker else None
        if wrong is None:
            continue
        if maker and not maker.built.interfaces:  # it has none of all that is used
            without.add(used.maker)
            places = [place for (name, *_), those in told.items() if name == used.maker for place in those]  # noqa: PLW2901
        if used.bare:
            wrong = _qualified(used, package, workspace) or wrong
        made = next(called(maker, _GENERATE, anywhere=True), None) if maker else None
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
            confidence=Confidence.MEDIUM if not makers and workspace.source_lists else Confidence.HIGH,
            severity=Severity.ERROR,
        )


def _used(package: Package) -> Iterator[_Used]:
    """Yield what a package surely uses that others should generate, or it itself."""
    needed = [use for use in package.uses if use.sure and not use.optional]
    for use in needed:
        if use.via == "interface":
            kind = "" if use.span.path.endswith(".idl") else "msg"
            yield _Used(use.package, kind, use.name.rpartition("/")[2], "", False, use.span)
        elif use.via == "include" and (match := _HEADER.fullmatch(use.name)) and match["maker"] == use.package:
            yield _Used(use.package, match["kind"], match["name"], match["end"], False, use.span)
    modules = {use.span: use.package for use in needed if use.via == "import"}
    for imported in package.imported_types:
        maker, kind, name = imported.name.split("/")
        if modules.get(imported.module) == maker and name[0].isupper():
            yield _Used(maker, kind, name, "", False, imported.span)
    given = generated_from(package) if package.interface_files else ()
    for file in package.interface_files:
        for type_, span in file.types if relative(package, file.path) in given else ():
            maker, _, name = type_.rpartition("/")
            if maker in ("", package.name):
                yield _Used(package.name, "msg", name, "", not maker, span)


def _wrong(used: _Used, maker: Package, workspace: Workspace) -> str | None:
    """Return what is wrong about a use of a package of the workspace, None if nothing is, or nobody can tell."""
    generated = maker.built.interfaces
    if maker.builds_with != "ament_cmake" or maker.hidden(Facet.INTERFACES):
        return None
    if not generated:
        return None if used.header else _of_nothing(used, maker, workspace)
    there = _there(maker, workspace)[used.kind, bool(used.header)]
    if _is_among(used, there):
        return None
    by_hand = f"{used.maker}/{used.kind}/{used.name}{used.header}" if used.header else f"{used.kind}/__init__.py"
    if any(f"/{file}".endswith(f"/{by_hand}") for file in maker.files):
        return None
    return _says(used, generated, there, "generates", "; correct the name, or add the file")


def _of_nothing(used: _Used, maker: Package, workspace: Workspace) -> str | None:
    """Return what is wrong about a use of a package that generates nothing and has no module of the name, None as above."""
    kind = used.kind or "msg"
    interface, file = f"{kind}/{used.name}", f"{kind}/{used.name}.{kind}"
    if maker.script is None or next(called(maker, _GENERATE, anywhere=True), None):
        return None
    if file in maker.files:
        return f"{used.maker} generates nothing from {file}; give it to {_GENERATE}()"
    if any(each.endswith((f"{kind}.py", f"{kind}/__init__.py", f".{kind}", ".idl")) for each in maker.files):
        return None
    having = [each.name for each in workspace.packages if interface in each.built.interfaces]
    way_out = f"; did you mean that of '{having[0]}'?" if having else "; correct the name"
    return f"{used.maker} generates no interfaces, and so no {interface}{way_out}"


def _lacking(used: _Used, workspace: Workspace) -> str | None:
    """Return what is wrong about a use of a package that is released, or below the workspace, None as above."""
    known = workspace.world.interfaces(used.maker, everywhere=not workspace.target.told)
    there = _names(known, used.kind, bool(used.header))
    if not known or _is_among(used, there):
        return None
    if used.name not in _names(known, "", bool(used.header)) and not similar(used.name, there, 1, 0.88):
        return None  # no slip, and a newer version may have more than is known
    return _says(used, sorted(known), there, "has", "; correct the name")


def _is_among(used: _Used, there: Collection[str]) -> bool:
    """Whether what is used is one of some interfaces, or a message that a service or an action is made of."""
    return used.name in there or (not used.header and any(used.name.startswith(f"{name}_") for name in there))


def _says(used: _Used, interfaces: Sequence[str], there: Collection[str], does: str, way_out: str) -> str:
    """Return what a message says of a use, by all that there is, and by what of it is of the same kind."""
    form = _form(used.header)
    named = f"{used.kind or 'msg'}/{used.name}{used.header}"
    of_others = ((each.partition("/")[0], form(each.partition("/")[2])) for each in interfaces)
    elsewhere = next((f"{kind}/{name}{used.header}" for kind, name in of_others if name == used.name), "")
    if elsewhere:
        return f"{used.maker} {does} no {named}; there is {elsewhere}"
    near = similar(used.name, sorted(there))
    return f"{used.maker} {does} no {named}{did_you_mean([f'{each}{used.header}' for each in near]) or way_out}"


def _qualified(used: _Used, package: Package, workspace: Workspace) -> str:
    """Return what a message says of a type without its package that another one has, "" if none is known that has it."""
    names = dict.fromkeys([*(declared.name for declared in package.declared), *_USUAL])
    world, everywhere = workspace.world, not workspace.target.told
    having = [
        f"{name}/{used.name}"
        for name in names
        if f"{used.kind}/{used.name}" in (world.interfaces(name, everywhere=everywhere) or _made(name, workspace))
    ]
    if not having:
        return ""
    return f"{used.maker} generates no {used.name}, and a type without a package is of the same one{did_you_mean(having[:2])}"


def _made(name: str, workspace: Workspace) -> tuple[str, ...]:
    """Return what a package of the workspace generates."""
    return next((package.built.interfaces for package in workspace.by_name.get(name, ())), ())


@per_package
def _there(maker: Package, workspace: Workspace) -> Mapping[tuple[str, bool], frozenset[str]]:
    """Return the interfaces of a package by their kind, "" for any, and by whether they are written as in headers.

    Those of files from which nothing is generated count, too: another finding speaks of them.
    """
    left_over = [each for file in maker.files if (each := _interface(file)) and each not in maker.built.set_aside]
    everything = frozenset([*maker.built.interfaces, *left_over])
    return {(kind, header): _names(everything, kind, header) for kind in ("", *_KINDS) for header in (False, True)}


@cache
def _names(interfaces: frozenset[str], kind: str, header: bool) -> frozenset[str]:
    """Return the names of those of a kind, "" for any, as they are written, in headers or elsewhere."""
    form = _form(header)
    return frozenset([form(each.partition("/")[2]) for each in interfaces if each.startswith(kind)])


def _form(header: object) -> Callable[[str], str]:
    """Return how the name of an interface is written, in that of a header or elsewhere."""
    return interface_names.snake if header else str


def _interface(file: str) -> str:
    """Return the interface that a file has in it, as ``msg/Name``, "" if it has none."""
    folder, _, name = file.rpartition("/")
    stem, _, suffix = name.rpartition(".")
    kind = folder.rpartition("/")[2]
    return f"{kind}/{stem}" if suffix in _KINDS.get(kind, ()) else ""


def _here(package: Package, file: str) -> Related:
    return Related("this file", place_of(package, file))


def _refused(package: Package, file: str) -> list[str]:
    """Return why rosidl does not take a file."""
    read = [each for each in package.interface_files if relative(package, each.path) == file]
    return [problem.message for each in read for problem in each.problems]


def _finding(
    package: Package, calls: list[Call], file: str, wanted: str = "", refused: str = "", *, aside: bool = False
) -> Finding:
    """``wanted``: what the file has to be called before anything can be generated from it, "" if it is.

    ``refused``: why rosidl does not take it, "" if it does; ``aside``: a comment has it where a list had it, which is
    mostly meant so.
    """
    way_out = f"rosidl wants it to be called {wanted}" if wanted else "add it, or remove it"
    if wanted and f"{_interface(file).partition('/')[0]}/{wanted}" in package.built.interfaces:
        way_out = f"{wanted} is in its place: remove it"
    elif refused and not wanted:
        way_out = f"remove it, or correct it, for rosidl does not take it: {refused}"
    return Finding(
        f"{file} is not given to {_GENERATE}(), so nothing is generated from it; {way_out}",
        calls[0].place,
        file,
        (_here(package, file),),
        None if wanted or aside or refused else _fix(calls, [file]),
        Confidence.MEDIUM if aside or calls[0].blocks else Confidence.HIGH,
    )


_MANY = 5
"""More files of one folder than these are told of at once."""


def _of_many(package: Package, calls: list[Call], files: list[str]) -> Finding:
    return Finding(
        f"{files[0]} and {len(files) - 1} more are not given to {_GENERATE}(), so nothing is generated from them; add them, "
        "or remove them",
        calls[0].place,
        f"{files[0].partition('/')[0]}/",
        several(_here(package, file) for file in files),
        _fix(calls, files),
        Confidence.MEDIUM if calls[0].blocks else Confidence.HIGH,
    )


def _fix(calls: list[Call], files: list[str]) -> Fix | None:
    """Return how to add files of one folder below the last one of it, None where none is written out."""
    folder = f"{files[0].partition('/')[0]}/"
    for call in calls:
        at = max((index for index, text in enumerate(call.texts) if text.startswith(folder)), default=None)
        if at is not None:
            span = call.span(at)
            quote = '"' if span.end_column - span.column == len(call.texts[at]) + 2 else ""
            gap = " " if at and span.line == call.span(at - 1).line else "\n" + " " * (span.column - 1)
            added = "".join(f"{gap}{quote}{file}{quote}" for file in files)
            return Fix(f"generate {few(files)}", (Edit(span.end(), added),), safe=False)
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
