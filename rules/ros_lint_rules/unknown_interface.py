"""
## What it finds

A message, service or action that is used but does not exist: code includes its header or imports it, or a field has it as type,
but its package does not have it. The package may be this one, another one of the workspace, or a released one. The type
`Header` without a package name is a `Header` of the same package, not that of `std_msgs`.

## Why it matters

The build or the import fails: "fatal error: robot/msg/state.hpp: No such file or directory", "cannot import name 'State' from
'robot.msg'".

## How to fix it

Correct the name, or add the file. The message suggests a similar name.

## Limitations

Not reported:

- Uses in files that may be unused, and in packages with a file that cannot be read.
- Optional imports and includes.
- Uses, if a folder of the package provides the header or module in another way, or two packages of the workspace have the same
  name.
- Uses of released packages whose interfaces are not all known.
- Uses of released packages, if a newer version may have the interface. Near matches and names of another kind, such as a service
  used as a message, are reported.
- Interfaces whose file is not listed: `ungenerated-interface` reports it.

If the distribution is not set, a use of a released package is reported only if the interface exists in no distribution. If the
workspace lists further repositories, which may contain the package, the confidence is medium.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from functools import cache
from typing import NamedTuple

from ros_lint.api import (
    Confidence,
    Facet,
    Finding,
    Package,
    Related,
    Rule,
    Severity,
    Span,
    Workspace,
    build,
    cached_by_package,
    files,
    first_related,
    names,
)

_GENERATE = "rosidl_generate_interfaces"
_HEADER = re.compile(r"(?P<maker>\w+)/(?P<kind>msg|srv|action)/(?P<name>(?!rosidl_)(?!\w*__)\w+)(?P<end>\.h(?:pp)?)")
"""Pattern of the main header of an interface; detail headers such as ``robot/msg/detail/state__struct.hpp`` do not match."""
_USUAL = ("std_msgs", "geometry_msgs", "sensor_msgs", "builtin_interfaces", "nav_msgs")
"""Packages with messages that other messages commonly contain."""


class _Used(NamedTuple):
    """A use of an interface (message, service or action)."""

    maker: str
    """The package that should have the interface."""
    kind: str
    """msg, srv or action; "" if unknown."""
    name: str
    """The name of the interface as written, without the suffix of a header."""
    header: str
    """The suffix of a header; "" if it is not a header."""
    bare: bool
    """True if the type has no package name, so it belongs to the same package."""
    place: Span


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
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
        related = [Related(f"the interfaces of '{used.maker}' are generated here", generating.name_span)] if generating else []
        related += [Related(f"an interface of '{used.maker}' is also used here", place) for place in places[1:]]
        yield Finding(
            wrong,
            places[0],
            f"{used.maker}/{used.kind or 'msg'}/{used.name}",
            first_related(related),
            confidence=Confidence.MEDIUM if not makers and workspace.source_lists else Confidence.HIGH,
        )


def _used(package: Package) -> Iterator[_Used]:
    """Yield the certain uses of interfaces, including interfaces of the package itself."""
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
    """Return the message about a use of an interface of ``maker``, a package of the workspace.

    None if the interface exists, or if that cannot be decided.
    """
    generated = maker.built.products.interfaces
    if maker.builds_with != "ament_cmake" or maker.hidden(Facet.INTERFACES):
        return None
    if not generated:
        return None if used.header else _wrong_without_interfaces(used, maker, workspace)
    available = _available(maker, workspace)[used.kind, bool(used.header)]
    if _is_among(used, available):
        return None
    by_hand = f"{used.maker}/{used.kind}/{used.name}{used.header}" if used.header else f"{used.kind}/__init__.py"
    named = files.files_by_name(maker, workspace).get(by_hand.rpartition("/")[2], ())
    if any(f"/{file}".endswith(f"/{by_hand}") for file in named):
        return None
    elsewhere = _first_by_form(maker, workspace)[bool(used.header)].get(used.name, "")
    return _message(used, elsewhere, available, "generate", "; correct the name or add the file")


@cached_by_package
def _first_by_form(maker: Package, _: Workspace) -> Mapping[bool, Mapping[str, str]]:
    """Return the generated interfaces of a package by their names, which are in snake_case for the key True (headers)."""
    return {header: _by_form(maker.built.products.interfaces, header) for header in (False, True)}


def _by_form(interfaces: Sequence[str], header: bool) -> Mapping[str, str]:
    form = _form(header)
    return {form(interface.partition("/")[2]): interface for interface in reversed(interfaces)}


def _wrong_without_interfaces(used: _Used, maker: Package, workspace: Workspace) -> str | None:
    """Return the message about a use of an interface of ``maker``, a package that generates no interfaces.

    None if the interface may exist nevertheless.
    """
    kind = used.kind or "msg"
    interface, file = f"{kind}/{used.name}", f"{kind}/{used.name}.{kind}"
    if maker.script is None or next(maker.calls(_GENERATE, anywhere=True), None):
        return None
    if file in maker.files:
        return f"'{used.maker}' does not generate code for '{file}'; add it to {_GENERATE}()"
    if any(path.endswith((f"{kind}.py", f"{kind}/__init__.py", f".{kind}", ".idl")) for path in maker.files):
        return None
    owners = [package.name for package in workspace.packages if interface in package.built.products.interfaces]
    remedy = f"; did you mean '{interface}' of '{owners[0]}'?" if owners else "; correct the name"
    return f"'{used.maker}' does not generate interfaces, so '{interface}' does not exist{remedy}"


def _wrong_released(used: _Used, workspace: Workspace) -> str | None:
    """Return the message about a use of an interface of a package that is released or in an underlay.

    None if the interface exists, or if that cannot be decided.
    """
    known = workspace.world.interfaces(used.maker, everywhere=not workspace.target.explicit)
    available = _names(known, used.kind, bool(used.header))
    if not known or _is_among(used, available):
        return None
    if used.name not in _names(known, "", bool(used.header)) and not names.similar_names(used.name, available, 1, 0.88):
        return None  # not a typo: a newer version may have the interface
    elsewhere = _by_form(sorted(known), bool(used.header)).get(used.name, "")
    return _message(used, elsewhere, available, "have", "; correct the name")


def _is_among(used: _Used, available: Collection[str]) -> bool:
    """Return whether the interface is among ``available``, or is a message of a service or action there: ``Add_Request``."""
    beginnings = [used.name[: match.start()] for match in re.finditer("_", used.name)]
    return used.name in available or (not used.header and any(name in available for name in beginnings))


def _message(used: _Used, elsewhere: str, available: Collection[str], verb: str, remedy: str) -> str:
    """Return the message about a use of a missing interface.

    It suggests ``elsewhere``, an interface of another kind but the same name, else a similar name from ``available``. If there
    is no suggestion, it ends with ``remedy``. ``verb``: "generate" or "have".
    """
    named = f"{used.kind or 'msg'}/{used.name}{used.header}"
    if elsewhere:
        kind = elsewhere.partition("/")[0]
        return f"'{used.maker}' does not {verb} '{named}'; it has '{kind}/{used.name}{used.header}'"
    near = names.nearest_names(used.name, available)
    suggestion = names.did_you_mean([f"{name}{used.header}" for name in near])
    return f"'{used.maker}' does not {verb} '{named}'{suggestion or remedy}"


def _qualified(used: _Used, package: Package, workspace: Workspace) -> str:
    """Return the message about a type without a package name, if another package has a message of this name; else ""."""
    all_names = dict.fromkeys([*(declared.name for declared in package.declared), *_USUAL])
    world, everywhere = workspace.world, not workspace.target.explicit
    owners = [
        f"{name}/{used.name}"
        for name in all_names
        if f"{used.kind}/{used.name}" in (world.interfaces(name, everywhere=everywhere) or _generated(name, workspace))
    ]
    if not owners:
        return ""
    message = f"'{used.name}' means '{used.maker}/{used.name}', which '{used.maker}' does not generate"
    return message + names.did_you_mean(owners[:2])


def _generated(name: str, workspace: Workspace) -> tuple[str, ...]:
    """Return the interfaces that a package of the workspace generates."""
    return next((package.built.products.interfaces for package in workspace.by_name.get(name, ())), ())


@cached_by_package
def _available(maker: Package, workspace: Workspace) -> Mapping[tuple[str, bool], frozenset[str]]:
    """Return the names of the interfaces of a package, by kind ("" for all kinds) and by whether the names are in snake_case.

    The names of headers are in snake_case. Interfaces for which no code is generated are included, because
    ungenerated-interface reports them.
    """
    interfaces = [names.interfaces.defined_in(file) for file in maker.files]
    ungenerated = [interface for interface in interfaces if interface and interface not in maker.built.cmake.commented_interfaces]
    everything = frozenset([*maker.built.products.interfaces, *ungenerated])
    return {
        (kind, header): _names(everything, kind, header) for kind in ("", *names.interfaces.KINDS) for header in (False, True)
    }


@cache
def _names(interfaces: frozenset[str], kind: str, header: bool) -> frozenset[str]:
    """Return the names of the interfaces of a kind, or of all interfaces if ``kind`` is "".

    With ``header`` the names are in snake_case, as in the names of headers.
    """
    form = _form(header)
    return frozenset([form(interface.partition("/")[2]) for interface in interfaces if interface.startswith(kind)])


def _form(header: object) -> Callable[[str], str]:
    """Return the function that converts the name of an interface: to snake_case for headers, else unchanged."""
    return names.interfaces.snake if header else str


RULE = Rule(
    name="unknown-interface",
    code="ROS321",
    summary="used messages, services and actions exist",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    package=check,
)
