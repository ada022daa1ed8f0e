"""Macros in C++ that make classes loadable: components (rclcpp_components) and plugins (pluginlib, class_loader)."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from ros_lint.collectors.cpp_includes import blanked
from ros_lint.facts import Registration

if TYPE_CHECKING:
    from ros_lint.text import Text

_MACRO = re.compile(
    r"^[ \t]*(RCLCPP_COMPONENTS_REGISTER_NODE|PLUGINLIB_EXPORT_CLASS|CLASS_LOADER_REGISTER_CLASS)\s*\(([^;{}()#]*)\)",
    re.MULTILINE,
)


def registrations(source: Text) -> tuple[Registration, ...]:
    """Return the classes that a C++ file makes loadable, in order."""
    text = source.text
    if "_REGISTER_" not in text and "PLUGINLIB_EXPORT_CLASS" not in text:
        return ()
    found = []
    for match in _MACRO.finditer(blanked(text)):
        name, _, base = (part.strip() for part in match[2].partition(","))
        kind = "component" if match[1].startswith("RCLCPP") else "plugin"
        if name and (base or kind == "component"):
            span = source.span(match.start(1), match.end(1))
            found.append(Registration("component" if kind == "component" else "plugin", _plain(name), _plain(base), span))
    return tuple(found)


def _plain(name: str) -> str:
    return re.sub(r"\s+", "", name).removeprefix("::")
