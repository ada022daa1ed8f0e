"""Names that rosidl takes for interfaces, and what it makes of them (rosidl_adapter/parser.py, rosidl_cmake)."""

from __future__ import annotations

import re

GROUP = "rosidl_interface_packages"
"""The group of all packages with interfaces."""
UNDERLYING = frozenset({"action_msgs", "builtin_interfaces", "service_msgs", "unique_identifier_msgs"})
"""What services and actions are made of, whatever fields they have; which of these must be declared has changed with time."""

_MESSAGE = re.compile(r"[A-Z][A-Za-z0-9]*")
_LOWER = re.compile(r"(?!\w*__)[a-z](?:[a-z0-9_]*[a-z0-9])?")
_CONSTANT = re.compile(r"[A-Z](?:_?[A-Z0-9])*")
_MADE = ("_Request", "_Response", "_Goal", "_Result", "_Feedback")
"""How the names of messages end that services and actions are made of."""
_BETWEEN_WORDS = re.compile("[^A-Za-z0-9]+")
_BEFORE_WORD = re.compile("(.)([A-Z][a-z]+)")
_BEFORE_CAPITAL = re.compile("([a-z0-9])([A-Z])")


def is_message(name: str) -> bool:
    """Return whether an interface may be called so."""
    name = name.removeprefix("Sample_")
    for end in _MADE:
        name = name.removesuffix(end)
    return _MESSAGE.fullmatch(name) is not None


def is_field(name: str) -> bool:
    """Return whether a field may be called so, and a package whose interfaces are generated."""
    return _LOWER.fullmatch(name) is not None


def is_constant(name: str) -> bool:
    """Return whether a constant may be called so."""
    return _CONSTANT.fullmatch(name) is not None


def snake(name: str) -> str:
    """Return the name of an interface as rosidl writes it in those of headers."""
    return _BEFORE_CAPITAL.sub(r"\1_\2", _BEFORE_WORD.sub(r"\1_\2", name)).lower()


def camel(name: str) -> str:
    """Return a name as rosidl wants it for an interface."""
    return "".join(word[:1].upper() + word[1:] for word in _BETWEEN_WORDS.split(name))
