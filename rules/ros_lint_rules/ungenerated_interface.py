"""
## What it finds

Interface files without generated code:

- Messages, services and actions in `msg/`, `srv/` and `action/` that `rosidl_generate_interfaces()` does not list, although it
  lists others.
- Interface files of an `ament_python` package that declares in `package.xml` that it generates interfaces. `ament_python`
  cannot generate code.

Uses of interfaces that do not exist: a header, an imported name or the type of a field that its package does not have. The
package may be this one, another one of the workspace, or a released one. The type `Header` without a package name is a `Header`
of the same package, not that of `std_msgs`.

## Why it matters

Without generated code the build or the import fails: "fatal error: robot/msg/state.hpp: No such file or directory", "cannot
import name 'State' from 'robot.msg'". `ros2 interface show` does not find the interface.

## How to fix it

Add the file to the call, or remove it. The fix adds it below another file of the same folder, if these files are listed
literally.

- rosidl rejects names like `motor_state.msg`: rename the file to `MotorState.msg` first.
- Move the interfaces of an `ament_python` package to an `ament_cmake` package.
- If a used interface does not exist, correct its name or add the file.

## Limitations

Files are not reported:

- In packages that generate nothing, unless other packages or interfaces use them.
- In other folders, and copies such as `State copy.msg` or `State.old.msg`.
- If the list of files cannot be evaluated.

Files are reported with medium confidence if a comment in the CMake file contains them in place of a list element, or if the
call is under a condition.

Uses are not reported:

- In files that may be unused, and in packages with a file that cannot be read.
- Optional imports and includes.
- If a folder of the package provides the header or module in another way, or two packages of the workspace have the same name.
- Of released packages whose interfaces are not all known.
- Of released packages, if a newer version may have the interface. Near matches and names of another kind, such as a service
  used as a message, are reported.

If the distribution is not set, a use of a released package is reported only if the interface exists in no distribution. If the
workspace lists further repositories, which may contain the package, the confidence is medium.
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
    build,
    cached_by_package,
    first_related,
    names,
)

_GENERATE = "rosidl_generate_interfaces"
_KINDS = {"msg": ("msg", "idl"), "srv": ("srv", "idl"), "action": ("action", "idl")}
"""File name suffixes of interfaces by folder."""
_DECLARE_INTERFACES = (names.interfaces.GROUP, "rosidl_default_generators")
_HEADER = re.compile(r"(?P<maker>\w+)/(?P<kind>msg|srv|action)/(?P<name>(?!rosidl_)(?!\w*__)\w+)(?P<end>\.h(?:pp)?)")
"""The main header of an interface, not its detail headers."""
_USUAL = ("std_msgs", "geometry_msgs", "sensor_msgs", "builtin_interfaces", "nav_msgs")
"""Packages with messages that other messages commonly contain."""


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    script = package.script
    if package.builds_with == "ament_python":
        yield from _of_python(package)
    yield from _missing(package, workspace)
    if script is None or package.builds_with != "ament_cmake" or package.hidden(Facet.INTERFACES):
        return
    calls = list(package.calls(_GENERATE, anywhere=True))
    if not calls or not script.products.interfaces:
        return
    plain: dict[str, list[str]] = {}
    for file in package.files:
        interface = _interface(file) if file.count("/") == 1 else ""
        kind, _, name = interface.partition("/")
        if interface in script.products.interfaces or not name.isidentifier():
            continue
        required = "" if file.endswith(".idl") or names.interfaces.is_message(name) else names.interfaces.camel(name)
        rejection = next(iter(_rejections(package, file)), "")
        commented_out = interface in script.cmake.commented_interfaces
        if required or rejection or commented_out:
            yield _finding(package, calls, file, required, rejection, commented_out=commented_out)
        else:
            plain.setdefault(kind, []).append(file)
    for files in plain.values():
        if len(files) > _MANY:
            yield _of_many(package, calls, files)
        else:
            yield from (_finding(package, calls, file) for file in files)


def _of_python(package: Package) -> Iterator[Finding]:
    """Yield one finding for all interfaces of a package, at the tag that declares that it generates interfaces."""
    depends = package.manifest.depends if package.manifest else ()
    tag = next((depend for depend in depends if depend.name in _DECLARE_INTERFACES), None)
    parts = [(file, *file.rpartition("/")) for file in package.files]
    files = [file for file, folder, _, name in parts if name.rpartition(".")[2] == folder.rpartition("/")[2] in _KINDS]
    if tag is None or not files:
        return
    others = f" and {len(files) - 1} more" if len(files) > 1 else ""
    yield Finding(
        f"no code is generated for '{files[0]}'{others}, because ament_python cannot generate interfaces; move "
        f"{'them' if others else 'it'} to an ament_cmake package",
        tag.span,
        files[0],
        first_related(_here(package, file) for file in files),
    )


class _Used(NamedTuple):
    """A use of an interface."""

    maker: str
    """The package that should have the interface."""
    kind: str
    """msg, srv or action; "" if unknown."""
    name: str
    """As written, without the suffix of a header."""
    header: str
    """The suffix of a header; "" if it is not a header."""
    bare: bool
    """True if the type has no package name, so it belongs to the same package."""
    place: Span


def _missing(package: Package, workspace: Workspace) -> Iterator[Finding]:
    """Yield findings for uses of interfaces that their packages do not have."""
    if not package.builds_with.startswith("ament_") or workspace.unread(package):
        return
    places_by_use: dict[tuple[str, str, str, str, bool], list[Span]] = {}
    for used in _used(package):
        places_by_use.setdefault(used[:-1], []).append(used.place)
    reported: set[str] = set()
    for key, places in places_by_use.items():
        used = _Used(*key, places[0])
        if used.maker in reported:
            continue
        makers = workspace.by_name.get(used.maker, ())
        maker = makers[0] if len(makers) == 1 else None
        wrong = _wrong_released(used, workspace) if not makers else _wrong(used, maker, workspace) if maker else None
        if wrong is None:
            continue
        if maker and not maker.built.products.interfaces:  # one finding for all uses of the package
            reported.add(used.maker)
            places = [place for (name, *_), same in places_by_use.items() if name == used.maker for place in same]  # noqa: PLW2901
        if used.bare:
            wrong = _qualified(used, package, workspace) or wrong
        generating = next(maker.calls(_GENERATE, anywhere=True), None) if maker else None
        related = [Related("the interfaces are generated here", generating.name_span)] if generating else []
        related += [Related("also used here", place) for place in places[1:]]
        yield Finding(
            wrong,
            places[0],
            f"{used.maker}/{used.kind or 'msg'}/{used.name}",
            first_related(related),
            confidence=Confidence.MEDIUM if not makers and workspace.source_lists else Confidence.HIGH,
            severity=Severity.ERROR,
        )


def _used(package: Package) -> Iterator[_Used]:
    """Yield the certain uses of interfaces, including those of the package itself."""
    needed = [use for use in package.uses if use.certain and not use.optional]
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
    generated = build.generated_from(package) if package.interface_files else ()
    for file in package.interface_files:
        for type_, span in file.types if package.relative(file.path) in generated else ():
            maker, _, name = type_.rpartition("/")
            if maker in ("", package.name):
                yield _Used(package.name, "msg", name, "", not maker, span)


def _wrong(used: _Used, maker: Package, workspace: Workspace) -> str | None:
    """Return the message about a use of a package of the workspace; None if it is right or cannot be decided."""
    generated = maker.built.products.interfaces
    if maker.builds_with != "ament_cmake" or maker.hidden(Facet.INTERFACES):
        return None
    if not generated:
        return None if used.header else _wrong_without_interfaces(used, maker, workspace)
    available = _available(maker, workspace)[used.kind, bool(used.header)]
    if _is_among(used, available):
        return None
    by_hand = f"{used.maker}/{used.kind}/{used.name}{used.header}" if used.header else f"{used.kind}/__init__.py"
    if any(f"/{file}".endswith(f"/{by_hand}") for file in maker.files):
        return None
    return _message(used, generated, available, "generate", "; correct the name or add the file")


def _wrong_without_interfaces(used: _Used, maker: Package, workspace: Workspace) -> str | None:
    """Return the message about a use of a package that generates nothing; None as in _wrong()."""
    kind = used.kind or "msg"
    interface, file = f"{kind}/{used.name}", f"{kind}/{used.name}.{kind}"
    if maker.script is None or next(maker.calls(_GENERATE, anywhere=True), None):
        return None
    if file in maker.files:
        return f"'{used.maker}' does not generate code for '{file}'; add it to {_GENERATE}()"
    if any(path.endswith((f"{kind}.py", f"{kind}/__init__.py", f".{kind}", ".idl")) for path in maker.files):
        return None
    owners = [package.name for package in workspace.packages if interface in package.built.products.interfaces]
    remedy = f"; did you mean the one of '{owners[0]}'?" if owners else "; correct the name"
    return f"'{used.maker}' does not generate interfaces, so '{interface}' does not exist{remedy}"


def _wrong_released(used: _Used, workspace: Workspace) -> str | None:
    """Return the message about a use of a package that is released or in an underlay; None as in _wrong()."""
    known = workspace.world.interfaces(used.maker, everywhere=not workspace.target.explicit)
    available = _names(known, used.kind, bool(used.header))
    if not known or _is_among(used, available):
        return None
    if used.name not in _names(known, "", bool(used.header)) and not names.similar_names(used.name, available, 1, 0.88):
        return None  # not a typo: a newer version may have the interface
    return _message(used, sorted(known), available, "have", "; correct the name")


def _is_among(used: _Used, available: Collection[str]) -> bool:
    """Return whether the interface is among ``available``, or is a message that belongs to a service or an action."""
    return used.name in available or (not used.header and any(used.name.startswith(f"{name}_") for name in available))


def _message(used: _Used, interfaces: Sequence[str], available: Collection[str], verb: str, remedy: str) -> str:
    """Return the message about a use, with a suggestion from all ``interfaces`` or from those ``available`` of the same kind."""
    form = _form(used.header)
    named = f"{used.kind or 'msg'}/{used.name}{used.header}"
    parts = ((interface.partition("/")[0], interface.partition("/")[2]) for interface in interfaces)
    elsewhere = next((f"{kind}/{form(name)}{used.header}" for kind, name in parts if form(name) == used.name), "")
    if elsewhere:
        return f"'{used.maker}' does not {verb} '{named}'; it has '{elsewhere}'"
    near = names.similar_names(used.name, sorted(available))
    suggestion = names.did_you_mean([f"{name}{used.header}" for name in near])
    return f"'{used.maker}' does not {verb} '{named}'{suggestion or remedy}"


def _qualified(used: _Used, package: Package, workspace: Workspace) -> str:
    """Return the message about a type without a package name that another package has; "" if no package has it."""
    all_names = dict.fromkeys([*(declared.name for declared in package.declared), *_USUAL])
    world, everywhere = workspace.world, not workspace.target.explicit
    owners = [
        f"{name}/{used.name}"
        for name in all_names
        if f"{used.kind}/{used.name}" in (world.interfaces(name, everywhere=everywhere) or _generated(name, workspace))
    ]
    if not owners:
        return ""
    message = f"'{used.maker}' does not generate '{used.name}', and a type without a package name belongs to the same package"
    return message + names.did_you_mean(owners[:2])


def _generated(name: str, workspace: Workspace) -> tuple[str, ...]:
    """Return the interfaces that a package of the workspace generates."""
    return next((package.built.products.interfaces for package in workspace.by_name.get(name, ())), ())


@cached_by_package
def _available(maker: Package, workspace: Workspace) -> Mapping[tuple[str, bool], frozenset[str]]:
    """Return the names of the interfaces of a package by kind, "" for any, and by whether they are written as in headers.

    Includes files for which no code is generated, because another finding reports them.
    """
    interfaces = [_interface(file) for file in maker.files]
    ungenerated = [interface for interface in interfaces if interface and interface not in maker.built.cmake.commented_interfaces]
    everything = frozenset([*maker.built.products.interfaces, *ungenerated])
    return {(kind, header): _names(everything, kind, header) for kind in ("", *_KINDS) for header in (False, True)}


@cache
def _names(interfaces: frozenset[str], kind: str, header: bool) -> frozenset[str]:
    """Return the names of the interfaces of a kind, "" for any, as written in headers or elsewhere."""
    form = _form(header)
    return frozenset([form(interface.partition("/")[2]) for interface in interfaces if interface.startswith(kind)])


def _form(header: object) -> Callable[[str], str]:
    """Return the function that spells the name of an interface as in headers, or as elsewhere."""
    return names.interfaces.snake if header else str


def _interface(file: str) -> str:
    """Return the interface that a file defines, as ``msg/Name``; "" if it defines none."""
    folder, _, name = file.rpartition("/")
    stem, _, suffix = name.rpartition(".")
    kind = folder.rpartition("/")[2]
    return f"{kind}/{stem}" if suffix in _KINDS.get(kind, ()) else ""


def _here(package: Package, file: str) -> Related:
    return Related("this file", package.start_of(file))


def _rejections(package: Package, file: str) -> list[str]:
    """Return the reasons why rosidl rejects a file."""
    parsed = [interface for interface in package.interface_files if package.relative(interface.path) == file]
    return [problem.message for interface in parsed for problem in interface.problems]


def _finding(
    package: Package, calls: list[Call], file: str, required: str = "", rejection: str = "", *, commented_out: bool = False
) -> Finding:
    """Return the finding about an unlisted file, which needs the name ``required`` first unless that is "".

    ``rejection``: why rosidl rejects the file, "" if it does not. ``commented_out``: a comment has it in place of a list element.
    """
    remedy = f"rename it to '{required}', as rosidl requires, and add it" if required else "add it or remove the file"
    if required and f"{_interface(file).partition('/')[0]}/{required}" in package.built.products.interfaces:
        remedy = f"'{required}' replaces it, so remove the file"
    elif rejection and not required:
        remedy = f"correct or remove it, because rosidl rejects it: {rejection}"
    return Finding(
        f"'{file}' is not listed in {_GENERATE}(), so no code is generated for it; {remedy}",
        calls[0].name_span,
        file,
        (_here(package, file),),
        None if required or commented_out or rejection else _fix(calls, [file]),
        Confidence.MEDIUM if commented_out or calls[0].blocks else Confidence.HIGH,
    )


_MANY = 5
"""If more files of one folder are not listed, they share one finding."""


def _of_many(package: Package, calls: list[Call], files: list[str]) -> Finding:
    return Finding(
        f"'{files[0]}' and {len(files) - 1} more are not listed in {_GENERATE}(), so no code is generated for them; "
        "add or remove them",
        calls[0].name_span,
        f"{files[0].partition('/')[0]}/",
        first_related(_here(package, file) for file in files),
        _fix(calls, files),
        Confidence.MEDIUM if calls[0].blocks else Confidence.HIGH,
    )


def _fix(calls: list[Call], files: list[str]) -> Fix | None:
    """Return the fix that adds files of one folder below the last listed one; None if no file is listed literally."""
    folder = f"{files[0].partition('/')[0]}/"
    for call in calls:
        at = max((index for index, text in enumerate(call.texts) if text.startswith(folder)), default=None)
        if at is not None:
            span = call.span(at)
            quote = '"' if span.end_column - span.column == len(call.texts[at]) + 2 else ""
            gap = " " if at and span.line == call.span(at - 1).line else "\n" + " " * (span.column - 1)
            added = "".join(f"{gap}{quote}{file}{quote}" for file in files)
            return Fix(f"generate {names.shorten_list(files)}", (Edit(span.end(), added),), safe=False)
    return None


RULE = Rule(
    name="ungenerated-interface",
    code="ROS313",
    summary="code is generated for interface files, and used interfaces exist",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
