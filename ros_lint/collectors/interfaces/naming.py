"""Valid names of interfaces, and the names that rosidl derives from them (rosidl_adapter, rosidl_cmake)."""

from __future__ import annotations

import re

GROUP = "rosidl_interface_packages"
"""The package group of all packages with interfaces, for ``<member_of_group>``."""
UNDERLYING = frozenset({"action_msgs", "builtin_interfaces", "service_msgs", "unique_identifier_msgs"})
"""Packages that all services and actions use.

The distribution decides which of these packages must be declared."""

_MESSAGE = re.compile(r"[A-Z][A-Za-z0-9]*")
_LOWER = re.compile(r"(?!\w*__)[a-z](?:[a-z0-9_]*[a-z0-9])?")
_CONSTANT = re.compile(r"[A-Z](?:_?[A-Z0-9])*")
_GENERATED_SUFFIXES = ("_Request", "_Response", "_Goal", "_Result", "_Feedback")
"""Endings of the names of messages that rosidl generates for services and actions."""
_BETWEEN_WORDS = re.compile("[^A-Za-z0-9]+")
_BEFORE_WORD = re.compile("(.)([A-Z][a-z]+)")
_BEFORE_CAPITAL = re.compile("([a-z0-9])([A-Z])")


def is_message(name: str) -> bool:
    """Return whether a name is a valid name of a message, service or action: ``LaserScan``, not ``laser_scan``."""
    name = name.removeprefix("Sample_")
    for end in _GENERATED_SUFFIXES:
        name = name.removesuffix(end)
    return _MESSAGE.fullmatch(name) is not None


def is_field(name: str) -> bool:
    """Return whether a name is a valid name of a field, or of a package with interfaces: ``range_min``, not ``rangeMin``."""
    return _LOWER.fullmatch(name) is not None


def is_constant(name: str) -> bool:
    """Return whether a name is a valid name of a constant: ``MAX_SPEED``."""
    return _CONSTANT.fullmatch(name) is not None


def snake(name: str) -> str:
    """Return the name of an interface as rosidl writes it in the names of headers: ``LaserScan`` -> ``laser_scan``."""
    return _BEFORE_CAPITAL.sub(r"\1_\2", _BEFORE_WORD.sub(r"\1_\2", name)).lower()


def camel(name: str) -> str:
    """Return a name in CamelCase, which rosidl requires for interfaces: ``laser_scan`` -> ``LaserScan``."""
    return "".join(word[:1].upper() + word[1:] for word in _BETWEEN_WORDS.split(name))


def defined_in(file: str) -> str:
    """Return the interface that a file defines: ``robot/msg/State.msg`` -> ``msg/State``; "" if the file defines no interface."""
    folder, _, name = file.rpartition("/")
    stem, _, suffix = name.rpartition(".")
    kind = folder.rpartition("/")[2]
    return f"{kind}/{stem}" if kind in KINDS and suffix in (kind, "idl") else ""


KINDS = ("msg", "srv", "action")
"""Kinds of interfaces. Each is also the name of the folder and the suffix of the files with such interfaces."""
